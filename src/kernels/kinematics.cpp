#include "kinematics.hpp"

#include "cspace/kinematics/center_of_mass.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/kinematics/jacobian_rate.hpp"
#include "cspace/math/rows.hpp"
#include "cspace/math/singular_values.hpp"
#include "cspace/math/stream.hpp"
#include "cspace/math/trig.hpp"
#include "kinematics_memory.hpp"

namespace cspace::kinematics::inline CSPACE_ISA {
namespace {

// The working arrays of one pack of configurations of a chain.
template <class V>
struct ChainWork {
    V *q, *qd, *s, *c, *J, *J_rate;
    Axis<V>*axes, *rates;
    double* stage;
    int dof, first;
    bool past_cache;
};
template <class V>
ChainWork<V> chain_work(const ChainRows& rows, void* memory) {
    Scratch scratch{static_cast<char*>(memory)};
    const int n = rows.chain.n, first = rows.floating ? 6 : 0, dof = first + rows.chain.n_coordinates;
    return {take_array<V>(scratch, rows.chain.n_coordinates),
            take_array<V>(scratch, dof),
            take_array<V>(scratch, n + 3),
            take_array<V>(scratch, n + 3),
            take_array<V>(scratch, 6 * dof),
            take_array<V>(scratch, 6 * dof),
            take_array<Axis<V>>(scratch, n),
            take_array<Axis<V>>(scratch, n),
            take_array<double>(scratch, Lanes<V>::count * (6 * dof < 16 ? 16 : 6 * dof)),
            dof,
            first,
            false};
}

// Writes the rows i to i + count of an output, `width` values each.
template <class V>
CSPACE_INLINE void put_rows(const ChainWork<V>& w, const V* values, int width, double* to, std::size_t i,
                            int count) {
    to += i * std::size_t(width);
    if (!w.past_cache) return store_rows(values, width, to, width, count);
    store_rows(values, width, w.stage, width, count);
    write_out(to, w.stage, std::size_t(width * count), true);
}

template <class V>
void jacobian_rate(const ChainRows& rows, const ChainWork<V>& w, const Pose<V>& T, const Vec3<V>& p,
                   const Pose<V>& T_world_base, std::size_t i, int count) {
    load_rows(rows.qd + i * w.dof, w.dof, count, w.dof, w.qd);
    const V zero = fill_lanes<V>(0.0);
    Twist<V> base{{zero, zero, zero}, {zero, zero, zero}};
    if (rows.floating) base = {{w.qd[0], w.qd[1], w.qd[2]}, {w.qd[3], w.qd[4], w.qd[5]}};
    const Twist<V> end = axis_rates(rows.chain, w.axes, p, w.qd + w.first, base, T_world_base.t, w.rates);
    joint_column_rates(rows.chain, w.axes, w.rates, p, end.v, w.J_rate, w.dof, w.first);
    if (rows.floating) base_columns(end.v - base.v, w.J_rate, w.dof, 6, 0);
    if (rows.in_tip) express_rate_in(T.R, end.w, w.J, w.J_rate, w.dof);
    put_rows(w, w.J_rate, 6 * w.dof, rows.J_rate, i, count);
}

template <class V>
void chosen_singular_values(const ChainRows& rows, const ChainWork<V>& w, std::size_t i, int count) {
    const int n = rows.chain.n_coordinates;
    int m = 0;
    for (int r = 0; r < 6; ++r) {
        if (!(rows.chosen >> r & 1u)) continue;
        for (int j = 0; j < n; ++j) w.J[m * n + j] = w.J[r * w.dof + w.first + j];
        ++m;
    }
    const int k = m < n ? m : n;
    V sigma[6];
    singular_values(w.J, m, n, sigma);
    store_rows(sigma, k, rows.sigma + i * k, k, count);
}

// The larger of the distances [m] and angles [rad] between poses and goals: ‖R − R_goal‖ = 2√2 sin(angle/2)
// keeps its digits for small angles.
template <class V>
void measure_miss(const ChainRows& rows, const Pose<V>& T, std::size_t i, int count) {
    V at[16], goal[16], distance = fill_lanes<V>(0.0), gap = distance;
    write_matrix(T, at);
    for (int l = 0; l < Lanes<V>::count; ++l) {
        const std::size_t row = i + std::size_t(l < count ? l : count - 1);
        const double* numbers = rows.goals + row / rows.goal_rows * rows.goal_size;
        for (std::size_t k = 0; k < rows.goal_size; ++k) set_lane(goal[k], l, numbers[k]);
    }
    const bool is_pose = rows.goal_size == 16;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3 && is_pose; ++c) {
            const V d = at[4 * r + c] - goal[4 * r + c];
            gap = mul_add(d, d, gap);
        }
        const V d = at[4 * r + 3] - goal[is_pose ? 4 * r + 3 : r];
        distance = mul_add(d, d, distance);
    }
    const V angle = 2.0 * asin(min(sqrt(0.125 * gap), fill_lanes<V>(1.0)));
    distance = sqrt(distance);
    store_lanes(rows.miss + i, select_lanes(angle > distance, angle, distance), count);
}

// One pack of configurations, from row i on.
template <class V>
CSPACE_INLINE bool chain_pack(const ChainRows& rows, const ChainWork<V>& w, std::size_t i, int count) {
    const int n = rows.chain.n_coordinates;
    load_rows(rows.q + i * n, n, count, n, w.q);
    if (!rows.miss && !all_finite(w.q, n)) return false;
    chain_sines(rows.chain, w.q, w.s, w.c);
    const auto T_world_base = load_pose<V>(rows.T_world_base + i * rows.base_stride, rows.base_stride, count);
    auto start = fill_pose<V>(rows.chain.T_base_first);
    if (rows.T_world_base) start = T_world_base * start;
    const Pose<V> T = follow_chain(rows.chain, start, w.q, w.s, w.c,
                                   [&](int k, const Vec3<V>& p, const Vec3<V>& d) { w.axes[k] = {p, d}; });
    if (rows.T) {
        V matrix[16];
        write_matrix(T, matrix);
        put_rows(w, matrix, 16, rows.T, i, count);
    }
    if (rows.miss) measure_miss(rows, T, i, count);
    if (!rows.J && !rows.J_rate && !rows.sigma) return true;
    Vec3<V> p = T.t;
    if (rows.point) {
        V offset[3];
        load_rows(rows.point + i * rows.point_stride, rows.point_stride, count, 3, offset);
        p = T * Vec3<V>{offset[0], offset[1], offset[2]};
    }
    joint_columns(rows.chain, w.axes, p, w.J, w.dof, w.first);
    if (rows.floating) base_columns(p - T_world_base.t, w.J, w.dof, 6);
    if (rows.J_rate) jacobian_rate(rows, w, T, p, T_world_base, i, count);
    if (rows.in_tip) express_in(T.R, w.J, w.dof);
    if (rows.J) put_rows(w, w.J, 6 * w.dof, rows.J, i, count);
    if (rows.sigma) chosen_singular_values(rows, w, i, count);
    return true;
}

template <class V>
bool tree_pack(const TreeRows& rows, void* memory, std::size_t i, int count) {
    Scratch scratch{static_cast<char*>(memory)};
    const model::Tree& tree = rows.tree;
    const int n = tree.n_coordinates, first = rows.floating ? 6 : 0, dof = first + n;
    V* q = take_array<V>(scratch, n);
    auto* T_world_joint = take_array<Pose<V>>(scratch, tree.n_joints);
    load_rows(rows.q + i * n, n, count, n, q);
    if (!all_finite(q, n)) return false;
    const auto T_world_base = load_pose<V>(rows.T_world_base + i * rows.base_stride, rows.base_stride, count);
    joint_poses(tree, q, T_world_base, T_world_joint);
    if (rows.T) {
        const std::size_t size = 16 * std::size_t(tree.n_frames);
        for (int f = 0; f < tree.n_frames; ++f) {
            V matrix[16];
            write_matrix(frame_pose(tree.frames[f], T_world_base, T_world_joint), matrix);
            store_rows(matrix, 16, rows.T + i * size + 16 * std::size_t(f), size, count);
        }
    }
    if (!rows.center && !rows.center_columns) return true;
    auto* moments = take_array<Vec3<V>>(scratch, tree.n_joints);
    const Vec3<V> center = center_of_mass(tree, T_world_base, T_world_joint, moments);
    if (rows.center) store_rows(&center.x, 3, rows.center + i * 3, 3, count);
    if (!rows.center_columns) return true;
    V* J = take_array<V>(scratch, 3 * dof);
    center_of_mass_columns(tree, T_world_joint, moments, J, dof, first);
    if (rows.floating) base_columns(center - T_world_base.t, J, dof, 3);
    store_rows(J, 3 * dof, rows.center_columns + i * 3 * dof, 3 * dof, count);
    return true;
}

constexpr int width = 4;

template <class Body>
bool over_packs(std::size_t begin, std::size_t end, const Body& body) {
    for (std::size_t i = begin; i < end; i += width) {
        if (!body(i, end - i < width ? int(end - i) : width)) return false;
    }
    return true;
}

// The working arrays of a single configuration.
struct OneWork {
    double *s, *c;
    Axis<double>* axes;
};
OneWork one_work(const model::Chain& chain, void* memory) {
    Scratch scratch{static_cast<char*>(memory)};
    return {take_array<double>(scratch, chain.n + 3), take_array<double>(scratch, chain.n + 3),
            take_array<Axis<double>>(scratch, chain.n)};
}
// Compiled once for pose and Jacobian, so that both round alike.
CSPACE_NOINLINE Posed follow_one(const model::Chain& chain, const double* q, const OneWork& work) {
    chain_sines(chain, q, work.s, work.c);
    return follow_chain(chain, chain.T_base_first, q, work.s, work.c,
                        [&](int k, const Vec3d& p, const Vec3d& d) { work.axes[k] = {p, d}; });
}

}  // namespace

bool chain_rows(const ChainRows& rows, std::size_t begin, std::size_t end, void* scratch) {
    auto work = chain_work<Pack<width>>(rows, scratch);
    const std::size_t values = rows.J || rows.J_rate ? 6 * std::size_t(work.dof) : 16;
    work.past_cache = is_aligned(rows.T) && is_aligned(rows.J) && is_aligned(rows.J_rate) &&
                      goes_past_cache(rows.count * values);
    const bool finite =
        over_packs(begin, end, [&](std::size_t i, int count) { return chain_pack(rows, work, i, count); });
    if (work.past_cache) finish_streams();
    return finite;
}

bool tree_rows(const TreeRows& rows, std::size_t begin, std::size_t end, void* scratch) {
    return over_packs(begin, end, [&](std::size_t i, int count) {
        return tree_pack<Pack<width>>(rows, scratch, i, count);
    });
}

bool chain_pose(const model::Chain& chain, const double* q, double* T, void* memory) {
    if (!all_finite(q, chain.n_coordinates)) return false;
    write_matrix(follow_one(chain, q, one_work(chain, memory)), T);
    return true;
}

bool chain_jacobian(const model::Chain& chain, const double* q, double* T, double* J, void* memory) {
    if (!all_finite(q, chain.n_coordinates)) return false;
    const OneWork work = one_work(chain, memory);
    const Posed end = follow_one(chain, q, work);
    if (T) write_matrix(end, T);
    joint_columns(chain, work.axes, end.t, J, chain.n_coordinates, 0);
    return true;
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
