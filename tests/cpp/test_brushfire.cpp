#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "check.hpp"
#include "cspace/navigation/fields/brushfire.hpp"
#include "random.hpp"

using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

BitGrid random_grid(check::Random& random) {
    const int rows = 1 + random.below(22), columns = 1 + random.below(22);
    const double share = random.uniform(0, 0.6);
    const int side = 1 + random.below(4);  // of the blocks that are blocked
    BitGrid grid(rows, columns);
    for (int r = 0; r < rows; r += side)
        for (int c = 0; c < columns; c += side)
            if (random.uniform(0, 1) < share)
                for (int k = 0; k < side * side; ++k)
                    if (grid.contains({r + k / side, c + k % side}))
                        grid.set(r + k / side, c + k % side, true);
    return grid;
}
std::vector<Cell> free_cells(const BitGrid& grid) {
    std::vector<Cell> cells;
    for (int r = 0; r < grid.rows(); ++r)
        for (int c = 0; c < grid.columns(); ++c)
            if (!grid.blocked(r, c)) cells.push_back({r, c});
    return cells;
}
std::uint32_t squared_gap(const BitGrid& grid, Cell at) {
    long best = std::numeric_limits<long>::max();
    for (int r = -1; r <= grid.rows(); ++r)
        for (int c = -1; c <= grid.columns(); ++c) {
            if (!grid.blocked(r, c)) continue;
            const long up = std::max(0, 2 * std::abs(r - at.row) - 1);
            const long along = std::max(0, 2 * std::abs(c - at.column) - 1);
            best = std::min(best, up * up + along * along);
        }
    return std::uint32_t(best);
}

// The greatest least clearance of ways by sides from a cell to all others, by going over all steps until
// nothing grows; −1 where no way leads.
std::vector<long> widest(const BitGrid& grid, const Clearance& clearance, Cell start,
                         bool (*allows)(std::uint32_t)) {
    std::vector<long> best(grid.numbers(), -1);
    best[grid.number(start)] = long(clearance.squared[grid.number(start)]);
    for (bool changed = true; changed;) {
        changed = false;
        for (const Cell c : free_cells(grid))
            for (int d = 0; d < 8; d += 2) {
                const Cell to = {c.row + row_step[d], c.column + column_step[d]};
                const std::uint32_t n = grid.number(c), m = grid.number(to);
                if (grid.blocked(to) || best[n] < 0 || !allows(m)) continue;
                const long reached = std::min(best[n], long(clearance.squared[m]));
                if (reached > best[m]) best[m] = reached, changed = true;
            }
    }
    return best;
}

}  // namespace

TEST(distances_are_those_to_the_nearest_blocked_cell) {
    check::Random random{1};
    for (int k = 0; k < 400; ++k) {
        const BitGrid grid = random_grid(random);
        const Clearance clearance = make_clearance(grid);
        for (const Cell c : free_cells(grid)) {
            const std::uint32_t n = grid.number(c);
            CHECK(clearance.squared[n] == squared_gap(grid, c));
            const Cell foot = grid.cell(clearance.nearest[n]);
            const long up = std::max(0, 2 * std::abs(foot.row - c.row) - 1);
            const long along = std::max(0, 2 * std::abs(foot.column - c.column) - 1);
            CHECK(grid.blocked(foot) && up * up + along * along == long(clearance.squared[n]));
        }
    }
}

TEST(marks_lie_where_the_distance_says) {
    check::Random random{2};
    for (int k = 0; k < 300; ++k) {
        const BitGrid grid = random_grid(random);
        const Diagram diagram(grid);
        for (const Cell c : free_cells(grid)) {
            const std::uint32_t n = grid.number(c);
            const auto at = diagram.pieces().at(diagram.mark(n));
            const long up = at.row - 2 * c.row - 1, along = at.column - 2 * c.column - 1;
            CHECK(up * up + along * along == long(diagram.clearance().squared[n]));
        }
        long sides = 0;
        for (int r = 0; r <= grid.rows(); ++r)
            for (int c = 0; c <= grid.columns(); ++c)
                sides += (grid.blocked(r, c) != grid.blocked(r - 1, c)) +
                         (grid.blocked(r, c) != grid.blocked(r, c - 1));
        CHECK(long(diagram.pieces().sides().size()) == sides);
    }
}

TEST(ways_on_the_diagram_are_as_wide_as_ways_anywhere) {
    check::Random random{3};
    for (int k = 0; k < 300; ++k) {
        const BitGrid grid = random_grid(random);
        const std::vector<Cell> cells = free_cells(grid);
        if (cells.empty()) continue;
        const Diagram diagram(grid);
        const auto pick = [&] { return cells[std::size_t(random.below(int(cells.size())))]; };
        const Cell start = pick();
        const auto best = widest(grid, diagram.clearance(), start, [](std::uint32_t) { return true; });
        for (int i = 0; i < 8; ++i) {
            const Cell goal = pick();
            for (const Prefer prefer : {Prefer::clearance, Prefer::length}) {
                const BrushfireAnswer answer = find_along(diagram, start, goal, prefer);
                CHECK(answer.way.found == (best[grid.number(goal)] >= 0));
                if (!answer.way.found) continue;
                const auto& way = answer.way.cells;
                CHECK(way.front() == start && way.back() == goal);
                long least = std::numeric_limits<long>::max();
                for (const Cell c : way)
                    least = std::min(least, long(diagram.clearance().squared[grid.number(c)]));
                CHECK(least == long(answer.squared));
                if (prefer == Prefer::clearance) CHECK(least >= best[grid.number(goal)]);
                for (std::size_t j = 1; j < way.size(); ++j) {
                    const int dr = way[j].row - way[j - 1].row, dc = way[j].column - way[j - 1].column;
                    CHECK(std::abs(dr) <= 1 && std::abs(dc) <= 1 && (dr || dc));
                    CHECK(!grid.blocked(way[j]) && !grid.blocked(way[j].row, way[j - 1].column) &&
                          !grid.blocked(way[j - 1].row, way[j].column));
                }
            }
        }
    }
}

TEST(the_diagram_is_thin_and_has_every_branch) {
    check::Random random{4};
    for (int k = 0; k < 300; ++k) {
        const BitGrid grid = random_grid(random);
        const Diagram diagram(grid);
        long edges = 0, listed = 0;
        for (std::uint32_t p = 0; p < diagram.cells().size(); ++p) {
            CHECK(diagram.place(diagram.cells()[p]) == p);
            for (const std::uint32_t b : diagram.beside(p)) edges += b != Diagram::none && b > p;
        }
        for (const Diagram::Branch& branch : diagram.branches()) listed += branch.steps;
        CHECK(edges == listed);
    }
}

TEST(corridors_have_one_line) {
    for (int width = 1; width <= 8; ++width) {
        const BitGrid grid(width, 60);
        const Diagram diagram(grid);
        for (int c = width; c < 60 - width; ++c) {
            int count = 0;
            for (int r = 0; r < width; ++r) count += diagram.place(grid.number({r, c})) != Diagram::none;
            CHECK(count == 1);
            CHECK(diagram.place(grid.number({(width - 1) / 2, c})) != Diagram::none);
        }
    }
}
