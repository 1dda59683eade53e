// What the files of robot.ik share: the solver behind a robot, the result type, and how plain arrays are
// read.
#pragma once

#include <vector>

#include "library/ik_arm.hpp"
#include "robot.hpp"

// --- the solver ----------------------------------------------------------------------------------------
// The solver of a robot that has one; null for every other object.
inline const cspace::ik::BuiltArm* arm_of(PyObject* robot) {
    if (!PyObject_TypeCheck(robot, robot_type)) return nullptr;
    return static_cast<const cspace::ik::BuiltArm*>(reinterpret_cast<RobotObject*>(robot)->ik.get());
}

// --- the result ----------------------------------------------------------------------------------------
// Followed in memory by count rows of dof angles, count branch numbers and count flags (families).
struct SolutionsObject {
    PyObject_VAR_HEAD PyObject* robot;
    PyObject* note;   // why rows are missing, where a filter removed them; or null
    PyObject* about;  // of a goal that is no pose or leaves freedom: cspace.ik.context.About; or null
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
SolutionsObject* new_solutions(PyObject* robot, const double* goal, int count, int dof,
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

// --- near= and locked= (ik_near.cpp, ik_locked_joints.cpp)
// -------------------------------------------------------
namespace cspace::ik {
class RedundantSolver;
struct LockedArm;
}  // namespace cspace::ik
void ik_set_near(PyObject* robot, const cspace::ik::RedundantSolver* arm, PyObject* solver, PyObject* about);
PyObject* ik_serve_near(PyObject*, PyObject* args);
PyObject* ik_near(PyObject* robot, const double* goal, PyObject* seed);
void ik_add_locked(PyObject* robot, PyObject* solver, PyObject* names, PyObject* about,
                   const std::vector<int>& locked_joint, const cspace::ik::LockedArm* locked);
PyObject* ik_locked(PyObject* robot, const double* goal, PyObject* locked);

// --- the functions of each file ------------------------------------------------------------------------
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
