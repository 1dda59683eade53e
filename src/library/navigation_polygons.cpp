#include "navigation_polygons.hpp"

#include "cspace/navigation/any_angle/polyanya.hpp"
#include "cspace/navigation/cells/exact_cells.hpp"
#include "cspace/navigation/visibility/search.hpp"
#include "maps_polygon_state.hpp"
#include "navigation_ends.hpp"

namespace cspace::navigation {

using maps::Index;
using maps::Settled;

namespace {

Route find_any_angle(PolygonCore::State& core, Settled& from, Settled& to, Trace* trace) {
    const maps::ConvexMesh& mesh = core.world.mesh();
    for (Settled* end : {&from, &to})
        for (Index& t : end->triangles) t = mesh.of_triangle[std::size_t(t)];
    return core.polyanya.get<Polyanya>(mesh).solve(from.at, from.triangles, to.at, to.triangles, trace);
}
Route find_by_visibility(PolygonCore::State& core, Settled& from, Settled& to, Trace* trace) {
    return core.visibility.get<VisibilitySearch>(core.world).solve(from, to, trace);
}
Route find_by_cells(PolygonCore::State& core, Settled& from, Settled& to, Trace* trace) {
    return core.exact_cells.get<ExactCells>(core.world).solve(from.at, to.at, trace);
}
// By the numbers of PolygonPlanner.
constexpr decltype(&find_any_angle) planners[] = {find_any_angle, find_by_visibility, find_by_cells};

}  // namespace

bool find_polygon_route(const PolygonCore& core, PolygonPlanner planner, Point start, Point goal,
                        Route& route, Trace* trace) {
    PolygonCore::State& state = core.state();
    Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    route.status = Status::unreachable;
    if (state.world.shared_component(from, to) == maps::none) return true;
    route = planners[int(planner)](state, from, to, trace);
    if (!(from.at == start && to.at == goal)) restore_ends(route, start, goal);
    return true;
}

void list_visibility_graph(const PolygonCore& core, std::vector<Point>& nodes,
                           std::vector<std::int32_t>& edges) {
    PolygonCore::State& state = core.state();
    const VisibilityGraph& graph = state.visibility.get<VisibilitySearch>(state.world).graph();
    for (Index n = 0; n < graph.size(); ++n) {
        nodes.push_back(graph.point(n));
        for (const auto& edge : graph.edges_of(n))
            if (n < edge.to) edges.insert(edges.end(), {n, edge.to});
    }
}

void list_exact_cells(const PolygonCore& core, std::vector<Point>& corners,
                      std::vector<std::int32_t>& doors) {
    PolygonCore::State& state = core.state();
    const Trapezoids& all = state.exact_cells.get<ExactCells>(state.world).cells();
    for (const Trapezoid& c : all.cells) {
        const SweptWall &bottom = all.wall(c.bottom), &top = all.wall(c.top);
        const double left = c.left.x, right = c.right.x;
        corners.insert(corners.end(), {{left, bottom.y_at(left)},
                                       {right, bottom.y_at(right)},
                                       {right, top.y_at(right)},
                                       {left, top.y_at(left)}});
    }
    for (const Door& d : all.doors) doors.insert(doors.end(), {d.left, d.right});
}

}  // namespace cspace::navigation
