// Arms with joints to spare: plain checked arrays in, filled arrays out. The solver keeps, for every set of
// joints that somebody held, the plan of those that move.
#include "ik_redundant.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/ik/goal.hpp"
#include "cspace/math/threads.hpp"
#include "ik.hpp"
#include "ik_general.hpp"
#include "ik_held.hpp"
#include "ik_shared.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

class RedundantSolver {
  public:
    RedundantSolver(const ik::Chain& chain, const double* lower, const double* upper, const double* weight)
        : arm(make_redundant(chain, lower, upper, weight, kernels::plan_general)), unit(unit_of(arm)) {}

    const ik::Redundant arm;
    const double unit;  // [m] in which curves along slides are followed

    // The same arm with lengths in its unit, built when first asked for.
    RedundantSolver& in_its_unit() {
        const std::lock_guard<std::mutex> guard(mutex_);
        if (!scaled_) {
            ik::Chain chain = arm.chain;
            double lower[ik::max_joints], upper[ik::max_joints];
            for (int i = 0; i < chain.n; ++i) {
                const double size = chain.prismatic[i] ? unit : 1;
                chain.point[i] = (1 / unit) * chain.point[i];
                lower[i] = arm.lower[i] / size;
                upper[i] = arm.upper[i] / size;
            }
            chain.tip.t = (1 / unit) * chain.tip.t;
            scaled_ = std::make_unique<RedundantSolver>(chain, lower, upper, arm.weight);
        }
        return *scaled_;
    }

    // The plan with these joints held, built when first asked for.
    const ik::LockedArm& holding(const std::vector<int>& held) {
        const std::lock_guard<std::mutex> guard(mutex_);
        if (arm.locked.n_moving > 0 && int(held.size()) == arm.locked.n_held &&
            std::equal(held.begin(), held.end(), arm.locked.held))
            return arm.locked;
        auto& slot = plans_[held];
        if (!slot) {
            double typical[ik::max_joints];
            typical_values(arm, typical);
            slot = std::make_unique<ik::LockedArm>(
                lock_joints(arm.chain, held.data(), int(held.size()), typical, kernels::plan_general));
        }
        return *slot;
    }
    const ik::LimitArms& limits() {
        const std::lock_guard<std::mutex> guard(mutex_);
        if (!limits_) {
            auto made = std::make_unique<ik::LimitArms>();
            make_limit_arms(arm, *made, kernels::plan_general);
            limits_ = std::move(made);
        }
        return *limits_;
    }

  private:
    // A power of two, which rounds nothing; 1 for arms about that long and for those that only turn.
    static double unit_of(const ik::Redundant& arm) {
        bool slides = false;
        for (int i = 0; i < arm.chain.n; ++i) slides |= arm.chain.prismatic[i];
        const bool usual = arm.length > 0.25 && arm.length < 4;
        return slides && !usual ? std::exp2(std::round(std::log2(arm.length))) : 1.0;
    }

    std::mutex mutex_;
    std::unique_ptr<RedundantSolver> scaled_;
    std::map<std::vector<int>, std::unique_ptr<ik::LockedArm>> plans_;
    std::unique_ptr<ik::LimitArms> limits_;
};

Posed pose_of(const double* m) { return read_goal(m).T; }

ik::Chain chain_of(const Matrix& axes, const Matrix& points, const Array<const bool, nb::ndim<1>>& prismatic,
                   const Goal& T_zero) {
    ik::Chain chain;
    chain.n = int(axes.shape(0));
    if (chain.n < 1 || chain.n > ik::max_joints || axes.shape(1) != 3 || points.shape(1) != 3 ||
        points.shape(0) != axes.shape(0) || prismatic.shape(0) != axes.shape(0))
        throw nb::value_error("one to sixteen joints, with as many axes, points and types");
    for (int i = 0; i < chain.n; ++i) {
        const double *h = axes.data() + 3 * i, *p = points.data() + 3 * i;
        chain.axis[i] = {h[0], h[1], h[2]};
        chain.point[i] = {p[0], p[1], p[2]};
        chain.prismatic[i] = prismatic.data()[i];
    }
    const double* m = T_zero.data();
    chain.tip = {{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}}, {m[3], m[7], m[11]}};
    return chain;
}

void make_solver(RedundantSolver* at, Matrix axes, Matrix points, Array<const bool, nb::ndim<1>> prismatic,
                 Goal T_zero, Row lower, Row upper, Row weight) {
    const ik::Chain chain = chain_of(axes, points, prismatic, T_zero);
    for (const Row& row : {lower, upper, weight})
        if (int(row.shape(0)) != chain.n)
            throw nb::value_error("limits and weights need one number per joint");
    new (at) RedundantSolver(chain, lower.data(), upper.data(), weight.data());
}

std::vector<int> default_held(const RedundantSolver& solver) {
    const ik::LockedArm& locked = solver.arm.locked;
    return {locked.held, locked.held + locked.n_held};
}

// The joints to hold: ascending, of the arm, and so many that at most six move.
const ik::LockedArm& plan_of(RedundantSolver& solver, const std::vector<int>& held) {
    const int n = solver.arm.chain.n, moving = n - int(held.size());
    const bool ascending = std::adjacent_find(held.begin(), held.end(), std::greater_equal<>()) == held.end();
    if (!ascending || (!held.empty() && (held.front() < 0 || held.back() >= n)) || moving < 1 ||
        moving > ik::max_moving)
        throw nb::value_error("held joints must ascend and leave one to six to move");
    return solver.holding(held);
}

int spare_with_held(const RedundantSolver& solver, const std::vector<int>& held) {
    unsigned bits = 0;
    for (const int joint : held) {
        if (joint < 0 || joint >= solver.arm.chain.n) throw nb::value_error("held joints are of the arm");
        bits |= 1u << joint;
    }
    return spare_with(solver.arm, bits);
}

int room_of(RedundantSolver& solver, const std::vector<int>& held) {
    const ik::LockedArm& locked = plan_of(solver, held);
    return locked.at_ends ? room_for(locked.arm) : ik::max_solutions;
}

// Goals of joints that stand at the ends, by the kernel of the others; `quick` says what it left open.
struct EndRows {
    static constexpr std::size_t most = 64;
    double T[most][16], q[most][max_branches * 6];
    std::int64_t count[most];
    ik::Quick quick[most];

    void solve(const ik::LockedArm& locked, const double* goals, const double* at, std::size_t stride,
               std::size_t rows) {
        kernels::held_goals(locked, goals, at, stride, rows, T[0]);
        kernels::ik_many(locked.arm.plan, T[0], rows, max_branches, q[0], count, quick);
    }
};

// Fills q (N, room, n) with NaN behind the solutions; the solutions themselves stand for what they show.
void solve_rows(RedundantSolver& solver, const std::vector<int>& held, Matrix at, Goals goals, Row idle,
                Array<double, nb::ndim<3>> q, Array<std::int8_t, nb::ndim<2>> branch,
                Array<bool, nb::ndim<2>> family, Array<std::int64_t, nb::ndim<1>> count,
                Array<std::uint8_t, nb::ndim<1>> status, int threads) {
    const ik::LockedArm& locked = plan_of(solver, held);
    const std::size_t n = std::size_t(solver.arm.chain.n), N = goals.shape(0), room = q.shape(1);
    if (at.shape(1) != n || (at.shape(0) != N && at.shape(0) != 1) || q.shape(0) != N || q.shape(2) != n ||
        branch.shape(0) != N || family.shape(0) != N || branch.shape(1) != room || family.shape(1) != room ||
        count.shape(0) != N || status.shape(0) != N || (idle.shape(0) != n && idle.shape(0) != 0))
        throw nb::value_error("arrays of matching sizes are needed");
    const double* rest = idle.shape(0) ? idle.data() : nullptr;
    const std::size_t stride = at.shape(0) == 1 ? 0 : n;
    const bool by_kernel =
        N > 1 && !rest && locked.at_ends && rank_of(locked.arm) == 3 && room >= max_branches;
    const nb::gil_scoped_release release;
    over_rows(N, threads, 1, 64, [&](std::size_t from, std::size_t to) {
        ik::Solutions found;
        const auto ends = by_kernel ? std::make_unique_for_overwrite<EndRows>() : nullptr;
        for (std::size_t i = from; i < to; ++i) {
            const double* values = at.data() + stride * i;
            const std::size_t in = (i - from) % EndRows::most;
            if (ends && in == 0)
                ends->solve(locked, goals.data() + 16 * i, values, stride, std::min(to - i, EndRows::most));
            if (ends && ends->quick[in] == ik::Quick::settled) {
                kernels::held_rows(locked, values, ends->q[in], ends->count[in], room,
                                   q.data() + room * n * i);
                count.data()[i] = ends->count[in];
                status.data()[i] =
                    std::uint8_t(int(ends->count[in] ? ik::Status::exact : ik::Status::unreachable));
                continue;
            }
            kernels::redundant_locked(locked, pose_of(goals.data() + 16 * i), values, rest, found);
            double* rows = q.data() + room * n * i;
            std::fill(rows, rows + room * n, none);
            const int k_max = std::min(found.count, int(room));
            for (int k = 0; k < k_max; ++k) {
                whole_row(locked, values, found.q[k], rows + n * std::size_t(k));
                branch.data()[room * i + std::size_t(k)] = found.branch[k];
                family.data()[room * i + std::size_t(k)] = found.family[k];
            }
            count.data()[i] = k_max;
            status.data()[i] = std::uint8_t(int(found.status) + (found.complete ? 0 : 8));
        }
        return true;
    });
}

void nearest_rows(RedundantSolver& solver, Goals goals, Matrix seeds, Array<double, nb::ndim<2>> q,
                  Array<bool, nb::ndim<1>> found, int threads) {
    const std::size_t n = std::size_t(solver.arm.chain.n), N = goals.shape(0);
    if (seeds.shape(1) != n || (seeds.shape(0) != N && seeds.shape(0) != 1) || q.shape(0) != N ||
        q.shape(1) != n || found.shape(0) != N)
        throw nb::value_error("arrays of matching sizes are needed");
    const nb::gil_scoped_release release;
    over_rows(N, threads, 1, 16, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const double* seed = seeds.data() + (seeds.shape(0) == 1 ? 0 : n * i);
            double* const row = q.data() + n * i;
            found.data()[i] =
                kernels::redundant_nearest(solver.arm, pose_of(goals.data() + 16 * i), seed, row);
            if (!found.data()[i]) std::fill(row, row + n, none);
        }
        return true;
    });
}

// Per interval: (lower, upper, branch, what ends it below, at which side, what ends it above, at which side),
// and a configuration inside; and whether none is missing.
using IntervalRow = std::tuple<double, double, int, int, int, int, int, std::vector<double>>;
std::tuple<std::vector<IntervalRow>, bool> intervals_of(RedundantSolver& given, int parameter, Goal goal) {
    const ik::Chain& chain = given.arm.chain;
    if (given.arm.spare != 1 || parameter < 0 || parameter >= chain.n)
        throw nb::value_error("intervals are those of a joint of an arm with one joint to spare");
    RedundantSolver& solver = given.unit == 1 ? given : given.in_its_unit();
    Posed T = pose_of(goal.data());
    T.t = (1 / given.unit) * T.t;
    const ik::LockedArm& locked = plan_of(solver, {parameter});
    const ik::LimitArms& limits = solver.limits();
    const auto trail = std::make_unique<Trail>();
    const auto found = std::make_unique<ik::Intervals>();
    {
        const nb::gil_scoped_release release;
        kernels::redundant_intervals(solver.arm, locked, parameter, limits, T, *trail, *found);
    }
    const auto in_metres = [&](int joint, double q) { return chain.prismatic[joint] ? given.unit * q : q; };
    std::vector<IntervalRow> rows;
    for (int k = 0; k < found->count; ++k) {
        const ik::Interval& i = found->interval[k];
        std::vector<double> q(i.q, i.q + chain.n);
        for (int j = 0; j < chain.n; ++j) q[std::size_t(j)] = in_metres(j, i.q[j]);
        rows.emplace_back(in_metres(parameter, i.lower), in_metres(parameter, i.upper), i.branch, i.end[0],
                          i.side[0], i.end[1], i.side[1], std::move(q));
    }
    return {std::move(rows), found->complete};
}

// All solutions at the values of one held joint: q (m, 16, n), NaN behind them.
bool sweep_rows(RedundantSolver& solver, int parameter, Goal goal, Row at, Row values,
                Array<double, nb::ndim<3>> q, Array<std::int8_t, nb::ndim<2>> branch,
                Array<std::int64_t, nb::ndim<1>> count) {
    const ik::Redundant& arm = solver.arm;
    const std::size_t n = std::size_t(arm.chain.n), m = values.shape(0);
    constexpr std::size_t room = ik::max_solutions;
    if (arm.spare != 1 || parameter < 0 || parameter >= arm.chain.n || at.shape(0) != n || q.shape(0) != m ||
        q.shape(1) != room || q.shape(2) != n || branch.shape(0) != m || branch.shape(1) != room ||
        count.shape(0) != m)
        throw nb::value_error("arrays of matching sizes are needed");
    const ik::LockedArm& locked = plan_of(solver, {parameter});
    std::vector<SweptRows> rows(m);
    kernels::redundant_sweep(locked, parameter, pose_of(goal.data()), at.data(), values.data(), int(m),
                             rows.data());
    bool complete = true;
    std::fill(q.data(), q.data() + m * room * n, none);
    for (std::size_t i = 0; i < m; ++i) {
        complete = complete && rows[i].complete;
        count.data()[i] = rows[i].count;
        for (int k = 0; k < rows[i].count; ++k) {
            std::copy(rows[i].q[k], rows[i].q[k] + n, q.data() + (room * i + std::size_t(k)) * n);
            branch.data()[room * i + std::size_t(k)] = std::int8_t(rows[i].branch[k]);
        }
    }
    return complete;
}

}  // namespace

void bind_ik_redundant(nb::module_& m) {
    nb::class_<RedundantSolver>(m, "RedundantSolver", "Inverse kinematics of an arm with joints to spare.")
        .def("__init__", &make_solver, "axes"_a, "points"_a, "prismatic"_a, "T_zero"_a, "lower"_a, "upper"_a,
             "weight"_a, "Builds the solver from screws at zero, limits, and weights of distances (n,).")
        .def_prop_ro("held", &default_held, "The joints held unless others are named, ascending.")
        .def_prop_ro(
            "spare", [](const RedundantSolver& s) { return s.arm.spare; },
            "Joints beyond those that the tip needs to move as it can.")
        .def("spare_with", &spare_with_held, "held"_a, "How many dimensions stay free with joints held.")
        .def_prop_ro(
            "closed_form", [](const RedundantSolver& s) { return rank_of(s.arm.locked.arm) > 1; },
            "Whether the joints that move have a closed form.")
        .def(
            "serve_near",
            [](nb::handle self, nb::handle robot, nb::handle about) {
                if (!PyObject_TypeCheck(robot.ptr(), robot_type)) throw nb::type_error("a robot comes first");
                const ik::Redundant& arm = nb::cast<const RedundantSolver&>(self).arm;
                ik_set_near(robot.ptr(), &arm, self.ptr(), about.ptr());
            },
            "robot"_a, "about"_a,
            "Answers near= of this robot from now on, for one goal without other keywords.")
        .def(
            "serve_held",
            [](nb::handle self, nb::handle robot, const std::vector<int>& held, nb::handle about) {
                if (!PyObject_TypeCheck(robot.ptr(), robot_type)) throw nb::type_error("a robot comes first");
                const nb::object names = robot.attr("joint_names");
                auto& solver = nb::cast<RedundantSolver&>(self);
                if (!PyTuple_CheckExact(names.ptr()) || int(nb::len(names)) != solver.arm.chain.n)
                    throw nb::type_error("the solver is that of the robot's joints");
                ik_add_held(robot.ptr(), self.ptr(), names.ptr(), about.ptr(), held, &plan_of(solver, held));
            },
            "robot"_a, "held"_a, "about"_a,
            "Answers fixed= with these joints from now on, for one goal without other keywords.")
        .def("room", &room_of, "held"_a, "Rows that the solutions of a goal may need.")
        .def("solve", &solve_rows, "held"_a, "at"_a, "goals"_a, "idle"_a, "q"_a, "branch"_a, "family"_a,
             "count"_a, "status"_a, "threads"_a, "Every solution with joints held at their values.")
        .def("nearest", &nearest_rows, "goals"_a, "seeds"_a, "q"_a, "found"_a, "threads"_a,
             "The nearest configuration to each seed.")
        .def("intervals", &intervals_of, "parameter"_a, "goal"_a, "The feasible intervals of one held joint.")
        .def("sweep", &sweep_rows, "parameter"_a, "goal"_a, "at"_a, "values"_a, "q"_a, "branch"_a, "count"_a,
             "Every solution at many values of one held joint; whether none is missing.");
}
