// The gaps that intervals leave of the range of joint 2.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "cspace/planning/two_joints/space.hpp"

namespace cspace::planning::two_joints {

// What bounds a gap: a piece where the link touches it, a limit of the joint, or nothing where the gap is all
// of a turn.
struct GapEnd {
    static constexpr std::int32_t limit = -1, nothing = -2;
    std::int32_t piece = nothing;
    Feature feature;
    // Whether the contact is the same; two pieces may have it.
    friend constexpr bool operator==(const GapEnd& a, const GapEnd& b) {
        return a.piece < 0 || b.piece < 0 ? a.piece == b.piece : a.feature == b.feature;
    }
};

// Coordinates of joint 2 from low to high. Where the joint wraps, low lies within its range, and high is up
// to a turn beyond.
struct Gap {
    double low, high;
    GapEnd at_low, at_high;
};

// Where two gaps overlap; none where low is not below high.
struct Overlap {
    double low, high;
    bool is_open() const { return low < high; }
    double middle() const { return 0.5 * (low + high); }
};

// The largest change [rad] of an arc between two rows that tells which way round it went: a tangent to a
// convex piece turns by less than a turn minus this along a slab.
inline constexpr double sure_change = 1.0;

class GapFinder {
  public:
    explicit GapFinder(const Joint& joint) : joint_(joint) {}

    // The gaps, in order, between intervals and their copies that are multiples of a turn away. An interval
    // whose high end is below its low end is none.
    void find(std::span<const BlockedInterval> blocked, std::vector<Gap>& gaps) const {
        gaps.clear();
        std::vector<BlockedInterval> copies;
        for (const BlockedInterval& interval : blocked) {
            if (!(interval.low <= interval.high)) continue;
            if (interval.high - interval.low >= turn) return;
            add_copies(interval, copies);
        }
        std::sort(copies.begin(), copies.end(),
                  [](const BlockedInterval& a, const BlockedInterval& b) { return a.low < b.low; });
        joint_.wraps ? find_around(copies, gaps) : find_between_limits(copies, gaps);
    }
    // The part of a that b overlaps, in the coordinates of a.
    Overlap overlap(const Gap& a, const Gap& b) const {
        if (!joint_.wraps) return {std::max(a.low, b.low), std::min(a.high, b.high)};
        const double low = wrap_above(b.low, a.low), width = b.high - b.low;
        if (low < a.high) return {low, std::min(a.high, low + width)};
        return {a.low, std::min(a.high, low + width - turn)};
    }
    // Whether a gap contains a coordinate.
    bool contains(const Gap& gap, double q) const {
        return joint_.wraps ? wrap_above(q, gap.low) <= gap.high : gap.low <= q && q <= gap.high;
    }

    // The copy of a coordinate within the range of a joint that wraps.
    double within_range(double q) const { return joint_.wraps ? wrap_above(q, joint_.lower) : q; }

  private:
    using Copies = std::vector<BlockedInterval>;
    Joint joint_;

    void add_copies(BlockedInterval interval, Copies& copies) const {
        const double width = interval.high - interval.low;
        double low = wrap_above(interval.low, joint_.lower);
        if (!joint_.wraps && low + width - turn >= joint_.lower) low -= turn;
        for (; low <= joint_.upper; low += turn) {
            interval.low = low, interval.high = low + width;
            copies.push_back(interval);
            if (joint_.wraps) return;
        }
    }
    void find_around(const Copies& copies, std::vector<Gap>& gaps) const {
        if (copies.empty()) return gaps.push_back({joint_.lower, joint_.upper, {}, {}});
        const auto last = std::max_element(
            copies.begin(), copies.end(),
            [](const BlockedInterval& a, const BlockedInterval& b) { return a.high < b.high; });
        find_from(copies, last->high - turn, {last->piece, last->at_high}, gaps);
        for (Gap& gap : gaps)
            if (gap.low < joint_.lower) gap.low += turn, gap.high += turn;
    }
    void find_between_limits(const Copies& copies, std::vector<Gap>& gaps) const {
        const auto [from, end] = find_from(copies, joint_.lower, {GapEnd::limit, {}}, gaps);
        if (from < joint_.upper) gaps.push_back({from, joint_.upper, end, {GapEnd::limit, {}}});
    }
    // Whether two intervals end at one corner that both obstacles have. Obstacles are closed, so that nothing
    // passes there; what lies between is rounding, or the change of that end along a slab.
    static bool is_closed(double from, const GapEnd& end, const BlockedInterval& next) {
        return end.piece >= 0 && end.feature.name != Feature::no_name && end.feature == next.at_low &&
               next.low - from <= 2 * sure_change;
    }
    // The gaps between the copies from a coordinate on, and what comes last.
    static std::pair<double, GapEnd> find_from(const Copies& copies, double from, GapEnd end,
                                               std::vector<Gap>& gaps) {
        for (const BlockedInterval& next : copies) {
            if (next.low > from && !is_closed(from, end, next))
                gaps.push_back({from, next.low, end, {next.piece, next.at_low}});
            if (next.high >= from) from = next.high, end = {next.piece, next.at_high};
        }
        return {from, end};
    }
};

}  // namespace cspace::planning::two_joints
