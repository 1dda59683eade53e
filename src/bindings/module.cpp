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
    bind_curves(m);
    bind_curves_quick(m);
    bind_robot(m);
    bind_rotations(m);
    bind_subproblems(m);
    bind_ik(m);
    bind_ik_numeric(m);
    bind_ik_redundant(m);
    bind_ik_swivel(m);
    bind_ik_tasks(m);
    bind_ik_tracking(m);
    bind_ik_description(m);
    bind_route(m);
    bind_grid(m);
    bind_grid_any_angle(m);
    bind_coverage(m);
    bind_cars(m);
    bind_following(m);
    bind_brushfire(m);
    bind_polygon_routes(m);
    bind_approximate_cells(m);
    bind_bugs(m);
    bind_grid_fields(m);
    bind_potential(m);
    bind_harmonic(m);
    bind_navigation_function(m);
    bind_voronoi(m);
    bind_voronoi_bug(m);
    bind_sampling(m);
    bind_polygon_world(m);
    bind_grid_replanning(m);
}
