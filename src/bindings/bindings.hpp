#pragma once
#include <nanobind/nanobind.h>

void bind_navigation_cells(nanobind::module_& m);
void bind_navigation_cars(nanobind::module_& m);
void bind_navigation_coverage(nanobind::module_& m);
void bind_navigation_fields_brushfire(nanobind::module_& m);
void bind_navigation_fields_potential(nanobind::module_& m);
void bind_navigation_fields_harmonic(nanobind::module_& m);
void bind_navigation_fields_function(nanobind::module_& m);
void bind_navigation_fields_grid(nanobind::module_& m);
void bind_navigation_bugs(nanobind::module_& m);
void bind_navigation_curves(nanobind::module_& m);
void bind_navigation_curves_fast(nanobind::module_& m);
void bind_navigation_following(nanobind::module_& m);
void bind_math(nanobind::module_& m);
void bind_kinematics(nanobind::module_& m);
void bind_robot(nanobind::module_& m);
void bind_spatial_rotations(nanobind::module_& m);
void bind_ik_subproblems(nanobind::module_& m);
void bind_ik(nanobind::module_& m);
void bind_ik_solver(nanobind::module_& m);
void bind_ik_goals(nanobind::module_& m);
void bind_ik_description(nanobind::module_& m);
void bind_ik_numeric(nanobind::module_& m);
void bind_ik_redundancy(nanobind::module_& m);
void bind_ik_arm_angle(nanobind::module_& m);
void bind_ik_tasks(nanobind::module_& m);
void bind_ik_tracking(nanobind::module_& m);
void bind_navigation_route(nanobind::module_& m);
void bind_navigation_grid(nanobind::module_& m);
void bind_navigation_any_angle(nanobind::module_& m);
void bind_navigation_polygons(nanobind::module_& m);
void bind_navigation_voronoi(nanobind::module_& m);
void bind_navigation_sampling(nanobind::module_& m);
void bind_maps_polygon_world(nanobind::module_& m);
void bind_navigation_grid_replanning(nanobind::module_& m);
