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

// planner: 0 any angle, 1 visibility, 2 exact cells
bool plan_in_polygons(const Query<PolygonCore>& query, Route& route, std::int64_t planner);

// The nodes of the visibility graph and its edges as pairs of them, each once.
std::pair<Table<Point>, Table<std::int32_t>> list_visibility_graph(const PolygonCore& core);
// The corners of the exact cells, four in a row: lower left, lower right, upper right, upper left; the doors
// as pairs of cells.
std::pair<Table<Point>, Table<std::int32_t>> list_exact_cells(const PolygonCore& core);

// Approximate cells: depth, most_depth, refine, uniform, manhattan, most_cells.
using QuadtreeSettings = std::array<std::int64_t, 6>;
// The numbers of free, mixed and full leaves, and the depth of the deepest.
bool plan_quadtree(const Query<PolygonCore>& query,
                   Answer<std::int64_t, std::int64_t, std::int64_t, int>& answer,
                   const QuadtreeSettings& settings);
// The leaves as squares (least x and y, largest x and y), and their kinds.
std::pair<Table<double>, Table<std::int8_t>> list_cell_leaves(const PolygonCore& core,
                                                              const QuadtreeSettings& settings);

// Planners that draw points from free space: 0 PRM, 1 RRT, 2 RRT*. neighbours: of a node of a roadmap. step,
// goal_bias: of a tree. Returns the numbers of points drawn, nodes and edges.
bool plan_samples(const Query<PolygonCore>& query, Answer<std::int64_t, std::int64_t, std::int64_t>& answer,
                  std::int64_t planner, std::int64_t samples, std::uint64_t seed, std::int64_t neighbours,
                  double step, double goal_bias);

// Along the Voronoi diagram. tolerance: how far a chord may lie from its arc [m]. Least distances from walls:
// on the whole way, on the diagram, and on the ways to and from it [m].
bool plan_voronoi(const Query<PolygonCore>& query, Answer<double, double, double, double>& answer,
                  bool is_widest, double tolerance);
// Vertices and their clearance [m]; for each arc its two vertices, and its points and their clearance [m];
// whether no component of free space lacks a part.
using VoronoiArc = std::pair<Table<Point>, Table<double>>;
std::tuple<Table<Point>, Table<double>, Table<std::int32_t>, std::vector<VoronoiArc>, bool> list_voronoi_arcs(
    const PolygonCore& core, double tolerance);

}  // namespace cspace::navigation
