// Inverse and forward dynamics and the mass matrix of one pack of rows, in doubles or floats.
#pragma once

#include "cspace/dynamics/forward_dynamics.hpp"
#include "cspace/dynamics/mass_matrix.hpp"
#include "cspace/math/linear.hpp"
#include "dynamics_arguments.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

template <class V>
bool inverse_pack(const BasicRows<scalar_of<V>>& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0);
    if (!read_arguments(rows, scratch, i, count, dof, given)) return false;
    compute_torques(rows, given, given.force, scratch, given.result);
    write_result(rows, given, i, count, dof);
    return true;
}

template <class V>
bool mass_pack(const BasicRows<scalar_of<V>>& rows, void* memory, std::size_t i, int count) {
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
bool solve_for_accelerations(const BasicRows<scalar_of<V>>& rows, const Arguments<V>& given, Scratch scratch,
                             V* qdd) {
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
        regular = regular && singular_inertia<V> * own[j] * row[j][j] < 1.0;
    solve_ldl(row, dof, qdd);
    return all(regular);
}

// The accelerations of a floating base and of the joints by articulated bodies.
template <class V>
CSPACE_INLINE bool give_way_to_torques(const BasicRows<scalar_of<V>>& rows, const Arguments<V>& given,
                                       Scratch scratch, V* qdd) {
    auto* links = take_array<LinkResponse<V>>(scratch, rows.bodies.n_links);
    Motion<V> base = base_motion(rows, given, static_cast<const V*>(nullptr));
    mask_of<V> regular;
    const V* tau = given.force + given.first;
    const Articulated<V> felt = articulate_bodies(rows.bodies, base.w, given.q, joint_rates(given, scratch),
                                                  tau, rows.rubs, links, regular, given.wrenches);
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
        set_vector(qdd, given.R * base.a + fill_vec3<V>(rows.gravity));
        set_vector(qdd + 3, given.R * base.wd);
    }
    find_accelerations(rows.bodies, base.a, base.wd, links, qdd + given.first);
    return all(regular);
}

template <class V>
bool forward_pack(const BasicRows<scalar_of<V>>& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0);
    if (!read_arguments(rows, scratch, i, count, dof, given)) return false;
    const bool regular = rows.bodies.shares ? solve_for_accelerations(rows, given, scratch, given.result)
                                            : give_way_to_torques(rows, given, scratch, given.result);
    write_result(rows, given, i, count, dof);
    return regular;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
