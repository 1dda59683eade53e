// Random arms of two links among random obstacles, and whether an arm touches them by the distance between
// segments: an oracle that knows nothing of arcs.
#pragma once

#include "cspace/math/crossing.hpp"
#include "cspace/planning/two_joints/space.hpp"
#include "random.hpp"

namespace check {

using cspace::Point;
using namespace cspace::planning::two_joints;

inline double distance_between(Point a, Point b, Point c, Point d) {
    if (cspace::do_cross({a, b}, {c, d})) return 0;
    const auto to_segment = [](Point p, Point from, Point to) {
        return cspace::distance(p, cspace::nearest_on(from, to, p));
    };
    return std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
}
// The distance of a segment to a piece without its radius: zero where they touch.
inline double distance_between(Point a, Point b, const Piece& piece) {
    double nearest = std::min(distance_to_corners(piece, a), distance_to_corners(piece, b));
    for (std::size_t i = 0; i < piece.size(); ++i)
        nearest = std::min(nearest, distance_between(a, b, piece.corners[i], piece.corners[piece.next(i)]));
    return nearest;
}
// How far the arm is from the obstacles, each with its radius and that of the links; negative where they
// touch, but no measure of depth there.
inline double clearance(const Arm& arm, const std::vector<Piece>& obstacles, double q_1, double q_2) {
    const Point elbow = arm.elbow(q_1);
    const double angle = arm.joint_1.angle(q_1) + arm.joint_2.angle(q_2);
    const Point tip = elbow + arm.length_2 * Point{std::cos(angle), std::sin(angle)};
    double nearest = 1e9;
    for (const Piece& piece : obstacles)
        nearest = std::min(
            nearest, std::min(distance_between(arm.base, elbow, piece), distance_between(elbow, tip, piece)) -
                         piece.radius - arm.radius);
    return nearest;
}

// The hull of random points around a centre, counterclockwise by their angles; a disc or a capsule at times.
inline Piece random_piece(Random& random, double far, std::int32_t obstacle) {
    const double at = random.uniform(0, 7), away = random.uniform(0.3, far);
    const double size = random.uniform(0.02, 0.4);
    const Point center{away * std::cos(at), away * std::sin(at)};
    const int count = 1 + random.below(6);
    std::vector<Point> corners;
    const double start = random.uniform(0, 7);
    for (int i = 0; i < count; ++i) {
        const double angle =
            start + cspace::planning::two_joints::turn * (i + random.uniform(-0.3, 0.3)) / count;
        corners.push_back(center + size * Point{std::cos(angle), std::sin(angle)});
    }
    return make_piece(corners, count < 3 ? size / 3 : random.below(2) * 0.05, obstacle);
}

struct Problem {
    Arm arm;
    std::vector<Piece> obstacles;
};
inline Problem random_problem(Random& random, bool has_limits) {
    Problem problem;
    Arm& arm = problem.arm;
    arm.base = {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)};
    arm.length_1 = random.uniform(0.3, 1.2), arm.length_2 = random.uniform(0.3, 1.2);
    arm.radius = random.below(2) * random.uniform(0, 0.08);
    for (Joint* joint : {&arm.joint_1, &arm.joint_2}) {
        joint->sign = random.below(2) ? 1 : -1;
        joint->offset = random.uniform(-3, 3);
        if (!has_limits) continue;
        joint->lower = random.uniform(-7, 0), joint->upper = joint->lower + random.uniform(0.5, 9);
        joint->wraps = false;
    }
    const int count = 1 + random.below(6);
    while (int(problem.obstacles.size()) < count) {
        const Piece piece = random_piece(random, 1.1 * (arm.length_1 + arm.length_2), count);
        if (distance_to_corners(piece, arm.base) > piece.radius + arm.radius)
            problem.obstacles.push_back(piece);
    }
    return problem;
}

}  // namespace check
