// What the kernels of dynamics share: their arguments in lanes, and the torques behind a motion.
#pragma once

#include "cspace/dynamics/inverse_dynamics.hpp"
#include "cspace/math/float_packs.hpp"
#include "dynamics.hpp"
#include "kinematics_memory.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

using kinematics::Scratch;
using kinematics::take_array;

// One pack of arguments. The values of the joints stand behind those of a floating base.
template <class V>
struct Arguments {
    const V *q, *qd, *force;  // qd and force: null where not given
    V* result;
    Pose<V> T;  // of the base
    Mat3<V> R;  // its axes in those of the world
    AppliedWrenches<V> wrenches;
    int n, first, dof;
};

// Rows i to i + count of an array with `width` values each, in lanes; one row alone is read in place. Null
// for null.
template <class V>
CSPACE_INLINE const V* read_rows(const scalar_of<V>* values, std::size_t i, int count, int width,
                                 Scratch& scratch) {
    if (!values) return nullptr;
    values += i * std::size_t(width);
    if constexpr (Lanes<V>::count == 1) {
        return values;
    } else {
        V* lanes = take_array<V>(scratch, width);
        load_rows(values, std::size_t(width), count, width, lanes);
        return lanes;
    }
}
// Whether all are finite; floats, of which angles may be among them, also no larger than their sines allow.
template <class V>
CSPACE_INLINE bool finite_rows(const V* values, int width, bool angles = false) {
    if (!values) return true;
    if constexpr (std::is_same_v<scalar_of<V>, double>) {
        return kinematics::all_finite(values, width);
    } else {
        mask_of<V> fits = fill_lanes<V>(0.0) == 0.0f;
        for (int i = 0; i < width; ++i)
            fits = fits && (angles ? and_bits(values[i], 0x7fffffffu) < largest_float_angle
                                   : values[i] * 0.0f == 0.0f);
        return all(fits);
    }
}
template <class V>
CSPACE_INLINE Vec3<V> vector_at(const V* values) {
    return {values[0], values[1], values[2]};
}
template <class V>
CSPACE_INLINE void set_vector(V* values, const Vec3<V>& a) {
    values[0] = a.x;
    values[1] = a.y;
    values[2] = a.z;
}
template <class V>
CSPACE_INLINE Pose<V> read_base(const scalar_of<V>* matrix, std::size_t stride, int count) {
    if (!matrix) return fill_pose<V>(identity_pose());
    V m[16];
    load_rows(matrix, stride, count, 16, m);
    return kinematics::read_matrix(m);
}

// The wrenches on links, those in the axes of the world in the axes of the base.
template <class V>
CSPACE_INLINE AppliedWrenches<V> read_wrenches(const BasicRows<scalar_of<V>>& rows, std::size_t i, int count,
                                               const Mat3<V>& R, Scratch& scratch) {
    if (rows.n_wrenches == 0) return {};
    auto* list = take_array<AppliedWrench<V>>(scratch, rows.n_wrenches);
    for (int k = 0; k < rows.n_wrenches; ++k) {
        const BasicPush<scalar_of<V>>& push = rows.wrenches[k];
        V numbers[6];
        load_rows(push.values + i * push.stride, push.stride, count, 6, numbers);
        Vec3<V> f = vector_at(numbers), n = vector_at(numbers + 3);
        const Mat3<V> axes = push.in_frame_axes ? fill_mat3<V>(push.axes) : transpose(R);
        list[k] = {push.path, push.depth, push.in_frame_axes, fill_vec3<V>(push.point), {axes * f, axes * n}};
    }
    return {list, rows.n_wrenches};
}

// width: of the result. False if an argument is not finite.
template <class V>
CSPACE_INLINE bool read_arguments(const BasicRows<scalar_of<V>>& rows, Scratch& scratch, std::size_t i,
                                  int count, int width, Arguments<V>& given) {
    const int n = rows.bodies.n_coordinates, first = rows.floating ? 6 : 0, dof = first + n;
    const V* q = read_rows<V>(rows.q, i, count, n, scratch);
    const V* qd = read_rows<V>(rows.qd, i, count, dof, scratch);
    const V* force = read_rows<V>(rows.force, i, count, dof, scratch);
    V* result;
    if constexpr (Lanes<V>::count == 1)
        result = rows.result + i * std::size_t(width);
    else
        result = take_array<V>(scratch, width);
    const auto T = read_base<V>(rows.T_world_base + i * rows.base_stride, rows.base_stride, count);
    given = {q, qd, force, result, T, T.R, read_wrenches(rows, i, count, T.R, scratch), n, first, dof};
    const bool finite = finite_rows(q, n, true), moves = finite_rows(qd, dof),
               pushes = finite_rows(force, dof);
    return finite && moves && pushes;
}
// The result of a pack as rows.
template <class V>
CSPACE_INLINE void write_result(const BasicRows<scalar_of<V>>& rows, const Arguments<V>& given, std::size_t i,
                                int count, int width) {
    if constexpr (Lanes<V>::count > 1)
        store_rows(given.result, width, rows.result + i * std::size_t(width), std::size_t(width), count);
}

// How the base moves, in its axes, its acceleration less gravity. acceleration: of a floating base, or null.
template <class V>
CSPACE_INLINE Motion<V> base_motion(const BasicRows<scalar_of<V>>& rows, const Arguments<V>& given,
                                    const V* acceleration) {
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> rest = {zero, zero, zero};
    Motion<V> base = {rest, rest, -fill_vec3<V>(rows.gravity)};
    if (given.first && given.qd) base.w = transpose_times(given.R, vector_at(given.qd + 3));
    if (given.first && acceleration) {
        base.a = base.a + vector_at(acceleration);
        base.wd = transpose_times(given.R, vector_at(acceleration + 3));
    }
    base.a = transpose_times(given.R, base.a);
    return base;
}

// The velocities of the joints, zero where none are given.
template <class V>
CSPACE_INLINE const V* joint_rates(const Arguments<V>& given, Scratch& scratch) {
    if (given.qd) return given.qd + given.first;
    V* rest = take_array<V>(scratch, given.n);
    for (int j = 0; j < given.n; ++j) rest[j] = fill_lanes<V>(0.0);
    return rest;
}

// tau (dof,) of inverse dynamics, or with qdd null of zero acceleration.
template <class V>
CSPACE_INLINE void compute_torques(const BasicRows<scalar_of<V>>& rows, const Arguments<V>& given,
                                   const V* qdd, Scratch scratch, V* tau) {
    auto* links = take_array<LinkMotion<V>>(scratch, rows.bodies.n_links);
    const Motion<V> base = base_motion(rows, given, qdd);
    const Wrench<V> on_base = given.qd || qdd
                                  ? inverse_dynamics(rows.bodies, base, given.q, joint_rates(given, scratch),
                                                     qdd ? qdd + given.first : nullptr, rows.rubs, links,
                                                     tau + given.first, given.wrenches)
                                  : gravity_torques(rows.bodies, base.a, given.q, links, tau + given.first);
    if (!given.first) return;
    set_vector(tau, given.R * on_base.f);
    set_vector(tau + 3, given.R * on_base.n);
}

// Packs as wide as the registers; one row alone is computed without lanes.
template <class One, class Many>
CSPACE_INLINE bool over_rows(std::size_t begin, std::size_t end, std::size_t width, const One& one,
                             const Many& many) {
    if (end - begin == 1) return one(begin);
    for (std::size_t i = begin; i < end; i += width) {
        if (!many(i, end - i < width ? int(end - i) : int(width))) return false;
    }
    return true;
}
using Wide = Pack<native_width>;

}  // namespace cspace::dynamics::inline CSPACE_ISA
