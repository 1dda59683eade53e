// The boundary of the free configurations of two joints, as curves on each of which one contact stays.
//
// Their points are exact up to rounding: ends of the gaps of a sweep's rows. Where link 1 touches, or at a
// limit, the boundary is a straight line.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/planning/two_joints/sweep.hpp"

namespace cspace::planning::two_joints {

enum class BoundaryKind : std::int8_t { side_on_corner, tip_on_corner, tip_on_side, link_1, limit };

struct BoundaryCurve {
    BoundaryKind kind = BoundaryKind::limit;
    std::int32_t obstacle = no_obstacle;
    std::vector<Point> points;  // q₁ within its limits; q₂ changes along the curve without a jump
};

namespace detail {

class BoundaryTracer {
  public:
    explicit BoundaryTracer(const Sweep& sweep) : sweep_(sweep) {
        InterruptPoll poll(64);
        for (std::size_t i = 0; i < sweep.rows().size(); ++i) {
            poll.step();
            if (i > 0) add_edges(sweep.rows()[i - 1], sweep.rows()[i]);
            trace(sweep.rows()[i]);
        }
        if (!sweep.space().arm().joint_1.wraps && !sweep.rows().empty())
            for (const SweepRow* row : {&sweep.rows().front(), &sweep.rows().back()})
                add_lines(*row, row->q_1, {BoundaryKind::limit, no_obstacle, {}});
        std::erase_if(curves, [](const BoundaryCurve& curve) { return curve.points.size() < 2; });
    }
    std::vector<BoundaryCurve> curves;

  private:
    // An end of a gap in the row before, and the curve that it belongs to.
    struct OpenEnd {
        GapEnd end;
        bool is_low;
        std::size_t curve;
    };

    const Sweep& sweep_;
    std::vector<OpenEnd> open_, next_;

    void trace(const SweepRow& row) {
        next_.clear();
        for (const Gap& gap : row.gaps) {
            if (gap.at_low.piece != GapEnd::nothing) go_on(row.q_1, gap.low, gap.at_low, true);
            if (gap.at_high.piece != GapEnd::nothing) go_on(row.q_1, gap.high, gap.at_high, false);
        }
        open_.swap(next_);
    }
    void go_on(double q_1, double q_2, const GapEnd& end, bool is_low) {
        for (const OpenEnd& open : open_) {
            if (!(open.end == end) || open.is_low != is_low) continue;
            std::vector<Point>& points = curves[open.curve].points;
            double change = q_2 - points.back().y;
            if (sweep_.space().arm().joint_2.wraps) change = short_way(change);
            if (std::abs(change) > sure_change) continue;
            points.push_back({q_1, points.back().y + change});
            next_.push_back({end, is_low, open.curve});
            return;
        }
        const bool is_limit = end.piece == GapEnd::limit;
        next_.push_back({end, is_low, curves.size()});
        curves.push_back({is_limit ? BoundaryKind::limit : BoundaryKind(end.feature.contact),
                          sweep_.space().obstacle_of(end.piece),
                          {{q_1, q_2}}});
    }
    // Where link 1 begins or ceases to touch between two rows.
    void add_edges(const SweepRow& a, const SweepRow& b) {
        if ((a.blocks_link_1 == no_obstacle) == (b.blocks_link_1 == no_obstacle)) return;
        const bool ends = a.blocks_link_1 != no_obstacle;
        const auto at = std::lower_bound(sweep_.edges().begin(), sweep_.edges().end(), a.q_1);
        const double edge = at != sweep_.edges().end() && *at <= b.q_1 ? *at : ends ? b.q_1 : a.q_1;
        const std::int32_t obstacle = sweep_.space().obstacle_of(ends ? a.blocks_link_1 : b.blocks_link_1);
        add_lines(ends ? b : a, edge, {BoundaryKind::link_1, obstacle, {}});
    }
    // A line across each gap of a row.
    void add_lines(const SweepRow& row, double q_1, const BoundaryCurve& line) {
        for (const Gap& gap : row.gaps) {
            curves.push_back(line);
            curves.back().points = {{q_1, gap.low}, {q_1, gap.high}};
        }
    }
};

}  // namespace detail

inline std::vector<BoundaryCurve> trace_boundaries(const Sweep& sweep) {
    return std::move(detail::BoundaryTracer(sweep).curves);
}

}  // namespace cspace::planning::two_joints
