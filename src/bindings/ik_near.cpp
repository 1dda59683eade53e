// robot.ik(T, near=q) of an arm with joints to spare: the compiled entry for one goal and one seed. The first
// call goes through cspace.ik.redundant, which leaves the solver here.
#include <cmath>
#include <cstring>

#include "cspace/ik/goal.hpp"
#include "ik_redundant.hpp"
#include "ik_shared.hpp"

using namespace cspace;

namespace {

struct NearEntry {
    const ik::Redundant* arm;
    PyObject* solver;  // keeps the arm
    PyObject* about;   // which freedom is left

    ~NearEntry() {
        Py_DECREF(solver);
        Py_DECREF(about);
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

// By the turn that comes closest to the seed, inside the limits if one is.
double by_closest_turn(const ik::Redundant& arm, int i, double q, double seed) {
    constexpr double turn = 6.283185307179586;
    if (arm.chain.prismatic[i]) return q;
    const double least = std::ceil((arm.lower[i] - q) / turn), most = std::floor((arm.upper[i] - q) / turn);
    const double wanted = std::nearbyint((seed - q) / turn);
    const double turns = least <= most ? std::fmin(std::fmax(wanted, least), most) : wanted;
    return q + turn * turns;
}

}  // namespace

void ik_set_near(PyObject* robot, const ik::Redundant* arm, PyObject* solver, PyObject* about) {
    auto& slot = reinterpret_cast<RobotObject*>(robot)->near;
    if (!slot) slot = std::shared_ptr<NearEntry>(new NearEntry{arm, Py_NewRef(solver), Py_NewRef(about)});
}

// Null without an error for what is not answered here.
PyObject* ik_near(PyObject* robot, const double* goal, PyObject* seed) {
    const auto* entry = static_cast<const NearEntry*>(reinterpret_cast<RobotObject*>(robot)->near.get());
    if (!entry || !is_seed(seed, entry->arm->chain.n)) return nullptr;
    const ik::Redundant& arm = *entry->arm;
    const ReadGoal<double> read = read_goal(goal);
    double q[ik::max_joints];
    if (!read.is_pose || !kernels::redundant_nearest(arm, read.T, data_of(seed), q)) return nullptr;
    SolutionsObject* made = new_solutions(robot, goal, 1, arm.chain.n, ik::Status::exact);
    if (!made) return nullptr;
    for (int i = 0; i < arm.chain.n; ++i) made->q[i] = by_closest_turn(arm, i, q[i], data_of(seed)[i]);
    branches_of(made)[0] = -1;
    families_of(made)[0] = 0;
    made->about = Py_NewRef(entry->about);
    return reinterpret_cast<PyObject*>(made);
}
