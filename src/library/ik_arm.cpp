#include "ik_arm.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "cspace/ik/arm.hpp"
#include "cspace/ik/goal.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "kernels/ik.hpp"

namespace cspace::ik {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t rows_worth_a_thread = 256;

// Solutions into one goal's rows, NaN behind them.
void write_rows(const SolutionRows& found, int room, int dof, double* q, std::int64_t* count,
                unsigned char* status) {
    std::fill(q, q + room * dof, none);
    *count = std::min(found.count, room);
    found.copy_rows(int(*count), dof, q);
    *status = static_cast<unsigned char>(int(found.status) + (found.complete ? 0 : incomplete));
}

// The closed form over a slice, then the slow path where it is in doubt. Returns the first goal refused, or
// the end.
std::size_t solve_slice(const BuiltArm& built, const GoalRows& rows, std::size_t from, std::size_t to) {
    const Arm& arm = *built.arm;
    const bool has_kernel = arm.has_plan && arm.plan.on_lanes && arm.plan.virtual_joints == 0;
    const std::size_t row = std::size_t(built.room * built.dof);
    auto* quick = reinterpret_cast<FastPath*>(rows.status);
    if (has_kernel)
        kernels::ik_many(arm, rows.goals + 16 * from, to - from, rows.n, built.room, rows.q + row * from,
                         rows.count + from, quick + from);
    SolutionStore store;
    SolutionRows found;
    for (std::size_t i = from; i < to; ++i) {
        if (has_kernel && quick[i] == FastPath::settled) {
            rows.status[i] = static_cast<unsigned char>(rows.count[i] ? Status::exact : Status::unreachable);
            continue;
        }
        poll_interrupts();
        if (!list_solutions(built, rows.goals + 16 * i, nullptr, store, found)) return i;
        write_rows(found, built.room, built.dof, rows.q + row * i, rows.count + i, rows.status + i);
    }
    return to;
}

std::size_t solve_point_slice(const BuiltArm& built, const GoalRows& rows, std::size_t from, std::size_t to) {
    const std::size_t row = std::size_t(built.room * built.dof);
    for (std::size_t i = from; i < to; ++i) {
        const double* p = rows.goals + 3 * i;
        if (!(std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]) <= tolerance::farthest)) return i;
        const Solutions found = solve_point(built, {p[0], p[1], p[2]});
        write_rows(rows_of(found), built.room, built.dof, rows.q + row * i, rows.count + i, rows.status + i);
    }
    return to;
}

// All goals, on threads. Returns the first goal refused, or their number.
template <class Slice>
std::size_t solve_on_threads(const BuiltArm& built, const GoalRows& rows, Slice solve_slice) {
    std::atomic<std::size_t> refused = rows.n;
    over_rows(rows.n, rows.threads, 1, rows_worth_a_thread, [&](std::size_t from, std::size_t to) {
        const std::size_t stopped = solve_slice(built, rows, from, to);
        if (stopped == to) return true;
        std::size_t first = refused;
        while (stopped < first && !refused.compare_exchange_weak(first, stopped)) {
        }
        return false;
    });
    return refused;
}

}  // namespace

BuiltArm build_arm(const Chain& chain) {
    auto arm = std::make_shared<Arm>();
    kernels::ik_make_arm(chain, *arm);
    const bool solvable = arm->has_plan || arm->has_few_joints || arm->is_general;
    return {arm, chain.n, solvable ? room_for(*arm) : 0, arm->has_few_joints,
            std::make_shared<ReachBounds>(measure_reach(chain, arm->plan.form.length))};
}

void SolutionRows::copy_rows(int first, int dof, double* to) const {
    if (stride == dof) {
        std::copy_n(q, first * dof, to);
        return;
    }
    for (int k = 0; k < first; ++k) std::copy_n(q + stride * k, dof, to + k * dof);
}

bool list_solutions(const BuiltArm& built, const double* goal, const double* unconstrained,
                    SolutionStore& store, SolutionRows& rows) {
    int count;
    const FastPath quick = kernels::ik_one(*built.arm, goal, store.q, store.branch, &count);
    if (quick == FastPath::doubtful) {
        kernels::ik_pose(*built.arm, read_goal(goal).T, unconstrained, store.found);
        rows = rows_of(store.found);
    } else if (quick == FastPath::settled) {
        rows = {count, store.q, 6, store.branch, nullptr, count ? Status::exact : Status::unreachable};
    }
    return quick != FastPath::refused;
}

Solutions solve_point(const BuiltArm& built, const Vec3d& goal) {
    PositionSolutions found;
    kernels::ik_position(built.arm->plan.chain, goal, false, found);
    return found;
}

std::size_t solve_goals(const BuiltArm& built, const GoalRows& rows) {
    return solve_on_threads(built, rows, solve_slice);
}
std::size_t solve_points(const BuiltArm& built, const GoalRows& rows) {
    return solve_on_threads(built, rows, solve_point_slice);
}

NearestPose nearest_to_goal(const BuiltArm& built, const double* goal, double stiffness) {
    NearestPose best;
    kernels::ik_nearest_miss(*built.arm, read_goal(goal).T, stiffness, best);
    return best;
}

void nearest_to_goals(const BuiltArm& built, const double* goals, std::size_t n, double stiffness, double* q,
                      int threads) {
    over_rows(n, threads, 1, 1, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            poll_interrupts();
            const NearestPose best = nearest_to_goal(built, goals + 16 * i, stiffness);
            std::copy(best.q, best.q + built.dof, q + std::size_t(built.dof) * i);
        }
        return true;
    });
}

NearestPose nearest_to_point(const BuiltArm& built, const Vec3d& goal) {
    PositionSolutions found;
    kernels::ik_position(built.arm->plan.chain, goal, true, found);
    NearestPose out;
    out.position = found.out_of_reach;
    const double* best = found.count ? found.q[0] : found.nearest;
    std::copy(best, best + built.dof, out.q);
    return out;
}

bool is_ruled_out(const BuiltArm& built, const double* goal) {
    return exceeds_reach(built.arm->plan.chain, *built.reach, read_goal(goal).T);
}

double turn_to_seed(const bool* prismatic, int n, const double* lower, const double* upper,
                    const double* seed, double* q) {
    constexpr double turn = 2 * pi, on_limit = 1e-9;
    double excess = 0;
    for (int i = 0; i < n; ++i) {
        if (q[i] >= lower[i] && q[i] <= upper[i] && std::fabs(seed[i] - q[i]) < turn / 2) continue;
        const double wanted = count_turns(seed[i] - q[i]);
        const double turns =
            prismatic[i] ? 0
                         : turns_within(q[i], q[i], lower[i] - on_limit, upper[i] + on_limit, wanted, wanted);
        const double moved = q[i] + turn * turns, inside = std::fmin(std::fmax(moved, lower[i]), upper[i]);
        const double over = std::fabs(moved - inside);
        q[i] = over <= on_limit ? inside : moved;
        excess = std::fmax(excess, over);
    }
    return excess <= on_limit ? 0 : excess;
}

bool nearest_listed(const BuiltArm& built, const double* lower, const double* upper, const double* goal,
                    const double* seed, double* q, std::int8_t* branch) {
    constexpr double double_solution = 3e-7;  // [rad, m] DOUBLE_SOLUTION of cspace.tolerances
    const Chain& chain = built.arm->plan.chain;
    SolutionStore store;
    SolutionRows rows;
    if (!list_solutions(built, goal, seed, store, rows) || rows.status != Status::exact || !rows.complete)
        return false;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < rows.count; ++k) {
        double turned[max_joints], sum = 0;
        std::copy_n(rows.q + k * rows.stride, chain.n, turned);
        const double excess = turn_to_seed(chain.prismatic, chain.n, lower, upper, seed, turned);
        if (excess > double_solution) continue;
        for (int i = 0; i < chain.n; ++i) sum += (turned[i] - seed[i]) * (turned[i] - seed[i]);
        if (!(sum < least)) continue;
        if (excess > 0) return false;  // a double solution may stand on the limit
        least = sum;
        std::copy(turned, turned + chain.n, q);
        *branch = rows.branch[k];
    }
    return std::isfinite(least);
}

}  // namespace cspace::ik
