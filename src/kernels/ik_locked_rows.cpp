#include <limits>

#include "cspace/ik/redundancy/locked_joints.hpp"
#include "cspace/math/rows.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

void locked_goals(const LockedArm& locked, const double* goals, const double* at, std::size_t stride,
                  std::size_t rows, double* moved) {
    using V = Pack<native_width>;
    over_packs<native_width>(rows, [=, &locked](std::size_t first, int count) {
        V m[16], value[max_joints];
        load_rows(goals + 16 * first, 16, count, 12, m);
        for (int k = 0; k < locked.n_locked; ++k)
            load_rows(at + stride * first + locked.locked_joint[k], stride, count, 1,
                      value + locked.locked_joint[k]);
        kinematics::write_matrix(goal_between_ends(locked, kinematics::read_matrix(m), value), m);
        store_rows(m, 16, moved + 16 * first, 16, count);
    });
}

void locked_rows(const LockedArm& locked, const double* at, const double* q, std::int64_t count,
                 std::size_t room, double* rows) {
    const std::size_t n = std::size_t(locked.whole.n);
    for (std::int64_t k = 0; k < count; ++k) whole_row(locked, at, q + 6 * k, rows + n * std::size_t(k));
    for (std::size_t i = n * std::size_t(count); i < n * room; ++i)
        rows[i] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace cspace::ik::inline CSPACE_ISA
