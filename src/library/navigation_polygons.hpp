// The planners that are shown a polygon world: what the bindings call. A world keeps what its planners have
// made. Questions to any angle, visibility and exact cells of one world may not be asked by two threads at a
// time. A search returns false where an end lies in an obstacle, and writes its events into a trace that is
// not null.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::navigation {

using maps::PolygonCore;

enum class PolygonPlanner { any_angle, visibility, exact_cells };
bool find_polygon_route(const PolygonCore& core, PolygonPlanner planner, Point start, Point goal,
                        Route& route, Trace* trace);

// The nodes of the visibility graph and its edges as pairs of them, each once.
void list_visibility_graph(const PolygonCore& core, std::vector<Point>& nodes,
                           std::vector<std::int32_t>& edges);
// The corners of the exact cells, four each: lower left, lower right, upper right, upper left; the doors as
// pairs of cells.
void list_exact_cells(const PolygonCore& core, std::vector<Point>& corners, std::vector<std::int32_t>& doors);

// Approximate cells. settings: depth, most_depth, refine, uniform, manhattan, most_cells.
bool find_cell_route(const PolygonCore& core, Point start, Point goal, const std::int64_t* settings,
                     CellRoute& found, Trace* trace);
// The leaves as squares (least x and y, largest x and y), and their kinds.
void list_cell_leaves(const PolygonCore& core, const std::int64_t* settings, std::vector<double>& squares,
                      std::vector<std::int8_t>& kinds);

// Planners that draw points from free space.
struct SamplingSettings {
    enum Planner { prm, rrt, rrt_star };
    int planner = prm;
    long long samples = 0;
    unsigned long long seed = 0;
    long long neighbours = 0;        // of a node of a roadmap
    double step = 1, goal_bias = 0;  // of a tree
};
bool find_sampled_route(const PolygonCore& core, const SamplingSettings& settings, Point start, Point goal,
                        SampledRoute& found, Trace* trace);

// Along the Voronoi diagram. tolerance: how far a chord may lie from its arc [m].
bool find_voronoi_route(const PolygonCore& core, Point start, Point goal, bool widest, double tolerance,
                        DiagramRoute& found, Trace* trace);
struct VoronoiArc {
    std::int32_t from, to;  // vertices
    std::vector<Point> line;
    std::vector<double> clearance;  // of its points [m]
};
struct VoronoiArcs {
    std::vector<Point> vertices;
    std::vector<double> clearance;  // of the vertices [m]
    std::vector<VoronoiArc> arcs;
    bool is_whole = true;  // in every component of free space
};
VoronoiArcs list_voronoi_arcs(const PolygonCore& core, double tolerance);

}  // namespace cspace::navigation
