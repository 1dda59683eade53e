// Position goals of arms of up to three joints of every kind: the joints a goal was made from come back,
// nothing that many Newton starts find is missing, and a miss is the smallest there is.
#include <algorithm>

#include "check.hpp"
#include "cspace/ik/position/solve.hpp"
#include "few_joints.hpp"

using namespace cspace;
using namespace cspace::ik;
using namespace few_joints;

namespace {

Vec3d tip_of(const ik::Chain& chain, const double* q) { return forward_kinematics(chain, q).t; }
bool lists(const ik::Chain& chain, const ik::PositionSolutions& s, const double* q, double tolerance) {
    for (int i = 0; i < s.count; ++i)
        if (apart(chain, s.q[i], q) < tolerance) return true;
    return false;
}
bool any_free(const ik::PositionSolutions& s) {
    for (int i = 0; i < s.count; ++i)
        if (s.self_motion[i]) return true;
    return false;
}
// Newton from one start with slopes by differences and the pseudo-inverse by Gauss elimination of (JᵀJ + ε).
bool newton(const ik::Chain& chain, const Vec3d& goal, double* q) {
    double smallest_slope = 0;
    for (int iteration = 0; iteration < 60; ++iteration) {
        const Vec3d gap = goal - tip_of(chain, q);
        Vec3d J[3];
        for (int j = 0; j < chain.n; ++j) {
            double a[3], b[3];
            std::copy(q, q + 3, a), std::copy(q, q + 3, b);
            a[j] += 1e-6, b[j] -= 1e-6;
            J[j] = 5e5 * (tip_of(chain, a) - tip_of(chain, b));
        }
        double m[3][4] = {};
        for (int i = 0; i < chain.n; ++i) {
            for (int j = 0; j < chain.n; ++j) m[i][j] = dot(J[i], J[j]) + (i == j ? 1e-9 : 0);
            m[i][3] = dot(J[i], gap);
        }
        smallest_slope = 1e9;
        for (int i = 0; i < chain.n; ++i) {
            smallest_slope = std::fmin(smallest_slope, m[i][i]);
            for (int k = i + 1; k < chain.n; ++k) {
                const double f = m[k][i] / m[i][i];
                for (int j = i; j < 4; ++j) m[k][j] -= f * m[i][j];
            }
        }
        double length = 0;
        for (int i = chain.n - 1; i >= 0; --i) {
            for (int j = i + 1; j < chain.n; ++j) m[i][3] -= m[i][j] * m[j][3];
            m[i][3] /= m[i][i];
            length = std::fmax(length, std::fabs(m[i][3]));
        }
        for (int i = 0; i < chain.n; ++i) q[i] += length > 1 ? m[i][3] / length : m[i][3];
        if (length < 1e-12) break;
    }
    return norm(goal - tip_of(chain, q)) < 1e-10 && smallest_slope > 1e-5;
}

}  // namespace

TEST(the_joints_a_goal_was_made_from_come_back) {
    Random random{1};
    for (int w = 0; w < words; ++w)
        for (int repeat = 0; repeat < 600; ++repeat) {
            const ik::Chain chain = random_arm(random, w, repeat % 2);
            double made[3] = {};
            random_joints(random, chain, made);
            const ik::PositionSolutions s = solve_position(chain, tip_of(chain, made));
            CHECK(s.count > 0);
            for (int i = 0; i < s.count; ++i)
                CHECK_NEAR(norm(tip_of(chain, s.q[i]) - tip_of(chain, made)), 0, 1e-11);
            CHECK(any_free(s) || lists(chain, s, made, 1e-5));
        }
}

TEST(nothing_that_many_starts_find_is_missing) {
    Random random{2};
    int most[words] = {};
    for (int w = 0; w < words; ++w)
        for (int repeat = 0; repeat < 40; ++repeat) {
            const ik::Chain chain = random_arm(random, w, repeat % 2);
            double made[3] = {};
            random_joints(random, chain, made);
            const Vec3d goal = tip_of(chain, made);
            const ik::PositionSolutions s = solve_position(chain, goal);
            most[w] = std::max(most[w], s.count);
            for (int start = 0; start < 60 && !any_free(s); ++start) {
                double q[3] = {};
                random_joints(random, chain, q);
                if (newton(chain, goal, q)) CHECK(lists(chain, s, q, 1e-5));
            }
        }
    CHECK(most[6] == 4);   // RRR
    CHECK(most[13] == 1);  // PPP
}

TEST(a_miss_is_the_smallest_there_is) {
    Random random{3};
    int misses = 0;
    for (int w = 0; w < words; ++w)
        for (int repeat = 0; repeat < 40; ++repeat) {
            const ik::Chain chain = random_arm(random, w, repeat % 2);
            const Vec3d goal = 3.0 * random.vector();
            const ik::PositionSolutions s = solve_position(chain, goal);
            if (s.count) continue;
            ++misses;
            CHECK(s.out_of_reach > 0);
            CHECK_NEAR(norm(tip_of(chain, s.nearest) - goal), s.out_of_reach, 1e-13);
            for (int start = 0; start < 4000; ++start) {
                double q[3] = {};
                random_joints(random, chain, q);
                if (start >= 2000)
                    for (int i = 0; i < chain.n; ++i) q[i] = s.nearest[i] + 1e-3 * q[i];
                if (norm(tip_of(chain, q) - goal) < s.out_of_reach - 1e-12) {
                    CHECK(false);
                    break;
                }
            }
        }
    CHECK(misses > 150);
}

TEST(the_planar_two_link_arm_has_its_four_textbook_cases) {
    ik::Chain chain = word(2);
    for (int i = 0; i < 2; ++i) chain.axis[i] = {0, 0, 1};
    const auto arm = [&](double l1, double l2) {
        chain.point[0] = {0, 0, 0};
        chain.point[1] = {l1, 0, 0};
        chain.tip = {identity_pose().R, {l1 + l2, 0, 0}};
    };
    arm(0.5, 0.3);
    CHECK(solve_position(chain, {0.4, 0.3, 0}).count == 2);
    CHECK(solve_position(chain, {0, 0.8, 0}).count == 1);   // stretched
    CHECK(solve_position(chain, {0, -0.2, 0}).count == 1);  // folded
    CHECK_NEAR(solve_position(chain, {0, 1.0, 0}).out_of_reach, 0.2, 1e-14);
    CHECK_NEAR(solve_position(chain, {0.1, 0, 0}).out_of_reach, 0.1, 1e-14);
    CHECK_NEAR(solve_position(chain, {0.4, 0.3, 0.7}).out_of_reach, 0.7, 1e-14);
    arm(0.4, 0.4);
    const ik::PositionSolutions base = solve_position(chain, {0, 0, 0});
    CHECK(base.count == 1 && base.self_motion[0]);
    CHECK_NEAR(std::fabs(base.q[0][1]), pi, 1e-7);
    CHECK_NEAR(std::fabs(base.direction[0][0]), 1, 1e-6);
}

TEST(a_planar_arm_of_three_joints_is_free) {
    ik::Chain chain = word(6);
    for (int i = 0; i < 3; ++i) chain.axis[i] = {0, 0, 1}, chain.point[i] = {0.4 * i, 0, 0};
    chain.tip = {identity_pose().R, {1.2, 0, 0}};
    const ik::PositionSolutions s = solve_position(chain, {0.5, 0.4, 0});
    CHECK(s.count == 1);  // a four-bar whose shortest link is too long for two curves
    for (int i = 0; i < s.count; ++i) {
        CHECK(s.self_motion[i]);
        CHECK_NEAR(s.q[i][0], 0, 1e-12);
        double ahead[3];
        for (int j = 0; j < 3; ++j) ahead[j] = s.q[i][j] + 1e-5 * s.direction[i][j];
        CHECK_NEAR(norm(tip_of(chain, ahead) - Vec3d{0.5, 0.4, 0}), 0, 1e-9);
    }
}

TEST(an_arm_far_from_its_base_keeps_its_digits) {
    Random random{4};
    for (int repeat = 0; repeat < 100; ++repeat) {
        ik::Chain chain = random_arm(random, 6, false);
        const Vec3d away = 1e4 * random.vector();
        for (int i = 0; i < 3; ++i)
            chain.point[i] = chain.point[i] + away + 1e3 * random.uniform(-1, 1) * chain.axis[i];
        chain.tip.t = chain.tip.t + away;
        double made[3];
        random_joints(random, chain, made);
        const ik::PositionSolutions s = solve_position(chain, tip_of(chain, made));
        CHECK(lists(chain, s, made, 1e-5));
    }
}
