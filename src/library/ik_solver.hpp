// Everything that inverse kinematics keeps of one arm: its screws at zero, its limits, and the plans that are
// built when first needed. Several threads may ask one solver at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "cspace/math/made_once.hpp"
#include "ik_arm.hpp"
#include "ik_redundancy.hpp"

namespace cspace::ik {

class Solver {
  public:
    // Limits and weights of distances per joint; the weight of a joint that only stands for a freedom of the
    // goal is 0. reach: no pose farther from the base is met [m].
    Solver(const Chain& chain, const double* lower, const double* upper, const double* weight, double reach)
        : chain_(chain), reach_(reach) {
        std::copy(lower, lower + chain.n, lower_);
        std::copy(upper, upper + chain.n, upper_);
        std::copy(weight, weight + chain.n, weight_);
    }

    const Chain& chain() const { return chain_; }
    const double* lower() const { return lower_; }
    const double* upper() const { return upper_; }

    // Whether joint j stands for the distance to a point that the tool looks at.
    bool leads_ahead(int j) const { return ik::leads_ahead(chain_, weight_, lower_, j); }

    // Where a goal leaves finitely many configurations, but for singular ones, it is solved by arm(); else
    // joints are locked by redundant().
    const BuiltArm& arm() {
        return arm_.get([this] { return std::make_unique<BuiltArm>(build_arm(chain_)); });
    }
    bool is_redundant() { return arm().room == 0; }
    RedundantSolver& redundant() {
        return redundant_.get(
            [this] { return std::make_unique<RedundantSolver>(chain_, lower_, upper_, weight_); });
    }

    // Whether the lengths and directions of the axes alone rule the goal out.
    bool exceeds_reach(const double* goal) {
        return std::hypot(goal[3], goal[7], goal[11]) > reach_ || is_ruled_out(arm(), goal);
    }

  private:
    Chain chain_;
    double lower_[max_joints], upper_[max_joints], weight_[max_joints], reach_;
    MadeOnce<BuiltArm> arm_;
    MadeOnce<RedundantSolver> redundant_;
};

}  // namespace cspace::ik
