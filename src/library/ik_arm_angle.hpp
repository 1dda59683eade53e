// Arms with two spherical joints, solved by the swivel of their elbow: what the bindings call.
#pragma once

#include <cstddef>
#include <memory>

#include "cspace/ik/chain.hpp"

namespace cspace::ik {

struct SwivelArm;

class SwivelSolver {
  public:
    explicit SwivelSolver(const Chain& seven_joints);

    bool serves() const;  // whether axes 1, 2, 3 and 5, 6, 7 meet
    // Goal i at swivel i, or one goal at all of the n swivels: q (n, 8, 7), NaN in rows without a solution.
    void solve(const double* goals, bool one_goal, const double* swivels, std::size_t n, double* q) const;
    double swivel_at(const double* q) const;

  private:
    std::shared_ptr<const SwivelArm> arm_;
};

}  // namespace cspace::ik
