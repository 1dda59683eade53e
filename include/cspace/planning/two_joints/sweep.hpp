// The free part of the configuration space of two joints as a sweep along joint 1: exact rows, and between
// two of them a slab with boxes that are proved free and boxes outside of which everything is proved blocked.
//
// Between critical angles each end of each arc is monotonic, so the arc of a row inside a slab lies between
// those of the two rows. Slabs around critical angles are thin, and a piece turned by half their width about
// the base bounds its arcs there. A slab is halved until each box that may be free contains one that is.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/planning/two_joints/critical_angles.hpp"
#include "cspace/planning/two_joints/gaps.hpp"

namespace cspace::planning::two_joints {

// A row of the space at one angle of joint 1: the arcs that link 2 may not enter, and the gaps between them.
struct SweepRow {
    double q_1 = 0;
    std::int32_t blocks_link_1 = no_obstacle;  // a piece; then there are no arcs and no gaps
    std::vector<BlockedInterval> arcs;         // at most one of each piece, in their order
    std::vector<Gap> gaps;
};

// Between a row and the next.
struct Slab {
    std::vector<Gap> free;      // free in every row of the slab
    std::vector<Gap> possible;  // outside of these nothing is free in any row
};

struct SweepSettings {
    int rows = 192;           // spread evenly over joint 1; critical angles and halves come to these
    double stride = 0.1;      // the largest change [rad] of joint 2 along a boundary between two rows
    int most_rows = 100'000;  // slabs are not halved any more then
};

namespace detail {

// Slabs narrower than this [rad] are not halved: what passes through them is left open. Where a side of an
// obstacle points to the elbow for a moment, arcs overlap by the square of the distance from there alone.
inline constexpr double narrowest_slab = 1e-7;
// Slabs narrower than this [rad] are not halved for the place where one contact follows another.
inline constexpr double narrowest_corner = 1e-9;
// Ends of arcs [rad] are off by rounding: a square root near a critical angle, at its margin, loses half of
// the digits that the margin leaves.
inline constexpr double arc_slack = 1e-11;
// Gaps narrower than this [rad] are no reason to halve a slab: where obstacles touch, arcs may stay as near
// to each other as rounding over a good part of a slab.
inline constexpr double narrowest_gap = 1e-10;
inline bool is_wide(const Gap& gap) { return gap.high - gap.low > narrowest_gap; }

// What a piece covers all the time while it moves by less than `off`; no corners where that may be nothing.
// Where it has a radius, of that length or more, the radius shrinks; else the sides come nearer to the
// middle.
inline Piece shrink_piece(const Piece& piece, double off) {
    if (piece.radius >= off) return piece.grown(-off);
    Point middle;
    for (const Point corner : piece.corners) middle = middle + (1.0 / double(piece.size())) * corner;
    double depth = piece.size() > 2 ? std::numeric_limits<double>::infinity() : 0;
    for (std::size_t i = 0; i < piece.size(); ++i)
        depth = std::min(depth, dot(piece.normals[i], piece.corners[i] - middle));
    if (depth <= 2 * off) return {};
    std::vector<Point> corners;
    for (const Point corner : piece.corners)
        corners.push_back(middle + (1 - off / depth) * (corner - middle));
    return make_piece(corners, 0, piece.obstacle);
}

}  // namespace detail

class Sweep {
  public:
    explicit Sweep(const Space& space, const SweepSettings& settings = {})
        : space_(space), settings_(settings), finder_(space.arm().joint_2) {
        if (space.buried_in() != no_obstacle) return;
        find_edges();
        find_ranges();
        const std::vector<double> stops = find_stops();
        rows_.push_back(make_stop(stops.front()));
        for (std::size_t i = 1; i < stops.size(); ++i) {
            poll_.step();
            divide(make_stop(stops[i]));
        }
    }

    const Space& space() const { return space_; }
    const GapFinder& finder() const { return finder_; }
    // From the lower limit of joint 1 to the upper one; none where the base is covered.
    const std::vector<SweepRow>& rows() const { return rows_; }
    // One less than rows: slab i lies between rows i and i + 1.
    const std::vector<Slab>& slabs() const { return slabs_; }
    // Where link 1 begins or ceases to touch, sorted.
    const std::vector<double>& edges() const { return edges_; }

    SweepRow make_row(double q_1) const {
        SweepRow row;
        row.q_1 = q_1, row.blocks_link_1 = space_.blocks_link_1(q_1);
        if (row.blocks_link_1 != no_obstacle) return row;
        row.arcs.reserve(space_.pieces().size());
        space_.visit_link_2(q_1, [&](const BlockedInterval& arc) { row.arcs.push_back(arc); });
        finder_.find(row.arcs, row.gaps);
        return row;
    }

    // The gaps of a row, a little larger, and those that rounding may have closed.
    std::vector<Gap> find_possible_gaps(const SweepRow& row) const {
        std::vector<Gap> gaps;
        if (row.blocks_link_1 != no_obstacle) return gaps;
        std::vector<BlockedInterval> arcs = row.arcs;
        for (BlockedInterval& arc : arcs) arc.low += detail::arc_slack, arc.high -= detail::arc_slack;
        finder_.find(arcs, gaps);
        return gaps;
    }

  private:
    const Space& space_;
    const SweepSettings settings_;
    GapFinder finder_;
    InterruptPoll poll_{16};
    std::vector<SweepRow> rows_;
    std::vector<Slab> slabs_;
    std::vector<double> edges_;
    std::vector<std::vector<AngleRange>> critical_;  // of each piece, as coordinates of joint 1, sorted
    std::vector<BlockedInterval> outer_, inner_;

    // Calls visit with the copies of a range of coordinates that reach into the limits of joint 1.
    template <class Visit>
    void visit_copies(double low, double width, const Visit& visit) const {
        const Joint& joint = space_.arm().joint_1;
        for (low = wrap_above(low + width, joint.lower) - width; low <= joint.upper; low += turn) visit(low);
    }
    void find_edges() {
        for (const BlockedInterval& band : space_.link_1())
            for (const double edge : {band.low, band.high})
                visit_copies(edge - critical_margin, 2 * critical_margin,
                             [&](double low) { edges_.push_back(low + critical_margin); });
        std::sort(edges_.begin(), edges_.end());
    }
    void find_ranges() {
        const Joint& joint = space_.arm().joint_1;
        for (const Piece& piece : space_.pieces()) {
            auto& ranges = critical_.emplace_back();
            for (const auto& [low, high] : find_critical_angles(space_.arm(), piece)) {
                const double a = joint.coordinate(low), b = joint.coordinate(high);
                const double first = std::min(a, b), width = std::max(a, b) - first;
                if (is_idle(piece, first, width)) continue;
                visit_copies(first, width, [&](double q) { ranges.push_back({q, q + width}); });
            }
            std::sort(ranges.begin(), ranges.end(),
                      [](const AngleRange& a, const AngleRange& b) { return a.low < b.low; });
        }
    }
    // Whether nothing of a piece is near at a critical angle.
    bool is_idle(const Piece& piece, double low, double width) const {
        constexpr double thin = 1e-5, slack = 1e-4;  // [rad], and of the arm's length
        const Arm& arm = space_.arm();
        if (width > thin) return false;
        const double reach = arm.length_2 + piece.radius + slack * (arm.length_1 + arm.length_2);
        return distance_to_corners(piece, arm.elbow(low)) > reach;
    }
    std::vector<double> find_stops() const {
        const Joint& joint = space_.arm().joint_1;
        std::vector<double> stops;
        const int count = std::max(settings_.rows, 2);
        for (int i = 0; i <= count; ++i)
            stops.push_back(i == count ? joint.upper : joint.lower + i * (joint.width() / count));
        for (const double edge : edges_)
            stops.insert(stops.end(), {edge - critical_margin, edge, edge + critical_margin});
        for (const auto& ranges : critical_)
            for (const AngleRange& range : ranges)
                if (!is_blocked(range.low, range.high)) stops.insert(stops.end(), {range.low, range.high});
        std::sort(stops.begin(), stops.end());
        stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
        std::erase_if(stops, [&](double q) { return q < joint.lower || q > joint.upper; });
        return stops;
    }
    bool has_edge(double low, double high) const {
        constexpr double near = 0.5 * critical_margin;
        const auto at = std::lower_bound(edges_.begin(), edges_.end(), low - near);
        return at != edges_.end() && *at <= high + near;
    }
    // Whether link 1 touches all along an interval.
    bool is_blocked(double low, double high) const {
        return !has_edge(low, high) && space_.blocks_link_1(0.5 * (low + high)) != no_obstacle;
    }
    bool is_critical(std::size_t piece, double low, double high) const {
        for (const AngleRange& range : critical_[piece]) {
            if (range.low >= high) return false;
            if (range.high > low) return true;
        }
        return false;
    }

    // A row where slabs end in any case. Where link 1 begins or ceases to touch, it touches: obstacles are
    // closed, and rounding has no say.
    SweepRow make_stop(double q_1) const {
        SweepRow row = make_row(q_1);
        if (!std::binary_search(edges_.begin(), edges_.end(), q_1)) return row;
        for (const BlockedInterval& band : space_.link_1())
            for (const double edge : {band.low, band.high})
                if (std::abs(short_way(edge - q_1)) < critical_margin) row.blocks_link_1 = band.piece;
        row.arcs.clear(), row.gaps.clear();
        return row;
    }
    // Adds the slab up to a row, or its halves.
    void divide(SweepRow&& next) {
        const double low = rows_.back().q_1, high = next.q_1, middle = 0.5 * (low + high);
        Slab slab;
        const bool is_settled = find_boxes(rows_.back(), next, slab);
        const bool can_halve = middle > low && middle < high && int(rows_.size()) < settings_.most_rows;
        if (can_halve && ((high - low > detail::narrowest_slab && !is_settled) ||
                          (high - low > detail::narrowest_corner && !is_traced(rows_.back(), next)))) {
            poll_.step();
            divide(make_row(middle));
            return divide(std::move(next));
        }
        slabs_.push_back(std::move(slab));
        rows_.push_back(std::move(next));
    }

    // Whether every box that may be free contains one that is, and so does every gap of the two rows: all but
    // the narrowest.
    bool find_boxes(const SweepRow& a, const SweepRow& b, Slab& slab) {
        const bool has_edge_inside = has_edge(a.q_1, b.q_1);
        if (!has_edge_inside && a.blocks_link_1 != no_obstacle) return true;
        outer_.clear(), inner_.clear();
        bound_arcs(a, b);
        if (!has_edge_inside) finder_.find(outer_, slab.free);
        finder_.find(inner_, slab.possible);
        const auto count_wide = [](const std::vector<Gap>& gaps) {
            return std::count_if(gaps.begin(), gaps.end(), detail::is_wide);
        };
        if (count_wide(slab.free) != count_wide(slab.possible)) return false;
        const auto has_free = [&](const Gap& gap) {
            return !detail::is_wide(gap) ||
                   std::any_of(slab.free.begin(), slab.free.end(),
                               [&](const Gap& free) { return finder_.overlap(gap, free).is_open(); });
        };
        const auto all_have_free = [&](const std::vector<Gap>& gaps) {
            return std::all_of(gaps.begin(), gaps.end(), has_free);
        };
        return all_have_free(slab.possible) && all_have_free(a.gaps) && all_have_free(b.gaps);
    }
    // What each piece blocks in some row of the slab, and what in all of them.
    void bound_arcs(const SweepRow& a, const SweepRow& b) {
        auto of_a = a.arcs.begin(), of_b = b.arcs.begin();
        for (std::size_t k = 0; k < space_.pieces().size(); ++k) {
            const bool in_a = of_a != a.arcs.end() && std::size_t(of_a->piece) == k;
            const bool in_b = of_b != b.arcs.end() && std::size_t(of_b->piece) == k;
            const bool is_even = in_a == in_b && a.blocks_link_1 == b.blocks_link_1;
            if (!is_even || is_critical(k, a.q_1, b.q_1) || (in_a && !add_between(*of_a, *of_b)))
                add_turned(std::int32_t(k), a.q_1, b.q_1);
            if (in_a) ++of_a;
            if (in_b) ++of_b;
        }
    }
    bool add_between(const BlockedInterval& a, BlockedInterval b) {
        const double shift = nearest_multiple(a.low - b.low);
        b.low += shift, b.high += shift;
        if (std::abs(a.low - b.low) > sure_change) return false;
        const auto [least_low, most_low] = std::minmax(a.low, b.low);
        const auto [least_high, most_high] = std::minmax(a.high, b.high);
        const Feature at_low = a.at_low == b.at_low ? a.at_low : Feature{};
        const Feature at_high = a.at_high == b.at_high ? a.at_high : Feature{};
        constexpr double slack = detail::arc_slack;
        outer_.push_back({least_low - slack, most_high + slack, a.piece, at_low, at_high});
        inner_.push_back({most_low + slack, least_high - slack, a.piece, at_low, at_high});
        return true;
    }
    // A piece where its arcs are not known to be monotonic: bounded by how far the slab turns it.
    void add_turned(std::int32_t number, double low, double high) {
        const Arm& arm = space_.arm();
        const double off = 0.5 * (high - low) * (arm.length_1 + arm.length_2), middle = 0.5 * (low + high);
        const Point elbow = arm.elbow(middle);
        const Piece& turned = space_.pieces()[std::size_t(number)];
        const auto add = [&](const Piece& piece, double slack, std::vector<BlockedInterval>& to) {
            if (piece.size() == 0 || arm.length_2 == 0) return;
            if (contains_point(piece, elbow)) return to.push_back({0, turn, number});
            const BlockedArc arc = find_blocked_arc(piece, elbow, arm.length_2);
            if (arc.is_empty) return;
            const BlockedInterval found = space_.interval_of_link_2(arc, middle, number);
            to.push_back({found.low - slack, found.high + slack, number});
        };
        add(turned.grown(off), detail::arc_slack, outer_);
        add(detail::shrink_piece(turned, off), -detail::arc_slack, inner_);
    }
    // Whether the ends of gaps in two rows are those of the same contacts, near each other.
    bool is_traced(const SweepRow& a, const SweepRow& b) const {
        const auto is_wide = [](const Gap& gap) { return detail::is_wide(gap); };
        if (std::count_if(a.gaps.begin(), a.gaps.end(), is_wide) !=
            std::count_if(b.gaps.begin(), b.gaps.end(), is_wide))
            return false;
        for (const Gap& gap : a.gaps) {
            if (!is_wide(gap)) continue;
            const auto goes_on = [&](const Gap& next) {
                return next.at_low == gap.at_low && next.at_high == gap.at_high &&
                       is_near(gap.low, next.low) && is_near(gap.high, next.high);
            };
            if (std::none_of(b.gaps.begin(), b.gaps.end(), goes_on)) return false;
        }
        return true;
    }
    bool is_near(double a, double b) const {
        const double change = space_.arm().joint_2.wraps ? short_way(b - a) : b - a;
        return std::abs(change) <= settings_.stride;
    }
};

}  // namespace cspace::planning::two_joints
