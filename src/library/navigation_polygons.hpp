// The planners that are shown a polygon world: what the bindings call. A world keeps what its planners have
// made. Queries to any angle, visibility and exact cells of one world may not be made by two threads at a
// time.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::navigation {

struct PolygonQuery : Query<PolygonCore> {
    std::int64_t planner;  // 0 any angle, 1 visibility, 2 exact cells

    auto settings() { return std::tie(planner); }
    bool is_concurrent(const PolygonCore&) const { return false; }
    bool find(const PolygonCore& core, Point start, Point goal, Trace* trace);
};

// The nodes of the visibility graph and its edges as pairs of them, each once.
std::pair<Table<Point>, Table<std::int32_t>> list_visibility_graph(const PolygonCore& core);
// The corners of the exact cells, four in a row: lower left, lower right, upper right, upper left; the doors
// as pairs of cells.
std::pair<Table<Point>, Table<std::int32_t>> list_exact_cells(const PolygonCore& core);

// Approximate cells: depth, most_depth, refine, uniform, manhattan, most_cells.
using QuadtreeSettings = std::array<std::int64_t, 6>;
struct QuadtreeQuery : Query<PolygonCore, CellRoute> {
    QuadtreeSettings numbers;

    auto settings() { return std::tie(numbers); }
    bool find(const PolygonCore& core, Point start, Point goal, Trace* trace);
    auto evidence() const { return std::optional(std::tuple_cat(found.leaves, std::tuple(found.depth))); }
};
// The leaves as squares (least x and y, largest x and y), and their kinds.
std::pair<Table<double>, Table<std::int8_t>> list_cell_leaves(const PolygonCore& core,
                                                              const QuadtreeSettings& settings);

// Planners that draw points from free space.
struct SampleQuery : Query<PolygonCore, SampledRoute> {
    enum Planner { prm, rrt, rrt_star };
    std::int64_t planner, samples;
    std::uint64_t seed;
    std::int64_t neighbours;  // of a node of a roadmap
    double step, goal_bias;   // of a tree

    auto settings() { return std::tie(planner, samples, seed, neighbours, step, goal_bias); }
    bool find(const PolygonCore& core, Point start, Point goal, Trace* trace);
    auto evidence() const {
        return std::optional(std::tuple(found.samples, found.route.stats.nodes, found.route.stats.edges));
    }
};

// Along the Voronoi diagram. tolerance: how far a chord may lie from its arc [m].
struct VoronoiQuery : Query<PolygonCore, DiagramRoute> {
    bool is_widest;
    double tolerance;

    auto settings() { return std::tie(is_widest, tolerance); }
    bool find(const PolygonCore& core, Point start, Point goal, Trace* trace);
    auto evidence() const {
        const auto& [route, clearance, on_diagram, at_start, at_goal] = found;
        const bool is_found = route.status == Status::found;
        const std::tuple distances(clearance, on_diagram, at_start, at_goal);
        return is_found ? std::optional(distances) : std::nullopt;
    }
};
// Vertices and their clearance [m]; for each arc its two vertices, and its points and their clearance [m];
// whether no component of free space lacks a part.
using VoronoiArc = std::pair<Table<Point>, Table<double>>;
std::tuple<Table<Point>, Table<double>, Table<std::int32_t>, std::vector<VoronoiArc>, bool> list_voronoi_arcs(
    const PolygonCore& core, double tolerance);

}  // namespace cspace::navigation
