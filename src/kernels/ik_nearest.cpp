#include "cspace/ik/redundancy/nearest_search.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// In ik_intervals.cpp.
extern template void intervals_by_arcs(const Redundant&, const LockedArm&, int, const LimitArms&,
                                       const Posed&, Trail&, Intervals&);

bool ik_nearest(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    return nearest_configuration(arm, goal, seed, q);
}
bool ik_nearest_proven(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    return nearest_proven(arm, goal, seed, q);
}
bool ik_nearest_within(const Redundant& arm, const LimitArms* arms, const Posed& goal, const double* seed,
                       Trail* trail, double* q) {
    return nearest_within_limits(arm, arms, goal, seed, trail, q);
}
bool ik_nearest_from(const Redundant& arm, const Posed& goal, const double* seed, const double* start,
                     double* q) {
    return nearest_from(arm, goal, seed, start, q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
