// The table of contents of the compiled half: one function per room, each in the file of that name.
#include <nanobind/nanobind.h>

#include "bindings.hpp"
#include "cspace/version.hpp"
#include "kernels/dispatch.hpp"

NB_MODULE(_core, m) {
    m.doc() = "The compiled core of cspace; use it through the package.";
    m.attr("__version__") = CSPACE_VERSION;
    m.attr("isa") = cspace::kernels::isa_name();
    bind_math(m);
    bind_navigation_curves(m);
    bind_navigation_curves_fast(m);
    bind_kinematics(m);
    bind_spatial_rotations(m);
    bind_ik_subproblems(m);
    bind_ik_solver(m);
    bind_robot(m);
    bind_ik(m);
    bind_ik_goals(m);
    bind_ik_numeric(m);
    bind_ik_redundancy(m);
    bind_ik_arm_angle(m);
    bind_ik_tasks(m);
    bind_ik_tracking(m);
    bind_ik_description(m);
    bind_navigation_route(m);
    bind_navigation_grid(m);
    bind_navigation_any_angle(m);
    bind_navigation_coverage(m);
    bind_navigation_cars(m);
    bind_navigation_following(m);
    bind_navigation_fields_brushfire(m);
    bind_navigation_polygons(m);
    bind_navigation_cells(m);
    bind_navigation_bugs(m);
    bind_navigation_fields_grid(m);
    bind_navigation_fields_potential(m);
    bind_navigation_fields_harmonic(m);
    bind_navigation_fields_function(m);
    bind_navigation_voronoi(m);
    bind_navigation_sampling(m);
    bind_maps_polygon_world(m);
    bind_navigation_grid_replanning(m);
}
