#include "navigation_polygons.hpp"

#include "cspace/navigation/any_angle/polyanya.hpp"
#include "cspace/navigation/cells/approximate_cells.hpp"
#include "cspace/navigation/cells/exact_cells.hpp"
#include "cspace/navigation/sampling/prm.hpp"
#include "cspace/navigation/sampling/rrt.hpp"
#include "cspace/navigation/visibility/search.hpp"
#include "cspace/navigation/voronoi/roadmap.hpp"
#include "maps_polygon_state.hpp"

namespace cspace::navigation {

using maps::Index;
using maps::Settled;
using State = PolygonCore::State;

namespace {

// Calls search(state, component, from, to) with the ends taken off walls, and gives the path the ends that
// were asked for; false where one lies in an obstacle.
template <class Search>
bool find_between(const PolygonCore& core, Point start, Point goal, Route& route, const Search& search) {
    State& state = core.state();
    Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    route.status = Status::unreachable;
    search(state, state.world.shared_component(from, to), from, to);
    if (route.path.empty() || (from.at == start && to.at == goal)) return true;
    route.path.front() = start, route.path.back() = goal;
    route.length = length_of(route.path);
    return true;
}

Route find_any_angle(State& state, Settled& from, Settled& to, Trace* trace) {
    const maps::ConvexMesh& mesh = state.world.mesh();
    for (Settled* end : {&from, &to})
        for (Index& t : end->triangles) t = mesh.of_triangle[std::size_t(t)];
    return state.polyanya.lend<Polyanya>(
        [&](Polyanya& search) { return search.solve(from.at, from.triangles, to.at, to.triangles, trace); },
        mesh);
}
const VisibilityGraph& graph_of(State& state) {
    return state.visibility_graph.get<VisibilityGraph>(state.world.space);
}
Route find_by_visibility(State& state, Settled& from, Settled& to, Trace* trace) {
    return state.visibility.lend<VisibilitySearch>(
        [&](VisibilitySearch& search) { return search.solve(from, to, trace); }, graph_of(state),
        state.world.space);
}
Route find_by_cells(State& state, Settled& from, Settled& to, Trace* trace) {
    return state.exact_cells.get<ExactCells>(state.world).solve(from.at, to.at, trace);
}
// By the numbers of PolygonPlanner.
constexpr decltype(&find_any_angle) planners[] = {find_any_angle, find_by_visibility, find_by_cells};

ApproximateCells cells_of(State& state, const std::int64_t* s, Trace* trace) {
    const CellOptions options{int(s[0]), int(s[1]), s[2] != 0, s[3] != 0, s[4] != 0, std::size_t(s[5])};
    return ApproximateCells(state.world, options, trace, &state.quadtree.get<CellStages>());
}

SampledRoute search_roadmap(State& state, const sampling::Problem& problem, const SamplingSettings& s,
                            Trace* trace) {
    const sampling::RoadmapKey key{problem.component, s.samples, s.neighbours, s.seed};
    const auto make = [&] { return std::make_shared<const sampling::Roadmap>(state.world, key); };
    const auto roadmap = state.samples.get<sampling::KeptRoadmap>().of(key, make, search::most_kept_bytes);
    return sampling::RoadmapSearch(problem, *roadmap).solve(trace);
}
SampledRoute grow_tree(const sampling::Problem& problem, const SamplingSettings& s, Trace* trace) {
    const sampling::Growth growth{s.samples, s.step, s.goal_bias, s.planner == s.rrt_star, s.seed};
    return sampling::Tree(problem, growth, trace).solve();
}

const voronoi::Roadmap& diagram_of(State& state) { return state.voronoi.get<voronoi::Roadmap>(state.world); }

}  // namespace

bool find_polygon_route(const PolygonCore& core, PolygonPlanner planner, Point start, Point goal,
                        Route& route, Trace* trace) {
    return find_between(core, start, goal, route, [&](State& state, Index component, auto& from, auto& to) {
        if (component != maps::none) route = planners[int(planner)](state, from, to, trace);
    });
}

bool find_cell_route(const PolygonCore& core, Point start, Point goal, const std::int64_t* settings,
                     CellRoute& found, Trace* trace) {
    return find_between(core, start, goal, found.route, [&](State& state, Index, auto& from, auto& to) {
        found = cells_of(state, settings, trace).solve(from.at, to.at);
    });
}

bool find_sampled_route(const PolygonCore& core, const SamplingSettings& settings, Point start, Point goal,
                        SampledRoute& found, Trace* trace) {
    const auto search = [&](State& state, Index component, auto& from, auto& to) {
        if (component == maps::none) return;
        const sampling::Problem problem = sampling::problem_of(state.world, component, from, to);
        found = settings.planner == settings.prm ? search_roadmap(state, problem, settings, trace)
                                                 : grow_tree(problem, settings, trace);
    };
    return find_between(core, start, goal, found.route, search);
}

bool find_voronoi_route(const PolygonCore& core, Point start, Point goal, bool widest, double tolerance,
                        DiagramRoute& found, Trace* trace) {
    const auto search = [&](State& state, Index component, auto& from, auto& to) {
        if (component != maps::none)
            found = diagram_of(state).solve(from, to, component, widest, tolerance, trace);
    };
    return find_between(core, start, goal, found.route, search);
}

void list_visibility_graph(const PolygonCore& core, std::vector<Point>& nodes,
                           std::vector<std::int32_t>& edges) {
    State& state = core.state();
    const VisibilityGraph& graph = graph_of(state);
    for (Index n = 0; n < graph.size(); ++n) {
        nodes.push_back(graph.point(n));
        for (const auto& edge : graph.edges_of(n))
            if (n < edge.to) edges.insert(edges.end(), {n, edge.to});
    }
}

void list_exact_cells(const PolygonCore& core, std::vector<Point>& corners,
                      std::vector<std::int32_t>& doors) {
    State& state = core.state();
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

void list_cell_leaves(const PolygonCore& core, const std::int64_t* settings, std::vector<double>& squares,
                      std::vector<std::int8_t>& kinds) {
    const ApproximateCells cells = cells_of(core.state(), settings, nullptr);
    const Quadtree& tree = cells.tree();
    for (Index c = 0; c < Index(tree.cells().size()); ++c) {
        if (!tree.is_leaf(c)) continue;
        const Point low = tree.low(tree[c]), high = tree.high(tree[c]);
        squares.insert(squares.end(), {low.x, low.y, high.x, high.y});
        kinds.push_back(tree[c].kind);
    }
}

VoronoiArcs list_voronoi_arcs(const PolygonCore& core, double tolerance) {
    const voronoi::Diagram& diagram = diagram_of(core.state()).diagram();
    VoronoiArcs made;
    for (const auto whole : diagram.is_whole) made.is_whole = made.is_whole && whole;
    for (const auto& vertex : diagram.vertices) {
        made.vertices.push_back(diagram.place(vertex.at));
        made.clearance.push_back(vertex.radius);
    }
    for (const voronoi::Arc& arc : diagram.arcs) {
        VoronoiArc& drawn = made.arcs.emplace_back(VoronoiArc{arc.from, arc.to, {}, {}});
        drawn.line = {arc.curve.at(arc.begin)};
        voronoi::Roadmap::sample(arc.curve, arc.begin, arc.end, tolerance, drawn.line);
        for (Point& p : drawn.line) {
            drawn.clearance.push_back(arc.curve.radius(arc.curve.parameter(p)));
            p = diagram.place(p);
        }
    }
    return made;
}

}  // namespace cspace::navigation
