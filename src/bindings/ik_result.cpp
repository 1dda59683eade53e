// The answer for one goal, as a raw Python type: cspace.ik.Solutions is its subclass.
#include <cstring>

#include "ik_shared.hpp"

using namespace cspace;

namespace {

PyTypeObject* solutions_type = nullptr;  // the Python class that results are made of
PyTypeObject* base_type = nullptr;       // SolutionsBase

}  // namespace

SolutionsObject* new_solutions(PyObject* solver, const double* goal, int count, int dof, ik::Status status) {
    if (!solutions_type) {
        PyObject* room = PyImport_ImportModule("cspace.ik.solutions");
        if (!room) return nullptr;
        Py_DECREF(room);
        if (!solutions_type) {
            PyErr_SetString(PyExc_ImportError, "cspace.ik.solutions has not named the class of results");
            return nullptr;
        }
    }
    auto* made = reinterpret_cast<SolutionsObject*>(
        solutions_type->tp_alloc(solutions_type, count * dof + (2 * count + 7) / 8));
    if (!made) return nullptr;
    made->solver = Py_NewRef(solver);
    std::memcpy(made->goal, goal, sizeof made->goal);
    made->count = count;
    made->dof = dof;
    made->status = status;
    made->complete = true;
    return made;
}

namespace {

// A solver may hold its own results as an attribute, so results take part in the search for cycles.
int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    Py_VISIT(reinterpret_cast<SolutionsObject*>(self)->solver);
    Py_VISIT(reinterpret_cast<SolutionsObject*>(self)->note);
    Py_VISIT(reinterpret_cast<SolutionsObject*>(self)->about);
    return 0;
}
int clear(PyObject* self) {
    Py_CLEAR(reinterpret_cast<SolutionsObject*>(self)->solver);
    Py_CLEAR(reinterpret_cast<SolutionsObject*>(self)->note);
    Py_CLEAR(reinterpret_cast<SolutionsObject*>(self)->about);
    return 0;
}
void destroy(PyObject* self) {
    PyTypeObject* type = Py_TYPE(self);
    PyObject_GC_UnTrack(self);
    clear(self);
    type->tp_free(self);
    Py_DECREF(type);
}

PyObject* get_q(PyObject* self, void*) {
    auto* s = reinterpret_cast<SolutionsObject*>(self);
    npy_intp shape[2] = {s->count, s->dof};
    PyObject* array = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
    if (array)
        std::memcpy(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)), s->q,
                    sizeof(double) * std::size_t(s->count * s->dof));
    return array;
}
// A position goal is kept as a pose whose rotation is NaN.
PyObject* get_goal(PyObject* self, void*) {
    const double* goal = reinterpret_cast<SolutionsObject*>(self)->goal;
    const bool is_position = goal[0] != goal[0];
    npy_intp shape[2] = {is_position ? 3 : 4, 4};
    PyObject* array = PyArray_SimpleNew(is_position ? 1 : 2, shape, NPY_DOUBLE);
    if (!array) return nullptr;
    auto* out = static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)));
    for (int i = 0; i < (is_position ? 3 : 16); ++i) out[i] = goal[is_position ? 4 * i + 3 : i];
    return array;
}
PyObject* get_solver(PyObject* self, void*) {
    return Py_NewRef(reinterpret_cast<SolutionsObject*>(self)->solver);
}
PyObject* get_note(PyObject* self, void*) {
    PyObject* note = reinterpret_cast<SolutionsObject*>(self)->note;
    return Py_NewRef(note ? note : Py_None);
}
PyObject* get_about(PyObject* self, void*) {
    PyObject* about = reinterpret_cast<SolutionsObject*>(self)->about;
    return Py_NewRef(about ? about : Py_None);
}
PyObject* get_verdict(PyObject* self, void*) {
    const auto* s = reinterpret_cast<SolutionsObject*>(self);
    return PyLong_FromLong(static_cast<long>(s->status) + (s->complete ? 0 : ik::incomplete));
}
PyObject* get_branch_numbers(PyObject* self, void*) {
    auto* s = reinterpret_cast<SolutionsObject*>(self);
    PyObject* list = PyTuple_New(s->count);
    for (int k = 0; list && k < s->count; ++k) PyTuple_SET_ITEM(list, k, PyLong_FromLong(branches_of(s)[k]));
    return list;
}
PyObject* get_is_self_motion(PyObject* self, void*) {
    auto* s = reinterpret_cast<SolutionsObject*>(self);
    PyObject* list = PyTuple_New(s->count);
    for (int k = 0; list && k < s->count; ++k)
        PyTuple_SET_ITEM(list, k, PyBool_FromLong(self_motions_of(s)[k]));
    return list;
}
Py_ssize_t length(PyObject* self) { return reinterpret_cast<SolutionsObject*>(self)->count; }
int truth(PyObject* self) { return reinterpret_cast<SolutionsObject*>(self)->count > 0; }

PyGetSetDef attributes[] = {
    {"q", get_q, nullptr, "The configurations (k, dof) [rad, m].", nullptr},
    {"goal", get_goal, nullptr, "The goal T_base_tip (4, 4).", nullptr},
    {"solver", get_solver, nullptr, "The solver that was asked.", nullptr},
    {"_note", get_note, nullptr, "Why rows are missing, if a filter removed them.", nullptr},
    {"_about", get_about, nullptr, "What there is to say about an invalid goal, or None.", nullptr},
    {"_verdict", get_verdict, nullptr, "The status as a number; 8 more if solutions may be missing.",
     nullptr},
    {"_branch_numbers", get_branch_numbers, nullptr, "Which branch of the closed form each row comes from.",
     nullptr},
    {"_is_self_motion", get_is_self_motion, nullptr, "Which rows stand for a self-motion.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(&destroy)},
                       {Py_tp_traverse, reinterpret_cast<void*>(&traverse)},
                       {Py_tp_clear, reinterpret_cast<void*>(&clear)},
                       {Py_tp_getset, attributes},
                       {Py_sq_length, reinterpret_cast<void*>(&length)},
                       {Py_nb_bool, reinterpret_cast<void*>(&truth)},
                       {Py_tp_doc, const_cast<char*>("The compiled half of cspace.ik.Solutions.")},
                       {0, nullptr}};
PyType_Spec spec = {
    "cspace._core.SolutionsBase", offsetof(SolutionsObject, q), sizeof(double),
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

constexpr int last_status = static_cast<int>(ik::Status::nearest);

}  // namespace

int ik_add_result_type(PyObject* module) {
    PyObject* type = PyType_FromSpec(&spec);
    if (!type || PyModule_AddObjectRef(module, "SolutionsBase", type) < 0) return -1;
    base_type = reinterpret_cast<PyTypeObject*>(type);  // kept for good
    return 0;
}

// _ik_make(solver, goal (4, 4), status, q (k, dof), branches (k), self_motion (k), note, about=None) →
// solutions
PyObject* ik_make(PyObject*, PyObject* args) {
    PyObject *solver, *goal, *q, *branches, *self_motions, *note, *about = Py_None;
    int status;
    if (!PyArg_ParseTuple(args, "OOiOO!O!O|O", &solver, &goal, &status, &q, &PyTuple_Type, &branches,
                          &PyTuple_Type, &self_motions, &note, &about))
        return nullptr;
    const Py_ssize_t k = PyTuple_GET_SIZE(branches);
    const bool shaped = PyArray_Check(q) && PyArray_NDIM(reinterpret_cast<PyArrayObject*>(q)) == 2;
    const npy_intp dof = shaped ? PyArray_DIM(reinterpret_cast<PyArrayObject*>(q), 1) : -1;
    if (!solver_of(solver) || status < 0 || (status & ~ik::incomplete) > last_status) {
        PyErr_SetString(PyExc_TypeError, "_ik_make takes a solver and a status it knows");
        return nullptr;
    }
    if (!shaped || k > 1 << 24 || PyTuple_GET_SIZE(self_motions) != k || !is_doubles(q, k * dof) ||
        !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError, "_ik_make takes contiguous float64 arrays and tuples of one length");
        return nullptr;
    }
    SolutionsObject* made = new_solutions(solver, data_of(goal), int(k), int(dof),
                                          static_cast<ik::Status>(status & ~ik::incomplete));
    if (!made) return nullptr;
    made->complete = !(status & ik::incomplete);
    std::memcpy(made->q, data_of(q), sizeof(double) * std::size_t(k * dof));
    for (Py_ssize_t i = 0; i < k; ++i) {
        branches_of(made)[i] = static_cast<std::int8_t>(PyLong_AsLong(PyTuple_GET_ITEM(branches, i)));
        self_motions_of(made)[i] = PyObject_IsTrue(PyTuple_GET_ITEM(self_motions, i)) == 1;
    }
    made->note = note == Py_None ? nullptr : Py_NewRef(note);
    made->about = about == Py_None ? nullptr : Py_NewRef(about);
    if (PyErr_Occurred()) Py_CLEAR(made);
    return reinterpret_cast<PyObject*>(made);
}

// _ik_results(cls): results are made of this class from now on.
PyObject* ik_results(PyObject*, PyObject* cls) {
    if (!PyType_Check(cls) || !PyType_IsSubtype(reinterpret_cast<PyTypeObject*>(cls), base_type)) {
        PyErr_SetString(PyExc_TypeError, "_ik_results takes a subclass of SolutionsBase");
        return nullptr;
    }
    Py_XDECREF(solutions_type);
    solutions_type = reinterpret_cast<PyTypeObject*>(Py_NewRef(cls));
    Py_RETURN_NONE;
}
