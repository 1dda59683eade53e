// Where two lines cross, rounded to the nearest doubles: the same point whichever points of the lines are
// given. What a segment meets of a box.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "cspace/math/predicates.hpp"

namespace cspace {

struct Line {
    Point from, to;
};

// Whether two segments cross inside both; exact.
inline bool do_cross(const Line& a, const Line& b) {
    return orientation(a.from, a.to, b.from) * orientation(a.from, a.to, b.to) < 0 &&
           orientation(b.from, b.to, a.from) * orientation(b.from, b.to, a.to) < 0;
}

// Where line b crosses segment a; the middle of a if they are parallel. The first estimate is corrected by
// how far it lies off both lines, which is computed without rounding (iterative refinement).
inline Point line_crossing(const Line& a, const Line& b) {
    const Point along = a.to - a.from, other = b.to - b.from;
    const double whole = cross(other, along), size = std::max(norm(along), norm(other));
    const double part = whole == 0 ? 0.5 : cross(other, b.from - a.from) / whole;
    Point at = a.from + std::clamp(part, 0.0, 1.0) * along;
    constexpr double converged = 0x1p-30;  // the next correction is below half of the last place
    constexpr double vanished = 0x1p-80;   // of the longer segment: no crossing is that near to an axis
    for (int round = 0; round < 3 && whole != 0; ++round) {
        const double off_a = exact::determinant(a.from, a.to, at) / whole;
        const double off_b = exact::determinant(b.from, b.to, at) / whole;
        const Point correction = off_a * other - off_b * along;
        if (!std::isfinite(correction.x) || !std::isfinite(correction.y)) break;
        at = at + correction;
        // The relative error of the correction is that of `whole`: 2⁻⁵² size² / whole.
        if (norm(correction) * size < converged * std::abs(whole)) break;
    }
    const auto inside = [&](double value, double from, double to) {
        if (std::abs(value) < vanished * size)
            value = 0;  // what refinement leaves of a coordinate that is zero
        return std::clamp(value, std::min(from, to), std::max(from, to));
    };
    return {inside(at.x, a.from.x, a.to.x), inside(at.y, a.from.y, a.to.y)};
}

// The least and the greatest orientation of the corners of a box, seen from a towards b.
inline std::pair<int, int> sides_of(Point a, Point b, const Box& box) {
    const auto& [low, high] = box;
    int least = 1, greatest = -1;
    for (const Point corner : {low, Point{high.x, low.y}, high, Point{low.x, high.y}}) {
        const int side = orientation(a, b, corner);
        least = std::min(least, side), greatest = std::max(greatest, side);
    }
    return {least, greatest};
}

// What a segment meets of a box.
enum class BoxPart : std::int8_t { none, border, inside };
inline BoxPart met_part(Point a, Point b, const Box& box) {
    const auto& [low, high] = box;
    const auto [left, right] = std::minmax(a.x, b.x);
    const auto [lower, upper] = std::minmax(a.y, b.y);
    if (right < low.x || left > high.x || upper < low.y || lower > high.y) return BoxPart::none;
    const auto [least, greatest] = sides_of(a, b, box);
    if (least > 0 || greatest < 0) return BoxPart::none;
    const bool beside = right <= low.x || left >= high.x || upper <= low.y || lower >= high.y;
    return beside || least == 0 || greatest == 0 ? BoxPart::border : BoxPart::inside;
}

}  // namespace cspace
