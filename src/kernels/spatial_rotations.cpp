#include "spatial_rotations.hpp"

#include "cspace/math/rows.hpp"
#include "cspace/spatial/rotation.hpp"

namespace cspace::spatial::inline CSPACE_ISA {
namespace {

using V = Pack<native_width>;

// Whether f(row, count) of every pack is good in all lanes.
template <class F>
CSPACE_INLINE bool all_packs(std::size_t n, F f) {
    bool good = true;
    over_packs<native_width>(n, [&](std::size_t i, int count) { good &= all(f(i, count)); });
    return good;
}
CSPACE_INLINE Vec3<V> load_vector(const double* rows, int count) {
    V v[3];
    load_rows(rows, 3, count, 3, v);
    return {v[0], v[1], v[2]};
}
CSPACE_INLINE void store_matrix(const Mat3<V>& m, double* rows, int count) {
    store_rows(&m.m[0][0], 9, rows, 9, count);
}

}  // namespace

bool quaternion_matrices_n(const double* q, bool scalar_last, double* R, std::size_t n) {
    const int w = scalar_last ? 3 : 0, x = scalar_last ? 0 : 1;
    return all_packs(n, [=](std::size_t i, int count) {
        V v[4];
        load_rows(q + 4 * i, 4, count, 4, v);
        const V square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
        store_matrix(rotation_of_quaternion(v[w], Vec3<V>{v[x], v[x + 1], v[x + 2]}, square), R + 9 * i,
                     count);
        return safe_square(square);
    });
}
bool rotvec_matrices_n(const double* w, double* R, std::size_t n) {
    return all_packs(n, [=](std::size_t i, int count) {
        const Vec3<V> v = load_vector(w + 3 * i, count);
        const V square = dot(v, v);
        store_matrix(rotation_of_rotvec(v, square), R + 9 * i, count);
        return square <= tolerance::one_turn * tolerance::one_turn;
    });
}
bool axis_angle_matrices_n(const double* axis, const double* angle, double* R, std::size_t n) {
    return all_packs(n, [=](std::size_t i, int count) {
        const Vec3<V> v = load_vector(axis + 3 * i, count);
        const V square = dot(v, v), turned = load_lanes<V>(angle + i, count);
        store_matrix(rotation_of_axis_angle(v, turned, square), R + 9 * i, count);
        return safe_square(square) && abs(turned) < HUGE_VAL;
    });
}

}  // namespace cspace::spatial::inline CSPACE_ISA
