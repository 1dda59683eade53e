// A way along the diagram of a grid: up the clearance from start and goal, and between on the diagram, where
// the least clearance is greatest, or the way is shortest.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/clearance.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/pieces.hpp"
#include "cspace/navigation/fields/thinning.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// The Voronoi diagram of a grid by brushfire: every free cell gets its nearest piece of boundary, cells where
// waves of different stretches meet are kept, and thinning joins them.
class Diagram {
  public:
    static constexpr std::uint32_t none = 0xffffffff;
    struct Branch {
        std::uint32_t from, to;  // cells where it ends
        std::int32_t steps;
        std::uint32_t squared;  // the least clearance on it, as in Clearance
    };

    explicit Diagram(maps::BitGrid grid)
        : grid_(std::move(grid)),
          clearance_(make_clearance(grid_)),
          pieces_(grid_),
          fate_(filled_vector(grid_.numbers(), Fate::blocked)) {
        name_marks();
        keep_meets();
        Thinning thin(grid_, clearance_.squared, fate_);
        thin.run();
        number_cells(thin);
        trace_branches();
    }

    Diagram(const Diagram&) = delete;
    Diagram& operator=(const Diagram&) = delete;

    const maps::BitGrid& grid() const { return grid_; }
    // Without the nearest blocked cells: mark() says more.
    const maps::Clearance& clearance() const { return clearance_; }
    const Pieces& pieces() const { return pieces_; }
    // The place of the boundary nearest to a free cell.
    Pieces::Mark mark(std::uint32_t cell) const { return Pieces::Mark(mark_[cell]); }
    bool is_meet(std::uint32_t cell) const { return fate_[cell] == Fate::kept; }

    // The cells of the diagram, and for each its neighbours along sides, by their places in the list.
    const std::vector<std::uint32_t>& cells() const { return cells_; }
    const std::array<std::uint32_t, 4>& beside(std::uint32_t place) const { return beside_[place]; }
    std::uint32_t place(std::uint32_t cell) const {
        return fate_[cell] > Fate::taken ? std::uint32_t(next_[cell]) : none;
    }
    // From a free cell that is not in the diagram to the next one on its way there.
    std::uint32_t above(std::uint32_t cell) const { return std::uint32_t(next_[cell]); }
    // Ways between cells of the diagram with other than two neighbours; of a circle, from one of its cells to
    // itself.
    const std::vector<Branch>& branches() const { return branches_; }

  private:
    maps::BitGrid grid_;
    maps::Clearance clearance_;
    Pieces pieces_;
    std::vector<Fate> fate_;
    // In reused memory: new pages take longer than writing to them.
    std::vector<std::uint32_t> mark_;
    std::vector<std::int32_t> next_;  // of cells in the diagram their place, of others the cell above
    std::vector<std::uint32_t> cells_;
    std::vector<std::array<std::uint32_t, 4>> beside_;
    std::vector<Branch> branches_;

    template <class Visit>
    void each_free(const Visit& visit) const {
        InterruptPoll poll(4);
        for (int row = 0; row < grid_.rows(); ++row) {
            poll.step();
            for (std::size_t k = 0; k < grid_.row_words(); ++k) {
                const std::size_t left = grid_.stride() - 64 * k;
                const std::uint64_t within = left >= 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << left) - 1;
                for (std::uint64_t free = ~grid_.row(row)[k] & within; free; free &= free - 1) {
                    const maps::Cell cell = {row, int(64 * k) + std::countr_zero(free) - 1};
                    visit(cell, grid_.number(cell));
                }
            }
        }
    }

    void name_marks() {
        mark_ = std::move(clearance_.nearest);
        each_free([&](maps::Cell cell, std::uint32_t n) {
            mark_[n] = std::uint32_t(pieces_.nearest(cell, grid_.cell(mark_[n])));
            fate_[n] = Fate::left;
        });
    }
    // Of two neighbours whose waves meet the one of more clearance is kept; of a wall and a cell, the cell.
    void keep_meets() {
        const auto meet = [&](maps::Cell cell, std::uint32_t n, maps::Cell beside) {
            const std::uint32_t m = grid_.number(beside);
            const bool is_wall = fate_[m] == Fate::blocked;
            if (!pieces_.are_apart(mark(n), is_wall ? pieces_.nearest(cell, beside) : mark(m))) return;
            fate_[is_wall || clearance_.squared[n] >= clearance_.squared[m] ? n : m] = Fate::kept;
        };
        each_free([&](maps::Cell cell, std::uint32_t n) {
            meet(cell, n, {cell.row, cell.column + 1});
            meet(cell, n, {cell.row + 1, cell.column});
            if (fate_[n - 1] == Fate::blocked) meet(cell, n, {cell.row, cell.column - 1});
            if (fate_[n - grid_.stride()] == Fate::blocked) meet(cell, n, {cell.row - 1, cell.column});
        });
    }
    void number_cells(const Thinning& thin) {
        next_ = pieces_.give_sides();
        each_free([&](maps::Cell, std::uint32_t n) {
            if (fate_[n] == Fate::taken) {
                next_[n] = std::int32_t(thin.above(n));
                return;
            }
            next_[n] = std::int32_t(cells_.size());
            cells_.push_back(n);
        });
        beside_.reserve(cells_.size());
        InterruptPoll poll(1024);
        for (const std::uint32_t n : cells_) {
            poll.step();
            beside_.push_back(
                {place(n + 1), place(n + grid_.stride()), place(n - 1), place(n - grid_.stride())});
        }
    }

    int degree(std::uint32_t k) const {
        int count = 0;
        for (const std::uint32_t b : beside_[k]) count += b != none;
        return count;
    }
    void trace_branches() {
        std::vector<std::uint8_t> passed(cells_.size());
        visit_range(0, cells_.size(), [&](std::size_t i) {
            const std::uint32_t k = std::uint32_t(i);
            if (degree(k) != 2)
                for (const std::uint32_t b : beside_[k])
                    if (b != none && (degree(b) != 2 ? k < b : !passed[b])) trace_branch(k, b, passed);
        });
        visit_range(0, cells_.size(), [&](std::size_t i) {
            const std::uint32_t k = std::uint32_t(i);
            if (degree(k) == 2 && !passed[k])
                for (const std::uint32_t b : beside_[k])
                    if (b != none && !passed[b]) trace_branch(k, b, passed);
        });
    }
    void trace_branch(std::uint32_t from, std::uint32_t to, std::vector<std::uint8_t>& passed) {
        const auto height = [&](std::uint32_t k) { return clearance_.squared[cells_[k]]; };
        Branch branch{cells_[from], 0, 1, std::min(height(from), height(to))};
        const std::uint32_t first = from;
        while (degree(to) == 2 && to != first) {
            passed[to] = 1;
            std::uint32_t on = none;
            for (const std::uint32_t b : beside_[to])
                if (b != none && b != from) on = b;
            from = to;
            to = on;
            ++branch.steps;
            branch.squared = std::min(branch.squared, height(to));
        }
        if (degree(to) == 2) passed[to] = 1;
        branch.to = cells_[to];
        branches_.push_back(branch);
    }
};

enum class Prefer : std::uint8_t { clearance, length };

namespace brushfire {

// Over the cells of a diagram, by places: widest first, or, over those of a least clearance, shortest first.
class Walk {
  public:
    Walk(const Diagram& diagram, std::uint32_t goal, bool widest, std::uint32_t least)
        : diagram_(diagram), goal_(goal), least_(least), widest_(widest), ways_(diagram.cells().size()) {}
    template <class Queue>
    void start(std::uint32_t at, Queue& queue) {
        ways_.improve(at, widest_ ? -height(at) : 0, at);
        queue.push({ways_.cost(at), 0, at});
    }
    bool settle(std::uint32_t at) { return ways_.settle(at); }
    bool is_goal(std::uint32_t at) const { return at == goal_; }
    template <class Queue>
    void expand(std::uint32_t at, Queue& queue) {
        for (const std::uint32_t to : diagram_.beside(at)) {
            if (to == Diagram::none || ways_.is_settled(to) ||
                diagram_.clearance().squared[cell(to)] < least_)
                continue;
            const double value = widest_ ? std::max(ways_.cost(at), -height(to)) : ways_.cost(at) + 1;
            ++edges_;
            if (ways_.improve(to, value, at)) queue.push({value, 0, to});
        }
    }
    std::uint32_t parent(std::uint32_t at) const { return ways_.before(at); }
    double value(std::uint32_t at) const { return ways_.cost(at); }
    std::uint64_t edges() const { return edges_; }

  private:
    const Diagram& diagram_;
    std::uint32_t goal_, least_;
    bool widest_;
    search::Ways ways_;
    std::uint64_t edges_ = 0;

    std::uint32_t cell(std::uint32_t at) const { return diagram_.cells()[at]; }
    double height(std::uint32_t at) const { return diagram_.clearance().squared[cell(at)]; }
};

// The cells from one up to the diagram.
inline std::vector<std::uint32_t> climb_to_diagram(const Diagram& diagram, std::uint32_t cell) {
    std::vector<std::uint32_t> way = {cell};
    while (diagram.place(way.back()) == Diagram::none) way.push_back(diagram.above(way.back()));
    return way;
}

// A path along sides without its loops, and with diagonal steps where both adjacent cells are free.
inline void straighten_way(const maps::BitGrid& grid, std::vector<std::uint32_t>& way) {
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
    std::vector<std::uint32_t> way = brushfire::climb_to_diagram(diagram, grid.number(start));
    std::vector<std::uint32_t> back = brushfire::climb_to_diagram(diagram, grid.number(goal));
    const std::uint32_t from = diagram.place(way.back()), to = diagram.place(back.back());
    const auto walk = [&](bool widest, std::uint32_t least) {
        brushfire::Walk made(diagram, to, widest, least);
        search::PriorityQueue queue;
        made.start(from, queue);
        answer.way.found = search::best_first(made, queue, answer.way.effort) == to;
        answer.way.effort.pushed += made.edges();
        return made;
    };
    std::uint32_t least = 0;
    if (prefer == Prefer::clearance) {
        const brushfire::Walk widest = walk(true, 0);
        if (!answer.way.found) return answer;
        least = std::uint32_t(-widest.value(to));
    }
    const brushfire::Walk shortest = walk(false, least);
    if (!answer.way.found) return answer;
    std::vector<std::uint32_t> along;
    for (std::uint32_t at = to; at != from; at = shortest.parent(at)) along.push_back(diagram.cells()[at]);
    way.insert(way.end(), along.rbegin(), along.rend());
    way.insert(way.end(), back.rbegin() + 1, back.rend());
    brushfire::straighten_way(grid, way);
    answer.squared = diagram.clearance().squared[way.front()];
    for (const std::uint32_t n : way) {
        answer.way.cells.push_back(grid.cell(n));
        answer.squared = std::min(answer.squared, diagram.clearance().squared[n]);
    }
    return answer;
}

}  // namespace cspace::navigation
