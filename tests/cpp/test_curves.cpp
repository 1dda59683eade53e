// Curves for cars. That a curve meets its goal proves its length no shorter than the shortest; that the
// length changes by no more than the way along any steering proves it no longer.
#include "check.hpp"
#include "cspace/navigation/curves/dubins.hpp"
#include "cspace/navigation/curves/reeds_shepp.hpp"
#include "random.hpp"

using namespace cspace::navigation;
using check::Random;

namespace {

constexpr double pi = std::numbers::pi;

// Poses anywhere, on a lattice of round numbers where words meet, and close together.
CarPose random_pose(Random& random) {
    const int kind = random.below(4);
    if (kind == 0) {
        const double x = random.below(9) - 4, y = random.below(9) - 4;
        return {x, y, (random.below(17) - 8) * pi / 4};
    }
    const double size = kind == 1 ? 1e-3 : kind == 2 ? 2.5 : 12;
    const double x = random.uniform(-size, size), y = random.uniform(-size, size);
    return {x, y, random.uniform(-4, 4) * (kind == 1 ? 1e-3 : 1)};
}

double miss(const CarPose& start, const Curve& curve, const CarPose& goal, double radius) {
    CarPose at = start;
    for (int i = 0; i < curve.count; ++i) at = drive_piece(at, curve.piece[i], radius);
    return std::max({std::fabs(at.x - goal.x), std::fabs(at.y - goal.y),
                     std::fabs(cspace::wrap_angle(at.theta - goal.theta))});
}

}  // namespace

TEST(curves_end_at_their_goals) {
    Random random{1};
    for (int repeat = 0; repeat < 300000; ++repeat) {
        const CarPose start = random_pose(random), goal = random_pose(random);
        const double radius = random.below(2) ? 1 : std::exp(random.uniform(-2, 2));
        const Curve forward = dubins_curve(start, goal, radius);
        const Curve both = reeds_shepp_curve(start, goal, radius);
        const double bound = 1e-13 * (radius + 12);
        CHECK_NEAR(miss(start, forward, goal, radius), 0, bound);
        CHECK_NEAR(miss(start, both, goal, radius), 0, bound);
        CHECK_NEAR(radius * forward.length(), dubins_distance(start, goal, radius), bound);
        CHECK_NEAR(radius * both.length(), reeds_shepp_distance(start, goal, radius), bound);
        for (int i = 0; i < forward.count; ++i) CHECK(forward.piece[i].length > 0);
        CHECK(both.length() <= forward.length() + bound);
    }
}

TEST(no_steering_comes_nearer_faster_than_it_drives) {
    Random random{2};
    for (int repeat = 0; repeat < 1000000; ++repeat) {
        const CarPose start = random_pose(random), goal = random_pose(random);
        const double step = std::exp(random.uniform(-9, 1));
        const Piece piece{random.below(3) - 1, random.below(2) ? step : -step};
        const CarPose next = drive_piece(start, piece, 1);
        const double here = reeds_shepp_distance(start, goal, 1), there = reeds_shepp_distance(next, goal, 1);
        // Where the distance has a square root, rounding of a pose by 1e-15 is worth 1e-7.
        CHECK_NEAR(here, there, step + 3e-7);
        const CarPose ahead = drive_piece(start, {piece.turn, step}, 1);
        CHECK(dubins_distance(start, goal, 1) <= step + dubins_distance(ahead, goal, 1) + 3e-7);
    }
}

TEST(lengths_have_the_symmetries_of_the_plane) {
    Random random{3};
    for (int repeat = 0; repeat < 200000; ++repeat) {
        const CarPose a = random_pose(random), b = random_pose(random);
        const auto mirrored = [](const CarPose& p) { return CarPose{p.x, -p.y, -p.theta}; };
        const auto about = [](const CarPose& p) { return CarPose{p.x, p.y, p.theta + pi}; };
        const double forward = dubins_distance(a, b, 1), both = reeds_shepp_distance(a, b, 1);
        CHECK_NEAR(dubins_distance(mirrored(a), mirrored(b), 1), forward, 1e-6);
        CHECK_NEAR(dubins_distance(about(b), about(a), 1), forward, 1e-6);
        CHECK_NEAR(reeds_shepp_distance(mirrored(a), mirrored(b), 1), both, 1e-6);
        CHECK_NEAR(reeds_shepp_distance(about(a), about(b), 1), both, 1e-6);
        CHECK_NEAR(reeds_shepp_distance(b, a, 1), both, 1e-6);
    }
}
