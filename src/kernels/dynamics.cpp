#include "dynamics.hpp"

#include "cspace/dynamics/coriolis.hpp"
#include "cspace/dynamics/derivatives.hpp"
#include "cspace/dynamics/forward_dynamics.hpp"
#include "cspace/dynamics/inverse_dynamics.hpp"
#include "cspace/dynamics/mass_matrix.hpp"
#include "cspace/dynamics/momentum.hpp"
#include "cspace/math/linear.hpp"
#include "kinematics_memory.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {
namespace {

using kinematics::Scratch;
using kinematics::take_array;

// One pack of arguments. The values of the joints stand behind those of a floating base.
template <class V>
struct Arguments {
    const V *q, *qd, *force;  // qd and force: null where not given
    V* result;
    Pose<V> T;  // of the base
    Mat3<V> R;  // its axes in those of the world
    int n, first, dof;
};

// Rows i to i + count of an array with `width` values each, in lanes; one row alone is read in place. Null
// for null.
template <class V>
CSPACE_INLINE const V* read_rows(const double* values, std::size_t i, int count, int width,
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
template <class V>
CSPACE_INLINE bool finite_rows(const V* values, int width) {
    return !values || kinematics::all_finite(values, width);
}

// width: of the result. False if an argument is not finite.
template <class V>
CSPACE_INLINE bool read_arguments(const Rows& rows, Scratch& scratch, std::size_t i, int count, int width,
                                  Arguments<V>& given) {
    const int n = rows.bodies.n_coordinates, first = rows.floating ? 6 : 0, dof = first + n;
    const V* q = read_rows<V>(rows.q, i, count, n, scratch);
    const V* qd = read_rows<V>(rows.qd, i, count, dof, scratch);
    const V* force = read_rows<V>(rows.force, i, count, dof, scratch);
    V* result;
    if constexpr (Lanes<V>::count == 1)
        result = rows.result + i * std::size_t(width);
    else
        result = take_array<V>(scratch, width);
    const auto T =
        kinematics::load_pose<V>(rows.T_world_base + i * rows.base_stride, rows.base_stride, count);
    given = {q, qd, force, result, T, T.R, n, first, dof};
    const bool finite = finite_rows(q, n), moves = finite_rows(qd, dof), pushes = finite_rows(force, dof);
    return finite && moves && pushes;
}
// The result of a pack as rows.
template <class V>
CSPACE_INLINE void write_result(const Rows& rows, const Arguments<V>& given, std::size_t i, int count,
                                int width) {
    if constexpr (Lanes<V>::count > 1)
        store_rows(given.result, width, rows.result + i * std::size_t(width), std::size_t(width), count);
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

// How the base moves, in its axes, its acceleration less gravity. acceleration: of a floating base, or null.
template <class V>
CSPACE_INLINE Motion<V> base_motion(const Rows& rows, const Arguments<V>& given, const V* acceleration) {
    const V zero = fill<V>(0.0);
    const Vec3<V> rest = {zero, zero, zero};
    Motion<V> base = {rest, rest, -fill3<V>(rows.gravity)};
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
    for (int j = 0; j < given.n; ++j) rest[j] = fill<V>(0.0);
    return rest;
}

// tau (dof,) of inverse dynamics, or with qdd null of zero acceleration.
template <class V>
CSPACE_INLINE void compute_torques(const Rows& rows, const Arguments<V>& given, const V* qdd, Scratch scratch,
                                   V* tau) {
    auto* links = take_array<LinkMotion<V>>(scratch, rows.bodies.n_links);
    const Motion<V> base = base_motion(rows, given, qdd);
    const Wrench<V> on_base =
        given.qd || qdd
            ? inverse_dynamics(rows.bodies, base, given.q, joint_rates(given, scratch),
                               qdd ? qdd + given.first : nullptr, rows.rubs, links, tau + given.first)
            : gravity_torques(rows.bodies, base.a, given.q, links, tau + given.first);
    if (!given.first) return;
    set_vector(tau, given.R * on_base.f);
    set_vector(tau + 3, given.R * on_base.n);
}

template <class V>
bool inverse_pack(const Rows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0);
    if (!read_arguments(rows, scratch, i, count, dof, given)) return false;
    compute_torques(rows, given, given.force, scratch, given.result);
    write_result(rows, given, i, count, dof);
    return true;
}

template <class V>
bool mass_pack(const Rows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0), size = dof * dof;
    if (!read_arguments(rows, scratch, i, count, size, given)) return false;
    auto* links = take_array<LinkComposite<V>>(scratch, rows.bodies.n_links);
    mass_matrix(rows.bodies, given.q, given.R, rows.floating, links, given.result);
    write_result(rows, given, i, count, size);
    return true;
}

// q̈ = M⁻¹ (τ − b) with the dense mass matrix, for coordinates that move several joints.
template <class V>
bool solve_for_accelerations(const Rows& rows, const Arguments<V>& given, Scratch scratch, V* qdd) {
    const int dof = given.dof;
    V* M = take_array<V>(scratch, dof * dof);
    V** row = take_array<V*>(scratch, (dof + 7) / 8 * 8);
    for (int r = 0; r < dof; ++r) row[r] = M + r * dof;
    V* own = take_array<V>(scratch, dof);
    mass_matrix(rows.bodies, given.q, given.R, rows.floating,
                take_array<LinkComposite<V>>(scratch, rows.bodies.n_links), M);
    compute_torques(rows, given, static_cast<const V*>(nullptr), scratch, qdd);
    for (int j = 0; j < dof; ++j) {
        qdd[j] = given.force[j] - qdd[j];
        own[j] = M[j * (dof + 1)];
    }
    mask_of<V> regular = factor_ldl(row, dof);
    for (int j = 0; j < dof; ++j)  // the inverse pivots stand on the diagonal
        regular = regular && tolerance::singular_inertia * own[j] * row[j][j] < 1.0;
    solve_ldl(row, dof, qdd);
    return all(regular);
}

// The accelerations of a floating base and of the joints by articulated bodies.
template <class V>
CSPACE_INLINE bool give_way_to_torques(const Rows& rows, const Arguments<V>& given, Scratch scratch, V* qdd) {
    auto* links = take_array<LinkResponse<V>>(scratch, rows.bodies.n_links);
    Motion<V> base = base_motion(rows, given, static_cast<const V*>(nullptr));
    mask_of<V> regular;
    const V* tau = given.force + given.first;
    const Articulated<V> felt =
        articulate(rows.bodies, base.w, given.q, joint_rates(given, scratch), tau, rows.rubs, links, regular);
    if (given.first) {
        const Mat3<V> A = to_matrix(felt.A), C = to_matrix(felt.C);
        V inertia[6][6], x[6];
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                inertia[r][c] = C.m[r][c];
                inertia[r][3 + c] = felt.B.m[c][r];
                inertia[3 + r][c] = felt.B.m[r][c];
                inertia[3 + r][3 + c] = A.m[r][c];
            }
        }
        set_vector(x, transpose_times(given.R, vector_at(given.force)) - felt.bias.f);
        set_vector(x + 3, transpose_times(given.R, vector_at(given.force + 3)) - felt.bias.n);
        regular = factor_ldl(inertia, 6) && regular;
        solve_ldl(inertia, 6, x);
        base.a = vector_at(x);
        base.wd = vector_at(x + 3);
        set_vector(qdd, given.R * base.a + fill3<V>(rows.gravity));
        set_vector(qdd + 3, given.R * base.wd);
    }
    accelerate(rows.bodies, base.a, base.wd, links, qdd + given.first);
    return all(regular);
}

template <class V>
bool forward_pack(const Rows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0);
    if (!read_arguments(rows, scratch, i, count, dof, given)) return false;
    const bool regular = rows.bodies.shares ? solve_for_accelerations(rows, given, scratch, given.result)
                                            : give_way_to_torques(rows, given, scratch, given.result);
    write_result(rows, given, i, count, dof);
    return regular;
}

template <class V>
bool spatial_pack(const Rows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0), square = dof * dof;
    const int sizes[] = {square, 2 * square, 6, 6 * dof, 1, 1};
    const int size = sizes[int(rows.what)];
    if (!read_arguments(rows, scratch, i, count, size, given)) return false;
    auto* links = take_array<SpatialLink<V>>(scratch, rows.bodies.n_links);
    const V zero = fill<V>(0.0);
    Twist<V> base = {{zero, zero, zero}, {zero, zero, zero}}, change = {-fill3<V>(rows.gravity), base.w};
    if (given.first && given.qd) base = {vector_at(given.qd), vector_at(given.qd + 3)};
    if (given.first && given.force) {
        change.v = change.v + vector_at(given.force);
        change.w = vector_at(given.force + 3);
    }
    change.v = change.v - cross(base.w, base.v);
    const bool slopes = rows.what == What::derivatives;
    const V* qd = given.qd ? given.qd + given.first : nullptr;
    const V* qdd = given.force ? given.force + given.first : nullptr;
    const SpatialBody<V> whole =
        place_links(rows.bodies, given.R, base, slopes ? &change : nullptr, given.q, qd, qdd, links);
    V* result = given.result;
    switch (rows.what) {
        case What::coriolis:
            coriolis_matrix(rows.bodies, base, rows.floating, links, whole, result);
            break;
        case What::derivatives:
            torque_derivatives(rows.bodies, base, change, rows.floating, rows.rubs, links, whole, result,
                               result + square);
            break;
        case What::momentum: {
            const Vec3<V> center = (1.0 / rows.bodies.mass) * whole.first;
            const Wrench<V> about = momentum_about(whole.momentum, center);
            set_vector(result, about.f);
            set_vector(result + 3, about.n);
            break;
        }
        case What::momentum_matrix:
            momentum_matrix(rows.bodies, rows.floating, links, whole, result);
            break;
        case What::kinetic:
            *result = kinetic_energy(rows.bodies, base, qd, links, whole);
            break;
        case What::potential:
            *result = potential_energy(rows.bodies, fill3<V>(rows.gravity), given.T.t, whole);
    }
    write_result(rows, given, i, count, size);
    return true;
}

// Packs as wide as the registers; one row alone is computed without lanes.
template <class One, class Many>
CSPACE_INLINE bool over_rows(std::size_t begin, std::size_t end, const One& one, const Many& many) {
    constexpr std::size_t width = native_width;
    if (end - begin == 1) return one(begin);
    for (std::size_t i = begin; i < end; i += width) {
        if (!many(i, end - i < width ? int(end - i) : int(width))) return false;
    }
    return true;
}

}  // namespace

using Wide = Pack<native_width>;

bool inverse_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, [&](std::size_t i) { return inverse_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return inverse_pack<Wide>(rows, memory, i, count); });
}
bool mass_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, [&](std::size_t i) { return mass_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return mass_pack<Wide>(rows, memory, i, count); });
}
bool spatial_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, [&](std::size_t i) { return spatial_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return spatial_pack<Wide>(rows, memory, i, count); });
}
bool forward_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, [&](std::size_t i) { return forward_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return forward_pack<Wide>(rows, memory, i, count); });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
