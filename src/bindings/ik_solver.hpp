// The compiled half of cspace.ik.Solver: the kinematics of a chain and everything that inverse kinematics
// keeps of it.
#pragma once

#include <memory>
#include <vector>

#include "kinematics.hpp"
#include "library/ik_solver.hpp"

// Joints, one bit each, that leave no freedom when they are locked, and the plan of the others.
struct LockedSet {
    unsigned joints;
    const cspace::ik::LockedArm* plan;
};

struct SolverObject {
    KinematicsObject kinematics;
    std::unique_ptr<cspace::ik::Solver> solver;  // null until _ik_build; never replaced: threads may be in it
    PyObject* joint_names;                       // a tuple; null likewise
    // What the results of near= and of locked= carry; null until cspace.ik leaves it here.
    PyObject* nearest_about;
    PyObject* locked_about;
    std::vector<LockedSet> locked_sets;
};

extern PyTypeObject* solver_type;  // SolverBase; null until the module is filled

// The solver behind a Python object; null for every other object.
inline cspace::ik::Solver* solver_of(PyObject* object) {
    if (!PyObject_TypeCheck(object, solver_type)) return nullptr;
    return reinterpret_cast<SolverObject*>(object)->solver.get();
}

// solver.solve(goal, …); `method` is the name in messages about the arguments.
PyObject* solver_solve(PyObject* self, const char* method, PyObject* const* args, Py_ssize_t nargs,
                       PyObject* kwnames);
extern const char solve_doc[];
