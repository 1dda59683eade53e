// What the files of inverse kinematics share: the solver behind an object, the result type, and how plain
// arrays are read.
#pragma once

#include <vector>

#include "ik_solver.hpp"

// The plan of the arm of a solver; null for every other object.
inline const cspace::ik::BuiltArm* arm_of(PyObject* object) {
    cspace::ik::Solver* solver = solver_of(object);
    return solver ? &solver->arm() : nullptr;
}

// --- the result ----------------------------------------------------------------------------------------
// Followed in memory by count rows of dof angles, count branch numbers and count flags (families).
struct SolutionsObject {
    PyObject_VAR_HEAD PyObject* solver;
    PyObject* note;   // why rows are missing, where a filter removed them; or null
    PyObject* about;  // of an invalid goal or leaves freedom: cspace.ik.context.About; or null
    double goal[16];
    int count, dof;
    cspace::ik::Status status;
    bool complete;
    double q[1];
};
inline std::int8_t* branches_of(SolutionsObject* s) {
    return reinterpret_cast<std::int8_t*>(s->q + std::ptrdiff_t(s->count) * s->dof);
}
inline std::int8_t* self_motions_of(SolutionsObject* s) { return branches_of(s) + s->count; }

// A complete result without note whose rows are still to be written; null with an error set.
SolutionsObject* new_solutions(PyObject* solver, const double* goal, int count, int dof,
                               cspace::ik::Status status);

// --- plain arrays --------------------------------------------------------------------------------------
inline double* data_of(PyObject* array) {
    return static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)));
}
inline bool is_plain(PyObject* value, int type, npy_intp size) {
    if (!PyArray_Check(value)) return false;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    return PyArray_EquivTypenums(PyArray_TYPE(array), type) && PyArray_ISCARRAY_RO(array) &&
           PyArray_SIZE(array) == size;
}
inline bool is_doubles(PyObject* value, npy_intp size) { return is_plain(value, NPY_DOUBLE, size); }
inline bool is_writable(PyObject* array) {
    return PyArray_ISWRITEABLE(reinterpret_cast<PyArrayObject*>(array));
}

// --- one goal with one keyword: near= or locked= ----------------------------------------------------------
// Null without an error for what is not answered there.
PyObject* ik_near(PyObject* solver, const double* goal, PyObject* seed);
PyObject* ik_locked(PyObject* solver, const double* goal, PyObject* locked);

// --- the functions of each file ------------------------------------------------------------------------
// ik_solver.cpp
PyObject* ik_build(PyObject*, PyObject* args);
// ik_result.cpp
int ik_add_result_type(PyObject* module);
PyObject* ik_make(PyObject*, PyObject* args);
PyObject* ik_results(PyObject*, PyObject* cls);
// ik_batch.cpp
PyObject* ik_many(PyObject*, PyObject* args);
PyObject* ik_positions(PyObject*, PyObject* args);
// ik_self_motion.cpp
PyObject* ik_direction(PyObject*, PyObject* args);
PyObject* ik_follow(PyObject*, PyObject* args);
PyObject* ik_onto(PyObject*, PyObject* args);
