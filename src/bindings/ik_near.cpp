// robot.ik(T, near=q): the compiled entry for one goal and one seed. The first call goes through cspace.ik,
// which leaves here what it takes: the solver of joints to spare, or the limits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "cspace/ik/goal.hpp"
#include "ik.hpp"
#include "ik_redundant.hpp"
#include "ik_shared.hpp"

using namespace cspace;

namespace {

struct NearEntry {
    const ik::Redundant* arm = nullptr;  // of joints to spare; null where a goal settles the joints
    PyObject* solver = nullptr;          // keeps the arm; null likewise
    PyObject* about = nullptr;           // which freedom is left; null likewise
    double lower[ik::max_joints], upper[ik::max_joints];

    ~NearEntry() {
        Py_XDECREF(solver);
        Py_XDECREF(about);
    }
};

bool is_seed(PyObject* value, int n) {
    if (!PyArray_CheckExact(value) || !is_doubles(value, n) ||
        PyArray_NDIM(reinterpret_cast<PyArrayObject*>(value)) != 1)
        return false;
    for (int i = 0; i < n; ++i)
        if (!(std::fabs(data_of(value)[i]) <= tolerance::farthest)) return false;
    return true;
}

// By the turn that comes closest to the seed, inside the limits if one is; on a limit that rounding takes it
// past.
double by_closest_turn(const NearEntry& entry, const ik::Chain& chain, int i, double q, double seed) {
    constexpr double turn = 6.283185307179586, on_limit = 1e-9;
    if (chain.prismatic[i]) return q;
    const double lower = entry.lower[i], upper = entry.upper[i];
    const double least = std::ceil((lower - on_limit - q) / turn);
    const double most = std::floor((upper + on_limit - q) / turn);
    const double wanted = std::nearbyint((seed - q) / turn);
    const double turns = least <= most ? std::fmin(std::fmax(wanted, least), most) : wanted;
    const double moved = q + turn * turns, inside = std::fmin(std::fmax(moved, lower), upper);
    return std::fabs(moved - inside) <= on_limit ? inside : moved;
}

PyObject* one_row(PyObject* robot, const double* goal, const double* q, int n, int branch, PyObject* about) {
    SolutionsObject* made = new_solutions(robot, goal, 1, n, ik::Status::exact);
    if (!made) return nullptr;
    std::copy(q, q + n, made->q);
    branches_of(made)[0] = std::int8_t(branch);
    families_of(made)[0] = 0;
    made->about = Py_XNewRef(about);
    return reinterpret_cast<PyObject*>(made);
}

// Among joints to spare.
PyObject* nearest_of_manifold(PyObject* robot, const NearEntry& entry, const double* goal,
                              const double* seed) {
    const ik::Redundant& arm = *entry.arm;
    const ReadGoal<double> read = read_goal(goal);
    double q[ik::max_joints];
    if (!read.is_pose || !kernels::redundant_nearest(arm, read.T, seed, q)) return nullptr;
    for (int i = 0; i < arm.chain.n; ++i) q[i] = by_closest_turn(entry, arm.chain, i, q[i], seed[i]);
    return one_row(robot, goal, q, arm.chain.n, -1, entry.about);
}

// Of rows q, each followed by the next, brought beside the seed by whole turns; null where there are none.
PyObject* nearest_row(PyObject* robot, const NearEntry& entry, const ik::Chain& chain, const double* goal,
                      const double* seed, const double* q, int stride, const std::int8_t* branch, int count) {
    double best[ik::max_joints], least = std::numeric_limits<double>::infinity();
    int row = -1;
    for (int k = 0; k < count; ++k) {
        double turned[ik::max_joints], sum = 0;
        for (int i = 0; i < chain.n; ++i) {
            turned[i] = by_closest_turn(entry, chain, i, q[k * stride + i], seed[i]);
            sum += (turned[i] - seed[i]) * (turned[i] - seed[i]);
        }
        if (!(sum < least)) continue;
        least = sum;
        row = k;
        std::copy(turned, turned + chain.n, best);
    }
    return row < 0 ? nullptr : one_row(robot, goal, best, chain.n, branch[row], nullptr);
}

// Among solutions that are listed and stand alone.
PyObject* nearest_of_list(PyObject* robot, const NearEntry& entry, const double* goal, const double* seed) {
    const ik::Arm* arm = arm_of(robot);
    if (!arm || !can_solve(*arm)) return nullptr;
    const ik::Chain& chain = arm->plan.chain;
    if (arm->has_plan) {
        double q[max_branches * 6];
        std::int8_t branch[max_branches];
        int count;
        if (kernels::ik_one(arm->plan, goal, q, branch, &count) == ik::Quick::settled)
            return nearest_row(robot, entry, chain, goal, seed, q, 6, branch, count);
    }
    const ReadGoal<double> read = read_goal(goal);
    if (!read.is_pose) return nullptr;
    const ik::Solutions found = solve_pose(*arm, read.T, seed);
    if (found.status != ik::Status::exact || !found.complete) return nullptr;
    return nearest_row(robot, entry, chain, goal, seed, found.q[0], ik::max_arm, found.branch, found.count);
}

NearEntry* new_entry(PyObject* robot) {
    auto& slot = reinterpret_cast<RobotObject*>(robot)->near;
    if (slot) return nullptr;
    auto made = std::make_shared<NearEntry>();
    NearEntry* entry = made.get();
    slot = std::move(made);
    return entry;
}

}  // namespace

void ik_set_near(PyObject* robot, const ik::Redundant* arm, PyObject* solver, PyObject* about) {
    NearEntry* entry = new_entry(robot);
    if (!entry) return;
    entry->arm = arm;
    entry->solver = Py_NewRef(solver);
    entry->about = Py_NewRef(about);
    std::copy(arm->lower, arm->lower + arm->chain.n, entry->lower);
    std::copy(arm->upper, arm->upper + arm->chain.n, entry->upper);
}

// _ik_serve_near(robot, lower (n,), upper (n,)): near= of this robot is answered here from now on.
PyObject* ik_serve_near(PyObject*, PyObject* args) {
    PyObject *robot, *lower, *upper;
    if (!PyArg_ParseTuple(args, "OOO", &robot, &lower, &upper)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    const int n = arm ? arm->plan.chain.n : 0;
    if (!arm || !can_solve(*arm) || !is_doubles(lower, n) || !is_doubles(upper, n)) {
        PyErr_SetString(PyExc_TypeError, "_ik_serve_near takes a robot with a solver and its limits");
        return nullptr;
    }
    if (NearEntry* entry = new_entry(robot)) {
        std::copy(data_of(lower), data_of(lower) + n, entry->lower);
        std::copy(data_of(upper), data_of(upper) + n, entry->upper);
    }
    Py_RETURN_NONE;
}

// Null without an error for what is not answered here.
PyObject* ik_near(PyObject* robot, const double* goal, PyObject* seed) {
    const auto* entry = static_cast<const NearEntry*>(reinterpret_cast<RobotObject*>(robot)->near.get());
    if (!entry) return nullptr;
    const int n = entry->arm ? entry->arm->chain.n : arm_of(robot)->plan.chain.n;
    if (!is_seed(seed, n)) return nullptr;
    const auto answer = entry->arm ? nearest_of_manifold : nearest_of_list;
    return answer(robot, *entry, goal, data_of(seed));
}
