// A way along the diagram of a grid: up the clearance from start and goal, and between on the diagram, where
// the least clearance is greatest, or the way is shortest.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/navigation/fields/diagram.hpp"
#include "cspace/navigation/grid/answer.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

enum class Prefer : std::uint8_t { clearance, length };

namespace brushfire {

// Over the cells of a diagram, by places: widest first, or, over those of a least clearance, shortest first.
class Walk {
  public:
    Walk(const Diagram& diagram, std::uint32_t goal, bool widest, std::uint32_t least)
        : diagram_(diagram),
          goal_(goal),
          least_(least),
          widest_(widest),
          parent_(diagram.cells().size(), search::no_node),
          value_(diagram.cells().size(), std::numeric_limits<double>::infinity()),
          settled_(diagram.cells().size()) {}
    template <class Queue>
    void start(std::uint32_t at, Queue& queue) {
        parent_[at] = at;
        value_[at] = widest_ ? -height(at) : 0;
        queue.push({value_[at], 0, at});
    }
    bool settle(std::uint32_t at) {
        if (settled_[at]) return false;
        settled_[at] = true;
        return true;
    }
    bool is_goal(std::uint32_t at) const { return at == goal_; }
    template <class Queue>
    void expand(std::uint32_t at, Queue& queue) {
        for (const std::uint32_t to : diagram_.beside(at)) {
            if (to == Diagram::none || settled_[to] || diagram_.clearance().squared[cell(to)] < least_)
                continue;
            const double value = widest_ ? std::max(value_[at], -height(to)) : value_[at] + 1;
            ++edges_;
            if (!(value < value_[to])) continue;
            value_[to] = value;
            parent_[to] = at;
            queue.push({value, 0, to});
        }
    }
    std::uint32_t parent(std::uint32_t at) const { return parent_[at]; }
    double value(std::uint32_t at) const { return value_[at]; }
    std::uint64_t edges() const { return edges_; }

  private:
    const Diagram& diagram_;
    std::uint32_t goal_, least_;
    bool widest_;
    std::vector<std::uint32_t> parent_;
    std::vector<double> value_;
    std::vector<bool> settled_;
    std::uint64_t edges_ = 0;

    std::uint32_t cell(std::uint32_t at) const { return diagram_.cells()[at]; }
    double height(std::uint32_t at) const { return diagram_.clearance().squared[cell(at)]; }
};

// The cells from one up to the diagram.
inline std::vector<std::uint32_t> retract(const Diagram& diagram, std::uint32_t cell) {
    std::vector<std::uint32_t> way = {cell};
    while (diagram.place(way.back()) == Diagram::none) way.push_back(diagram.above(way.back()));
    return way;
}

// A path along sides without its loops, and with diagonal steps where both adjacent cells are free.
inline void straighten(const maps::BitGrid& grid, std::vector<std::uint32_t>& way) {
    std::vector<std::uint32_t> cells;
    std::vector<std::uint32_t> sorted = way;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::size_t> last(way.size());
    const auto rank = [&](std::uint32_t n) {
        return std::size_t(std::lower_bound(sorted.begin(), sorted.end(), n) - sorted.begin());
    };
    for (std::size_t k = 0; k < way.size(); ++k) last[rank(way[k])] = k;
    for (std::size_t k = 0; k < way.size(); ++k) {
        k = last[rank(way[k])];
        cells.push_back(way[k]);
    }
    way.clear();
    for (std::size_t k = 0; k < cells.size(); ++k) {
        way.push_back(cells[k]);
        if (k + 2 >= cells.size()) continue;
        const maps::Cell a = grid.cell(cells[k]), b = grid.cell(cells[k + 1]), c = grid.cell(cells[k + 2]);
        const bool turns = a.row != c.row && a.column != c.column;
        if (turns && !grid.blocked(a.row + c.row - b.row, a.column + c.column - b.column)) ++k;
    }
}

}  // namespace brushfire

struct BrushfireAnswer {
    GridAnswer way;
    std::uint32_t squared = 0;  // the least clearance on the way, as in Clearance
};

inline BrushfireAnswer find_along(const Diagram& diagram, maps::Cell start, maps::Cell goal, Prefer prefer) {
    const maps::BitGrid& grid = diagram.grid();
    BrushfireAnswer answer;
    std::vector<std::uint32_t> way = brushfire::retract(diagram, grid.number(start));
    std::vector<std::uint32_t> back = brushfire::retract(diagram, grid.number(goal));
    const std::uint32_t from = diagram.place(way.back()), to = diagram.place(back.back());
    const auto search = [&](bool widest, std::uint32_t least, const auto& then) {
        brushfire::Walk walk(diagram, to, widest, least);
        search::PriorityQueue queue;
        walk.start(from, queue);
        const bool found = search::best_first(walk, queue, answer.way.effort) == to;
        answer.way.effort.pushed += walk.edges();
        if (found) then(walk);
        return found;
    };
    std::uint32_t least = 0;
    if (prefer == Prefer::clearance &&
        !search(true, 0, [&](const auto& walk) { least = std::uint32_t(-walk.value(to)); }))
        return answer;
    std::vector<std::uint32_t> along;
    if (!search(false, least, [&](const auto& walk) {
            for (std::uint32_t at = to; at != from; at = walk.parent(at))
                along.push_back(diagram.cells()[at]);
        }))
        return answer;
    way.insert(way.end(), along.rbegin(), along.rend());
    way.insert(way.end(), back.rbegin() + 1, back.rend());
    brushfire::straighten(grid, way);
    answer.way.found = true;
    answer.squared = diagram.clearance().squared[way.front()];
    for (const std::uint32_t n : way) {
        answer.way.cells.push_back(grid.cell(n));
        answer.squared = std::min(answer.squared, diagram.clearance().squared[n]);
    }
    return answer;
}

}  // namespace cspace::navigation
