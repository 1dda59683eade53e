// Joints that turn or slide in general position, up to six of them in any order: every solution reaches its
// goal, the generator is among them, the certificate holds.
#include "check.hpp"
#include "cspace/ik/arm.hpp"
#include "random_arms.hpp"

using namespace cspace;
using namespace cspace::ik;

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
        const Posed goal = forward_kinematics(chain, q);
        const ik::Solutions s = solve_pose(arm, goal, nullptr);
        double nearest = 10;
        for (int k = 0; k < s.count; ++k) {
            nearest = min(nearest, joint_distance(chain, s.q[k], q));
            tally.worst = max(tally.worst, pose_difference(forward_kinematics(chain, s.q[k]), goal, length));
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

// Axes along the coordinate axes, points on a grid.
static ik::Chain grid_arm(int n, int slides, arms::Rng& rng) {
    ik::Chain chain;
    chain.n = n;
    Vec3d at = {0, 0, 0};
    for (int i = 0; i < n; ++i) {
        const int k = static_cast<int>(rng() % 3);
        chain.axis[i] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
        const auto step = [&] { return rng() % 2 ? arms::uniform(rng, 0.2, 0.5) : 0; };
        chain.point[i] = at = at + Vec3d{step(), step(), step()};
        chain.prismatic[i] = slides >> i & 1;
    }
    chain.tip = {identity_pose().R, at + Vec3d{0.1, 0.2, 0.15}};
    return chain;
}

static double smallest_singular_value(const ik::Chain& chain, const Posed& goal, const double* q) {
    PoseError error;
    measure_error(chain, goal, 1, q, error);
    decompose_matrix(error.jacobian);
    double least = 10;
    for (int i = 0; i < chain.n; ++i) least = min(least, error.jacobian.sigma[i]);
    return least;
}

// Quarter turns bring axes of different links into line; base and tip exchanged, other equations vanish.
TEST(a_certified_list_holds_what_the_reversed_arm_finds_at_quarter_turns) {
    arms::Rng rng(7);
    int compared = 0, lacking = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const int n = 5 + repeat % 2, first = rng() % n, second = rng() % n;
        const ik::Chain chain = grid_arm(n, 1 << first | 1 << second, rng), back = reverse_chain(chain);
        const ik::Arm arm = make_arm(chain), other = make_arm(back);
        if (!arm.is_general || !other.is_general) continue;
        for (int pose = 0; pose < 6; ++pose) {
            double q[6] = {};
            for (int i = 0; i < n; ++i)
                q[i] = rng() % 3 ? 0.5 * pi * static_cast<int>(rng() % 4) - pi : arms::uniform(rng, -pi, pi);
            const Posed goal = forward_kinematics(chain, q);
            if (smallest_singular_value(chain, goal, q) < 1e-2) continue;
            const ik::Solutions found = solve_pose(arm, goal, nullptr);
            if (!found.complete) continue;
            const ik::Solutions reversed = solve_pose(other, inverse(goal), nullptr);
            for (int k = -1; k < reversed.count; ++k) {
                for (int i = 0; i < n && k >= 0; ++i) q[i] = reversed.q[k][n - 1 - i];
                if (smallest_singular_value(chain, goal, q) < 1e-2) continue;
                double nearest = 10;
                for (int j = 0; j < found.count; ++j)
                    nearest = min(nearest, joint_distance(chain, found.q[j], q));
                lacking += nearest > 1e-6;
                ++compared;
            }
        }
    }
    CHECK(compared > 2000);
    CHECK(lacking == 0);
}
