// The curve of a family: the tip stays, it closes, and it is the four-bar linkage that geometry says.
#include "check.hpp"
#include "cspace/ik/self_motion/continuation.hpp"

using namespace cspace;
using namespace cspace::ik;

namespace {

// Links of 1, 1 and 0.5 m in the plane, at q.
ik::Chain planar_arm() {
    ik::Chain chain;
    chain.n = 3;
    for (int i = 0; i < 3; ++i) {
        chain.axis[i] = {0, 0, 1};
        chain.point[i] = {double(i), 0, 0};
    }
    chain.tip = identity_pose();
    chain.tip.t = {2.5, 0, 0};
    return chain;
}

}  // namespace

TEST(three_links_on_a_point_swing_as_a_four_bar_linkage) {
    const ik::Chain chain = planar_arm();
    const double q[3] = {0.3, 0.5, 0.7};
    const Posed goal = forward_kinematics(chain, q);
    const ik::TipConstraint constraint = {goal, false, 1.0};
    // The direction that leaves the tip alone: across both rows of the Jacobian.
    PoseError at;
    measure_constrained(chain, constraint, q, at);
    const double* along = at.jacobian.v[weakest_direction(at.jacobian)];
    double low = q[0], high = q[0], last[3] = {}, worst = 0;
    int steps = 0;
    const ik::CurveEnd end =
        follow_curve(chain, constraint, q, along, [&](const double* p, const double* t, double) {
            worst = max(worst, norm(forward_kinematics(chain, p).t - goal.t));
            CHECK_NEAR(dot_n(t, t, 3), 1.0, 1e-12);
            low = min(low, p[0]);
            high = max(high, p[0]);
            for (int i = 0; i < 3; ++i) last[i] = p[i];
            ++steps;
        });
    CHECK(end == ik::CurveEnd::closed);
    CHECK(steps > 50);
    CHECK(worst < 1e-12);
    for (int i = 0; i < 3; ++i) CHECK_NEAR(std::remainder(last[i] - q[i], 2 * pi), 0.0, 1e-12);
    // The first link swings until the other two are stretched: 1.5 m from its end to the goal.
    const double r = norm(goal.t), bearing = std::atan2(goal.t.y, goal.t.x);
    const double swing = std::acos((1 + r * r - 1.5 * 1.5) / (2 * r));
    CHECK_NEAR(high, bearing + swing, 1e-3);
    CHECK_NEAR(low, bearing - swing, 1e-3);
}
