// Plans of arms among obstacles: RRT-Connect and trees from the starts, shortcuts, and a proof of every edge
// of the answer.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "collision_checker.hpp"
#include "cspace/planning/options.hpp"

namespace cspace::planning {

// Where an arm may be: bounds per coordinate (dof,). wraps: which joints have the period 2π and no bounds;
// their samples lie between −π and π. Empty: none.
struct ArmSpace {
    const collision::Checker& checker;
    std::span<const double> lower, upper;
    std::span<const unsigned char> wraps;
};
// From any of the starts to any of the goals: rows (s, dof) and (g, dof). time_limit [s]: of this problem,
// where it is less than that of all.
struct ArmProblem {
    std::span<const double> starts, goals;
    double time_limit = std::numeric_limits<double>::infinity();
};

// The same bits on every machine. Throws std::invalid_argument for spans of other sizes, bounds upside down
// or not finite, joints that wrap without a period, and options out of range; and what the check of
// interrupts throws.
ArmPlan plan_arm(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options);
// Each as if alone, on so many threads (0: all).
std::vector<ArmPlan> plan_arms(const ArmSpace& space, std::span<const ArmProblem> problems,
                               const ArmOptions& options, int threads);

// The same by a tree from the starts. Throws std::invalid_argument for a bias that is no share, too.
ArmPlan plan_arm(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                 const TreeOptions& tree);
std::vector<ArmPlan> plan_arms(const ArmSpace& space, std::span<const ArmProblem> problems,
                               const ArmOptions& options, int threads, const TreeOptions& tree);

}  // namespace cspace::planning
