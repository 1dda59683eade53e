#include "cspace/navigation/any_angle/grid_any_angle.hpp"
#include "maps_grid_state.hpp"
#include "navigation_grid.hpp"

namespace cspace::navigation {

bool find_any_angle_route(const maps::GridWorld& world, Point start, Point goal, Look look, Route& route,
                          Trace* trace) {
    auto& [bits, frame, parts] = world.state();
    if (!maps::RunMesh::fits(bits))
        throw std::invalid_argument(
            "the grid has too many cells for a search over runs of cells; use larger cells");
    GridAnyAngle search(bits, frame);
    const SettledInRuns from = search.settle(start), to = search.settle(goal);
    if (from.runs.empty() || to.runs.empty()) return false;
    route = search.solve(start, from, goal, to, &parts, trace, look);
    return true;
}

}  // namespace cspace::navigation
