// Pose goals of arms of up to three joints: the joints a pose was made from come back, answers meet the pose,
// and a pose that the arm cannot take has none.
#include "check.hpp"
#include "cspace/ik/position/pose.hpp"
#include "few_joints.hpp"

using namespace cspace;
using namespace cspace::ik;
using check::Random;

TEST(the_joints_a_pose_was_made_from_come_back) {
    Random random{1};
    for (int w = 0; w < few_joints::words; ++w)
        for (int repeat = 0; repeat < 600; ++repeat) {
            ik::Chain chain = few_joints::random_arm(random, w, repeat % 2);
            chain.tip.R = spatial::rotation_about(random.axis(), 0.6, 0.8);
            double made[3] = {};
            few_joints::random_joints(random, chain, made);
            const Posed T = forward_kinematics(chain, made);
            const ik::Solutions s = solve_few_joint_pose(chain, T);
            CHECK(s.count > 0);
            bool listed = false;
            for (int i = 0; i < s.count; ++i) {
                const Posed reached = forward_kinematics(chain, s.q[i]);
                CHECK(norm(reached.t - T.t) < 1e-11 && spatial::angle_between(reached.R, T.R) < 1e-11);
                listed = listed || s.self_motion[i] || few_joints::apart(chain, s.q[i], made) < 1e-5;
            }
            CHECK(listed);
        }
}

TEST(a_pose_off_the_arm_has_no_answer) {
    Random random{2};
    for (int w = 0; w < few_joints::words; ++w)
        for (int repeat = 0; repeat < 60; ++repeat) {
            const ik::Chain chain = few_joints::random_arm(random, w, repeat % 2);
            double made[3] = {};
            few_joints::random_joints(random, chain, made);
            Posed T = forward_kinematics(chain, made);
            T.R = T.R * spatial::rotation_about(random.axis(), 0.8, 0.6);
            T.t = T.t + 0.1 * random.axis();
            const ik::Solutions s = solve_few_joint_pose(chain, T);
            for (int i = 0; i < s.count; ++i) {  // a planar displacement may happen to fit a planar arm
                CHECK_NEAR(norm(forward_kinematics(chain, s.q[i]).t - T.t), 0, 1e-11);
                CHECK_NEAR(
                    norm(matrix_column(forward_kinematics(chain, s.q[i]).R, 0) - matrix_column(T.R, 0)), 0,
                    1e-11);
            }
            CHECK(s.count == 0 || chain.n == 3);
        }
}

TEST(a_planar_pose_has_two_answers) {
    ik::Chain chain;
    chain.n = 3;
    for (int i = 0; i < 3; ++i) chain.axis[i] = {0, 0, 1}, chain.point[i] = {0.4 * i, 0, 0};
    chain.tip = {identity_pose().R, {1.2, 0, 0}};
    const double made[3] = {0.3, 0.9, -0.5};
    const ik::Solutions s = solve_few_joint_pose(chain, forward_kinematics(chain, made));
    CHECK(s.count == 2);
    for (int i = 0; i < s.count; ++i) CHECK(!s.self_motion[i]);
}
