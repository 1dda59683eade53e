// Descents of the artificial potential of an arm.
#pragma once

#include "planning_arm.hpp"

namespace cspace::planning {

// The strengths are those of search::Gains.
struct FieldRule {
    double k = 1, k_r = 1;
    double rho_0 = 0.1, rho_links = 0.01;  // how far obstacles, and links, repel [m]
    double cone = 0.5;                     // from how far on the goal attracts with the same force [rad, m]
    double step = 0.1;                     // longest step [rad, m]
    std::int64_t looks = 20000;            // evaluations of the potential per start
};

// What repels at a rest: the force on the joints, and the least distance [m].
struct Push {
    collision::Contact contact;
    double force, rho;
};

// How the descent ended: 0 goal, 1 minimum, 2 saddle, 3 crease, 4 wall, 5 budget of evaluations, 6 time.
struct FieldRest {
    int kind = -1;                   // −1: no descent
    std::vector<double> rows;        // its configurations (m, dof)
    std::vector<double> values;      // and their potentials
    double force = 0, distance = 0;  // that remains; from the nearest goal
    int saddles = 0;                 // that it left again
    std::vector<Push> pushes;        // the strongest first, one for each pair of a link and what repels it
};

struct FieldPlan {
    ArmPlan plan;
    FieldRest rest;
};

// The descent from the start nearest to a goal; where it does not arrive, from the others. Of those that do
// not arrive the rest nearest to a goal. Errors as of plan_arm.
FieldPlan plan_by_field(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                        const FieldRule& rule);
std::vector<FieldPlan> plan_each_by_field(const ArmSpace& space, std::span<const ArmProblem> problems,
                                          const ArmOptions& options, const FieldRule& rule, int threads);

// The potential of goals (g, dof) at rows (n, dof), and its gradients (n, dof).
void evaluate_potential(const ArmSpace& space, std::span<const double> goals, const FieldRule& rule,
                        std::span<const double> rows, double* values, double* gradients);

// The farthest that a sphere may be from the axis of a joint that moves it [m]; 1 at least with a prismatic
// joint.
double find_reach(const collision::Checker& checker);

}  // namespace cspace::planning
