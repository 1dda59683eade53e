#include <chrono>
#include <cstring>
#include <limits>
#include <string>

#include "bindings.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/version.hpp"
#include "kernels/dispatch.hpp"

namespace {

// The last part of a dotted name.
const char* name_of(const char* dotted) {
    const char* dot = std::strrchr(dotted, '.');
    return dot ? dot + 1 : dotted;
}

}  // namespace

PyTypeObject* add_type(nanobind::module_& m, PyType_Spec& spec, PyTypeObject* base) {
    PyObject* type = PyType_FromSpecWithBases(&spec, reinterpret_cast<PyObject*>(base));
    if (!type || PyModule_AddObjectRef(m.ptr(), name_of(spec.name), type) < 0) throw nanobind::python_error();
    return reinterpret_cast<PyTypeObject*>(type);
}

void ResultType::add(nanobind::module_& m, PyType_Spec& spec) {
    base_ = add_type(m, spec);
    const auto set_class = [this](nanobind::handle given) {
        auto* cls = reinterpret_cast<PyTypeObject*>(given.ptr());
        if (!PyType_Check(given.ptr()) || !PyType_IsSubtype(cls, base_))
            throw nanobind::type_error(
                (std::string(entry_) + " takes a subclass of " + name_of(base_->tp_name)).c_str());
        Py_XDECREF(made_of_);
        made_of_ = reinterpret_cast<PyTypeObject*>(given.inc_ref().ptr());
    };
    m.def(entry_, set_class, nanobind::arg("cls"), "Sets the class that results are made of.");
}

PyObject* ResultType::make(Py_ssize_t count) const {
    if (!made_of_) {
        PyObject* room = PyImport_ImportModule(module_);
        Py_XDECREF(room);
        if (!room) return nullptr;
        if (!made_of_)
            return PyErr_Format(PyExc_ImportError, "%s has not named the class of results", module_);
    }
    return made_of_->tp_alloc(made_of_, count);
}

using cspace::interrupts::Clock;

// When the time of a thread is over, and the class of what is raised then.
static thread_local Clock::time_point deadline = Clock::time_point::max();
static PyObject* time_over = nullptr;

static void check_deadline() {
    if (Clock::now() < deadline) return;
    PyErr_SetNone(time_over);
    throw nanobind::python_error();
}
// Raises what Python's signal handlers raise, KeyboardInterrupt among it. Any code may run in them.
static void check_signals() {
    const nanobind::gil_scoped_acquire held;
    if (PyErr_CheckSignals()) throw nanobind::python_error();
    check_deadline();
}
// In so many seconds, infinite for never; returns when it would have been.
static double set_deadline(double seconds) {
    using Seconds = std::chrono::duration<double>;
    constexpr double never = std::numeric_limits<double>::infinity(), longest = 1e9;
    const double before =
        deadline == Clock::time_point::max() ? never : Seconds(deadline - Clock::now()).count();
    cspace::interrupts::next_check = {};
    deadline = seconds < longest
                   ? Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(seconds))
                   : Clock::time_point::max();
    return before;
}
static void bind_deadline(nanobind::module_& m) {
    time_over = PyErr_NewExceptionWithDoc("cspace._core.TimeOver",
                                          "The time of a thread is over. No handler of errors catches it.",
                                          PyExc_BaseException, nullptr);
    if (!time_over) throw nanobind::python_error();
    m.attr("TimeOver") = nanobind::borrow(time_over);
    m.def("set_deadline", &set_deadline, nanobind::arg("seconds"),
          "From then on compiled code of this thread raises TimeOver where it heeds Ctrl-C; inf for never. "
          "Returns the seconds that were left before.");
    m.def("check_deadline", &check_deadline, "Raises TimeOver if the time of this thread is over.");
}

NB_MODULE(_core, m) {
    m.doc() = "The compiled core of cspace; use it through the package.";
    m.attr("__version__") = CSPACE_VERSION;
    cspace::set_interrupt_check(check_signals);
    bind_deadline(m);
    m.attr("isa") = cspace::kernels::isa_name();
#define CSPACE_FILL(part) bind_##part(m);
    CSPACE_BINDINGS(CSPACE_FILL)
}
