// Plans of arms with few joints by search over a grid of configurations.
#pragma once

#include <cstdint>
#include <vector>

#include "planning_arm.hpp"

namespace cspace::planning {

// The estimate of what is left is the distance to the nearest goal d, or of the potential
//     U = d + min(½ k_r (1/ρ − 1/ρ₀)², cap),
// ρ the least distance from obstacles: min(scale · U, weight · d). By h alone (order 2) weight has no part.
struct GridRule {
    std::vector<std::int32_t> cells;  // per joint
    int order = 0;                    // 0: A*, 1: Dijkstra, 2: best first by h, 3: breadth first
    int reach = 1;                    // steps that an edge spans along a joint at most
    double weight = 1;                // the path costs at most so many times the cheapest over the grid
    bool has_potential = false;
    double scale = 1, k_r = 1, rho_0 = 0.1, cap = 1;
};

// A shortest path over the grid, or what the order promises, simplified and proved as those of plan_arm. Also
// throws std::invalid_argument for more than three joints, and for grids that are empty or too large.
ArmPlan plan_on_grid(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                     const GridRule& rule);
std::vector<ArmPlan> plan_each_on_grid(const ArmSpace& space, std::span<const ArmProblem> problems,
                                       const ArmOptions& options, const GridRule& rule, int threads);

}  // namespace cspace::planning
