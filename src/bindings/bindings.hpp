#pragma once
#include <nanobind/nanobind.h>

void bind_approximate_cells(nanobind::module_& m);
void bind_cars(nanobind::module_& m);
void bind_coverage(nanobind::module_& m);
void bind_brushfire(nanobind::module_& m);
void bind_potential(nanobind::module_& m);
void bind_harmonic(nanobind::module_& m);
void bind_navigation_function(nanobind::module_& m);
void bind_grid_fields(nanobind::module_& m);
void bind_bugs(nanobind::module_& m);
void bind_curves(nanobind::module_& m);
void bind_curves_quick(nanobind::module_& m);
void bind_following(nanobind::module_& m);
void bind_math(nanobind::module_& m);
void bind_robot(nanobind::module_& m);
void bind_rotations(nanobind::module_& m);
void bind_subproblems(nanobind::module_& m);
void bind_ik(nanobind::module_& m);
void bind_ik_description(nanobind::module_& m);
void bind_ik_numeric(nanobind::module_& m);
void bind_ik_redundant(nanobind::module_& m);
void bind_ik_swivel(nanobind::module_& m);
void bind_ik_tasks(nanobind::module_& m);
void bind_ik_tracking(nanobind::module_& m);
void bind_route(nanobind::module_& m);
void bind_grid(nanobind::module_& m);
void bind_grid_any_angle(nanobind::module_& m);
void bind_polygon_routes(nanobind::module_& m);
void bind_voronoi(nanobind::module_& m);
void bind_voronoi_bug(nanobind::module_& m);
void bind_sampling(nanobind::module_& m);
void bind_polygon_world(nanobind::module_& m);
void bind_grid_replanning(nanobind::module_& m);
