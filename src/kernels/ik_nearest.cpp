#include "cspace/ik/redundant/nearest_search.hpp"
#include "ik_redundant.hpp"
#include "once.hpp"

namespace cspace::inline CSPACE_ISA {

bool ik_nearest(const ik::Redundant& arm, const Posed& goal, const double* seed, double* q) {
    return nearest_configuration(arm, goal, seed, q);
}

}  // namespace cspace::inline CSPACE_ISA
