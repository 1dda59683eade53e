// Joints that turn or slide in general position, up to six of them in any order: every solution reaches its
// goal, the generator is among them, the certificate holds.
#include "check.hpp"
#include "cspace/ik/arm.hpp"
#include "random_arms.hpp"

using namespace cspace;

// Joint i slides where bit i of `slides` is set.
static ik::Chain general_arm(int n, int slides, arms::Rng& rng) {
    ik::Chain chain;
    chain.n = n;
    for (int i = 0; i < n; ++i) {
        chain.axis[i] = arms::random_direction(rng);
        chain.point[i] = arms::random_pose(rng).t;
        chain.prismatic[i] = slides >> i & 1;
    }
    chain.tip = arms::random_pose(rng);
    return chain;
}

struct Tally {
    int missed = 0, uncertain = 0, odd = 0;
    double worst = 0;
};

static void ask(const ik::Chain& chain, int poses, arms::Rng& rng, Tally& tally) {
    const ik::Arm arm = make_arm(chain);
    CHECK(arm.is_general);
    const double length = characteristic_length(chain);
    for (int pose = 0; pose < poses; ++pose) {
        double q[6];
        for (double& joint : q) joint = arms::uniform(rng, -pi, pi);
        const Posed goal = forward(chain, q);
        const ik::Solutions s = solve_pose(arm, goal, nullptr);
        double nearest = 10;
        for (int k = 0; k < s.count; ++k) {
            nearest = min(nearest, distance(chain, s.q[k], q));
            tally.worst = max(tally.worst, pose_difference(forward(chain, s.q[k]), goal, length));
        }
        tally.missed += nearest > 1e-6;
        tally.uncertain += !s.complete;
        tally.odd += s.complete && s.count % 2;
    }
}

TEST(every_generator_of_six_turning_joints_is_found_and_certified) {
    arms::Rng rng(5);
    Tally tally;
    for (int geometry = 0; geometry < 20; ++geometry) ask(general_arm(6, 0, rng), 50, rng, tally);
    CHECK(tally.missed == 0);
    CHECK(tally.uncertain <= 2);
    CHECK(tally.odd == 0);
    CHECK(tally.worst < 1e-12);
}

// Four slides are one too many for three directions.
TEST(every_order_of_turns_and_slides_is_solved) {
    arms::Rng rng(6);
    Tally tally;
    for (int n = 4; n <= 6; ++n)
        for (int slides = 1; slides < 1 << n; ++slides) {
            int count = 0;
            for (int i = 0; i < n; ++i) count += slides >> i & 1;
            if (count <= 3) ask(general_arm(n, slides, rng), 20, rng, tally);
        }
    CHECK(tally.missed == 0);
    CHECK(tally.uncertain <= 2);
    CHECK(tally.worst < 1e-11);
}
