#include "cspace/ik/redundancy/nearest_search.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

bool ik_nearest(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    return nearest_configuration(arm, goal, seed, q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
