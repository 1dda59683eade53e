#include "ik_near_rows.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "cspace/ik/goal.hpp"
#include "cspace/math/threads.hpp"

namespace cspace::ik {

NearRows sort_rows_near(const Chain& chain, std::span<const double> q, const NearSeed& near, double close) {
    const std::size_t n = std::size_t(chain.n);
    NearRows sorted;
    std::vector<double> turned(q.begin(), q.end());
    std::vector<std::pair<double, std::size_t>> order;  // squared distance and row
    for (std::size_t k = 0; k < turned.size() / n; ++k) {
        double* const row = &turned[k * n];
        if (!std::isfinite(row[0])) continue;
        const double excess = turn_to_seed(chain.prismatic, chain.n, near.lower, near.upper, near.seed, row);
        sorted.is_doubtful |= excess > 0 && excess <= close;
        if (excess > 0) continue;
        double square = 0;
        for (std::size_t i = 0; i < n; ++i) square += (row[i] - near.seed[i]) * (row[i] - near.seed[i]);
        order.emplace_back(square, k);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [square, k] : order) sorted.q.insert(sorted.q.end(), &turned[k * n], &turned[k * n] + n);
    return sorted;
}

std::optional<NearRows> solve_locked_near(Solver& solver, const double* goal, std::span<const double> values,
                                          const NearSeed& near) {
    if (!read_goal(goal).is_pose) return std::nullopt;
    const RedundantSolver& arm = solver.redundant();
    const std::vector<int> joints = arm.default_locked();
    const std::size_t n = std::size_t(solver.chain().n), width = joints.size(), count = values.size() / width;
    const std::size_t room = std::size_t(arm.room_for(joints));
    std::vector<double> goals(count * 16), at(count * n), q(count * room * n);
    std::vector<std::int8_t> branch(count * room);
    const auto self_motion = std::make_unique<bool[]>(count * room);
    std::vector<std::int64_t> found(count);
    std::vector<std::uint8_t> status(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(goal, 16, &goals[i * 16]);
        for (std::size_t k = 0; k < width; ++k) at[i * n + std::size_t(joints[k])] = values[i * width + k];
    }
    arm.solve(arm.lock(joints), {goals.data(), count, at.data(), true, nullptr, room, q.data(), branch.data(),
                                 self_motion.get(), found.data(), status.data(), 1});
    return sort_rows_near(solver.chain(), q, near, 0);
}

std::vector<std::optional<NearRows>> solve_each_locked_near(Solver& solver, std::span<const double> goals,
                                                            std::span<const double> values,
                                                            const double* lower, const double* upper,
                                                            std::span<const double> seeds, int threads) {
    const std::size_t n = std::size_t(solver.chain().n);
    std::vector<std::optional<NearRows>> found(goals.size() / 16);
    over_rows(found.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (; begin < end; ++begin) {
            poll_interrupts();
            const NearSeed near = {lower, upper, &seeds[begin * n]};
            found[begin] = solve_locked_near(solver, &goals[begin * 16], values, near);
        }
        return true;
    });
    return found;
}

}  // namespace cspace::ik
