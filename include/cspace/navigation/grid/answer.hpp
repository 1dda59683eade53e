// What a search over the cells of a grid answers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// A cell that was settled: how far it is, and from which cell.
struct Settled {
    maps::Cell cell, parent;
    double g;
};

struct GridAnswer {
    bool found = false;
    std::vector<maps::Cell> cells;  // from start to goal; between two that follow each other the way is a
                                    // row, a column or a diagonal, or, of any angle, a straight line
    double cost = 0;                // of the way, as the planner counts [cells, or cells · cost]
    double least = 0;               // no path costs less, if the planner proves that
    search::Effort effort;
    std::int64_t parts =
        0;  // how many there are, where the ends lie in two of them, which proves the verdict
    std::vector<Settled>* settled = nullptr;  // takes the cells in the order in which they were settled
    std::vector<std::uint32_t> order;         // the same as the search numbers them
};

namespace grid_search {

template <class Look>
void note_settled(GridAnswer& answer, const Look& look) {
    if (!answer.settled) return;
    for (const std::uint32_t node : answer.order) answer.settled->push_back(look(node));
}

// The cells from the start to a node, where parent_of(node) is itself for the start.
template <class ParentOf, class CellOf>
void follow_back(std::uint32_t node, const ParentOf& parent_of, const CellOf& cell_of,
                 std::vector<maps::Cell>& cells) {
    cells.clear();
    for (std::uint32_t before = parent_of(node);; node = before, before = parent_of(node)) {
        cells.push_back(cell_of(node));
        if (before == node) break;
    }
    std::reverse(cells.begin(), cells.end());
}

}  // namespace grid_search

}  // namespace cspace::navigation
