// What the files of inverse kinematics share: the solver behind an object, and the result of one goal.
#pragma once

#include <memory>
#include <vector>

#include "arrays_in_place.hpp"
#include "kinematics.hpp"
#include "library/ik_solver.hpp"

// --- the solver ----------------------------------------------------------------------------------------
// Joints, one bit each, that leave no freedom when they are locked, and the plan of the others.
struct LockedSet {
    unsigned joints;
    const cspace::ik::LockedArm* plan;
};

// The compiled half of cspace.ik.Solver: the kinematics of a chain and everything that inverse kinematics
// keeps of it.
struct SolverObject {
    KinematicsObject kinematics;
    std::unique_ptr<cspace::ik::Solver> core;  // null until _ik_build; never replaced: threads may be in it
    PyObject* joint_names;                     // a tuple; null likewise
    // What the results of near= and of locked= carry; null until cspace.ik leaves it here.
    PyObject* nearest_about;
    PyObject* locked_about;
    std::vector<LockedSet> locked_sets;
};
inline SolverObject* solver_object(PyObject* self) { return reinterpret_cast<SolverObject*>(self); }

extern PyTypeObject* solver_type;  // SolverBase; null until the module is filled

// A solver as an argument; whatever is none, or not built yet, is refused.
struct SolverArgument {
    PyObject* object = nullptr;

    cspace::ik::Solver& core() const { return *solver_object(object)->core; }
    const cspace::ik::BuiltArm& arm() const { return core().arm(); }
    bool read(PyObject* value) {
        object = value;
        return PyObject_TypeCheck(value, solver_type) && solver_object(value)->core;
    }
};
template <>
struct nanobind::detail::type_caster<SolverArgument> {
    NB_TYPE_CASTER(SolverArgument, const_name("solver"))
    bool from_python(handle given, std::uint32_t, cleanup_list*) noexcept { return value.read(given.ptr()); }
};

// solver.solve(goal, …); `method` is the name in messages about the arguments.
PyObject* solver_solve(PyObject* self, const char* method, PyObject* const* args, Py_ssize_t nargs,
                       PyObject* kwnames);
extern const char solve_doc[];

// One goal with one keyword; of near= within the limits of the arm or without any. Null without an error for
// what is not answered there.
PyObject* solve_near(PyObject* solver, const double* goal, PyObject* seed, bool within_limits);
PyObject* solve_locked(PyObject* solver, const double* goal, PyObject* locked);

// --- the result ----------------------------------------------------------------------------------------
// A result with rows of the joints of a solver; about: of an invalid goal or leaves freedom, a
// cspace.ik.context.About, or null. Null with an error set.
PyObject* new_solutions(PyObject* solver, const double* goal, const cspace::ik::SolutionRows& rows,
                        PyObject* about = nullptr);
inline nanobind::object solutions_from(PyObject* result) {
    if (!result) throw nanobind::python_error();
    return nanobind::steal(result);
}
