#include "cspace/ik/arm.hpp"
#include "cspace/ik/fast_path.hpp"
#include "cspace/math/stream.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {
namespace {

using V = Pack<native_width>;

// Moves the rows that hold to the front; NaN behind them. Returns how many there are.
CSPACE_INLINE int compact_rows(unsigned ok, double* rows, int room) {
    constexpr unsigned all = (1u << max_branches) - 1;
    if (ok == all && room == max_branches) return max_branches;
    int count = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!(ok >> k & 1)) continue;
        if (count != k)
            for (int i = 0; i < 6; ++i) rows[6 * count + i] = rows[6 * k + i];
        ++count;
    }
    for (int i = 6 * count; i < 6 * room; ++i) rows[i] = std::numeric_limits<double>::quiet_NaN();
    return count;
}

CSPACE_INLINE unsigned branches_of_lane(const mask_of<V>* ok, int l) {
    unsigned bits = 0;
    for (int k = 0; k < max_branches; ++k) bits |= unsigned(get_lane(ok[k], l)) << k;
    return bits;
}

}  // namespace

template FastPath solve_fast_path(const Plan&, const double*, double*, signed char*, int*);
template Branches<double> solve_closed_form(const Plan&, const Posed&, const ClosedFormSettings&);

FastPath ik_one(const Arm& arm, const double* T, double* q, std::int8_t* branch, int* count) {
    if (arm.has_plan) return solve_fast_path(arm.plan, T, q, branch, count);
    return read_goal(T).is_pose ? FastPath::doubtful : FastPath::refused;
}

void ik_many(const Arm& arm, const double* T, std::size_t n, std::size_t batch, int room, double* q,
             std::int64_t* count, FastPath* quick) {
    const Plan& plan = arm.plan;
    const ClosedFormSettings settings = closed_form_settings(plan);
    const std::size_t row = std::size_t(room) * 6;
    alignas(64) double stage[native_width * max_solutions * 6];
    const bool past_cache = goes_past_cache(batch * row) && is_aligned(q);
    for (std::size_t first = 0; first < n; first += native_width) {
        const int lanes = int(n - first < native_width ? n - first : native_width);
        V m[16];
        load_rows(T + 16 * first, 16, lanes, 16, m);
        const ReadGoal<V> goal = read_goal(m);
        Branches<V> b = closed_form(plan, goal_in_form(plan, goal.T), settings);
        for (int k = 0; k < max_branches; ++k) {
            V angles[6];
            for (int i = 0; i < 6; ++i) angles[plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
            if (plan.polish && any(b.ok[k]))
                b.doubt = b.doubt || (b.ok[k] && !polished_angles(plan, goal.T, angles));
            store_rows(angles, 6, stage + 6 * k, row, lanes);
        }
        for (int l = 0; l < lanes; ++l) {
            count[first + l] = compact_rows(branches_of_lane(b.ok, l), stage + row * l, room);
            quick[first + l] = !get_lane(goal.is_pose, l) ? FastPath::refused
                               : get_lane(b.doubt, l)     ? FastPath::doubtful
                                                          : FastPath::settled;
        }
        write_out(q + row * first, stage, row * std::size_t(lanes), past_cache);
    }
    if (past_cache) finish_streams();
}

}  // namespace cspace::ik::inline CSPACE_ISA
