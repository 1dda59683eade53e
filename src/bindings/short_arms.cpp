#include "arrays.hpp"
#include "bindings.hpp"
#include "chains.hpp"
#include "cspace/ik/position/pose.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

using Prismatic = Array<const bool, nb::ndim<1>>;
using Solutions = Array<double, nb::shape<-1, 8, -1>>;
using Free = Array<bool, nb::shape<-1, 8>>;
using Count = Array<std::int32_t, nb::ndim<1>>;

ik::Chain chain_of(const Vectors& axes, const Vectors& points, const Prismatic& prismatic,
                   const Goal& T_zero) {
    const std::size_t n = axes.shape(0);
    if (n < 1 || n > ik::max_position_joints || points.shape(0) != n || prismatic.shape(0) != n)
        throw nb::value_error("one to three joints, with as many axes, points and types");
    return chain_from(int(n), axes.data(), points.data(), prismatic.data(), T_zero.data());
}

// Every array that is written must have a row per goal; the last axis of q and direction counts joints.
template <class... Arrays>
void one_row_per_goal(std::size_t rows, const Arrays&... arrays) {
    if (((arrays.shape(0) != rows) || ...)) throw nb::value_error("every array needs one row per goal");
}
template <class... Arrays>
void one_column_per_joint(int n, const Arrays&... arrays) {
    if (((arrays.shape(arrays.ndim() - 1) != std::size_t(n)) || ...))
        throw nb::value_error("the last axis must have one entry per joint");
}

// Rows of `most` answers of n joints, NaN beyond count.
template <class Found>
void put(const Found& found, int n, double* q, double* direction, bool* free, std::int32_t* count) {
    constexpr int most = ik::max_position_solutions;
    *count = found.count;
    for (int k = 0; k < most; ++k) {
        free[k] = k < found.count && found.free[k];
        for (int i = 0; i < n; ++i) {
            const double none = std::numeric_limits<double>::quiet_NaN();
            q[k * n + i] = k < found.count ? found.q[k][i] : none;
            direction[k * n + i] = free[k] ? found.direction[k][i] : none;
        }
    }
}

}  // namespace

void bind_short_arms(nb::module_& m) {
    m.def(
        "position_solutions",
        [](Vectors axes, Vectors points, Prismatic prismatic, Goal T_zero, Vectors goals, Solutions q,
           Solutions direction, Free free, Count count, RowOut missing, Array<double, nb::ndim<2>> nearest) {
            const ik::Chain chain = chain_of(axes, points, prismatic, T_zero);
            const std::size_t rows = goals.shape(0), row = 8 * std::size_t(chain.n);
            one_row_per_goal(rows, q, direction, free, count, missing, nearest);
            one_column_per_joint(chain.n, q, direction, nearest);
            nb::gil_scoped_release released;
            for (std::size_t k = 0; k < rows; ++k) {
                const double* p = goals.data() + 3 * k;
                const ik::PositionSolutions found = solve_position(chain, {p[0], p[1], p[2]});
                put(found, chain.n, q.data() + k * row, direction.data() + k * row, free.data() + 8 * k,
                    count.data() + k);
                missing.data()[k] = found.missing;
                for (int i = 0; i < chain.n; ++i) nearest.data()[k * chain.n + i] = found.nearest[i];
            }
        },
        "axes"_a, "points"_a, "prismatic"_a, "T_zero"_a, "goals"_a, "q"_a, "direction"_a, "free"_a, "count"_a,
        "missing"_a, "nearest"_a,
        "Joints that bring the tip of an arm of up to three joints to goals (n, 3); the last six are "
        "written.");
    m.def(
        "short_pose_solutions",
        [](Vectors axes, Vectors points, Prismatic prismatic, Goal T_zero, Goals goals, Solutions q,
           Solutions direction, Free free, Count count) {
            const ik::Chain chain = chain_of(axes, points, prismatic, T_zero);
            const std::size_t rows = goals.shape(0), row = 8 * std::size_t(chain.n);
            one_row_per_goal(rows, q, direction, free, count);
            one_column_per_joint(chain.n, q, direction);
            nb::gil_scoped_release released;
            for (std::size_t k = 0; k < rows; ++k)
                put(solve_short_pose(chain, read_matrix(goals.data() + 16 * k)), chain.n, q.data() + k * row,
                    direction.data() + k * row, free.data() + 8 * k, count.data() + k);
        },
        "axes"_a, "points"_a, "prismatic"_a, "T_zero"_a, "goals"_a, "q"_a, "direction"_a, "free"_a, "count"_a,
        "Joints that bring an arm of up to three joints to poses (n, 4, 4); the last four are written.");
}
