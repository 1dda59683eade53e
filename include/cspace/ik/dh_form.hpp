// Six revolute joints in standard Denavit–Hartenberg form, the shape in which the closed forms are written:
//   T_base_tip = base · Π_i Rz(t_i) Tz(d_i) Tx(a_i) Rx(α_i) · tool,   t_i = q_i + offset_i,
// with d_1 = d_6 = a_6 = α_6 = 0 (moved into base and tool) and d_i = 0 where axes i−1 and i are parallel.
// Relations that hold within tolerance::axis_relation are made exact; `deviation` is the resulting change.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/math/turn.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

struct DhForm {
    double a[6], d[6], ca[6], sa[6], offset[6];
    bool parallel[5];  // axes i and i+1
    bool meeting[5];   // axes i and i+1 intersect (and are not parallel)
    Posed base, tool;
    double length = 1;        // characteristic length of the arm [m]
    double deviation = 0;     // largest difference between this form and the true chain [m/length, rad]
    bool degenerate = false;  // two adjacent axes coincide: the arm is redundant
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The common normal of two axes: its direction and its feet on both.
struct CommonNormal {
    Vec3d x;         // unit, from axis i towards axis i+1
    Vec3d from, to;  // feet on axis i and on axis i+1
    double a;        // distance between the feet [m]
};

// `start` is the point on axis i that becomes the foot if the axes are parallel.
inline CommonNormal common_normal(const Vec3d& z1, const Vec3d& p1, const Vec3d& z2, const Vec3d& p2,
                                  bool is_parallel, const Vec3d& start) {
    if (is_parallel) {
        const Vec3d across = (p2 - start) - dot(p2 - start, z1) * z1;
        const double a = norm(across);
        const Vec3d x = a > 0 ? (1 / a) * across : Vec3d{1, 0, 0};
        return {x, start, start + across, a};
    }
    const Vec3d n = cross(z1, z2);
    const double sine2 = dot(n, n);
    const Vec3d gap = p2 - p1;
    const Vec3d from = p1 + (dot(cross(gap, z2), n) / sine2) * z1;
    const Vec3d to = p2 + (dot(cross(gap, z1), n) / sine2) * z2;
    Vec3d x = (1 / std::sqrt(sine2)) * n;
    double a = dot(to - from, x);
    if (a < 0) {
        a = -a;
        x = -x;
    }
    return {x, from, to, a};
}

inline double angle_about(const Vec3d& z, const Vec3d& from, const Vec3d& to) {
    return std::atan2(dot(z, cross(from, to)), dot(from, to));
}

inline Posed frame_at(const Vec3d& origin, const Vec3d& x, const Vec3d& z) {
    return {from_columns(x, cross(z, x), z), origin};
}

// Rz(t) Tz(d) Tx(a) Rx(α) of joint i.
inline Posed link_pose(const DhForm& f, int i, const Turn<double>& t) {
    return {
        {{{t.c, -t.s * f.ca[i], t.s * f.sa[i]}, {t.s, t.c * f.ca[i], -t.c * f.sa[i]}, {0, f.sa[i], f.ca[i]}}},
        {f.a[i] * t.c, f.a[i] * t.s, f.d[i]}};
}
inline Posed dh_forward(const DhForm& f, const double* q) {
    Posed T = f.base;
    for (int i = 0; i < 6; ++i) T = T * link_pose(f, i, turn_by(q[i] + f.offset[i]));
    return T * f.tool;
}

// Largest entry of the difference of two poses, translations divided by `length`.
inline double pose_difference(const Posed& A, const Posed& B, double length) {
    double worst = norm(A.t - B.t) / length;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) worst = max(worst, std::fabs(A.R.m[i][j] - B.R.m[i][j]));
    return worst;
}

// Generic configurations, spread over the circle without a pattern, so that measurements do not depend on a
// special configuration.
inline void spread_configuration(int k, int n, double* q) {
    for (int i = 0; i < n; ++i) {
        const double turns = 0.5 + (k + 1) * 0.6180339887498949 * (i + 1) + 0.7548776662466927 * i * i;
        q[i] = pi * (2 * (turns - std::floor(turns)) - 1);
    }
}

inline double measure_deviation(const Chain& chain, const DhForm& f) {
    double worst = 0;
    for (int k = 0; k < 8; ++k) {
        double q[6];
        spread_configuration(k, 6, q);
        worst = max(worst, pose_difference(forward_kinematics(chain, q), dh_forward(f, q), f.length));
    }
    return worst;
}

// Requires six revolute joints.
inline DhForm dh_form(const Chain& chain) {
    DhForm f{};
    f.length = characteristic_length(chain);
    Vec3d z[6];
    CommonNormal normal[5];
    z[0] = chain.axis[0];
    Vec3d start = chain.point[0];
    for (int i = 0; i < 5; ++i) {
        z[i + 1] = chain.axis[i + 1];
        const double sine = norm(cross(chain.axis[i], chain.axis[i + 1]));
        const double cosine = dot(chain.axis[i], chain.axis[i + 1]);
        f.parallel[i] = sine < tolerance::axis_relation;
        if (f.parallel[i]) z[i + 1] = cosine > 0 ? z[i] : -z[i];
        // A parallel first pair takes its foot where the next normal will start, which leaves d_2 = 0.
        if (i == 0 && f.parallel[0]) {
            const CommonNormal next = common_normal(
                chain.axis[1], chain.point[1], chain.axis[2], chain.point[2],
                norm(cross(chain.axis[1], chain.axis[2])) < tolerance::axis_relation, chain.point[1]);
            start = chain.point[0] + dot(next.from - chain.point[0], z[0]) * z[0];
        }
        normal[i] = common_normal(z[i], chain.point[i], z[i + 1], chain.point[i + 1], f.parallel[i], start);
        start = normal[i].to;
        const bool touching = normal[i].a < tolerance::axis_relation * f.length;
        f.meeting[i] = touching && !f.parallel[i];
        f.degenerate |= touching && f.parallel[i];
        f.a[i] = touching ? 0 : normal[i].a;
        const double alpha = f.parallel[i] ? (cosine > 0 ? 0 : pi) : angle_about(normal[i].x, z[i], z[i + 1]);
        f.ca[i] = f.parallel[i] ? (cosine > 0 ? 1 : -1) : std::cos(alpha);
        f.sa[i] = f.parallel[i] ? 0 : std::sin(alpha);
    }
    for (int i = 1; i < 5; ++i) {
        f.d[i] = dot(normal[i].from - normal[i - 1].to, z[i]);
        if (std::fabs(f.d[i]) < tolerance::axis_relation * f.length) f.d[i] = 0;
        f.offset[i] = angle_about(z[i], normal[i - 1].x, normal[i].x);
    }
    f.ca[5] = 1;
    f.base = frame_at(normal[0].from, normal[0].x, z[0]);
    // The tool closes the chain exactly at zero.
    f.tool = identity_pose();
    const double zero[6] = {};
    f.tool = inverse(dh_forward(f, zero)) * chain.tip;
    f.deviation = measure_deviation(chain, f);
    return f;
}

}  // namespace cspace::ik::inline CSPACE_ISA
