#include "ik.hpp"

#include "cspace/ik/evaluate.hpp"
#include "cspace/ik/goal.hpp"
#include "cspace/ik/polish.hpp"
#include "cspace/math/rows.hpp"
#include "cspace/math/stream.hpp"

namespace cspace::inline CSPACE_ISA {
namespace {

using V = Pack<native_width>;

// Moves the rows that hold to the front; NaN behind them. Returns how many there are.
CSPACE_INLINE int compact(unsigned ok, double* rows) {
    constexpr unsigned all = (1u << max_branches) - 1;
    if (ok == all) return max_branches;
    int count = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!(ok >> k & 1)) continue;
        if (count != k)
            for (int i = 0; i < 6; ++i) rows[6 * count + i] = rows[6 * k + i];
        ++count;
    }
    for (int i = 6 * count; i < 6 * max_branches; ++i) rows[i] = std::numeric_limits<double>::quiet_NaN();
    return count;
}

CSPACE_INLINE unsigned branches_of_lane(const mask_of<V>* ok, int l) {
    unsigned bits = 0;
    for (int k = 0; k < max_branches; ++k) bits |= unsigned(lane(ok[k], l)) << k;
    return bits;
}

// Corrects angles on the true chain; false where that did not settle.
template <class W>
CSPACE_INLINE mask_of<W> polished_angles(const ik::Plan& plan, const Pose<W>& goal, W* q) {
    const mask_of<W> settled = polish(plan.chain, goal, plan.form.length, q);
    for (int i = 0; i < 6; ++i) q[i] = wrap_once(q[i]);
    return settled;
}

}  // namespace

ik::Quick ik_one(const ik::Plan& plan, const double* T, double* q, std::int8_t* branch, int* count) {
    const ReadGoal<double> goal = read_goal(T);
    *count = 0;
    if (!goal.is_pose) return ik::Quick::refused;
    if (plan.virtual_joints || !plan.on_lanes) return ik::Quick::doubtful;
    const Abreast found = closed_form_abreast(plan, goal_in_form(plan, goal.T), care_of(plan));
    if (found.doubt) return ik::Quick::doubtful;
    Pack<4> angles[2][6];
    for (int e = 0; e < 2; ++e)
        for (int i = 0; i < 6; ++i) angles[e][plan.joint[i]] = joint_angle(plan, i, found.t[e][i]);
    if (plan.polish)
        for (int e = 0; e < 2; ++e)
            if (any(found.ok[e] && !polished_angles(plan, fill_pose<Pack<4>>(goal.T), angles[e])))
                return ik::Quick::doubtful;
    // Branch 2 l + e is lane l of angles[e].
    for (int e = 0; e < 2; ++e) store_rows(angles[e], 6, q + 6 * e, 12, 4);
    int n = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!lane(found.ok[k & 1], k >> 1)) continue;
        if (n != k)
            for (int i = 0; i < 6; ++i) q[6 * n + i] = q[6 * k + i];
        branch[n++] = static_cast<std::int8_t>(k);
    }
    *count = n;
    return ik::Quick::settled;
}

void ik_many(const ik::Plan& plan, const double* T, std::size_t n, double* q, std::int64_t* count,
             ik::Quick* quick) {
    const Care care = care_of(plan);
    constexpr std::size_t row = max_branches * 6;
    alignas(64) double stage[native_width * row];
    const bool past_cache = goes_past_cache(n * row) && is_aligned(q);
    for (std::size_t first = 0; first < n; first += native_width) {
        const int lanes = int(n - first < native_width ? n - first : native_width);
        V m[16];
        load_rows(T + 16 * first, 16, lanes, 16, m);
        const ReadGoal<V> goal = read_goal(m);
        Branches<V> b = closed_form(plan, goal_in_form(plan, goal.T), care);
        for (int k = 0; k < max_branches; ++k) {
            V angles[6];
            for (int i = 0; i < 6; ++i) angles[plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
            if (plan.polish) b.doubt = b.doubt || (b.ok[k] && !polished_angles(plan, goal.T, angles));
            store_rows(angles, 6, stage + 6 * k, row, lanes);
        }
        for (int l = 0; l < lanes; ++l) {
            count[first + l] = compact(branches_of_lane(b.ok, l), stage + row * l);
            quick[first + l] = !lane(goal.is_pose, l) ? ik::Quick::refused
                               : lane(b.doubt, l)     ? ik::Quick::doubtful
                                                      : ik::Quick::settled;
        }
        write_out(q + row * first, stage, row * std::size_t(lanes), past_cache);
    }
    if (past_cache) finish_streams();
}

}  // namespace cspace::inline CSPACE_ISA
