// Perturbed goals: at a singular pose a solver may lose solutions. Goals slightly displaced from it in
// several directions are regular, and Newton's method leads from their solutions back to the goal.
#pragma once

#include "cspace/ik/near_singular.hpp"

namespace cspace::ik::inline CSPACE_ISA {

inline constexpr int perturbed_goals = 12;

// The k-th perturbed goal: generic directions, both senses, decreasing distances.
inline Posed perturbed_goal(const Posed& goal, double length, int k) {
    double d[max_joints];
    spread_configuration(k / 4, 6, d);
    const double size = (k % 2 ? -1 : 1) * (k % 4 < 2 ? 1e-2 : 1e-3) / pi;
    const Vec3d away = size * length * Vec3d{d[0], d[1], d[2]}, turn = size * Vec3d{d[3], d[4], d[5]};
    return {spatial::rotation_of_rotvec(turn) * goal.R, goal.t + away};
}

// Descends from q and adds the result if it is a new solution. Near solutions, a valley that almost reaches
// the goal does not count.
inline void descend_to_solution(const Chain& chain, const Posed& goal, double length, double* q, int steps,
                                Solutions& out) {
    if (out.count == max_solutions) return;
    PoseError error;
    const double left = refine(chain, goal, length, q, error, steps);
    if (left <= (out.count ? tolerance::exact : tolerance::reached))
        accept_solution(out, chain, goal, length, q, out.count, 2);
}

// propose(goal, add_candidate) calls add_candidate(q) for every solution of a goal, as a configuration of the
// chain. Returns whether a new solution was found.
template <class Propose>
inline bool search_perturbed_goals(const Chain& chain, const Posed& goal, double length,
                                   const Propose& propose, Solutions& out) {
    constexpr int most_steps = 40;
    const int before = out.count;
    const auto add_candidate = [&](double* q) {
        descend_to_solution(chain, goal, length, q, most_steps, out);
    };
    for (int k = 0; k < perturbed_goals; ++k) propose(perturbed_goal(goal, length, k), add_candidate);
    classify_solutions(out);
    return out.count > before;
}

}  // namespace cspace::ik::inline CSPACE_ISA
