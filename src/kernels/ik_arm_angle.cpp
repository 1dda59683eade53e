#include <limits>

#include "cspace/ik/redundancy/arm_angle.hpp"
#include "cspace/math/rows.hpp"
#include "ik.hpp"

namespace cspace::ik::inline CSPACE_ISA {

void swivel_solutions(const SwivelArm& arm, const Posed& goal, const double* swivels, int n, double* q) {
    using V = Pack<4>;
    constexpr int row = swivel_branches * 7;
    for (int first = 0; first < n; first += 4) {
        const int lanes = n - first < 4 ? n - first : 4;
        SwivelSolutions<V> found;
        solve_swivel(arm, goal, load_lanes<V>(swivels + first, lanes), found);
        for (int b = 0; b < swivel_branches; ++b) {
            for (V& angle : found.q[b])
                angle =
                    select_lanes(found.ok[b], angle, fill_lanes<V>(std::numeric_limits<double>::quiet_NaN()));
            store_rows(found.q[b], 7, q + row * first + 7 * b, row, lanes);
        }
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
