// The equations of closed loops at one configuration: φ(q) = 0, its derivative K, and the part k of
// φ̈ = K q̈ + k that velocities cause (Featherstone 2008, chapter 8).
#pragma once

#include <cmath>

#include "cspace/kinematics/forward.hpp"
#include "cspace/kinematics/loop_places.hpp"

namespace cspace::kinematics::inline CSPACE_ISA {

// Where joints and loops are, in axes of the base.
inline void place_loops(const ClosedLoops& loops, const double* q, LoopPlaces& places) {
    for (int k = 0; k < loops.n_joints; ++k) {
        const LoopJoint& joint = loops.joints[k];
        const double value = joint.ratio * q[joint.coordinate] + joint.offset;
        const Posed before = joint.parent < 0 ? joint.before : places.joints[joint.parent] * joint.before;
        places.joints[k] = move_joint(before, !joint.turns, value);
    }
    for (int l = 0; l < loops.n_loops; ++l) {
        int side = 0;
        for (const LoopEnd* end : {&loops.loops[l].a, &loops.loops[l].b})
            places.ends[2 * l + side++] =
                end->joint < 0 ? end->place : places.joints[end->joint] * end->place;
    }
}

// The child frame as seen from the parent frame.
inline Posed relative_place(const LoopPlaces& places, int loop) {
    const Posed &A = places.ends[2 * loop], &B = places.ends[2 * loop + 1];
    return {transpose(A.R) * B.R, transpose_times(A.R, B.t - A.t)};
}
inline double sum_of_products(const Mat3d& A, const Mat3d& B) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += A.m[i][j] * B.m[i][j];
    return sum;
}

// Whether a loop is nearer to a place upside down.
inline bool is_turned_over(const ClosedLoops& loops, const LoopPlaces& places, int loop) {
    const Loop& each = loops.loops[loop];
    return each.is_signed && sum_of_products(each.upright, relative_place(places, loop).R) <= 0.0;
}
// φ (n_rows,).
inline void find_residual(const ClosedLoops& loops, const LoopPlaces& places, double* phi) {
    for (int r = 0; r < loops.n_rows; ++r) {
        const LoopRow& row = loops.rows[r];
        const Posed B = relative_place(places, row.loop);
        phi[r] = row.rod > 0.0 ? (dot(B.t, B.t) - row.rod * row.rod) / (2.0 * row.rod)
                               : dot(row.P, B.t) + sum_of_products(row.C, B.R);
    }
}
// The size of φ without units.
inline double residual_size(const ClosedLoops& loops, const double* phi) {
    double sum = 0.0;
    for (int r = 0; r < loops.n_rows; ++r) sum += std::pow(loops.rows[r].scale * phi[r], 2);
    return std::sqrt(sum);
}

// The wrench [f; n] of a row at the origin of B, in axes of the base.
inline void find_row_wrench(const LoopRow& row, const LoopPlaces& places, Vec3d& f, Vec3d& n) {
    const Posed B = relative_place(places, row.loop);
    const Mat3d G = B.R * transpose(row.C);
    const Mat3d& R = places.ends[2 * row.loop].R;
    f = R * (row.rod > 0.0 ? (1.0 / row.rod) * B.t : row.P);
    n = R * Vec3d{G.m[1][2] - G.m[2][1], G.m[2][0] - G.m[0][2], G.m[0][1] - G.m[1][0]};
}
// K (n_rows, dof).
inline void find_loop_jacobian(const ClosedLoops& loops, const LoopPlaces& places, double* K) {
    for (int r = 0; r < loops.n_rows; ++r) {
        double* const to = K + r * loops.dof;
        for (int j = 0; j < loops.dof; ++j) to[j] = 0.0;
        const LoopRow& row = loops.rows[r];
        Vec3d f, n;
        find_row_wrench(row, places, f, n);
        const Vec3d& p = places.ends[2 * row.loop + 1].t;
        const signed char* const sides = loops.sides + row.loop * loops.n_joints;
        for (int k = 0; k < loops.n_joints; ++k) {
            if (!sides[k]) continue;
            const LoopJoint& joint = loops.joints[k];
            const Vec3d axis = matrix_column(places.joints[k].R, 2);
            const double along = joint.turns ? dot(axis, n + cross(p - places.joints[k].t, f)) : dot(axis, f);
            to[joint.column] += sides[k] * joint.ratio * along;
        }
    }
}

// The motions of all bodies at velocities qd (dof,).
inline void find_loop_motions(const ClosedLoops& loops, const double* qd, LoopPlaces& places) {
    const Vec3d none = {0.0, 0.0, 0.0};
    for (int k = 0; k < loops.n_joints; ++k) {
        const LoopJoint& joint = loops.joints[k];
        const Vec3d axis = (joint.ratio * qd[joint.column]) * matrix_column(places.joints[k].R, 2);
        const Vec3d w = joint.turns ? axis : none, v = joint.turns ? cross(places.joints[k].t, axis) : axis;
        const LoopMotion before =
            joint.parent < 0 ? LoopMotion{none, none, none, none} : places.motions[joint.parent];
        LoopMotion& after = places.motions[k];
        after.w = before.w + w;
        after.v = before.v + v;
        after.alpha = before.alpha + cross(after.w, w);
        after.a = before.a + cross(after.w, v) + cross(after.v, w);
    }
}
// How the frame of an end moves: w, alpha and the velocity v and acceleration a of its origin.
inline LoopMotion find_end_motion(const LoopPlaces& places, const LoopEnd& end, const Vec3d& p) {
    const Vec3d none = {0.0, 0.0, 0.0};
    if (end.joint < 0) return {none, none, none, none};
    const LoopMotion& body = places.motions[end.joint];
    const Vec3d v = body.v + cross(body.w, p);
    return {body.w, v, body.alpha, body.a + cross(body.alpha, p) + cross(body.w, v)};
}
// [alpha]× + [w]×², the second derivative of a rotation.
inline Mat3d bend_of(const LoopMotion& motion) {
    const Vec3d &w = motion.w, &e = motion.alpha;
    const double square = dot(w, w);
    return {{{w.x * w.x - square, w.x * w.y - e.z, w.x * w.z + e.y},
             {w.y * w.x + e.z, w.y * w.y - square, w.y * w.z - e.x},
             {w.z * w.x - e.y, w.z * w.y + e.x, w.z * w.z - square}}};
}
inline Mat3d cross_matrix(const Vec3d& w) { return {{{0, -w.z, w.y}, {w.z, 0, -w.x}, {-w.y, w.x, 0}}}; }

// The first and the second derivative of d, and the second of D, of a loop.
struct LoopRates {
    Vec3d d1, d2;
    Mat3d D2;
};
inline LoopRates find_loop_rates(const ClosedLoops& loops, const LoopPlaces& places, int l) {
    const Posed &A = places.ends[2 * l], &B = places.ends[2 * l + 1];
    const LoopMotion a = find_end_motion(places, loops.loops[l].a, A.t);
    const LoopMotion b = find_end_motion(places, loops.loops[l].b, B.t);
    const Vec3d dp = B.t - A.t, dv = b.v - a.v, da = b.a - a.a;
    const Mat3d back = cross_matrix(-a.w), bend_a = transpose(bend_of(a)), bend_b = bend_of(b);
    const Mat3d mixed = back * cross_matrix(b.w);
    Mat3d sum;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum.m[i][j] = bend_a.m[i][j] + 2.0 * mixed.m[i][j] + bend_b.m[i][j];
    return {transpose_times(A.R, back * dp + dv), transpose_times(A.R, bend_a * dp + 2.0 * (back * dv) + da),
            transpose(A.R) * sum * B.R};
}
// k (n_rows,) at velocities qd (dof,).
inline void find_loop_bias(const ClosedLoops& loops, const double* qd, LoopPlaces& places, double* k) {
    find_loop_motions(loops, qd, places);
    for (int r = 0; r < loops.n_rows; ++r) {
        const LoopRow& row = loops.rows[r];
        const LoopRates rates = find_loop_rates(loops, places, row.loop);
        k[r] = row.rod > 0.0
                   ? (dot(rates.d1, rates.d1) + dot(relative_place(places, row.loop).t, rates.d2)) / row.rod
                   : dot(row.P, rates.d2) + sum_of_products(row.C, rates.D2);
    }
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
