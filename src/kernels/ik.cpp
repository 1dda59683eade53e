#include "ik.hpp"

#include "cspace/ik/evaluate.hpp"
#include "cspace/ik/goal.hpp"

namespace cspace::inline CSPACE_ISA {
namespace {

constexpr int width = 4;
using V = Pack<width>;

// Four rows of `stride` numbers, entries 0…15 of each, as lanes.
CSPACE_INLINE void load_goals(const double* T, std::size_t rows, V* m) {
    for (int k = 0; k < 16; ++k)
        for (int l = 0; l < width; ++l) set_lane(m[k], l, T[16 * (std::size_t(l) < rows ? l : 0) + k]);
}

// One lane's solutions, those that hold first, NaN behind them.
CSPACE_INLINE int write_lane(const V (*q)[6], const mask_of<V>* ok, int l, double* out) {
    int count = 0;
    for (int k = 0; k < max_branches; ++k) {
        for (int i = 0; i < 6; ++i) out[6 * count + i] = lane(q[k][i], l);
        count += lane(ok[k], l);
        if (count == max_branches) return count;
    }
    for (int i = 6 * count; i < 6 * max_branches; ++i) out[i] = std::numeric_limits<double>::quiet_NaN();
    return count;
}

}  // namespace

ik::Quick ik_one(const ik::Plan& plan, const double* T, double* q, std::int8_t* branch, int* count) {
    const ReadGoal<double> goal = read_goal(T);
    *count = 0;
    if (!goal.is_pose) return ik::Quick::refused;
    if (plan.virtual_joints || plan.polish || !plan.on_lanes) return ik::Quick::doubtful;
    const Branches<double> b = closed_form(plan, goal_in_form(plan, goal.T), Care{});
    if (b.doubt) return ik::Quick::doubtful;
    int n = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!b.ok[k]) continue;
        for (int i = 0; i < 6; ++i) q[6 * n + plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
        branch[n++] = static_cast<std::int8_t>(k);
    }
    *count = n;
    return ik::Quick::settled;
}

void ik_many(const ik::Plan& plan, const double* T, std::size_t n, double* q, std::int64_t* count,
             ik::Quick* quick) {
    const Care care;
    for (std::size_t first = 0; first < n; first += width) {
        const std::size_t rows = n - first < width ? n - first : width;
        V m[16];
        load_goals(T + 16 * first, rows, m);
        const ReadGoal<V> goal = read_goal(m);
        const Branches<V> b = closed_form(plan, goal_in_form(plan, goal.T), care);
        V angles[max_branches][6];
        for (int k = 0; k < max_branches; ++k)
            for (int i = 0; i < 6; ++i) angles[k][plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
        for (std::size_t l = 0; l < rows; ++l) {
            const std::size_t row = first + l;
            count[row] = write_lane(angles, b.ok, int(l), q + row * max_branches * 6);
            quick[row] = !lane(goal.is_pose, int(l))            ? ik::Quick::refused
                         : lane(b.doubt, int(l)) || plan.polish ? ik::Quick::doubtful
                                                                : ik::Quick::settled;
        }
    }
}

}  // namespace cspace::inline CSPACE_ISA
