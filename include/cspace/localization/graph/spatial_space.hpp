// Poses in space as the variables of a graph: composition, exponential and logarithm of SE(3) and their
// derivatives (Barfoot 2017, "State Estimation for Robotics", section 7.1).
//
// Twists are [v; ω] in the frame of the base: X becomes X exp ξ. Matrices are stored row by row.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/math/symmetric_eigen.hpp"
#include "cspace/spatial/left_jacobian.hpp"
#include "cspace/spatial/rotation.hpp"

namespace cspace::localization {

struct SpatialSpace {
    static constexpr int dimension = 3, freedom = 6, pose_numbers = 16;
    using Twist = std::array<double, 6>;
    using Square = std::array<double, 36>;
    using Point = std::array<double, 3>;
    using PointSquare = std::array<double, 9>;
    using PointByPose = std::array<double, 18>;
    using Pose = Posed;

    static Pose read_pose(const double* from) {
        Pose pose;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) pose.R.m[i][j] = from[4 * i + j];
        }
        pose.t = {from[3], from[7], from[11]};
        return pose;
    }
    static void write_pose(const Pose& pose, double* to) {
        const double t[3] = {pose.t.x, pose.t.y, pose.t.z};
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) to[4 * i + j] = pose.R.m[i][j];
            to[4 * i + 3] = t[i], to[12 + i] = 0;
        }
        to[15] = 1;
    }
    static Pose compose(const Pose& a, const Pose& b) { return a * b; }
    static Pose inverse(const Pose& a) { return cspace::inverse(a); }
    static Pose between(const Pose& a, const Pose& b) {
        return {transpose(a.R) * b.R, transpose_times(a.R, b.t - a.t)};
    }
    static Mat3d skew(const Vec3d& w) { return {{{0, -w.z, w.y}, {w.z, 0, -w.x}, {-w.y, w.x, 0}}}; }
    static Pose exponential(const double* twist) {
        const Vec3d v{twist[0], twist[1], twist[2]}, w{twist[3], twist[4], twist[5]};
        return {spatial::rotation_of_rotvec(w), spatial::left_jacobian_times(w, v)};
    }
    static Twist logarithm(const Pose& pose) {
        const Vec3d w = spatial::rotvec_of_rotation(pose.R);
        const Vec3d v = spatial::left_jacobian_inverse_times(w, pose.t);
        return {v.x, v.y, v.z, w.x, w.y, w.z};
    }
    // A step of a rotation that has lost digits: R (3 I − RᵀR) / 2 halves their number (Higham 1986).
    static Mat3d straighten(const Mat3d& R) {
        Mat3d rest = transpose(R) * R;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) rest.m[i][j] = (i == j ? 1.5 : 0.0) - 0.5 * rest.m[i][j];
        }
        return R * rest;
    }
    static Pose move(const Pose& pose, const double* twist) {
        const Pose moved = pose * exponential(twist);
        return {straighten(moved.R), moved.t};
    }
    // d log(X exp ξ) / dξ by the products of [w] and [v]; see Barfoot 2017, equation 7.86.
    static Square log_jacobian(const Twist& e) {
        // The right Jacobian at e is the left one at −e.
        const Vec3d v{-e[0], -e[1], -e[2]}, w{-e[3], -e[4], -e[5]};
        const double square = dot(w, w), rest = spatial::half_cotangent_rest(square);
        const auto factors = spatial::left_jacobian_factors(square);
        const auto slopes = spatial::left_jacobian_slopes(square, factors);
        const double first = factors.g, second = slopes.f + 0.5 * factors.g, third = -slopes.g;
        const Mat3d V = skew(v), W = skew(w), WW = W * W, WV = W * V, VW = V * W, WVW = WV * W;
        const Mat3d WWV = W * WV, VWW = VW * W, WVWW = WVW * W, WWVW = W * WVW;
        Mat3d inverse, Q;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                inverse.m[i][j] = (i == j) - 0.5 * W.m[i][j] + rest * WW.m[i][j];
                Q.m[i][j] = 0.5 * V.m[i][j] + first * (WV.m[i][j] + VW.m[i][j] + WVW.m[i][j]) +
                            second * (WWV.m[i][j] + VWW.m[i][j] - 3 * WVW.m[i][j]) +
                            third * (WVWW.m[i][j] + WWVW.m[i][j]);
            }
        }
        const Mat3d coupled = inverse * Q * inverse;
        Square J{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                J[6 * i + j] = J[6 * (i + 3) + j + 3] = inverse.m[i][j];
                J[6 * i + j + 3] = -coupled.m[i][j];
            }
        }
        return J;
    }
    // The unit quaternion (w, x, y, z) of a rotation, w ≥ 0 (Shepperd 1978).
    static std::array<double, 4> quaternion(const Mat3d& R) {
        const double trace = R.m[0][0] + R.m[1][1] + R.m[2][2];
        const std::array<double, 4> squares = {1 + trace, 1 + 2 * R.m[0][0] - trace,
                                               1 + 2 * R.m[1][1] - trace, 1 + 2 * R.m[2][2] - trace};
        std::size_t largest = 0;
        for (std::size_t k = 1; k < 4; ++k) largest = squares[k] > squares[largest] ? k : largest;
        const Vec3d axis = 2.0 * spatial::sine_of(R);
        const double a = axis.x, b = axis.y, c = axis.z;
        const double xy = R.m[0][1] + R.m[1][0], xz = R.m[0][2] + R.m[2][0], yz = R.m[1][2] + R.m[2][1];
        const std::array<std::array<double, 4>, 4> rows = {{{squares[0], a, b, c},
                                                            {a, squares[1], xy, xz},
                                                            {b, xy, squares[2], yz},
                                                            {c, xz, yz, squares[3]}}};
        std::array<double, 4> q = rows[largest];
        const double scale = (q[0] < 0 ? -0.5 : 0.5) / std::sqrt(squares[largest]);
        for (double& each : q) each *= scale;
        return q;
    }
    // The residual of g2o, translation and vector of the unit quaternion, and its derivative.
    static Twist g2o_residual(const Pose& pose) {
        const auto q = quaternion(pose.R);
        return {pose.t.x, pose.t.y, pose.t.z, q[1], q[2], q[3]};
    }
    static Square g2o_jacobian(const Pose& pose) {
        const auto q = quaternion(pose.R);
        const Mat3d S = skew({q[1], q[2], q[3]});
        Square J{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                J[6 * i + j] = pose.R.m[i][j];
                J[6 * (i + 3) + j + 3] = 0.5 * ((i == j ? q[0] : 0.0) + S.m[i][j]);
            }
        }
        return J;
    }
    // The residual of the chordal problem: the vector of the quaternion counts twice.
    static Twist chordal_residual(const Pose& pose) {
        Twist e = g2o_residual(pose);
        for (std::size_t k = 3; k < 6; ++k) e[k] *= 2;
        return e;
    }
    static Square chordal_jacobian(const Pose& pose) {
        Square J = g2o_jacobian(pose);
        for (std::size_t k = 18; k < 36; ++k) J[k] *= 2;
        return J;
    }
    static Square adjoint(const Pose& pose) {
        const Mat3d TR = skew(pose.t) * pose.R;
        Square A{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                A[6 * i + j] = A[6 * (i + 3) + j + 3] = pose.R.m[i][j];
                A[6 * i + j + 3] = TR.m[i][j];
            }
        }
        return A;
    }
    static Vec3d vector_of(const Point& p) { return {p[0], p[1], p[2]}; }
    static Point point_of(const Vec3d& p) { return {p.x, p.y, p.z}; }
    static Point to_base(const Pose& pose, const Point& point) {
        return point_of(transpose_times(pose.R, vector_of(point) - pose.t));
    }
    static Point to_map(const Pose& pose, const Point& point) { return point_of(pose * vector_of(point)); }
    static PointByPose point_by_pose(const Point& h) {
        return {-1, 0, 0, 0, -h[2], h[1], 0, -1, 0, h[2], 0, -h[0], 0, 0, -1, -h[1], h[0], 0};
    }
    static PointSquare point_by_point(const Pose& pose) {
        PointSquare J;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) J[3 * i + j] = pose.R.m[j][i];
        }
        return J;
    }

    // The linear relaxation: row k of the rotation and coordinate k of the position are unknowns of the right
    // side k.
    static constexpr int relaxed = 4, relaxed_point = 1, rotation_part = 3, right_sides = 3;
    static std::array<double, 16> relaxed_motion(const Pose& z) {
        const auto& R = z.R.m;
        return {R[0][0], R[1][0], R[2][0], 0, R[0][1], R[1][1], R[2][1], 0,
                R[0][2], R[1][2], R[2][2], 0, z.t.x,   z.t.y,   z.t.z,   1};
    }
    static void write_relaxed(const Pose& pose, double* to) {
        const double t[3] = {pose.t.x, pose.t.y, pose.t.z};
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < 3; ++j) to[4 * k + j] = pose.R.m[k][j];
            to[4 * k + 3] = t[k];
        }
    }
    static Pose read_relaxed(const double* from) {
        Mat3d M;
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < 3; ++j) M.m[k][j] = from[4 * k + j];
        }
        return {nearest_rotation(M), {from[3], from[7], from[11]}};
    }
    // The rotation with the largest trace of RᵀM, from the eigenvector of Horn's matrix (Horn 1987).
    static Mat3d nearest_rotation(const Mat3d& M) {
        const auto& m = M.m;
        const Vec3d axis = 2.0 * spatial::sine_of(M);
        const double a = axis.x, b = axis.y, c = axis.z;
        const double xy = m[0][1] + m[1][0], xz = m[0][2] + m[2][0], yz = m[1][2] + m[2][1];
        const SymmetricEigen found = decompose_symmetric(
            {m[0][0] + m[1][1] + m[2][2], a, b, c, a, m[0][0] - m[1][1] - m[2][2], xy, xz, b, xy,
             m[1][1] - m[0][0] - m[2][2], yz, c, xz, yz, m[2][2] - m[0][0] - m[1][1]},
            4);
        std::size_t largest = 0;
        for (std::size_t k = 1; k < 4; ++k) largest = found.values[k] > found.values[largest] ? k : largest;
        const double* const q = found.vectors.data() + 4 * largest;
        return spatial::rotation_of_quaternion(q[0], Vec3d{q[1], q[2], q[3]}, 1.0);
    }
    static Pose with_position(const Pose& pose, const Point& at) { return {pose.R, vector_of(at)}; }
    static Point position(const Pose& pose) { return point_of(pose.t); }
    static Point rotate(const Pose& pose, const Point& p) { return point_of(pose.R * vector_of(p)); }
};

}  // namespace cspace::localization
