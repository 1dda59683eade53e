// A path over the trapezoids of free space: from cell to cell through the middles of their doors, then pulled
// taut.
#pragma once

#include <vector>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/math/funnel.hpp"
#include "cspace/math/predicates.hpp"
#include "cspace/navigation/cells/trapezoids.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/search/adjacency.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

class ExactCells {
  public:
    explicit ExactCells(const maps::PolygonWorld& world)
        : cells_(world.walls), doors_(cells_.cells.size(), [&](const auto& add) {
              for (Index d = 0; d < Index(cells_.doors.size()); ++d)
                  for (const Index cell :
                       {cells_.doors[std::size_t(d)].left, cells_.doors[std::size_t(d)].right})
                      add(std::size_t(cell), d);
          }) {
        const Point low = world.outlines.low, high = world.outlines.high;
        far_ = 4 * (std::abs(low.y) + std::abs(high.y) + (high.x - low.x) + (high.y - low.y));
        for (const Door& door : cells_.doors) spans_.push_back(span(door));
    }

    const Trapezoids& cells() const { return cells_; }

    Route solve(Point start, Point goal, Trace* trace = nullptr) const {
        const std::size_t count = cells_.cells.size();
        Open open{*this,
                  start,
                  trace,
                  search::Ways(count),
                  std::vector<Point>(count),
                  std::vector<std::uint8_t>(count, 0)};
        search::PriorityQueue queue;
        for (Index c = 0; c < Index(count); ++c) {
            open.holds_goal[std::size_t(c)] = cells_.contains(c, goal);
            if (cells_.contains(c, start)) open.reach(c, 0, start, search::no_node, queue);
        }
        search::Effort effort;
        const std::uint32_t last = search::best_first(open, queue, effort);
        Route route;
        route.status = Status::unreachable;
        route.stats = {std::int64_t(effort.settled), open.edges};
        return last == search::no_node ? route : finish(route, open.ways, last, start, goal);
    }

  private:
    // The points of a door, all at one x.
    struct Span {
        double x, low, high;
        // The point nearest to p: a straight line leads there, for cells are convex.
        Point nearest(Point p) const { return {x, std::clamp(p.y, low, high)}; }
    };
    // The cells as nodes of best_first, each with the door and the point at which the path enters it.
    struct Open {
        const ExactCells& of;
        Point start;
        Trace* trace;
        search::Ways ways;
        std::vector<Point> entry;
        std::vector<std::uint8_t> holds_goal;
        std::int64_t edges = 0;

        bool settle(std::uint32_t cell) {
            if (!ways.settle(cell)) return false;
            const bool is_first = ways.before(cell) == search::no_node;
            if (trace) trace->push_back({0, is_first ? start : entry[cell], entry[cell], ways.cost(cell)});
            return true;
        }
        bool is_goal(std::uint32_t cell) const { return holds_goal[cell]; }
        void expand(std::uint32_t cell, search::PriorityQueue& queue) {
            const Point from = entry[cell];
            for (const Index d : of.doors_.of(cell)) {
                const Door& door = of.cells_.doors[std::size_t(d)];
                const Point at = of.spans_[std::size_t(d)].nearest(from);
                const Index other = door.left == Index(cell) ? door.right : door.left;
                reach(other, ways.cost(cell) + distance(from, at), at, std::uint32_t(d), queue);
            }
        }
        void reach(Index to, double cost, Point at, std::uint32_t door, search::PriorityQueue& queue) {
            const auto cell = std::uint32_t(to);
            ++edges;
            if (!ways.improve(cell, cost, door)) return;
            entry[cell] = at;
            queue.push({cost, 0, cell});
        }
    };
    Trapezoids cells_;
    search::Adjacency<Index> doors_;  // of each cell
    std::vector<Span> spans_;         // of each door
    double far_;

    Span span(const Door& door) const {
        const Trapezoid& cell = cells_.cells[std::size_t(door.left)];
        const double y = cells_.wall(door.is_above ? cell.top : cell.bottom).y_at(door.corner.x);
        return {door.corner.x, std::min(y, door.corner.y), std::max(y, door.corner.y)};
    }
    // The door as a gap. Its other end lies on a wall that bounds both cells; the string cannot reach that
    // wall but at its corners, which are ends of gaps themselves, so the gap may as well be open there.
    Portal gap(const Door& door, bool to_the_right) const {
        const Point open{door.corner.x, door.is_above ? far_ : -far_};
        return to_the_right == door.is_above ? Portal{open, door.corner, true, false}
                                             : Portal{door.corner, open, false, true};
    }
    Route& finish(Route& route, const search::Ways& ways, std::uint32_t cell, Point start, Point goal) const {
        std::vector<Portal> gaps;
        while (ways.before(cell) != search::no_node) {
            const Door& door = cells_.doors[ways.before(cell)];
            const bool to_the_right = door.right == Index(cell);
            gaps.push_back(gap(door, to_the_right));
            cell = std::uint32_t(to_the_right ? door.left : door.right);
        }
        Funnel funnel(start);
        for (auto gap = gaps.rbegin(); gap != gaps.rend(); ++gap) funnel.pass(*gap);
        route.status = Status::found;
        route.path = funnel.finish(goal);
        route.length = length_of(route.path);
        return route;
    }
};

}  // namespace cspace::navigation
