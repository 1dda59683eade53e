// A path between two configurations through the free boxes of a sweep: proved free all along.
//
// Boxes are cut along joint 2 into cells, which A* searches: a way goes straight for the goal within a box,
// and enters the next one at the nearest point. The row of boxes that it finds is pulled taut. So a path is
// short, but not always the shortest.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "cspace/math/funnel.hpp"
#include "cspace/planning/two_joints/components.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::planning::two_joints {

namespace detail {

// The widest cell [rad].
inline constexpr double widest_cell = 0.2;
// An end [rad] of the interval of a box that has no ends: farther than any path goes.
inline constexpr double far_away = 1e3;

// Points closer than this [rad] are one: rounding moves a configuration off its row.
inline constexpr double same_place = 1e-12;

// A free box of a sweep.
struct Box {
    const Gap* gap;
    std::size_t slab;
    std::uint32_t first_cell;
    int cells;
    bool is_whole() const { return gap->at_low.piece == GapEnd::nothing; }
    double side() const { return (gap->high - gap->low) / cells; }
    int cell_at(double y) const { return std::clamp(int((y - gap->low) / side()), 0, cells - 1); }
};

// A cell where its coordinates are those of the space plus shifts, and where the way enters it.
struct PlacedCell {
    Point shift, at = {};
    double length = 0;     // of the way up to there
    bool goes_up = false;  // whether it comes from the slab below
};

class CellSearch {
  public:
    CellSearch(const Sweep& sweep, std::uint32_t goal_box, Point goal)
        : sweep_(sweep), boxes_(list_boxes(sweep)), goal_(goal) {
        for (std::uint32_t b = 0; b < boxes_.size(); ++b) {
            boxes_[b].first_cell = std::uint32_t(box_of_.size());
            box_of_.insert(box_of_.end(), std::size_t(boxes_[b].cells), b);
        }
        first_.push_back(0);
        for (const Slab& slab : sweep.slabs()) first_.push_back(first_.back() + slab.free.size());
        goal_cell_ = boxes_[goal_box].first_cell + std::uint32_t(boxes_[goal_box].cell_at(goal.y));
        ways_.emplace(box_of_.size());
        placed_.resize(box_of_.size());
    }
    // From a place in a box; false if the goal is not reached.
    bool run(std::uint32_t box, Point at, double shift_2) {
        queue_.clear();
        const auto cell = std::uint32_t(boxes_[box].cell_at(at.y - shift_2));
        reach(search::no_node, boxes_[box].first_cell + cell, {{0, shift_2}, at});
        search::Effort effort;
        return search::best_first(*this, queue_, effort) != search::no_node;
    }
    // The cells from the start to the goal; what leaves a box and comes back to it is left out.
    std::vector<std::uint32_t> row_of_cells() const {
        std::vector<std::uint32_t> cells{goal_cell_};
        while (ways_->before(cells.back()) != search::no_node) cells.push_back(ways_->before(cells.back()));
        std::reverse(cells.begin(), cells.end());
        std::vector<std::size_t> last(boxes_.size());
        for (std::size_t k = 0; k < cells.size(); ++k) last[box_of_[cells[k]]] = k;
        std::vector<std::uint32_t> kept;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            kept.push_back(cells[k]);
            const std::size_t again = last[box_of_[cells[k]]];
            if (placed_[cells[again]].shift == placed_[cells[k]].shift) k = again;
        }
        return kept;
    }
    const PlacedCell& placed(std::uint32_t cell) const { return placed_[cell]; }
    const Box& box_of(std::uint32_t cell) const { return boxes_[box_of_[cell]]; }
    // The interval of the whole box of a cell.
    Overlap interval_of(std::uint32_t cell) const {
        const Box& box = box_of(cell);
        const double shift = placed_[cell].shift.y;
        if (box.is_whole()) return {-far_away, far_away};
        return {box.gap->low + shift, box.gap->high + shift};
    }
    // The point of the box of a cell that is nearest to a configuration.
    Point nearest_in_box(std::uint32_t cell, Point q) const {
        const std::size_t s = box_of(cell).slab;
        const double shift = placed_[cell].shift.x;
        const auto [low, high] = interval_of(cell);
        return {std::clamp(q.x, sweep_.rows()[s].q_1 + shift, sweep_.rows()[s + 1].q_1 + shift),
                std::clamp(q.y, low, high)};
    }

    bool settle(std::uint32_t cell) { return ways_->settle(cell); }
    bool is_goal(std::uint32_t cell) const { return cell == goal_cell_; }
    void expand(std::uint32_t cell, search::PriorityQueue&) {
        const Box& box = box_of(cell);
        const int number = int(cell - box.first_cell);
        for (const int step : {-1, 1}) enter_beside(cell, box, number + step);
        visit_exits(box.slab, [&](const Exit& exit) {
            for (const Gap& gap : exit.row.gaps) {
                if (!sweep_.finder().overlap(gap, *box.gap).is_open()) continue;
                enter_across(cell, gap, exit, box.slab, 0);
                if (exit.across != box.slab) enter_across(cell, gap, exit, exit.across, exit.shift);
                return;
            }
        });
    }

  private:
    const Sweep& sweep_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> box_of_;  // of each cell
    std::vector<std::size_t> first_;     // box of each slab
    const Point goal_;
    std::uint32_t goal_cell_;
    std::optional<search::Ways> ways_;
    std::vector<PlacedCell> placed_;
    search::PriorityQueue queue_;

    static std::vector<Box> list_boxes(const Sweep& sweep) {
        std::vector<Box> boxes;
        for (std::size_t s = 0; s < sweep.slabs().size(); ++s)
            for (const Gap& gap : sweep.slabs()[s].free)
                boxes.push_back({&gap, s, 0, 1 + int((gap.high - gap.low) / widest_cell)});
        return boxes;
    }
    // A row at which a slab ends, and the slab across it with the shift of joint 1 there.
    struct Exit {
        const SweepRow& row;
        bool is_upper;
        std::size_t across;
        double shift;
    };
    template <class Visit>
    void visit_exits(std::size_t s, const Visit& visit) const {
        const std::size_t count = sweep_.slabs().size();
        const bool wraps = sweep_.space().arm().joint_1.wraps;
        const bool is_first = s == 0, is_last = s + 1 == count;
        if (!is_first || wraps)
            visit(Exit{sweep_.rows()[s], false, is_first ? count - 1 : s - 1, is_first ? -turn : 0.0});
        if (!is_last || wraps)
            visit(Exit{sweep_.rows()[s + 1], true, is_last ? 0 : s + 1, is_last ? turn : 0.0});
    }
    // A cell of the same box.
    void enter_beside(std::uint32_t from, const Box& box, int number) {
        double shift = placed_[from].shift.y;
        if (box.is_whole()) {
            if (number < 0) number += box.cells, shift -= turn;
            if (number >= box.cells) number -= box.cells, shift += turn;
        }
        if (number < 0 || number >= box.cells) return;
        enter(from, box, number, placed_[from].at, {{placed_[from].shift.x, shift}, {}});
    }
    // The boxes of a slab that a gap of a row connects with a cell's: each in the cell that is nearest.
    void enter_across(std::uint32_t from, const Gap& gap, const Exit& exit, std::size_t slab,
                      double shift_1) {
        const PlacedCell& here = placed_[from];
        const Box& own = box_of(from);
        const Point leave = go_straight(from, exit.row.q_1 + here.shift.x);
        const auto offset_in = [&](const Gap& g) { return sweep_.finder().overlap(gap, g).low - g.low; };
        for (std::size_t b = first_[slab]; b < first_[slab + 1]; ++b) {
            const Box& box = boxes_[b];
            if (&box == &own || !sweep_.finder().overlap(gap, *box.gap).is_open()) continue;
            double shift = here.shift.y - offset_in(*own.gap) + offset_in(*box.gap);
            if (gap.at_low.piece == GapEnd::nothing)  // the nearest copy
                shift = nearest_multiple(leave.y - 0.5 * (box.gap->low + box.gap->high));
            enter(from, box, box.cell_at(leave.y - shift), leave,
                  {{here.shift.x + shift_1, shift}, {}, 0, exit.is_upper});
        }
    }
    // Where a straight line from a cell to the goal leaves the box at a row, or the nearest point there.
    Point go_straight(std::uint32_t from, double x) const {
        const Point at = placed_[from].at, off = offset_of_goal(at);
        const auto [low, high] = interval_of(from);
        const double part = off.x == 0 ? 0 : std::clamp((x - at.x) / off.x, 0.0, 1.0);
        return {x, std::clamp(at.y + part * off.y, low, high)};
    }
    // Into a cell, from a point of the box before.
    void enter(std::uint32_t from, const Box& box, int number, Point leave, PlacedCell place) {
        const double low = box.gap->low + place.shift.y + number * box.side();
        place.at = {leave.x, std::clamp(leave.y, low, low + box.side())};
        place.length = placed_[from].length + distance(placed_[from].at, leave) + distance(leave, place.at);
        reach(from, box.first_cell + std::uint32_t(number), place);
    }
    void reach(std::uint32_t from, std::uint32_t cell, const PlacedCell& place) {
        const double cost = place.length + norm(offset_of_goal(place.at));
        if (!ways_->improve(cell, cost, from)) return;
        placed_[cell] = place;
        queue_.push({cost, 0, cell});
    }
    // The way to the nearest copy of the goal.
    Point offset_of_goal(Point at) const {
        const Arm& arm = sweep_.space().arm();
        const Point off = goal_ - at;
        return {arm.joint_1.wraps ? short_way(off.x) : off.x, arm.joint_2.wraps ? short_way(off.y) : off.y};
    }
};

}  // namespace detail

class PathFinder {
  public:
    PathFinder(const Sweep& sweep, const Components& components) : sweep_(sweep), components_(components) {}

    // From one free configuration to another, or to its copy that is turns away where joints wrap. Empty
    // where the two are not known to lie in one component.
    std::vector<Point> find(Point from, Point to) const {
        const std::optional<Entry> start = enter(from), goal = enter(to);
        if (!start || !goal || components_.component_at(start->box) != components_.component_at(goal->box))
            return {};
        detail::CellSearch search(sweep_, goal->box, goal->in_box);
        if (!search.run(start->box, start->at, start->q.y - start->in_box.y)) return {};
        std::vector<Point> path = pull_taut(search, *start, *goal);
        const Point shift = from - start->q;  // multiples of a turn
        for (Point& q : path) q = q + shift;
        path.front() = from;
        return path;
    }

  private:
    // A configuration q, the point of its row in the nearest box, both in the coordinates of its gap; and the
    // configuration in the coordinates of the box.
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
                    const bool is_whole = free.at_low.piece == GapEnd::nothing;
                    const double near = is_whole ? y : std::clamp(y, both.low, both.high);
                    if (best && std::abs(near - y) >= std::abs(best->at.y - best->q.y)) continue;
                    const double shift = is_whole ? 0 : both.low - free.low;
                    best = {components_.box_number(slab, i), {q.x, y}, {q.x, near}, {q.x, y - shift}};
                }
        }
        return best;
    }
    static std::vector<Point> pull_taut(const detail::CellSearch& search, const Entry& start,
                                        const Entry& goal) {
        const std::vector<std::uint32_t> cells = search.row_of_cells();
        const Point end = goal.in_box + search.placed(cells.back()).shift;
        Funnel funnel(search.nearest_in_box(cells.front(), start.q));
        for (std::size_t k = 1; k < cells.size(); ++k) pass(funnel, search, cells[k - 1], cells[k]);
        std::vector<Point> path{start.q};
        for (const Point p : funnel.finish(search.nearest_in_box(cells.back(), end)))
            if (distance(p, path.back()) > detail::same_place) path.push_back(p);
        if (path.size() > 1 && distance(path.back(), end) <= detail::same_place) path.pop_back();
        path.push_back(end);
        return path;
    }
    // From a cell to the next, which may lie in the same box.
    static void pass(Funnel& funnel, const detail::CellSearch& search, std::uint32_t from, std::uint32_t to) {
        const detail::Box &a = search.box_of(from), &b = search.box_of(to);
        if (&a == &b) return;
        const Overlap own = search.interval_of(from), next = search.interval_of(to);
        const double x = search.placed(to).at.x;
        const Overlap both{std::max(own.low, next.low), std::min(own.high, next.high)};
        if (a.slab == b.slab || !both.is_open()) {  // along the row
            const double leave = std::clamp(next.middle(), own.low, own.high);
            const double enter = std::clamp(leave, next.low, next.high);
            funnel.pass({{x, leave}, {x, leave}});
            return funnel.pass({{x, enter}, {x, enter}});
        }
        const bool goes_up = search.placed(to).goes_up;
        const Point upper{x, both.high}, lower{x, both.low};
        const bool is_open = both.high == detail::far_away;
        goes_up ? funnel.pass({upper, lower, is_open, is_open})
                : funnel.pass({lower, upper, is_open, is_open});
    }
};

}  // namespace cspace::planning::two_joints
