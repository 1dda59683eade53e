// Six joints in general position: every solution reaches its goal, the generator is among them, the
// certificate holds.
#include "check.hpp"
#include "cspace/ik/arm.hpp"
#include "random_arms.hpp"

using namespace cspace;

static ik::Chain general_arm(arms::Rng& rng) {
    ik::Chain chain;
    chain.n = 6;
    for (int i = 0; i < 6; ++i) {
        chain.axis[i] = arms::random_direction(rng);
        chain.point[i] = arms::random_pose(rng).t;
    }
    chain.tip = arms::random_pose(rng);
    return chain;
}

TEST(every_generator_is_found_and_certified) {
    arms::Rng rng(5);
    int missed = 0, uncertain = 0;
    double worst = 0;
    for (int geometry = 0; geometry < 20; ++geometry) {
        const ik::Chain chain = general_arm(rng);
        const ik::Arm arm = make_arm(chain);
        CHECK(arm.is_general);
        for (int pose = 0; pose < 50; ++pose) {
            double q[6];
            for (double& angle : q) angle = arms::uniform(rng, -pi, pi);
            const Posed goal = forward(chain, q);
            const ik::Solutions s = solve_pose(arm, goal, nullptr);
            double nearest = 10;
            for (int k = 0; k < s.count; ++k) {
                nearest = min(nearest, wrapped_distance(s.q[k], q, 6));
                worst = max(worst, pose_difference(forward(chain, s.q[k]), goal, arm.general.frames.length));
            }
            missed += nearest > 1e-6;
            uncertain += !s.complete;
            CHECK(!s.complete || s.count % 2 == 0);
        }
    }
    CHECK(missed == 0);
    CHECK(uncertain <= 2);
    CHECK(worst < 1e-12);
}
