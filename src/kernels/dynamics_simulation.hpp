// Roll-outs of some rows over some steps.
#pragma once

#include <cstddef>

#include "cspace/dynamics/loop_memory.hpp"
#include "cspace/dynamics/roll_out_task.hpp"
#include "dispatch.hpp"

namespace cspace::dynamics {

// Rows of a part, and bytes of scratch memory, aligned to 64, that one thread needs.
inline constexpr std::size_t part_rows = 8;
inline std::size_t scratch_bytes(const RollOut& task) {
    const std::size_t n = std::size_t(task.mechanics.bodies.n_links), dof = std::size_t(task.mechanics.dof());
    const std::size_t joints = std::size_t(task.mechanics.bodies.n_coordinates);
    const std::size_t wrenches = std::size_t(task.mechanics.n_wrenches);
    const std::size_t loops = task.mechanics.loops ? loop_memory_bytes(*task.mechanics.loops) + 64 : 0;
    return loops +
           8 * part_rows * (80 * n + 8 * (n + 8) + dof * (3 * dof + 44) + 14 * joints + 6 * wrenches + 64);
}

}  // namespace cspace::dynamics

// Rows begin to end, at most part_rows of them, from step k to step k_end. With k_end = steps + 1 the state
// at the end is looked at too.
CSPACE_KERNEL(cspace::dynamics, void, roll_out_fixed,
              (const RollOut& task, std::size_t begin, std::size_t end, long long k, long long k_end,
               void* scratch))
// The same by the adaptive method. is_fresh: the first call for these steps. True if all rows have come to
// their end.
CSPACE_KERNEL(cspace::dynamics, bool, roll_out_adaptive,
              (const RollOut& task, std::size_t begin, std::size_t end, long long k, long long k_end,
               bool is_fresh, PieceBuffer& pieces, void* scratch))
