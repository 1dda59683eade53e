// Descents from many starts to one goal: a sample of its solutions, which may lack some.
#pragma once

#include "cspace/ik/numeric/descent.hpp"

namespace cspace::inline CSPACE_ISA {

// One descent per start. T: T_base_tip (4, 4). starts, q (count, chain.n); residual (count,) is the larger of
// position error [m] and angle [rad] that is left. Starts that reach the goal are left at rounding, others
// at a local minimum; nothing is wrapped or compared. The same start gives the same q in any company.
template <class V>
void descend_from_starts(const ik::Chain& chain, const double* T, const double* starts, std::size_t count,
                         double* q, double* residual) {
    const ik::Path path = path_of(chain);
    const ik::Task task;
    constexpr std::size_t part = 64;
    double cost[part], position[part], rotation[part];
    std::int32_t steps[part];
    ik::Ending ending[part];
    for (std::size_t first = 0; first < count; first += part) {
        const std::size_t n = count - first < part ? count - first : part;
        const std::size_t offset = first * std::size_t(chain.n);
        for (std::size_t k = 0; k < n; ++k) ending[k] = ik::Ending::unknown;
        run_descents<V>({&path, &task, T, 0, starts + offset, std::size_t(chain.n), nullptr, n, false,
                         q + offset, cost, position, rotation, steps, ending});
        for (std::size_t k = 0; k < n; ++k) residual[first + k] = max(position[k], rotation[k]);
    }
}

}  // namespace cspace::inline CSPACE_ISA
