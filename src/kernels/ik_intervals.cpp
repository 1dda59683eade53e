#include "cspace/ik/redundancy/arcs.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template void intervals_by_arcs(const Redundant&, const LockedArm&, int, const LimitArms&, const Posed&,
                                Trail&, Intervals&);

void ik_make_limit_arms(const Redundant& arm, LimitArms& out) { make_limit_arms(arm, out); }

void ik_intervals(const Redundant& arm, const LockedArm& locked, int parameter, const LimitArms& arms,
                  const Posed& goal, Trail& trail, Intervals& out) {
    const bool by_default = &locked == &arm.locked;
    if (by_default && intervals_by_cells(arm, arms, goal, out)) return;
    intervals_by_arcs(arm, locked, parameter, arms, goal, trail, out);
}

}  // namespace cspace::ik::inline CSPACE_ISA
