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

// Memory for numbers that are read in packs.
template <class V>
CSPACE_INLINE V* take_packed(Scratch& scratch, int n) {
    const std::size_t beyond = reinterpret_cast<std::uintptr_t>(scratch.next) % sizeof(Wide);
    if (beyond) scratch.next += sizeof(Wide) - beyond;
    return take_array<V>(scratch, n);
}
// How many numbers the rows of three matrices beside each other take: of single numbers whole packs.
template <class V>
CSPACE_INLINE int side_by_side(int n) {
    constexpr int step = Lanes<V>::count == 1 ? native_width : 1;
    return (3 * n + step - 1) / step * step;
}
// The derivatives ∂τ and M of torques, beside each other, become those of the accelerations that they cause,
// −M⁻¹ ∂τ and M⁻¹.
template <class V>
CSPACE_INLINE bool respond(V* slopes, int n, Scratch scratch) {
    const int stride = side_by_side<V>(n), square = n * n;
    V* L = take_array<V>(scratch, square);
    for (int i = 0; i < n; ++i) {
        V* M = slopes + i * stride + 2 * n;
        for (int j = 0; j < n; ++j) {
            L[i * n + j] = M[j];
            M[j] = fill_lanes<V>(i == j ? -1.0 : 0.0);
        }
        for (int j = n; j < stride - 2 * n; ++j) M[j] = fill_lanes<V>(0.0);
    }
    const SparseFactor<V> factor = {n,
                                    L,
                                    take_array<int>(scratch, square),
                                    take_array<int>(scratch, n),
                                    take_array<int>(scratch, square),
                                    take_array<int>(scratch, n),
                                    take_array<int>(scratch, n)};
    const bool regular = all(factor_sparse(factor, tolerance::singular_inertia));
    for (int i = 0; i < n; ++i) L[i * (n + 1)] = -L[i * (n + 1)];  // the inverse of −M
    if constexpr (Lanes<V>::count == 1)
        solve_sparse(factor, reinterpret_cast<Wide*>(slopes), stride / native_width);
    else
        solve_sparse(factor, slopes, stride);
    return regular;
}

// The derivatives of accelerations, as rows.
template <class V>
CSPACE_INLINE void write_responses(const Rows& rows, std::size_t i, int count, int n, const V* slopes) {
    const std::size_t size = 3 * std::size_t(n * n);
    for (int k = 0; k < 3; ++k) {
        for (int r = 0; r < n; ++r) {
            const V* row = slopes + r * side_by_side<V>(n) + k * n;
            double* to = rows.result + i * size + std::size_t((k * n + r) * n);
            if constexpr (Lanes<V>::count == 1)
                std::memcpy(to, row, sizeof(double) * std::size_t(n));
            else
                store_rows(row, n, to, size, count);
        }
    }
}

template <class V>
bool spatial_pack(const Rows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    const int dof = rows.bodies.n_coordinates + (rows.floating ? 6 : 0), square = dof * dof;
    const int sizes[] = {square, 3 * square, 0, 6, 6 * dof, 1, 1};
    const int size = sizes[int(rows.what)];
    if (!read_arguments(rows, scratch, i, count, size, given)) return false;
    auto* links = take_array<SpatialLink<V>>(scratch, rows.bodies.n_links);
    const V zero = fill_lanes<V>(0.0);
    Twist<V> base = {{zero, zero, zero}, {zero, zero, zero}}, change = {-fill_vec3<V>(rows.gravity), base.w};
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
    switch (rows.what) {
        case What::coriolis:
            coriolis_matrix(rows.bodies, base, rows.floating, links, whole, result);
            break;
        case What::derivatives:
        case What::responses: {
            const bool responds = rows.what == What::responses;
            const int next = responds ? dof : square, stride = responds ? side_by_side<V>(dof) : dof;
            if (responds) result = take_packed<V>(scratch, dof * stride);
            torque_derivatives(rows.bodies, base, change, rows.floating, rows.rubs, links, whole, stride,
                               result, result + next, result + 2 * next);
            if (!responds) break;
            const bool regular = respond(result, dof, scratch);
            write_responses(rows, i, count, dof, result);
            return regular;
        }
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
            *result = potential_energy(rows.bodies, fill_vec3<V>(rows.gravity), given.T.t, whole);
    }
    write_result(rows, given, i, count, size);
    return true;
}

}  // namespace

bool spatial_rows(const Rows& rows, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, native_width, [&](std::size_t i) { return spatial_pack<double>(rows, memory, i, 1); },
        [&](std::size_t i, int count) { return spatial_pack<Wide>(rows, memory, i, count); });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
