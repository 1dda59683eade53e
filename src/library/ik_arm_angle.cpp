#include "ik_arm_angle.hpp"

#include "cspace/ik/goal.hpp"
#include "kernels/ik_arm_angle.hpp"

namespace cspace::ik {

SwivelSolver::SwivelSolver(const Chain& seven_joints)
    : arm_(std::make_shared<SwivelArm>(make_swivel_arm(seven_joints))) {}

bool SwivelSolver::serves() const { return arm_->serves; }

void SwivelSolver::solve(const double* goals, bool one_goal, const double* swivels, std::size_t n,
                         double* q) const {
    const std::size_t each = one_goal ? n : 1;
    for (std::size_t i = 0; i < n; i += each)
        kernels::swivel_solutions(*arm_, read_goal(goals + 16 * (one_goal ? 0 : i)).T, swivels + i, int(each),
                                  q + 56 * i);
}

double SwivelSolver::swivel_at(const double* q) const { return swivel_of(*arm_, q); }

}  // namespace cspace::ik
