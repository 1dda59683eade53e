// Poses of the plane as the variables of a graph: composition, exponential and logarithm of SE(2) and their
// derivatives (Chirikjian 2011, "Stochastic Models, Information Theory, and Lie Groups", volume 2).
//
// Twists are [v; ω] in the frame of the base: X becomes X exp ξ. Matrices are stored row by row.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "cspace/math/wrapping.hpp"
#include "cspace/spatial/left_jacobian.hpp"

namespace cspace::localization {

struct PlanarSpace {
    static constexpr int dimension = 2, freedom = 3, pose_numbers = 3;
    using Twist = std::array<double, 3>;
    using Square = std::array<double, 9>;  // freedom × freedom
    using Point = std::array<double, 2>;
    using PointSquare = std::array<double, 4>;
    using PointByPose = std::array<double, 6>;  // dimension × freedom

    struct Pose {
        double x = 0, y = 0, c = 1, s = 0;
    };

    static Pose read_pose(const double* from) {
        return {from[0], from[1], std::cos(from[2]), std::sin(from[2])};
    }
    static void write_pose(const Pose& pose, double* to) {
        to[0] = pose.x, to[1] = pose.y, to[2] = wrap_once(std::atan2(pose.s, pose.c));
    }
    static Pose compose(const Pose& a, const Pose& b) {
        return {a.x + a.c * b.x - a.s * b.y, a.y + a.s * b.x + a.c * b.y, a.c * b.c - a.s * b.s,
                a.s * b.c + a.c * b.s};
    }
    static Pose inverse(const Pose& a) {
        return {-(a.c * a.x + a.s * a.y), a.s * a.x - a.c * a.y, a.c, -a.s};
    }
    // a⁻¹ b.
    static Pose between(const Pose& a, const Pose& b) {
        const double x = b.x - a.x, y = b.y - a.y;
        return {a.c * x + a.s * y, a.c * y - a.s * x, a.c * b.c + a.s * b.s, a.c * b.s - a.s * b.c};
    }
    static Pose exponential(const double* twist) {
        const double w = twist[2], c = std::cos(w), s = std::sin(w);
        const auto [x, y] = spatial::PlanarJacobian(w, c, s).times(twist);
        return {x, y, c, s};
    }
    static Twist logarithm(const Pose& pose) {
        const double w = std::atan2(pose.s, pose.c), half = w / 2;
        const double k = 1 - w * w * spatial::half_cotangent_rest(w * w);  // (w/2) cot(w/2)
        return {k * pose.x + half * pose.y, k * pose.y - half * pose.x, w};
    }
    // X exp ξ, with a rotation of unit length.
    static Pose move(const Pose& pose, const double* twist) {
        Pose moved = compose(pose, exponential(twist));
        const double scale = 1 / std::sqrt(moved.c * moved.c + moved.s * moved.s);
        moved.c *= scale, moved.s *= scale;
        return moved;
    }
    // d log(X exp ξ) / dξ at 0, for e = log X: I + ad/2 + c ad².
    static Square log_jacobian(const Twist& e) {
        const double x = e[0], y = e[1], w = e[2], c = spatial::half_cotangent_rest(w * w);
        const double turn = 1 - c * w * w;
        return {turn, -w / 2, y / 2 + c * w * x, w / 2, turn, -x / 2 + c * w * y, 0, 0, 1};
    }
    // The residual of g2o, [x, y, θ] of E, and its derivative as above (Kümmerle et al. 2011).
    static Twist g2o_residual(const Pose& pose) { return {pose.x, pose.y, std::atan2(pose.s, pose.c)}; }
    static Square g2o_jacobian(const Pose& pose) { return {pose.c, -pose.s, 0, pose.s, pose.c, 0, 0, 0, 1}; }
    // The residual of the chordal problem, [x, y, 2 sin(θ/2)], and its derivative.
    static Twist chordal_residual(const Pose& pose) {
        return {pose.x, pose.y, 2 * std::sin(std::atan2(pose.s, pose.c) / 2)};
    }
    static Square chordal_jacobian(const Pose& pose) {
        const double half = std::cos(std::atan2(pose.s, pose.c) / 2);
        return {pose.c, -pose.s, 0, pose.s, pose.c, 0, 0, 0, half};
    }
    // The adjoint of X on twists.
    static Square adjoint(const Pose& pose) {
        return {pose.c, -pose.s, pose.y, pose.s, pose.c, -pose.x, 0, 0, 1};
    }
    static Point to_base(const Pose& pose, const Point& point) {
        const double x = point[0] - pose.x, y = point[1] - pose.y;
        return {pose.c * x + pose.s * y, pose.c * y - pose.s * x};
    }
    static Point to_map(const Pose& pose, const Point& point) {
        return {pose.x + pose.c * point[0] - pose.s * point[1],
                pose.y + pose.s * point[0] + pose.c * point[1]};
    }
    // d h / dξ of h = X⁻¹ l, and d h / dl.
    static PointByPose point_by_pose(const Point& h) { return {-1, 0, h[1], 0, -1, -h[0]}; }
    static PointSquare point_by_point(const Pose& pose) { return {pose.c, pose.s, -pose.s, pose.c}; }

    // The linear relaxation: a complex number r for the rotation, and the position, in one column of
    // unknowns.
    static constexpr int relaxed = 4, relaxed_point = 2, rotation_part = 2, right_sides = 1;
    // x_j = A x_i of an exact measurement.
    static std::array<double, 16> relaxed_motion(const Pose& z) {
        return {z.c, -z.s, 0, 0, z.s, z.c, 0, 0, z.x, -z.y, 1, 0, z.y, z.x, 0, 1};
    }
    static void write_relaxed(const Pose& pose, double* to) {
        to[0] = pose.c, to[1] = pose.s, to[2] = pose.x, to[3] = pose.y;
    }
    static Pose read_relaxed(const double* from) {
        const double length = std::hypot(from[0], from[1]);
        if (!(length > 0)) return {from[2], from[3], 1, 0};
        return {from[2], from[3], from[0] / length, from[1] / length};
    }
    static Pose with_position(const Pose& pose, const Point& at) { return {at[0], at[1], pose.c, pose.s}; }
    static Point position(const Pose& pose) { return {pose.x, pose.y}; }
    static Point rotate(const Pose& pose, const Point& p) {
        return {pose.c * p[0] - pose.s * p[1], pose.s * p[0] + pose.c * p[1]};
    }
};

}  // namespace cspace::localization
