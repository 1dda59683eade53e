// Solutions in valleys. Where the tip hardly moves along a direction of the joints, a whole curve of
// configurations may almost meet the goal: rounded axes cause such valleys, and a wrist that is straight to
// 1e-9 rad does. Along the curve the error has one direction only, and vanishes where its sign changes.
#pragma once

#include <algorithm>

#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/self_motion/continuation.hpp"
#include "cspace/ik/self_motion/self_motion.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// Whether q lies in a valley along which the goal counts as reached throughout, without a self-motion.
// `direction`: the unit velocity along it.
inline bool lies_in_valley(const Chain& chain, const Posed& goal, double length, const double* q,
                           double* direction) {
    constexpr double hardly = 1e-7, stride = 0.02, next_to_nothing = 1e-10;
    PoseError at;
    measure_error(chain, goal, length, q, at);
    if (chain.n == 6 && weak_direction(at.jacobian, hardly).sigma > hardly) return false;
    decompose_matrix(at.jacobian);
    const int weak = weakest_direction(at.jacobian);
    if (at.jacobian.sigma[weak] > hardly || leaves_goal(chain, goal, length, q, at.jacobian, next_to_nothing))
        return false;
    for (int i = 0; i < chain.n; ++i) direction[i] = at.jacobian.v[weak][i];
    for (const double way : {stride, -stride}) {
        const double kept = kept_of_stride(chain, goal, length, q, direction, way, true, next_to_nothing);
        if (0.8 < kept && kept < 1.25) return true;
    }
    return false;
}

// A valley that was followed: the largest error along it, and whether its list is complete.
struct Valley {
    double deepest = 0;
    bool whole =
        false;  // followed to its ends, no other one crosses it, and there was room for its solutions
};

// Adds the solutions of the valley through q while rows are free, and marks them in `listed`.
inline Valley search_valley(const Chain& chain, const Posed& goal, double length, const double* q,
                            const double* direction, int room, bool* listed, Solutions& out) {
    constexpr double longest = 0.2, crossed = 1e-3, floor = 1e-6;
    int steps_left = 1000, last_way = -1;
    Valley valley;
    bool alone = true;
    double along[max_joints], before[max_joints], error[6], size[2] = {};
    const auto accept = [&](const double* from, const double* to, double part) {
        double between[max_joints];
        for (int i = 0; i < chain.n; ++i) between[i] = from[i] + part * (to[i] - from[i]);
        const int row = accept_solution(out, chain, goal, length, between, max_branches + out.count, 20);
        if (out.count > room || out.count == max_solutions) alone = false;
        out.count = std::min(out.count, room);
        if (row >= 0 && row < room) listed[row] = true;
    };
    const auto visit = [&](int way, const double* at, const double*, double margin) {
        double e[6];
        tip_error(forward_kinematics(chain, at), goal, length, e);
        const double here = std::sqrt(dot_n(e, e, 6));
        const bool goes_on = way == last_way;
        if (goes_on && dot_n(e, error, 6) < 0)
            accept(before, at, size[1] / (size[1] + here));
        else if (goes_on && size[1] < size[0] && size[1] < here)
            accept(before, before, 0);
        alone = alone && margin > crossed;
        valley.deepest = max(valley.deepest, here);
        for (int i = 0; i < chain.n; ++i) before[i] = at[i];
        for (int k = 0; k < 6; ++k) error[k] = e[k];
        size[0] = goes_on ? size[1] : 0;
        size[1] = here;
        last_way = way;
    };
    in_lengths(chain, length, direction, along);
    valley.whole =
        follow_self_motion(chain, {goal, true, length, floor}, q, along, steps_left, visit, longest) && alone;
    return valley;
}

// A self-motion that misses the goal by rounding near solution k, and by more elsewhere, is a valley. Then
// the solutions of the valley take its place. False if it is not.
inline bool turn_into_valley(const Chain& chain, const Posed& goal, double length, int k, int room,
                             bool* listed, Solutions& out) {
    constexpr double flat = 1e-12;
    PoseError at;
    measure_error(chain, goal, length, out.q[k], at);
    decompose_matrix(at.jacobian);
    if (at.jacobian.sigma[weakest_direction(at.jacobian)] < flat) return false;
    double q[max_joints], direction[max_joints];
    for (int i = 0; i < chain.n; ++i) q[i] = out.q[k][i], direction[i] = out.direction[k][i];
    const Valley valley = search_valley(chain, goal, length, q, direction, room, listed, out);
    if (!valley.whole || valley.deepest <= tolerance::reached) return false;
    listed[k] = true;
    out.status = Status::exact;
    for (int m = 0; m < out.count; ++m) {
        out.self_motion[m] = out.self_motion[m] && !listed[m];
        if (out.self_motion[m]) out.status = Status::singular;
    }
    return true;
}

}  // namespace cspace::ik::inline CSPACE_ISA
