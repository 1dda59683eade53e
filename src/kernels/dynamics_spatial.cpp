// What is computed in common axes; see spatial_links.hpp.
#include <cstdint>
#include <cstring>

#include "cspace/dynamics/coriolis.hpp"
#include "cspace/dynamics/derivatives.hpp"
#include "cspace/dynamics/momentum.hpp"
#include "cspace/dynamics/sparse_factor.hpp"
#include "cspace/tolerances.hpp"
#include "dynamics_arguments.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {
namespace {

// The columns of `slopes` (3, n, n) and of the identity beside each other in rows of packs, and back.
CSPACE_INLINE void copy_columns(double* matrices, int n, int step, double* beside, bool back) {
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < 3; ++k) {
            double *own = matrices + (k * n + i) * n, *other = beside + i * step + k * n;
            std::memcpy(back ? own : other, back ? other : own, sizeof(double) * std::size_t(n));
        }
    }
}
// The derivatives of torques (3, n, n) become those of the accelerations that they cause: −M⁻¹ ∂τ and M⁻¹.
template <class V>
CSPACE_INLINE bool respond(V* slopes, int n, Scratch scratch) {
    const int square = n * n;
    V *M = slopes + 2 * square, *L = take_array<V>(scratch, square);
    for (int i = 0; i < square; ++i) {
        L[i] = M[i];
        M[i] = fill<V>(0.0);
        slopes[i] = -slopes[i];
        slopes[square + i] = -slopes[square + i];
    }
    for (int i = 0; i < n; ++i) M[i * (n + 1)] = fill<V>(1.0);
    const SparseFactor<V> factor = {
        n, L, take_array<int>(scratch, square), take_array<int>(scratch, n), take_array<int>(scratch, square),
        take_array<int>(scratch, n)};
    const bool regular = all(factor_sparse(factor, tolerance::singular_inertia));
    if constexpr (Lanes<V>::count == 1) {
        const int packs = (3 * n + native_width - 1) / native_width;
        const std::size_t beyond = reinterpret_cast<std::uintptr_t>(scratch.next) % sizeof(Wide);
        if (beyond) scratch.next += sizeof(Wide) - beyond;
        Wide* beside = take_array<Wide>(scratch, n * packs);
        for (int i = 0; i < n; ++i) beside[(i + 1) * packs - 1] = fill<Wide>(0.0);
        copy_columns(slopes, n, packs * native_width, reinterpret_cast<double*>(beside), false);
        solve_sparse(factor, beside, packs);
        copy_columns(slopes, n, packs * native_width, reinterpret_cast<double*>(beside), true);
    } else {
        for (int k = 0; k < 3; ++k) solve_sparse(factor, slopes + k * square, n);
    }
    return regular;
}

template <class V>
bool spatial_pack(const Rows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0), square = dof * dof;
    const int sizes[] = {square, 3 * square, 3 * square, 6, 6 * dof, 1, 1};
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
    const bool slopes = rows.what == What::derivatives || rows.what == What::responses;
    const V* qd = given.qd ? given.qd + given.first : nullptr;
    const V* qdd = given.force ? given.force + given.first : nullptr;
    const SpatialBody<V> whole =
        place_links(rows.bodies, given.R, base, slopes ? &change : nullptr, given.q, qd, qdd, links);
    V* result = given.result;
    bool regular = true;
    switch (rows.what) {
        case What::coriolis:
            coriolis_matrix(rows.bodies, base, rows.floating, links, whole, result);
            break;
        case What::derivatives:
        case What::responses:
            torque_derivatives(rows.bodies, base, change, rows.floating, rows.rubs, links, whole, result,
                               result + square, result + 2 * square);
            if (rows.what == What::responses) regular = respond(result, dof, scratch);
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
    return regular;
}

}  // namespace

bool spatial_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, native_width, [&](std::size_t i) { return spatial_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return spatial_pack<Wide>(rows, memory, i, count); });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
