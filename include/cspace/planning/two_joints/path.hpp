// A path between two configurations through the free boxes of a sweep: proved free all along.
//
// Boxes are searched by A*, each entered at its point nearest to where the one before was entered; of two
// ways into a box the one counts that leads to the goal on the shorter way if nothing stood between. The row
// of boxes that it finds is pulled taut. So a path is short, but not always the shortest.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "cspace/math/funnel.hpp"
#include "cspace/planning/two_joints/components.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::planning::two_joints {

namespace detail {

// A copy of a box in coordinates that do not wrap, and where the way enters it.
struct PlacedBox {
    double shift_1 = 0, low = 0, high = 0;
    Point at;
    double length = 0;  // of the way up to there
    double nearest(double y) const { return std::clamp(y, low, high); }
};

class BoxSearch {
  public:
    BoxSearch(const Sweep& sweep, std::size_t boxes, std::uint32_t goal, Point goal_at)
        : ways(boxes), placed(boxes), sweep_(sweep), goal_(goal), goal_at_(goal_at) {
        for (std::size_t s = 0; s < sweep.slabs().size(); ++s)
            for (std::size_t i = 0; i < sweep.slabs()[s].free.size(); ++i)
                slab_.push_back(s), box_.push_back(&sweep.slabs()[s].free[i]);
        first_.push_back(0);
        for (const Slab& slab : sweep.slabs()) first_.push_back(first_.back() + slab.free.size());
    }
    search::Ways ways;
    std::vector<PlacedBox> placed;

    bool settle(std::uint32_t box) { return ways.settle(box); }
    bool is_goal(std::uint32_t box) const { return box == goal_; }
    void expand(std::uint32_t box, search::PriorityQueue& queue) {
        visit_exits(box, [&](const SweepRow& row, std::size_t across, double shift) {
            const auto gap = std::find_if(row.gaps.begin(), row.gaps.end(), [&](const Gap& g) {
                return sweep_.finder().overlap(g, *box_[box]).is_open();
            });
            if (gap == row.gaps.end()) return;
            const PlacedBox from = placed[box];
            const double q_1 = row.q_1 + from.shift_1;
            for (const std::size_t slab : {slab_[box], across})
                for (std::size_t next = first_[slab]; next < first_[slab + 1]; ++next)
                    if (next != box && sweep_.finder().overlap(*gap, *box_[next]).is_open())
                        reach(box, std::uint32_t(next), *gap, q_1,
                              slab == across ? from.shift_1 + shift : from.shift_1, queue);
        });
    }
    // A box where its coordinates are those of the space, or a turn beside them.
    PlacedBox place(std::uint32_t box, double shift_1, double shift_2) const {
        constexpr double far = 1e3;  // [rad], for a box that is a whole turn
        if (is_whole(*box_[box])) return {shift_1, -far, far, {}};
        return {shift_1, box_[box]->low + shift_2, box_[box]->high + shift_2, {}};
    }
    std::size_t slab_of(std::uint32_t box) const { return slab_[box]; }
    const Gap& box_at(std::uint32_t box) const { return *box_[box]; }
    static bool is_whole(const Gap& gap) { return gap.at_low.piece == GapEnd::nothing; }

  private:
    const Sweep& sweep_;
    const std::uint32_t goal_;
    const Point goal_at_;
    std::vector<std::size_t> slab_, first_;
    std::vector<const Gap*> box_;

    // Calls visit(row, slab across it, shift of joint 1 there) for the rows at which a box ends.
    template <class Visit>
    void visit_exits(std::uint32_t box, const Visit& visit) const {
        const std::size_t s = slab_[box], count = sweep_.slabs().size();
        const bool wraps = sweep_.space().arm().joint_1.wraps;
        const bool is_first = s == 0, is_last = s + 1 == count;
        if (!is_first || wraps)
            visit(sweep_.rows()[s], is_first ? count - 1 : s - 1, is_first ? -turn : 0.0);
        if (!is_last || wraps) visit(sweep_.rows()[s + 1], is_last ? 0 : s + 1, is_last ? turn : 0.0);
    }
    // The distance to the nearest copy of the goal.
    double distance_to_goal(Point at) const {
        const Arm& arm = sweep_.space().arm();
        const Point off = goal_at_ - at;
        return std::hypot(arm.joint_1.wraps ? short_way(off.x) : off.x,
                          arm.joint_2.wraps ? short_way(off.y) : off.y);
    }
    void reach(std::uint32_t box, std::uint32_t next, const Gap& gap, double q_1, double shift_1,
               search::PriorityQueue& queue) {
        const PlacedBox& from = placed[box];
        const auto in_gap = [&](const Gap& g) { return sweep_.finder().overlap(gap, g).low - g.low; };
        double shift_2 = 0;
        if (is_whole(gap))
            shift_2 = nearest_multiple(from.at.y - 0.5 * (box_[next]->low + box_[next]->high));
        else if (!is_whole(*box_[next]))
            shift_2 = from.low - box_[box]->low - in_gap(*box_[box]) + in_gap(*box_[next]);
        PlacedBox to = place(next, shift_1, shift_2);
        to.at = {q_1, to.nearest(from.at.y)};
        to.length = from.length + distance(from.at, to.at);
        const double cost = to.length + distance_to_goal(to.at);
        if (!ways.improve(next, cost, box)) return;
        placed[next] = to;
        queue.push({cost, 0, next});
    }
};

}  // namespace detail

class PathFinder {
  public:
    PathFinder(const Sweep& sweep, const Components& components) : sweep_(sweep), components_(components) {}

    // From one free configuration to another, or to its copy that is turns away where joints wrap. Empty where
    // the two are not known to lie in one component.
    std::vector<Point> find(Point from, Point to) const {
        const std::optional<Entry> start = enter(from), goal = enter(to);
        if (!start || !goal || components_.component_at(start->box) != components_.component_at(goal->box))
            return {};
        detail::BoxSearch space(sweep_, components_.boxes(), goal->box, goal->q);
        space.placed[start->box] = space.place(start->box, 0, start->q.y - start->in_box.y);
        space.placed[start->box].at = {start->q.x, start->at.y};
        space.ways.improve(start->box, 0, search::no_node);
        search::PriorityQueue queue;
        queue.push({0, 0, start->box});
        search::Effort effort;
        if (search::best_first(space, queue, effort) == search::no_node) return {};
        std::vector<Point> path = pull_taut(space, *start, *goal);
        const Point shift = from - start->q;  // multiples of a turn
        for (Point& q : path) q = q + shift;
        path.front() = from;
        return path;
    }

  private:
    // A configuration in the space, and the point of its row in the nearest box; both as they were given, and
    // the configuration in the coordinates of the box.
    struct Entry {
        std::uint32_t box;
        Point q, at, in_box;
    };
    const Sweep& sweep_;
    const Components& components_;

    std::optional<Entry> enter(Point given) const {
        const Joint &joint_1 = sweep_.space().arm().joint_1, &joint_2 = sweep_.space().arm().joint_2;
        Point q = given;
        if (joint_1.wraps) q.x = wrap_above(q.x, joint_1.lower);
        if (joint_2.wraps) q.y = wrap_above(q.y, joint_2.lower);
        const SweepRow row = sweep_.make_row(q.x);
        std::optional<Entry> best;
        for (const Gap& gap : row.gaps) {
            if (!sweep_.finder().contains(gap, q.y)) continue;
            const double y = joint_2.wraps ? wrap_above(q.y, gap.low) : q.y;
            for (const std::size_t slab : components_.slabs_at(q.x))
                for (std::size_t i = 0; i < sweep_.slabs()[slab].free.size(); ++i) {
                    const Gap& free = sweep_.slabs()[slab].free[i];
                    const Overlap both = sweep_.finder().overlap(gap, free);
                    if (!both.is_open()) continue;
                    const bool is_whole = detail::BoxSearch::is_whole(free);
                    const double near = is_whole ? y : std::clamp(y, both.low, both.high);
                    if (best && std::abs(near - y) >= std::abs(best->at.y - best->in_box.y)) continue;
                    const double shift = is_whole ? 0 : both.low - free.low;
                    best = {components_.box_number(slab, i), {q.x, y}, {q.x, near}, {q.x, y - shift}};
                }
        }
        return best;
    }
    std::vector<Point> pull_taut(const detail::BoxSearch& space, const Entry& start, const Entry& goal) const {
        std::vector<std::uint32_t> boxes{goal.box};
        while (space.ways.before(boxes.back()) != search::no_node)
            boxes.push_back(space.ways.before(boxes.back()));
        std::reverse(boxes.begin(), boxes.end());
        Funnel funnel({start.q.x, start.at.y});
        for (std::size_t k = 1; k < boxes.size(); ++k) pass(funnel, space, boxes[k - 1], boxes[k]);
        // The goal beside its box, where the way ends.
        const detail::PlacedBox& last = space.placed[goal.box];
        double y = goal.in_box.y + last.low - space.box_at(goal.box).low;
        if (detail::BoxSearch::is_whole(space.box_at(goal.box)))
            y = goal.q.y + nearest_multiple(last.at.y - goal.q.y);
        const double x = goal.q.x + last.shift_1;
        std::vector<Point> path{start.q};
        for (const Point p : funnel.finish({x, last.nearest(y)}))
            if (!(p == path.back())) path.push_back(p);
        if (!(path.back() == Point{x, y})) path.push_back({x, y});
        return path;
    }
    void pass(Funnel& funnel, const detail::BoxSearch& space, std::uint32_t from, std::uint32_t to) const {
        const detail::PlacedBox &a = space.placed[from], &b = space.placed[to];
        const double x = b.at.x, low = std::max(a.low, b.low), high = std::min(a.high, b.high);
        const bool goes_back = space.slab_of(from) == space.slab_of(to) && a.shift_1 == b.shift_1;
        if (goes_back || !(low < high)) {  // along the row
            const double leave = a.nearest(b.low > a.high ? a.high : a.low);
            const double enter = b.nearest(leave);
            funnel.pass({{x, leave}, {x, leave}});
            return funnel.pass({{x, enter}, {x, enter}});
        }
        const bool goes_up = x > middle_of(space, from);
        const Point upper{x, high}, lower{x, low};
        goes_up ? funnel.pass({upper, lower}) : funnel.pass({lower, upper});
    }
    double middle_of(const detail::BoxSearch& space, std::uint32_t box) const {
        const std::size_t s = space.slab_of(box);
        return space.placed[box].shift_1 + 0.5 * (sweep_.rows()[s].q_1 + sweep_.rows()[s + 1].q_1);
    }
};

}  // namespace cspace::planning::two_joints
