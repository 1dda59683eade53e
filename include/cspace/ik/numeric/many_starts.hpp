// Multi-start descent to one goal: a sample of its solutions, not necessarily complete.
#pragma once

#include "cspace/ik/numeric/descent.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// One descent per start. T: T_base_tip (4, 4). starts, q (count, chain.n). residual (count,): the larger of
// the remaining position error [m] and angle [rad]. Starts that reach the goal end at rounding, others at a
// local minimum. Nothing is wrapped or compared. The result q of a start does not depend on the other starts.
template <class V>
void descend_from_starts(const Chain& chain, const double* T, const double* starts, std::size_t count,
                         double* q, double* residual) {
    const Path path = path_of(chain);
    const Task task;
    constexpr std::size_t part = 64;
    double cost[part], position[part], rotation[part];
    std::int32_t steps[part];
    Ending ending[part];
    for (std::size_t first = 0; first < count; first += part) {
        const std::size_t n = count - first < part ? count - first : part;
        const std::size_t offset = first * std::size_t(chain.n);
        for (std::size_t k = 0; k < n; ++k) ending[k] = Ending::unknown;
        run_descents<V>({&path, &task, T, 0, starts + offset, std::size_t(chain.n), nullptr, n, false,
                         q + offset, cost, position, rotation, steps, ending});
        for (std::size_t k = 0; k < n; ++k) residual[first + k] = max(position[k], rotation[k]);
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
