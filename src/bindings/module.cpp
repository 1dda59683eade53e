#include <cstring>

#include "bindings.hpp"
#include "cspace/version.hpp"
#include "kernels/dispatch.hpp"

PyTypeObject* add_type(nanobind::module_& m, PyType_Spec& spec, PyTypeObject* base) {
    PyObject* type = PyType_FromSpecWithBases(&spec, reinterpret_cast<PyObject*>(base));
    if (!type || PyModule_AddObjectRef(m.ptr(), std::strrchr(spec.name, '.') + 1, type) < 0)
        throw nanobind::python_error();
    return reinterpret_cast<PyTypeObject*>(type);
}

NB_MODULE(_core, m) {
    m.doc() = "The compiled core of cspace; use it through the package.";
    m.attr("__version__") = CSPACE_VERSION;
    m.attr("isa") = cspace::kernels::isa_name();
#define CSPACE_FILL(part) bind_##part(m);
    CSPACE_BINDINGS(CSPACE_FILL)
}
