// The Voronoi diagram of free space, which a world keeps once it is made: what the bindings call.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::navigation {

using maps::PolygonCore;

struct VoronoiFinding {
    Route route;
    double clearance = 0;   // least distance from walls on the whole way [m]
    double on_diagram = 0;  // and on the diagram
    double at_start = 0, at_goal = 0;
};

// tolerance: how far a chord may lie from its arc [m]. False where an end lies in an obstacle.
bool find_voronoi_route(const PolygonCore& core, Point start, Point goal, bool widest, double tolerance,
                        VoronoiFinding& finding, Trace* trace);

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
