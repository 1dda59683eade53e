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
bool find_between(const Query<PolygonCore>& query, Route& route, const Search& search) {
    State& state = query.world.state();
    const auto& [world, start, goal, trace] = query;
    Settled from, to;
    if (!state.settle(start, goal, from, to)) return false;
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
// By the numbers of plan_in_polygons.
constexpr std::array planners = {find_any_angle, find_by_visibility, find_by_cells};

ApproximateCells cells_of(State& state, const QuadtreeSettings& s, Trace* trace) {
    const CellOptions options{int(s[0]), int(s[1]), s[2] != 0, s[3] != 0, s[4] != 0, std::size_t(s[5])};
    return ApproximateCells(state.world, options, trace, &state.quadtree.get<CellStages>());
}

SampledRoute search_roadmap(State& state, const sampling::Problem& problem, const sampling::RoadmapKey& key,
                            Trace* trace) {
    const auto make = [&] { return std::make_shared<const sampling::Roadmap>(state.world, key); };
    const auto roadmap = state.samples.get<sampling::KeptRoadmap>().of(key, make, search::most_kept_bytes);
    return sampling::RoadmapSearch(problem, *roadmap).solve(trace);
}

const voronoi::Roadmap& diagram_of(State& state) { return state.voronoi.get<voronoi::Roadmap>(state.world); }

}  // namespace

bool plan_in_polygons(const Query<PolygonCore>& query, Route& route, std::int64_t planner) {
    return find_between(query, route, [&](State& state, Index component, auto& from, auto& to) {
        if (component != maps::none) route = planners.at(std::size_t(planner))(state, from, to, query.trace);
    });
}

bool plan_quadtree(const Query<PolygonCore>& query,
                   Answer<std::int64_t, std::int64_t, std::int64_t, int>& answer,
                   const QuadtreeSettings& settings) {
    return find_between(query, answer.route, [&](State& state, Index, auto& from, auto& to) {
        CellRoute found = cells_of(state, settings, query.trace).solve(from.at, to.at);
        answer.route = std::move(found.route);
        answer.evidence = std::tuple_cat(found.leaves, std::tuple(found.depth));
    });
}

bool plan_samples(const Query<PolygonCore>& query, Answer<std::int64_t, std::int64_t, std::int64_t>& answer,
                  std::int64_t planner, std::int64_t samples, std::uint64_t seed, std::int64_t neighbours,
                  double step, double goal_bias) {
    enum { prm, rrt, rrt_star };
    SampledRoute found;
    const auto search = [&](State& state, Index component, auto& from, auto& to) {
        if (component == maps::none) return;
        const sampling::Problem problem = sampling::problem_of(state.world, component, from, to);
        const sampling::Growth growth{samples, step, goal_bias, planner == rrt_star, seed};
        found = planner == prm
                    ? search_roadmap(state, problem, {component, samples, neighbours, seed}, query.trace)
                    : sampling::Tree(problem, growth, query.trace).solve();
    };
    if (!find_between(query, found.route, search)) return false;
    answer.evidence = {found.samples, found.route.stats.nodes, found.route.stats.edges};
    answer.route = std::move(found.route);
    return true;
}

bool plan_voronoi(const Query<PolygonCore>& query, Answer<double, double, double, double>& answer,
                  bool is_widest, double tolerance) {
    return find_between(query, answer.route, [&](State& state, Index component, auto& from, auto& to) {
        if (component == maps::none) return;
        auto [route, clearance, on_diagram, at_start, at_goal] =
            diagram_of(state).solve(from, to, component, is_widest, tolerance, query.trace);
        answer.route = std::move(route);
        if (answer.route.status == Status::found)
            answer.evidence = {clearance, on_diagram, at_start, at_goal};
    });
}

std::pair<Table<Point>, Table<std::int32_t>> list_visibility_graph(const PolygonCore& core) {
    State& state = core.state();
    const VisibilityGraph& graph = graph_of(state);
    std::vector<Point> nodes;
    std::vector<std::int32_t> edges;
    for (Index n = 0; n < graph.size(); ++n) {
        nodes.push_back(graph.point(n));
        for (const auto& edge : graph.edges_of(n))
            if (n < edge.to) edges.insert(edges.end(), {n, edge.to});
    }
    return {{std::move(nodes)}, {std::move(edges), 2}};
}

std::pair<Table<Point>, Table<std::int32_t>> list_exact_cells(const PolygonCore& core) {
    State& state = core.state();
    std::vector<Point> corners;
    std::vector<std::int32_t> doors;
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
    return {{std::move(corners), 4}, {std::move(doors), 2}};
}

std::pair<Table<double>, Table<std::int8_t>> list_cell_leaves(const PolygonCore& core,
                                                              const QuadtreeSettings& settings) {
    std::vector<double> squares;
    std::vector<std::int8_t> kinds;
    const ApproximateCells cells = cells_of(core.state(), settings, nullptr);
    const Quadtree& tree = cells.tree();
    for (Index c = 0; c < Index(tree.cells().size()); ++c) {
        if (!tree.is_leaf(c)) continue;
        const Point low = tree.low(tree[c]), high = tree.high(tree[c]);
        squares.insert(squares.end(), {low.x, low.y, high.x, high.y});
        kinds.push_back(tree[c].kind);
    }
    return {{std::move(squares), 4}, {std::move(kinds)}};
}

std::tuple<Table<Point>, Table<double>, Table<std::int32_t>, std::vector<VoronoiArc>, bool> list_voronoi_arcs(
    const PolygonCore& core, double tolerance) {
    const voronoi::Diagram& diagram = diagram_of(core.state()).diagram();
    Table<Point> vertices;
    Table<double> radii;
    Table<std::int32_t> ends{{}, 2};
    std::vector<VoronoiArc> arcs;
    for (const auto& vertex : diagram.vertices) {
        vertices.values.push_back(diagram.place(vertex.at));
        radii.values.push_back(vertex.radius);
    }
    for (const voronoi::Arc& arc : diagram.arcs) {
        ends.values.insert(ends.values.end(), {arc.from, arc.to});
        auto& [line, clearance] = arcs.emplace_back();
        line.values = {arc.curve.at(arc.begin)};
        voronoi::Roadmap::sample(arc.curve, arc.begin, arc.end, tolerance, line.values);
        for (Point& p : line.values) {
            clearance.values.push_back(arc.curve.radius(arc.curve.parameter(p)));
            p = diagram.place(p);
        }
    }
    const auto& whole = diagram.is_whole;
    return {std::move(vertices), std::move(radii), std::move(ends), std::move(arcs),
            std::find(whole.begin(), whole.end(), 0) == whole.end()};
}

}  // namespace cspace::navigation
