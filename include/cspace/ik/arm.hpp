// An arm ready to be asked: its plan, and the answers that need no instruction set of their own.
#pragma once

#include "cspace/ik/careful.hpp"
#include "cspace/ik/complete.hpp"

namespace cspace::ik {

struct Arm {
    Plan plan;
    bool has_plan = false;
};

// The configuration that comes nearest to a goal that nothing reaches.
struct Miss {
    double q[max_joints];
    double position;  // [m]
    double rotation;  // [rad]
};

}  // namespace cspace::ik

namespace cspace::inline CSPACE_ISA {

inline ik::Arm make_arm(const ik::Chain& chain) {
    ik::Arm arm;
    arm.has_plan = make_plan(arm.plan, chain);
    return arm;
}

// Minimises ‖Δp‖² + (stiffness · length · angle)²: stiffness 1 weighs a radian like the arm's length, a large
// one keeps the orientation and gives the distance by which the goal is out of reach. Starts from the
// branches cut off at their borders and from configurations spread over the joints.
inline ik::Miss nearest_miss(const ik::Arm& arm, const Posed& goal, double stiffness) {
    const ik::Plan& plan = arm.plan;
    Care care;
    care.band = std::numeric_limits<double>::infinity();
    const Branches<double> b = closed_form(plan, goal_in_form(plan, goal), care);
    ik::Miss best{{}, std::numeric_limits<double>::infinity(), 0};
    double least = std::numeric_limits<double>::infinity();
    const double length = plan.form.length * stiffness;
    constexpr int spread = 8;
    for (int k = 0; k < max_branches + spread; ++k) {
        double q[ik::max_joints] = {};
        spread_configuration(k, plan.chain.n, q);
        for (int i = 0; i < 6 && k < max_branches; ++i)
            if (plan.joint[i] >= 0 && std::isfinite(b.t[k][i]))
                q[plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
        PoseError error;
        const double size = refine(plan.chain, goal, length, q, error, 200);
        if (!(size < least)) continue;
        least = size;
        best.position = error.position;
        best.rotation = error.rotation;
        for (int i = 0; i < plan.chain.n; ++i) best.q[i] = wrap_once(std::remainder(q[i], 2 * pi));
    }
    return best;
}

}  // namespace cspace::inline CSPACE_ISA
