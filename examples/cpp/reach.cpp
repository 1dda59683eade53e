// Every configuration of a UR5e that reaches a pose, by the headers of the library alone.
#include <cspace/ik/arm.hpp>
#include <cstdio>

using namespace cspace;

// The axes of the joints at zero, in the base, a point on each [m], and the tip: robot.chain in Python.
ik::Chain ur5e() {
    const Vec3d axes[] = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 1, 0}};
    const Vec3d points[] = {{0, 0, 0.1625},           {0, 0, 0.1625},           {0.425, 0, 0.1625},
                            {0.8172, 0.1333, 0.1625}, {0.8172, 0.1333, 0.0628}, {0.8172, 0.2329, 0.0628}};
    ik::Chain chain;
    chain.n = 6;
    for (int i = 0; i < chain.n; ++i) {
        chain.axis[i] = axes[i];
        chain.point[i] = points[i];
    }
    chain.tip = {{{{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}}}, {0.8172, 0.2329, 0.0628}};  // rotation, place
    return chain;
}

int main() {
    const ik::Arm arm = make_arm(ur5e());  // finds the geometry; once for each arm
    const double q[] = {0.3, -1.2, 1.4, -0.8, 0.7, 0.1};
    const Posed goal = forward_kinematics(arm.plan.chain, q);

    const ik::Solutions found = solve_pose(arm, goal, nullptr);
    std::printf("%d configurations%s\n", found.count, found.complete ? "" : ", perhaps more");
    for (int k = 0; k < found.count; ++k) {
        for (int i = 0; i < arm.plan.chain.n; ++i) std::printf("%8.4f", found.q[k][i]);
        const Posed reached = forward_kinematics(arm.plan.chain, found.q[k]);
        const double error = ik::pose_difference(reached, goal, 1);  // of rotations, and of places in m
        std::printf("   error %.0e\n", error);
        if (error > 1e-12) return 1;
    }
    return found.count > 0 ? 0 : 1;
}
