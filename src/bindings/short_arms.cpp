#include <nanobind/ndarray.h>

#include "bindings.hpp"
#include "cspace/ik/position/pose.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

template <class T, class... Traits>
using Array = nb::ndarray<T, nb::c_contig, nb::device::cpu, Traits...>;
using Rows = Array<const double, nb::shape<-1, 3>>;

Vec3d vector(const double* v) { return {v[0], v[1], v[2]}; }
Posed pose(const double* m) {
    return {{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}}, {m[3], m[7], m[11]}};
}
ik::Chain chain_of(const Rows& axes, const Rows& points, const Array<const bool, nb::shape<-1>>& prismatic,
                   const double* T_zero) {
    ik::Chain chain;
    chain.n = int(axes.shape(0));
    if (chain.n < 1 || chain.n > ik::max_position_joints || points.shape(0) != axes.shape(0) ||
        prismatic.shape(0) != axes.shape(0))
        throw nb::value_error("one to three joints, with as many axes, points and types");
    for (int i = 0; i < chain.n; ++i) {
        chain.axis[i] = vector(axes.data() + 3 * i);
        chain.point[i] = vector(points.data() + 3 * i);
        chain.prismatic[i] = prismatic.data()[i];
    }
    chain.tip = pose(T_zero);
    return chain;
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
    using Prismatic = Array<const bool, nb::shape<-1>>;
    using Matrix = Array<const double, nb::shape<4, 4>>;
    using Solutions = Array<double, nb::shape<-1, 8, -1>>;
    using Free = Array<bool, nb::shape<-1, 8>>;
    using Count = Array<std::int32_t, nb::shape<-1>>;
    m.def(
        "position_solutions",
        [](Rows axes, Rows points, Prismatic prismatic, Matrix T_zero, Rows goals, Solutions q,
           Solutions direction, Free free, Count count, Array<double, nb::shape<-1>> missing,
           Array<double, nb::shape<-1, -1>> nearest) {
            const ik::Chain chain = chain_of(axes, points, prismatic, T_zero.data());
            const std::size_t rows = goals.shape(0), row = 8 * std::size_t(chain.n);
            one_row_per_goal(rows, q, direction, free, count, missing, nearest);
            one_column_per_joint(chain.n, q, direction, nearest);
            nb::gil_scoped_release released;
            for (std::size_t k = 0; k < rows; ++k) {
                const ik::PositionSolutions found = solve_position(chain, vector(goals.data() + 3 * k));
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
        [](Rows axes, Rows points, Prismatic prismatic, Matrix T_zero,
           Array<const double, nb::shape<-1, 4, 4>> goals, Solutions q, Solutions direction, Free free,
           Count count) {
            const ik::Chain chain = chain_of(axes, points, prismatic, T_zero.data());
            const std::size_t rows = goals.shape(0), row = 8 * std::size_t(chain.n);
            one_row_per_goal(rows, q, direction, free, count);
            one_column_per_joint(chain.n, q, direction);
            nb::gil_scoped_release released;
            for (std::size_t k = 0; k < rows; ++k)
                put(solve_short_pose(chain, pose(goals.data() + 16 * k)), chain.n, q.data() + k * row,
                    direction.data() + k * row, free.data() + 8 * k, count.data() + k);
        },
        "axes"_a, "points"_a, "prismatic"_a, "T_zero"_a, "goals"_a, "q"_a, "direction"_a, "free"_a, "count"_a,
        "Joints that bring an arm of up to three joints to poses (n, 4, 4); the last four are written.");
}
