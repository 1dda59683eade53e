#include "cspace/navigation/cells/approximate_cells.hpp"
#include "cspace/navigation/cells/cell_stage.hpp"
#include "maps_polygon_state.hpp"
#include "navigation_ends.hpp"
#include "navigation_polygons.hpp"

namespace cspace::navigation {

namespace {

ApproximateCells cells_of(const PolygonCore& core, const std::int64_t* s, Trace* trace) {
    const CellOptions options{int(s[0]), int(s[1]), s[2] != 0, s[3] != 0, s[4] != 0, std::size_t(s[5])};
    PolygonCore::State& state = core.state();
    return ApproximateCells(state.world, options, trace, &state.quadtree.get<CellStages>());
}

}  // namespace

CellFinding find_cell_route(const PolygonCore& core, Point start, Point goal, const std::int64_t* settings,
                            Trace* trace) {
    const Point from = core.state().settle(start).at, to = core.state().settle(goal).at;
    CellAnswer answer = cells_of(core, settings, trace).solve(from, to);
    if (!(from == start && to == goal)) restore_ends(answer.route, start, goal);
    return {std::move(answer.route), answer.leaves[0], answer.leaves[1], answer.leaves[2], answer.depth};
}

void list_cell_leaves(const PolygonCore& core, const std::int64_t* settings, std::vector<double>& squares,
                      std::vector<std::int8_t>& kinds) {
    const ApproximateCells cells = cells_of(core, settings, nullptr);
    const Quadtree& tree = cells.tree();
    for (maps::Index c = 0; c < maps::Index(tree.cells().size()); ++c) {
        if (!tree.is_leaf(c)) continue;
        const Point low = tree.low(tree[c]), high = tree.high(tree[c]);
        squares.insert(squares.end(), {low.x, low.y, high.x, high.y});
        kinds.push_back(tree[c].kind);
    }
}

}  // namespace cspace::navigation
