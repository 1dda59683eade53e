// Joints to spare without Python: locked joints change no pose, the two ways to the feasible intervals agree,
// and the way to the nearest configuration is square to the self-motion.
#include <memory>

#include "check.hpp"
#include "cspace/ik/redundancy/arcs.hpp"
#include "cspace/ik/redundancy/nearest_search.hpp"
#include "random_arms.hpp"

using namespace cspace;
using namespace cspace::ik;

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
        const Mat3d R = spatial::rotation_about(Vec3d{1, 0, 0}, i == 0 ? 1.0 : 0.0, turn[i]);
        T = T * Posed{R, {a[i], 0, 0}};
        T = T * Posed{identity_pose().R, {0, 0, d[i]}};
        chain.axis[i] = matrix_column(T.R, 2);
        chain.point[i] = T.t;
    }
    chain.tip = T * Posed{identity_pose().R, {0, 0, 0.107}};
    return make_redundant(chain, lower, upper, weight);
}

static void random_within(arms::Rng& rng, const ik::Redundant& arm, double* q) {
    for (int i = 0; i < arm.chain.n; ++i) q[i] = arms::uniform(rng, arm.lower[i], arm.upper[i]);
}

TEST(held_joints_change_no_pose) {
    const ik::Redundant arm = shoulder_arm();
    arms::Rng rng(1);
    for (int first = 0; first < 7; ++first)
        for (int second = first + 1; second < 7; ++second) {
            const int locked_joint[2] = {first, second};
            double q[7], typical[7];
            typical_values(arm, typical);
            random_within(rng, arm, q);
            const ik::LockedArm locked = lock_joints(arm.chain, locked_joint, 2, typical, false);
            double moving[5];
            for (int k = 0; k < 5; ++k) moving[k] = q[locked.moving[k]];
            const Posed whole = forward_kinematics(arm.chain, q);
            CHECK(pose_difference(forward_kinematics(locked_chain(locked, q), moving), whole, 1) < 1e-14);
            if (!locked.at_ends) continue;
            const double zero[7] = {};
            const Posed rest = forward_kinematics(locked_chain(locked, zero), moving);
            CHECK(pose_difference(rest, goal_between_ends(locked, whole, q), 1) < 1e-14);
        }
}

TEST(the_default_choice_leaves_a_closed_form) {
    const ik::Redundant arm = shoulder_arm();
    CHECK(arm.redundancy_degree == 1 && arm.locked.n_locked == 1 && arm.locked.locked_joint[0] == 6);
    CHECK(rank_of(arm.locked.arm) == 3);
}

TEST(cells_and_arcs_agree) {
    const ik::Redundant arm = shoulder_arm();
    const auto limits = std::make_unique<ik::LimitArms>();
    const auto cells = std::make_unique<ik::Intervals>(), arcs = std::make_unique<ik::Intervals>();
    const auto trail = std::make_unique<Trail>();
    make_limit_arms(arm, *limits);
    arms::Rng rng(2);
    for (int k = 0; k < 25; ++k) {
        double q[7];
        random_within(rng, arm, q);
        const Posed goal = forward_kinematics(arm.chain, q);
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
        const Posed goal = forward_kinematics(arm.chain, q);
        CHECK(nearest_configuration(arm, goal, seed, best));
        CHECK(pose_difference(forward_kinematics(arm.chain, best), goal, 1) < 1e-9);
        CHECK(distance_from_seed(arm, make_target(arm, seed, false), best) <=
              distance_from_seed(arm, make_target(arm, seed, false), q) + 1e-12);
        CurvePoint at;
        for (int i = 0; i < 7; ++i) at.q[i] = best[i];
        onto_curve(arm.chain, arm.rank, goal, arm.length, at);
        double along = 0;
        for (int i = 0; i < 7; ++i) along += at.tangent[i] * short_way(best[i] - seed[i]);
        CHECK(std::fabs(along) < 1e-9);
    }
}

// Arms of seven and eight joints, some of them slides, in millimetres and in metres.
static ik::Chain random_chain(arms::Rng& rng, int k) {
    ik::Chain chain;
    const double size = k % 3 == 0 ? 1e-3 : 1;
    chain.n = 7 + k % 2;
    for (int i = 0; i < chain.n; ++i) {
        const Posed at = arms::random_pose(rng);
        chain.axis[i] = matrix_column(at.R, 2);
        chain.point[i] = size * at.t;
        chain.prismatic[i] = k % 4 == 3 && i % 4 == k % 5;
    }
    chain.tip = arms::random_pose(rng);
    chain.tip.t = size * chain.tip.t;
    return chain;
}

// An arm of seven revolute joints in general position, within limits of up to half a turn and more.
static ik::Redundant random_general_arm(arms::Rng& rng, int k) {
    double lower[7], upper[7], weight[7];
    for (int i = 0; i < 7; ++i) {
        lower[i] = -arms::uniform(rng, 1.2, 3.6);
        upper[i] = arms::uniform(rng, 1.2, 3.6);
        weight[i] = 1;
    }
    return ik::make_redundant(random_chain(rng, 4 * (k % 2)), lower, upper, weight);
}

// Each joint by the multiple of 2π within limits that is nearest to the seed.
static double distance_within(const ik::Redundant& arm, const double* seed, const double* q) {
    double sum = 0;
    for (int i = 0; i < arm.chain.n; ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (int turns = -1; turns <= 1; ++turns) {
            const double at = q[i] + 2 * pi * turns;
            if (at >= arm.lower[i] - limit_slack && at <= arm.upper[i] + limit_slack)
                least = std::min(least, std::fabs(at - seed[i]));
        }
        sum += least * least;
    }
    return std::sqrt(sum);
}

TEST(following_the_arcs_around_a_seed_finds_what_tracing_all_of_them_finds) {
    arms::Rng rng(11);
    const auto limits = std::make_unique<ik::LimitArms>();
    const auto trail = std::make_unique<Trail>();
    for (int k = 0; k < 12; ++k) {
        const ik::Redundant arm = random_general_arm(rng, k);
        CHECK(has_arcs_to_follow(arm));
        *limits = {};
        make_limit_arms(arm, *limits);
        for (int j = 0; j < 4; ++j) {
            double q[7], seed[7], near_by[7], of_all[7];
            random_within(rng, arm, q);
            random_within(rng, arm, seed);
            const Posed goal = forward_kinematics(arm.chain, q);
            CHECK(nearest_within_limits(arm, limits.get(), goal, seed, nullptr, near_by));
            CHECK(nearest_within_limits(arm, limits.get(), goal, seed, trail.get(), of_all));
            CHECK(is_within(arm, near_by, limit_slack));
            CHECK(pose_difference(forward_kinematics(arm.chain, near_by), goal, arm.length) < 1e-8);
            const double distance = distance_within(arm, seed, near_by);
            CHECK(distance <= distance_within(arm, seed, of_all) + 1e-8);
            CHECK(distance <= distance_within(arm, seed, q) + 1e-8);
        }
    }
}

// An arc is followed to where it closes or meets the next start.
TEST(the_least_distance_along_a_closed_arc_does_not_depend_on_where_it_is_entered) {
    arms::Rng rng(12);
    const double far = std::numeric_limits<double>::infinity();
    int arcs = 0;
    for (int k = 0; k < 12; ++k) {
        const ik::Redundant arm = random_general_arm(rng, k);
        double q[7], seed[7];
        random_within(rng, arm, q);
        random_within(rng, arm, seed);
        const Posed goal = forward_kinematics(arm.chain, q);
        const ik::Target target = make_target(arm, seed, false);
        const auto nearest_from = [&](const double* start, ik::Nearest& best) {
            const auto starts = std::make_unique<ik::ArcStarts>();
            const auto minima = std::make_unique<ik::ArcMinima>();
            const ik::Nearest none = {};
            add_arc_start(arm, start, distance_from_seed(arm, target, start), *starts);
            find_arc_minima<7, Pack<4>>({&arm, &target, starts.get(), minima.get(), &none, {far, far}}, goal);
            settle_minima(arm, goal, target, *minima, best);
            return starts->is_reached[0];
        };
        ik::Nearest first, again;
        if (!nearest_from(q, first) || !std::isfinite(first.distance)) continue;
        ++arcs;
        CHECK(first.distance <= distance_from_seed(arm, target, q) + 1e-12);
        CHECK(nearest_from(first.q, again));
        CHECK_NEAR(first.distance, again.distance, 1e-9);
    }
    CHECK(arcs > 4);
}

// The derivative of the frames' points, and the angular velocity, as the joints q of the halves move along x.
struct HalvesSpeed {
    Vec3d linear[2] = {}, angular[2] = {};
};
static HalvesSpeed speed_of(const ik::SplitChain& halves, const Posed& goal, double length,
                            const double (*q)[2], const double (*x)[2], double t) {
    Pack<2> at[4];
    for (int k = 0; k < 4; ++k)
        for (int half = 0; half < 2; ++half) set_lane(at[k], half, q[k][half] + t * x[k][half]);
    SplitChainMotion motion;
    move_split_chain(halves, goal, 1 / length, at, motion);
    HalvesSpeed out;
    for (int half = 0; half < 2; ++half)
        for (int k = 0; k < 4; ++k) {
            out.linear[half] = out.linear[half] + x[k][half] * vector_of_half(motion.linear[k], half);
            out.angular[half] = out.angular[half] + x[k][half] * vector_of_half(motion.axis[k], half);
        }
    return out;
}

// Where the proof stands on: the second derivatives against differences of the first, and the third ones
// within their bounds.
TEST(derivatives_of_the_halves) {
    arms::Rng rng(4);
    for (int trial = 0; trial < 400; ++trial) {
        const ik::Chain chain = random_chain(rng, trial);
        const double length = characteristic_length(chain), h = 1e-3;
        const ik::SplitChain halves = make_split_chain(chain, length);
        const Posed goal = arms::random_pose(rng);
        double q[4][2], x[4][2], square[2] = {0, 0};
        Pack<2> at[4];
        for (int k = 0; k < 4; ++k)
            for (int half = 0; half < 2; ++half) {
                const bool slides = halves.sliding[k][half] > 0;
                q[k][half] = slides ? length * arms::uniform(rng, -1, 1) : arms::uniform(rng, -pi, pi);
                x[k][half] = halves.joint[k][half] < 0 ? 0 : arms::uniform(rng, -1, 1);
                if (slides) x[k][half] *= min(1.0, length);
                set_lane(at[k], half, q[k][half]);
                square[half] += x[k][half] * x[k][half];
            }
        const HalvesSpeed before = speed_of(halves, goal, length, q, x, -h),
                          now = speed_of(halves, goal, length, q, x, 0),
                          after = speed_of(halves, goal, length, q, x, h);
        double lambda[6];
        for (double& weight : lambda) weight = arms::uniform(rng, -1, 1);
        SplitChainMotion motion;
        Pack<2> bent[4][4];
        move_split_chain(halves, goal, 1 / length, at, motion);
        bend_split_chain(motion, lambda, bent);
        const Vec3d force = {lambda[0], lambda[1], lambda[2]}, moment = {lambda[3], lambda[4], lambda[5]};
        double by_formula = square[0] + square[1], by_difference = 0;
        for (int half = 0; half < 2; ++half) {
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < 4; ++b)
                    by_formula -= x[a][half] * x[b][half] * get_lane(a < b ? bent[a][b] : bent[b][a], half);
            by_difference += dot(force, after.linear[half] - before.linear[half]) / (2 * h) +
                             dot(moment, after.angular[half] - before.angular[half]) / (2 * h);
            const Vec3d v2 =
                (1 / (h * h)) * (after.linear[half] + before.linear[half] - 2.0 * now.linear[half]);
            const Vec3d w = now.angular[half], w1 = (0.5 / h) * (after.angular[half] - before.angular[half]);
            const Vec3d w2 =
                (1 / (h * h)) * (after.angular[half] + before.angular[half] - 2.0 * now.angular[half]);
            const double cube = square[half] * std::sqrt(square[half]), way = half ? -1 : 1;
            double reach = halves.reach[half];
            for (int k = 0; k < 4; ++k) reach += halves.slid[k][half] * std::fabs(q[k][half]);
            CHECK(norm(v2) <= reach * cube + 1e-4);
            CHECK(norm(w2 + (0.5 * way) * cross(w1, w) - dot(w, w) * w) <= halves.turn[half] * cube + 1e-4);
        }
        CHECK_NEAR(by_formula, by_difference, 1e-4 * (1 + std::fabs(by_formula)));
    }
}

TEST(what_is_proven_is_the_nearest) {
    const ik::Redundant arm = shoulder_arm();
    arms::Rng rng(5);
    int proven = 0;
    for (int trial = 0; trial < 300; ++trial) {
        double q[7], seed[7], found[7], values[64];
        random_within(rng, arm, q);
        const double size = trial % 3 == 0 ? 0.02 : trial % 3 == 1 ? 0.08 : 0.2;
        for (int i = 0; i < 7; ++i) seed[i] = q[i] + arms::uniform(rng, -size, size);
        const Posed goal = forward_kinematics(arm.chain, q);
        if (!nearest_by_proof(arm.split_chain, goal, arm.length, seed, found)) continue;
        ++proven;
        CHECK(pose_difference(forward_kinematics(arm.chain, found), goal, 1) < 1e-9);
        const double distance = distance_from_seed(arm, make_target(arm, seed, false), found);
        CHECK(distance <= distance_from_seed(arm, make_target(arm, seed, false), q) + 1e-12);
        for (int k = 0; k < 64; ++k) values[k] = seed[6] + distance * ((k + 0.5) / 32 - 1);
        const Sweep sweep = make_sweep(arm.locked, 6, goal, seed);
        sweep_values(sweep, values, 64, [&](int, const SweptRows& rows) {
            for (int k = 0; k < rows.count; ++k)
                CHECK(distance <= distance_from_seed(arm, make_target(arm, seed, false), rows.q[k]) + 1e-9);
        });
    }
    CHECK(proven > 200);
}
