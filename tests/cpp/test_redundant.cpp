// Joints to spare without Python: held joints change no pose, the two ways to the feasible intervals agree,
// and the way to the nearest configuration is square to the self-motion.
#include <memory>

#include "check.hpp"
#include "cspace/ik/redundant/nearest_search.hpp"
#include "cspace/ik/redundant/trace.hpp"
#include "random_arms.hpp"

using namespace cspace;

// A 7R arm with a spherical shoulder and two meeting axes before the last, sizes and limits as of a Panda.
static ik::Redundant shoulder_arm() {
    const double turn[7] = {0, -1, 1, 1, -1, 1, 1};  // α_{i−1} in quarter turns
    const double a[7] = {0, 0, 0, 0.0825, -0.0825, 0, 0.088}, d[7] = {0.333, 0, 0.316, 0, 0.384, 0, 0};
    const double lower[7] = {-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973};
    const double upper[7] = {2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973};
    const double weight[7] = {1, 1, 1, 1, 1, 1, 1};
    ik::Chain chain;
    chain.n = 7;
    Posed T = identity_pose();
    for (int i = 0; i < 7; ++i) {
        const Mat3d R = rotation_about(Vec3d{1, 0, 0}, i == 0 ? 1.0 : 0.0, turn[i]);
        T = T * Posed{R, {a[i], 0, 0}};
        T = T * Posed{identity_pose().R, {0, 0, d[i]}};
        chain.axis[i] = column(T.R, 2);
        chain.point[i] = T.t;
    }
    chain.tip = T * Posed{identity_pose().R, {0, 0, 0.107}};
    return make_redundant(chain, lower, upper, weight, make_general_arm);
}

static void random_within(arms::Rng& rng, const ik::Redundant& arm, double* q) {
    for (int i = 0; i < arm.chain.n; ++i) q[i] = arms::uniform(rng, arm.lower[i], arm.upper[i]);
}

TEST(held_joints_change_no_pose) {
    const ik::Redundant arm = shoulder_arm();
    arms::Rng rng(1);
    for (int first = 0; first < 7; ++first)
        for (int second = first + 1; second < 7; ++second) {
            const int held[2] = {first, second};
            double q[7], typical[7];
            typical_values(arm, typical);
            random_within(rng, arm, q);
            const ik::LockedArm locked = lock_joints(arm.chain, held, 2, typical, no_general_arm);
            double moving[5];
            for (int k = 0; k < 5; ++k) moving[k] = q[locked.moving[k]];
            const Posed whole = forward(arm.chain, q);
            CHECK(pose_difference(forward(locked_chain(locked, q), moving), whole, 1) < 1e-14);
            if (!locked.at_ends) continue;
            const double zero[7] = {};
            const Posed rest = forward(locked_chain(locked, zero), moving);
            CHECK(pose_difference(rest, goal_between_ends(locked, whole, q), 1) < 1e-14);
        }
}

TEST(the_default_choice_leaves_a_closed_form) {
    const ik::Redundant arm = shoulder_arm();
    CHECK(arm.spare == 1 && arm.locked.n_held == 1 && arm.locked.held[0] == 6);
    CHECK(rank_of(arm.locked.arm) == 3);
}

TEST(cells_and_arcs_agree) {
    const ik::Redundant arm = shoulder_arm();
    const auto limits = std::make_unique<ik::LimitArms>();
    const auto cells = std::make_unique<ik::Intervals>(), arcs = std::make_unique<ik::Intervals>();
    const auto trail = std::make_unique<Trail>();
    make_limit_arms(arm, *limits, make_general_arm);
    arms::Rng rng(2);
    for (int k = 0; k < 25; ++k) {
        double q[7];
        random_within(rng, arm, q);
        const Posed goal = forward(arm.chain, q);
        CHECK(intervals_by_cells(arm, *limits, goal, *cells));
        intervals_by_arcs(arm, arm.locked, 6, *limits, goal, *trail, *arcs);
        CHECK(cells->complete && arcs->complete);
        CHECK(cells->count == arcs->count);
        double sum[2] = {0, 0}, ends[2] = {0, 0};
        for (int j = 0; j < cells->count; ++j) {
            sum[0] += cells->interval[j].upper - cells->interval[j].lower;
            ends[0] += std::sin(cells->interval[j].upper) + std::cos(cells->interval[j].lower);
        }
        for (int j = 0; j < arcs->count; ++j) {
            sum[1] += arcs->interval[j].upper - arcs->interval[j].lower;
            ends[1] += std::sin(arcs->interval[j].upper) + std::cos(arcs->interval[j].lower);
        }
        CHECK_NEAR(sum[0], sum[1], 1e-8);
        CHECK_NEAR(ends[0], ends[1], 1e-8);
    }
}

TEST(the_way_to_the_nearest_is_square_to_the_self_motion) {
    const ik::Redundant arm = shoulder_arm();
    arms::Rng rng(3);
    for (int k = 0; k < 50; ++k) {
        double q[7], seed[7], best[7];
        random_within(rng, arm, q);
        for (int i = 0; i < 7; ++i) seed[i] = q[i] + arms::uniform(rng, -0.3, 0.3);
        const Posed goal = forward(arm.chain, q);
        CHECK(nearest_configuration(arm, goal, seed, best));
        CHECK(pose_difference(forward(arm.chain, best), goal, 1) < 1e-9);
        CHECK(distance_from_seed(arm, seed, best) <= distance_from_seed(arm, seed, q) + 1e-12);
        CurvePoint at;
        for (int i = 0; i < 7; ++i) at.q[i] = best[i];
        onto_curve(arm.chain, arm.rank, goal, arm.length, at);
        double along = 0;
        for (int i = 0; i < 7; ++i) along += at.tangent[i] * short_way(best[i] - seed[i]);
        CHECK(std::fabs(along) < 1e-9);
    }
}
