#include "navigation_voronoi.hpp"

#include "cspace/navigation/voronoi/roadmap.hpp"
#include "maps_polygon_state.hpp"

namespace cspace::navigation {

namespace {

const voronoi::Roadmap& roadmap_of(PolygonCore::State& core) {
    return core.voronoi.get<voronoi::Roadmap>(core.world);
}

}  // namespace

bool find_voronoi_route(const PolygonCore& core, Point start, Point goal, bool widest, double tolerance,
                        VoronoiFinding& finding, Trace* trace) {
    PolygonCore::State& state = core.state();
    const maps::Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    const maps::Index component = state.world.shared_component(from, to);
    finding.route.status = Status::unreachable;
    if (component == maps::none) return true;
    voronoi::Way way = roadmap_of(state).solve(from, to, component, widest, tolerance, trace);
    finding = {std::move(way.route), way.clearance, way.on_diagram, way.at_start, way.at_goal};
    std::vector<Point>& path = finding.route.path;
    if (!path.empty()) path.front() = start, path.back() = goal;
    return true;
}

VoronoiArcs list_voronoi_arcs(const PolygonCore& core, double tolerance) {
    const voronoi::Diagram& diagram = roadmap_of(core.state()).diagram();
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
