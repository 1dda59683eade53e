// Goals that no configuration meets: nothing that is reached counts as one, and what is told is true.
#include "check.hpp"
#include "cspace/ik/reach_bounds.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::ik;
using check::Random;

namespace {

// Axes that are often parallel, some of which slide.
ik::Chain random_chain(Random& random, int n, double scale) {
    const Vec3d common = random.axis();
    ik::Chain chain;
    chain.n = n;
    for (int i = 0; i < n; ++i) {
        chain.axis[i] = random.below(2) ? random.axis() : (random.below(2) ? -1.0 : 1.0) * common;
        chain.point[i] = scale * random.vector();
        chain.prismatic[i] = random.below(4) == 0;
    }
    chain.tip = {spatial::rotation_about(random.axis(), std::cos(1.1), std::sin(1.1)),
                 scale * random.vector()};
    return chain;
}

}  // namespace

TEST(what_an_arm_reaches_is_not_beyond_it) {
    Random random{1};
    for (int repeat = 0; repeat < 20000; ++repeat) {
        const double scale = std::pow(10.0, random.below(7) - 3);
        const ik::Chain chain = random_chain(random, 1 + random.below(7), scale);
        const ik::ReachBounds reach = measure_reach(chain, characteristic_length(chain));
        double q[ik::max_joints];
        const double way = random.below(10) ? scale : 1e6 * scale;
        for (int i = 0; i < chain.n; ++i) q[i] = (chain.prismatic[i] ? way : pi) * random.uniform(-1, 1);
        CHECK(!exceeds_reach(chain, reach, forward_kinematics(chain, q)));
    }
}

TEST(the_last_of_three_axes_leans_as_far_as_the_middle_one_turns_it) {
    Random random{2};
    for (int repeat = 0; repeat < 200; ++repeat) {
        ik::Chain chain;
        chain.n = 3;
        for (int i = 0; i < 3; ++i) chain.axis[i] = random.axis(), chain.point[i] = {0, 0, 0};
        chain.tip = identity_pose();
        double low = pi, high = 0;
        for (int k = 0; k < 2000; ++k) {
            const double q[3] = {0, k * pi / 1000, 0};
            const double angle = angle_between(chain.axis[0], forward_kinematics(chain, q).R * chain.axis[2]);
            low = min(low, angle);
            high = max(high, angle);
        }
        // The third axis, turned in the plane that it makes with the first, leans by any angle asked for.
        const Vec3d square = cross(chain.axis[0], chain.axis[2]);
        const double own = angle_between(chain.axis[0], chain.axis[2]);
        for (const double lean : {low - 0.02, low + 0.02, 0.5 * (low + high), high - 0.02, high + 0.02}) {
            if (lean < 0 || lean > pi || high - low < 0.1) continue;
            const Vec3d about = (1 / norm(square)) * square;
            Posed goal = identity_pose();
            goal.R = spatial::rotation_about(about, std::cos(lean - own), std::sin(lean - own));
            CHECK(exceeds_reach(chain, measure_reach(chain, 1), goal) ==
                  (lean < low - 0.01 || lean > high + 0.01));
        }
    }
}

TEST(a_scara_keeps_its_tool_upright_and_reaches_as_far_as_its_links) {
    ik::Chain chain;
    chain.n = 4;
    for (int i = 0; i < 4; ++i) chain.axis[i] = {0, 0, 1};
    chain.point[1] = {0.4, 0, 0.1};
    chain.point[3] = chain.point[2] = {0.7, 0, 0.3};
    chain.prismatic[2] = true;
    chain.tip = {identity_pose().R, {0.7, 0, 0}};
    const auto at = [&](double x, double z, double lean) {
        return exceeds_reach(
            chain, measure_reach(chain, 1),
            {spatial::rotation_about(Vec3d{1, 0, 0}, std::cos(lean), std::sin(lean)), {x, 0, z}});
    };
    CHECK(!at(0.699, 25, 0) && !at(-0.699, -25, 0));
    CHECK(at(0.701, 0, 0) && at(0.5, 0, 1e-6) && at(0.5, 0, pi));
}
