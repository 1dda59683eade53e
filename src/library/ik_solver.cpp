#include "ik_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cspace::ik {

Solver::Solver(const Chain& chain, const double* lower, const double* upper, const double* weight,
               double reach)
    : chain_(chain), reach_(reach) {
    std::copy(lower, lower + chain.n, lower_);
    std::copy(upper, upper + chain.n, upper_);
    std::copy(weight, weight + chain.n, weight_);
}

const BuiltArm& Solver::build() {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (!arm_) {
        built_ = build_arm(chain_);
        arm_.store(&built_, std::memory_order_release);
    }
    return built_;
}

RedundantSolver& Solver::redundant() {
    std::call_once(redundant_once_, [this] {
        redundant_ = std::make_unique<RedundantSolver>(chain_, lower_, upper_, weight_);
    });
    return *redundant_;
}

bool Solver::exceeds_reach(const double* goal) {
    return std::hypot(goal[3], goal[7], goal[11]) > reach_ || is_ruled_out(arm(), goal);
}

}  // namespace cspace::ik
