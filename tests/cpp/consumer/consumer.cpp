// The headers as somebody else uses them: a planned arm, its pose, and every way to reach it.
#include <cstdio>

#include "cspace/ik/arm.hpp"
#include "cspace/version.hpp"

using namespace cspace;

// An elbow arm with a spherical wrist; lengths in metres.
static ik::Chain elbow_arm() {
    ik::Chain chain;
    chain.n = 6;
    const Vec3d axes[6] = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    const double height[6] = {0, 0.3, 0.7, 0.7, 0.7, 0.7}, ahead[6] = {0, 0, 0, 0, 0.4, 0.4};
    for (int i = 0; i < 6; ++i) {
        chain.axis[i] = axes[i];
        chain.point[i] = {ahead[i], 0, height[i]};
    }
    chain.tip = {identity_pose().R, {0.5, 0, 0.7}};
    return chain;
}

int main() {
    static const ik::Arm arm = make_arm(elbow_arm());
    const double q[6] = {0.3, -0.5, 0.8, 0.4, 0.9, -0.2};
    const Posed goal = forward(arm.plan.chain, q);
    const ik::Solutions found = solve_pose(arm, goal, nullptr);
    double nearest = 1;
    for (int k = 0; k < found.count; ++k) {
        const Posed reached = forward(arm.plan.chain, found.q[k]);
        if (pose_difference(reached, goal, 1) > 1e-12) return 1;
        nearest = min(nearest, distance(arm.plan.chain, found.q[k], q));
    }
    std::printf("cspace %s: %d solutions\n", CSPACE_VERSION, found.count);
    return found.count == 8 && nearest < 1e-12 ? 0 : 1;
}
