#include "ik_redundant.hpp"

namespace cspace::inline CSPACE_ISA {

bool redundant_nearest(const ik::Redundant& arm, const Posed& goal, const double* seed, double* q) {
    return nearest_configuration(arm, goal, seed, q);
}

void redundant_intervals(const ik::Redundant& arm, const ik::LockedArm& locked, int parameter,
                         const ik::LimitArms& arms, const Posed& goal, Trail& trail, ik::Intervals& out) {
    const bool by_default = &locked == &arm.locked;
    if (by_default && intervals_by_cells(arm, arms, goal, out)) return;
    intervals_by_arcs(arm, locked, parameter, arms, goal, trail, out);
}

void redundant_sweep(const ik::LockedArm& locked, int parameter, const Posed& goal, const double* at,
                     const double* values, int n, SweptRows* rows) {
    const Sweep sweep = make_sweep(locked, parameter, goal, at);
    sweep_values(sweep, values, n, [&](int k, const SweptRows& found) { rows[k] = found; });
}

void redundant_locked(const ik::LockedArm& locked, const Posed& goal, const double* at, const double* idle,
                      ik::Solutions& out) {
    out = solve_locked(locked, goal, at, idle);
}

}  // namespace cspace::inline CSPACE_ISA
