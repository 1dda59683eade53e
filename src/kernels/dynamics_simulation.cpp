#include "dynamics_simulation.hpp"

#include "cspace/dynamics/roll_out.hpp"
#include "kinematics_memory.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {
namespace {

using kinematics::Scratch;
using kinematics::take_array;

template <class V>
RollOutMemory<V> make_memory(const RollOut& task, void* bytes) {
    Scratch scratch{static_cast<char*>(bytes)};
    const int n = task.mechanics.bodies.n_coordinates, dof = task.mechanics.dof();
    const int links = task.mechanics.bodies.n_links;
    const auto take = [&](int count) { return take_array<V>(scratch, count); };
    const Pose<V> T = fill_pose<V>(identity_pose());
    const auto take_state = [&] { return State<V>{take(n), take(dof), T}; };
    RollOutMemory<V> memory;
    memory.state = take_state();
    memory.after = take_state();
    memory.tau = take(dof);
    memory.fresh = take(dof);
    memory.control = take(5 * n);
    // The axes of a chain take its sines and six numbers per joint.
    memory.work = {take(80 * links + 8 * (links + 8)),
                   take(dof * dof),
                   take(dof * dof),
                   take(6 * task.mechanics.n_wrenches),
                   take(dof),
                   take(dof),
                   {},
                   {}};
    memory.stages = {take(15 * dof), take(7 * dof), take(dof), take(dof), take_state()};
    memory.variational = {take(dof), take(dof),       take(dof), take(dof),   take(dof),
                          take(dof), take(dof * dof), take(dof), take_state()};
    for (int j = 0; j < dof; ++j) memory.variational.zero[j] = fill_lanes<V>(0.0);
    if (task.mechanics.loops) memory.work.loops = make_loop_memory(*task.mechanics.loops, scratch.next);
    return memory;
}

// f(memory, i, count) for packs as wide as the registers; one row alone is computed without lanes.
template <class F>
void over_packs_of(const RollOut& task, std::size_t begin, std::size_t end, void* scratch, const F& f) {
    if (end - begin == 1) {
        auto memory = make_memory<double>(task, scratch);
        f(memory, begin, 1);
        return;
    }
    auto memory = make_memory<Pack<native_width>>(task, scratch);
    over_packs<native_width>(end - begin, [&](std::size_t i, int count) { f(memory, begin + i, count); });
}

}  // namespace

void roll_out_fixed(const RollOut& task, std::size_t begin, std::size_t end, long long k, long long k_end,
                    void* scratch) {
    over_packs_of(task, begin, end, scratch, [&](auto& memory, std::size_t i, int count) {
        roll_fixed_steps(task, i, count, k, k_end, memory);
    });
}

bool roll_out_adaptive(const RollOut& task, std::size_t begin, std::size_t end, long long k, long long k_end,
                       bool is_fresh, PieceBuffer& pieces, void* scratch) {
    bool is_done = true;
    over_packs_of(task, begin, end, scratch, [&](auto& memory, std::size_t i, int count) {
        is_done &= roll_adaptive_steps(task, begin, i, count, k, k_end, is_fresh, pieces, memory);
    });
    return is_done;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
