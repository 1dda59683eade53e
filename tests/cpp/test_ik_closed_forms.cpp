// The closed forms on hundreds of random geometries of each class, in both directions.
#include <cstring>

#include "check.hpp"
#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/virtual_joints.hpp"
#include "random_arms.hpp"

using namespace cspace;
using namespace cspace::ik;
using arms::Class;

static void expect_every_generator_found(Class kind, bool backwards) {
    arms::Rng rng(17 + 2 * int(kind) + backwards);
    int missed = 0;
    double worst = 0;
    for (int geometry = 0; geometry < 100; ++geometry) {
        const ik::Chain arm = arms::random_arm(kind, backwards, rng);
        static ik::Plan plan;
        CHECK(make_plan(plan, arm));
        CHECK(plan.form.deviation < 1e-12);
        for (int pose = 0; pose < 10; ++pose) {
            double q[6];
            for (double& angle : q) angle = arms::uniform(rng, -pi, pi);
            const Posed goal = forward_kinematics(arm, q);
            const ik::Solutions s = solve_carefully(plan, goal, nullptr);
            CHECK(s.status == ik::Status::exact);
            double nearest = 10;
            for (int k = 0; k < s.count; ++k) {
                nearest = min(nearest, joint_distance(arm, s.q[k], q));
                worst = max(worst, pose_difference(forward_kinematics(arm, s.q[k]), goal, plan.form.length));
            }
            missed += nearest > 1e-7;
        }
    }
    CHECK(missed == 0);
    CHECK(worst < 1e-12);
    if (missed || worst >= 1e-12)
        std::printf("class %d backwards %d: missed %d, worst residual %g\n", int(kind), backwards, missed,
                    worst);
}

TEST(every_class_recovers_its_generators) {
    for (int kind = 0; kind < int(Class::count); ++kind)
        for (const bool backwards : {false, true}) expect_every_generator_found(Class(kind), backwards);
}

// Arms of four and five joints: six-joint classes with joints left out, so that a closed form exists.
static void expect_shorter_arms_solved(Class kind, int left_out, int joints) {
    arms::Rng rng(91 + 7 * int(kind) + left_out + 31 * joints);
    int missed = 0, without_plan = 0;
    double worst = 0;
    for (int geometry = 0; geometry < 40; ++geometry) {
        const ik::Chain six = arms::random_arm(kind, false, rng);
        ik::Chain arm = six;
        arm.n = 0;
        for (int i = 0; i < 6; ++i) {
            if (i == left_out || (joints == 4 && i == 5)) continue;
            arm.axis[arm.n] = six.axis[i];
            arm.point[arm.n++] = six.point[i];
        }
        static ik::Plan plan;
        if (!make_plan(plan, arm)) {
            ++without_plan;
            continue;
        }
        for (int pose = 0; pose < 5; ++pose) {
            double q[6];
            for (double& angle : q) angle = arms::uniform(rng, -pi, pi);
            const Posed goal = forward_kinematics(arm, q);
            const ik::Solutions s = solve_carefully(plan, goal, nullptr);
            double nearest = 10;
            for (int k = 0; k < s.count; ++k) {
                nearest = min(nearest, joint_distance(arm, s.q[k], q));
                worst = max(worst, pose_difference(forward_kinematics(arm, s.q[k]), goal, plan.form.length));
            }
            missed += nearest > 1e-7;
        }
    }
    CHECK(without_plan == 0);
    CHECK(missed == 0);
    CHECK(worst < 1e-11);
    if (missed || without_plan || worst >= 1e-11)
        std::printf("class %d without joint %d: missed %d, no plan %d, worst %g\n", int(kind), left_out,
                    missed, without_plan, worst);
}

TEST(arms_of_five_and_four_joints_are_completed) {
    for (int left_out = 0; left_out < 6; ++left_out) {
        expect_shorter_arms_solved(Class::last_parallel, left_out, 5);
        expect_shorter_arms_solved(Class::three_parallel, left_out, 5);
    }
    expect_shorter_arms_solved(Class::three_parallel, 4, 4);
    expect_shorter_arms_solved(Class::last_parallel, 4, 4);
}
