// The answer for one goal, as a raw Python type: cspace.ik.Solutions is its subclass.
#include <nanobind/stl/vector.h>
#include <structmember.h>

#include <cstring>

#include "bindings.hpp"
#include "ik.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

ResultType solutions_type("cspace.ik.solutions", "_ik_results");

// Followed in memory by count rows of dof angles, count branch numbers and count flags (self-motions).
struct SolutionsObject {
    PyObject_VAR_HEAD PyObject* solver;
    PyObject* note;   // why rows are missing, where a filter removed them; or null
    PyObject* about;  // of an invalid goal or leaves freedom: cspace.ik.context.About; or null
    double goal[16];
    int count, dof;
    ik::Status status;
    bool complete;
    double q[1];

    std::size_t size() const { return std::size_t(count) * std::size_t(dof); }
    std::int8_t* branches() { return reinterpret_cast<std::int8_t*>(q + size()); }
    char* self_motions() { return reinterpret_cast<char*>(branches() + count); }
};
SolutionsObject* object_of(PyObject* self) { return reinterpret_cast<SolutionsObject*>(self); }

}  // namespace

PyObject* new_solutions(PyObject* solver, const double* goal, const ik::SolutionRows& rows, PyObject* about) {
    const int dof = solver_object(solver)->core->chain().n;
    PyObject* self = solutions_type.make(rows.count * dof + (2 * rows.count + 7) / 8);
    if (!self) return nullptr;
    SolutionsObject* made = object_of(self);
    made->solver = Py_NewRef(solver);
    made->about = Py_XNewRef(about);
    std::memcpy(made->goal, goal, sizeof made->goal);
    made->count = rows.count;
    made->dof = dof;
    made->status = rows.status;
    made->complete = rows.complete;
    rows.copy_rows(rows.count, dof, made->q);
    std::memcpy(made->branches(), rows.branch, std::size_t(rows.count));
    if (rows.self_motion) std::memcpy(made->self_motions(), rows.self_motion, std::size_t(rows.count));
    return self;
}

namespace {

// A solver may hold its own results as an attribute, so results take part in the search for cycles.
using Slots = Collected<SolutionsObject, free_object, &SolutionsObject::solver, &SolutionsObject::note,
                        &SolutionsObject::about>;

PyObject* get_q(PyObject* self, void*) {
    return new_array({object_of(self)->count, object_of(self)->dof}, object_of(self)->q);
}
// A position goal is kept as a pose whose rotation is NaN.
PyObject* get_goal(PyObject* self, void*) {
    const double* goal = object_of(self)->goal;
    const double position[3] = {goal[3], goal[7], goal[11]};
    return goal[0] == goal[0] ? new_array({4, 4}, goal) : new_array({3}, position);
}
PyObject* get_verdict(PyObject* self, void*) {
    const SolutionsObject* s = object_of(self);
    return PyLong_FromLong(static_cast<long>(s->status) + (s->complete ? 0 : ik::incomplete));
}
PyObject* get_branch_numbers(PyObject* self, void*) {
    SolutionsObject* s = object_of(self);
    PyObject* list = PyTuple_New(s->count);
    for (int k = 0; list && k < s->count; ++k) PyTuple_SET_ITEM(list, k, PyLong_FromLong(s->branches()[k]));
    return list;
}
PyObject* get_is_self_motion(PyObject* self, void*) {
    SolutionsObject* s = object_of(self);
    PyObject* list = PyTuple_New(s->count);
    for (int k = 0; list && k < s->count; ++k)
        PyTuple_SET_ITEM(list, k, PyBool_FromLong(s->self_motions()[k]));
    return list;
}
Py_ssize_t count_rows(PyObject* self) { return object_of(self)->count; }
int has_rows(PyObject* self) { return object_of(self)->count > 0; }

PyMemberDef members[] = {
    {"solver", T_OBJECT, offsetof(SolutionsObject, solver), READONLY, "The solver that was asked."},
    {"_note", T_OBJECT, offsetof(SolutionsObject, note), READONLY,
     "Why rows are missing, if a filter removed them."},
    {"_about", T_OBJECT, offsetof(SolutionsObject, about), READONLY,
     "What there is to say about an invalid goal, or None."},
    {nullptr, 0, 0, 0, nullptr}};
PyGetSetDef attributes[] = {
    {"q", get_q, nullptr, "The configurations (k, dof) [rad, m].", nullptr},
    {"goal", get_goal, nullptr, "The goal T_base_tip (4, 4).", nullptr},
    {"_verdict", get_verdict, nullptr, "The status as a number; 8 more if solutions may be missing.",
     nullptr},
    {"_branch_numbers", get_branch_numbers, nullptr, "Which branch of the closed form each row comes from.",
     nullptr},
    {"_is_self_motion", get_is_self_motion, nullptr, "Which rows stand for a self-motion.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(&Slots::destroy)},
                       {Py_tp_traverse, reinterpret_cast<void*>(&Slots::visit)},
                       {Py_tp_clear, reinterpret_cast<void*>(&Slots::clear)},
                       {Py_tp_members, members},
                       {Py_tp_getset, attributes},
                       {Py_sq_length, reinterpret_cast<void*>(&count_rows)},
                       {Py_nb_bool, reinterpret_cast<void*>(&has_rows)},
                       {Py_tp_doc, const_cast<char*>("The compiled half of cspace.ik.Solutions.")},
                       {0, nullptr}};
PyType_Spec spec = {
    "cspace._core.SolutionsBase", offsetof(SolutionsObject, q), sizeof(double),
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

nb::object make_solutions(SolverArgument solver, const ConstDoubles& goal, int status, const ConstDoubles& q,
                          const std::vector<int>& branches, const std::vector<bool>& self_motions,
                          nb::handle note, nb::handle about) {
    const int code = status & ~ik::incomplete, n = solver.core().chain().n;
    const std::size_t k = branches.size();
    if (status < 0 || code > int(ik::Status::nearest))
        throw nb::type_error("_ik_make takes a status it knows");
    if (k > 1 << 24 || self_motions.size() != k || q.size != npy_intp(k) * n || goal.size != 16)
        throw nb::type_error("_ik_make takes rows of the solver's joints and tuples of one length");
    const std::vector<std::int8_t> numbers(branches.begin(), branches.end());
    const std::vector<char> flags(self_motions.begin(), self_motions.end());
    const nb::object result =
        solutions_from(new_solutions(solver.object, goal.data,
                                     {int(k), q.data, n, numbers.data(), flags.data(),
                                      static_cast<ik::Status>(code), !(status & ik::incomplete)},
                                     about.is_none() ? nullptr : about.ptr()));
    if (!note.is_none()) object_of(result.ptr())->note = note.inc_ref().ptr();
    return result;
}

}  // namespace

void bind_ik_result(nb::module_& m) {
    solutions_type.add(m, spec);
    m.def("_ik_make", make_solutions, "solver"_a, "goal"_a, "status"_a, "q"_a, "branches"_a, "self_motions"_a,
          "note"_a.none(), "about"_a.none() = nb::none(), "A result from its parts.");
}
