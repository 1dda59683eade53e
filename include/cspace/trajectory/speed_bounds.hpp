// The fastest squared speeds along a path: what can be reached from the end backwards, then the greatest
// acceleration forwards (Pham and Pham 2018).
//
// For given x the rows of an interval leave an interval of y whose width is concave in x, so that the
// greatest and the least x with a y are found by Newton's method from outside, in one or two passes over the
// rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/math/float_lanes.hpp"
#include "cspace/trajectory/path_rows.hpp"

namespace cspace::trajectory {

// Squared speeds from which the rest of the path can be followed; empty if low is above high.
struct SpeedRange {
    double low, high;
};

// How a squared speed changes with the one after it, if it is the greatest from which the rest of the path
// can be followed, or with the one before it.
struct Carry {
    float ratio;
    bool is_from_after;

    Carry(double exact, bool after) : ratio(float(std::clamp(exact, -most, most))), is_from_after(after) {}

  private:
    static constexpr double most = 2.0;  // more comes of rows that hardly count
};

// Share of y by which the width of what remains may be negative: the rounding of two rows.
inline constexpr double closed_width = 8e-16;

// Share of x by which the rows are narrowed: the rounding of y, which is all of an acceleration where
// intervals are short and motions fast.
inline constexpr double speed_rounding = 4.5e-16;

// Share by which a squared speed may be below the greatest possible one and count as that.
inline constexpr double same_speed = 1e-9;

// Share of the greatest speed from which a motion comes to a stand within an interval; any would do.
inline constexpr double moving_share = 1e-2;

}  // namespace cspace::trajectory

namespace cspace::trajectory::inline CSPACE_ISA {

// The line that bounds y at some x: value = offset + slope x.
struct Edge {
    double value, slope, offset;
};
struct Edges {
    Edge low, high;
};

// The number of a lane that has the largest value, which every lane of `largest` has.
template <class V>
CSPACE_INLINE int find_lane(V v, V largest) {
    const unsigned bits = bits_of(v == largest);
    return bits ? lowest_lane(bits) : 0;
}
// The line of the largest value among lanes.
template <class V>
CSPACE_INLINE Edge largest_edge(V value, V slope, V offset) {
    double slopes[Lanes<V>::count], offsets[Lanes<V>::count];
    store_lanes(slopes, slope);
    store_lanes(offsets, offset);
    const V largest = largest_lanes(value);
    const int k = find_lane(value, largest);
    return {get_lane(largest, 0), slopes[k], offsets[k]};
}

// What the rows and the range of the next place leave of y at x.
CSPACE_INLINE Edges bound_next(const Rows& rows, double x, const SpeedRange& next) {
    using V = Pack<native_width>;
    V slope = load_lanes<V>(rows.slope);
    V low_slope = slope, high_slope = slope, low_offset = load_lanes<V>(rows.low),
      high_offset = load_lanes<V>(rows.high);
    V low = slope * x + low_offset, high = slope * x + high_offset;
    for (int r = Lanes<V>::count; r < rows.count; r += Lanes<V>::count) {
        slope = load_lanes<V>(rows.slope + r);
        const V part = slope * x, offset = load_lanes<V>(rows.low + r), other = load_lanes<V>(rows.high + r);
        const V below = part + offset, above = part + other;
        const auto higher = below > low;
        const auto lower = above < high;
        low = select_lanes(higher, below, low);
        low_slope = select_lanes(higher, slope, low_slope);
        low_offset = select_lanes(higher, offset, low_offset);
        high = select_lanes(lower, above, high);
        high_slope = select_lanes(lower, slope, high_slope);
        high_offset = select_lanes(lower, other, high_offset);
    }
    Edges edges{largest_edge(low, low_slope, low_offset), largest_edge(-high, high_slope, high_offset)};
    edges.high.value = -edges.high.value;
    edges.low.value += speed_rounding * x;
    edges.low.slope += speed_rounding;
    edges.high.value -= speed_rounding * x;
    edges.high.slope -= speed_rounding;
    const double most = min(next.high, rows.largest_y);
    if (most < edges.high.value) edges.high = {most, 0.0, most};
    if (next.low > edges.low.value) edges.low = {next.low, 0.0, next.low};
    if (rows.least_sum > x + edges.low.value) edges.low = {rows.least_sum - x, -1.0, rows.least_sum};
    return edges;
}

// An end of the x with a y, negative if there is none, and how it changes with the greatest y.
struct FoundEnd {
    double x, ratio;
};

// Newton's method from outside. side: −1 from above, +1 from below.
CSPACE_INLINE FoundEnd find_end(const Rows& rows, double x, double side, const SpeedRange& next) {
    constexpr int most_steps = 100;  // each changes a row, and two in a hundred paths need more than four
    double share = std::numeric_limits<double>::epsilon();
    for (int step = 0; step < most_steps; ++step) {
        const Edges edges = bound_next(rows, x, next);
        const double width = edges.high.value - edges.low.value;
        if (width >= -closed_width * (std::fabs(edges.high.value) + std::fabs(edges.low.value))) {
            const bool is_from_next = step > 0 && edges.high.slope == 0.0 && edges.high.offset == next.high;
            return {x, is_from_next ? 1.0 / edges.low.slope : 0.0};
        }
        const double slope = edges.high.slope - edges.low.slope;
        if (!(side * slope > 0.0)) return {-1.0, 0.0};
        double found = (edges.low.offset - edges.high.offset) / slope;
        if (!(side * (found - x) > 0.0)) {
            // Within rounding of the end that this row has; where it is steep, it hides those of the others.
            found = x + side * share * x;
            share *= 2.0;
        }
        if (found == x) return {x, 0.0};
        if (found < 0.0) return {-1.0, 0.0};
        x = found;
    }
    return {x, 0.0};
}

// Backwards through the intervals end − 1 … begin: range[i] from range[i + 1]. Returns the interval that
// nothing passes, or −1. memory: three times row_capacity numbers.
template <int m>
inline std::ptrdiff_t bound_speeds(const TimedRows& path, std::size_t begin, std::size_t end,
                                   SpeedRange* range, Carry* carry, double* memory) {
    for (std::size_t i = end; i-- > begin;) {
        const Rows rows = build_rows<m>(path, i, memory);
        const SpeedRange& next = range[i + 1];
        const FoundEnd top =
            find_end(rows, path.stops[i] ? 0.0 : min(rows.largest_x, range[i].high), -1.0, next);
        const double most = top.x;
        const bool may_stand = next.low == 0.0 && path.rises[i] == 0.0 && !path.sampled.along;
        double least = may_stand ? 0.0 : find_end(rows, 0.0, 1.0, next).x;
        if (next.high == 0.0) least = max(least, moving_share * most);  // or it would stand at both ends
        if (most < 0.0 || least < 0.0 || least > most) return std::ptrdiff_t(i);
        range[i] = {least, most};
        carry[i] = {top.ratio, true};
    }
    return -1;
}

// The greatest y that edges leave. Where they cross by rounding it is on the less steep one: a row in which y
// hardly counts knows its end only roughly.
CSPACE_INLINE double greatest_next(const Edges& edges) {
    if (edges.low.value <= edges.high.value) return edges.high.value;
    return std::fabs(edges.low.slope) < std::fabs(edges.high.slope) ? edges.low.value : edges.high.value;
}

// Forwards through the intervals begin … end − 1: the greatest speed[i + 1] from speed[i], within the ranges.
template <int m>
inline void raise_speeds(const TimedRows& path, std::size_t begin, std::size_t end, const SpeedRange* range,
                         double* speed, Carry* carry, double* memory) {
    for (std::size_t i = begin; i < end; ++i) {
        const Rows rows = build_rows<m>(path, i, memory);
        const Edges edges = bound_next(rows, speed[i], range[i + 1]);
        const SpeedRange& next = range[i + 1];
        speed[i + 1] = max(next.low, min(greatest_next(edges), next.high));
        if (speed[i + 1] < (1.0 - same_speed) * next.high) carry[i + 1] = {edges.high.slope, false};
    }
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
