// All of cspace: one header for programs that would rather not choose. It lists the headers
// that no other one includes; every other header comes with them.
//
// Each room is a namespace: cspace::model, cspace::spatial, cspace::shapes, cspace::kinematics,
// cspace::collision, cspace::ik, cspace::search, cspace::maps and cspace::navigation. The mathematics that
// every room uses, its vectors, packs of lanes, polynomials and linear algebra, stands in cspace itself; the
// thresholds stand in cspace::tolerance. Inside each namespace an inline one is named after the instruction
// set (cspace/math/isa.hpp).
#pragma once

#include "cspace/collision/edge.hpp"
#include "cspace/collision/rows.hpp"
#include "cspace/ik/numeric/resolved_rate.hpp"
#include "cspace/ik/numeric/search.hpp"
#include "cspace/ik/numeric/tasks.hpp"
#include "cspace/ik/redundancy/arm_angle.hpp"
#include "cspace/ik/redundancy/nearest_search.hpp"
#include "cspace/ik/subproblems/sp2.hpp"
#include "cspace/ik/subproblems/sp3.hpp"
#include "cspace/ik/subproblems/sp5.hpp"
#include "cspace/ik/subproblems/sp6.hpp"
#include "cspace/ik/tracking/follow.hpp"
#include "cspace/maps/grid_outlines.hpp"
#include "cspace/maps/path_clearance.hpp"
#include "cspace/maps/rasterize.hpp"
#include "cspace/math/stream.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/navigation/any_angle/grid_any_angle.hpp"
#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "cspace/navigation/cars/hybrid_a_star.hpp"
#include "cspace/navigation/cells/approximate_cells.hpp"
#include "cspace/navigation/cells/exact_cells.hpp"
#include "cspace/navigation/coverage/cover.hpp"
#include "cspace/navigation/fields/brushfire.hpp"
#include "cspace/navigation/fields/descent.hpp"
#include "cspace/navigation/fields/fast_marching.hpp"
#include "cspace/navigation/fields/harmonic.hpp"
#include "cspace/navigation/fields/navigation_function.hpp"
#include "cspace/navigation/fields/potential_search.hpp"
#include "cspace/navigation/following/dynamic_window.hpp"
#include "cspace/navigation/following/follow.hpp"
#include "cspace/navigation/grid/d_star_lite.hpp"
#include "cspace/navigation/sampling/prm.hpp"
#include "cspace/navigation/sampling/rrt.hpp"
#include "cspace/navigation/visibility/search.hpp"
#include "cspace/navigation/voronoi/roadmap.hpp"
#include "cspace/shapes/cover.hpp"
#include "cspace/shapes/distance.hpp"
#include "cspace/version.hpp"
