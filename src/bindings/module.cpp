#include <cstring>

#include "bindings.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/version.hpp"
#include "kernels/dispatch.hpp"

PyTypeObject* add_type(nanobind::module_& m, PyType_Spec& spec, PyTypeObject* base) {
    PyObject* type = PyType_FromSpecWithBases(&spec, reinterpret_cast<PyObject*>(base));
    if (!type || PyModule_AddObjectRef(m.ptr(), std::strrchr(spec.name, '.') + 1, type) < 0)
        throw nanobind::python_error();
    return reinterpret_cast<PyTypeObject*>(type);
}

// Raises what Python's signal handlers raise, KeyboardInterrupt among it. Any code may run in them.
static void check_signals() {
    const nanobind::gil_scoped_acquire held;
    if (PyErr_CheckSignals()) throw nanobind::python_error();
}

NB_MODULE(_core, m) {
    m.doc() = "The compiled core of cspace; use it through the package.";
    m.attr("__version__") = CSPACE_VERSION;
    cspace::set_interrupt_check(check_signals);
    m.attr("isa") = cspace::kernels::isa_name();
#define CSPACE_FILL(part) bind_##part(m);
    CSPACE_BINDINGS(CSPACE_FILL)
}
