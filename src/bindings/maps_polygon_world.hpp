// The compiled half of cspace.maps.PolygonWorld, and how planners' bindings reach it.
#pragma once

#include <memory>

#include "bindings.hpp"
#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/any_angle/polyanya.hpp"
#include "cspace/navigation/bugs/surroundings.hpp"
#include "cspace/navigation/bugs/walls.hpp"
#include "cspace/navigation/cells/cell_stage.hpp"
#include "cspace/navigation/cells/exact_cells.hpp"
#include "cspace/navigation/sampling/prm.hpp"
#include "cspace/navigation/visibility/search.hpp"
#include "cspace/navigation/voronoi/roadmap.hpp"

struct PolygonCore {
    explicit PolygonCore(cspace::maps::Outlines outlines) : world(std::move(outlines)) {}

    cspace::maps::PolygonWorld world;
    double tolerance = 0;  // how deep in an obstacle rounding may have put a point that lies on a wall [m]
    // Made when first asked; used with the GIL held.
    std::unique_ptr<cspace::navigation::Walls> felt;           // what robots touch
    std::unique_ptr<cspace::navigation::Surroundings> sensed;  // what robots see that keep away from it
    std::unique_ptr<cspace::navigation::Polyanya> shortest;
    std::unique_ptr<cspace::navigation::VisibilitySearch> visibility;
    std::unique_ptr<cspace::navigation::ExactCells> cells;
    std::unique_ptr<cspace::navigation::voronoi::Roadmap> voronoi;
    // The last of each kind, which options shape; threads may ask for them at once.
    cspace::navigation::CellStages quadtree;
    cspace::navigation::sampling::KeptRoadmap roadmap;
};

// The core behind a Python object; null for other objects.
inline PolygonCore* polygon_core_of(PyObject* value) {
    return nanobind::isinstance<PolygonCore>(value) ? nanobind::inst_ptr<PolygonCore>(value) : nullptr;
}
