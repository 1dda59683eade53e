// Everything that inverse kinematics keeps of one arm: its screws at zero, its limits, and the plans that are
// built when first needed. Several threads may ask one solver at once.
#pragma once

#include <atomic>
#include <limits>
#include <memory>
#include <mutex>

#include "ik_arm.hpp"
#include "ik_redundancy.hpp"

namespace cspace::ik {

class Solver {
  public:
    // Limits and weights of distances per joint; the weight of a joint that only stands for a freedom of the
    // goal is 0. reach: no pose farther from the base is met [m].
    Solver(const Chain& chain, const double* lower, const double* upper, const double* weight,
           double reach = std::numeric_limits<double>::infinity());

    const Chain& chain() const { return chain_; }
    const double* lower() const { return lower_; }
    const double* upper() const { return upper_; }

    // Whether joint j stands for the distance to a point that the tool looks at.
    bool leads_ahead(int j) const { return ik::leads_ahead(chain_, weight_, lower_, j); }

    // Where a goal leaves finitely many configurations, but for singular ones, it is solved by arm(); else
    // joints are locked by redundant().
    const BuiltArm& arm() {
        const BuiltArm* built = arm_.load(std::memory_order_acquire);
        return built ? *built : build();
    }
    bool is_redundant() { return arm().room == 0; }
    RedundantSolver& redundant();

    // Whether the lengths and directions of the axes alone rule the goal out.
    bool exceeds_reach(const double* goal);

  private:
    const BuiltArm& build();

    Chain chain_;
    double lower_[max_joints], upper_[max_joints], weight_[max_joints], reach_;
    std::mutex mutex_;
    BuiltArm built_;
    std::atomic<const BuiltArm*> arm_ = nullptr;  // once it is built
    std::once_flag redundant_once_;
    std::unique_ptr<RedundantSolver> redundant_;
};

}  // namespace cspace::ik
