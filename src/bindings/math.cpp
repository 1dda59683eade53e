#include <nanobind/ndarray.h>

#include "bindings.hpp"
#include "trig.hpp"

namespace nb = nanobind;
using In = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Out = nb::ndarray<double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

void bind_math(nb::module_& m) {
    m.def(
        "sincos",
        [](In x, Out s, Out c) { cspace::kernels::sincos_n(x.data(), s.data(), c.data(), x.size()); },
        nb::arg("x"), nb::arg("sin"), nb::arg("cos"),
        "Sine and cosine of x (n,) [rad], written into sin and cos.");
    m.def(
        "atan2", [](In y, In x, Out a) { cspace::kernels::atan2_n(y.data(), x.data(), a.data(), x.size()); },
        nb::arg("y"), nb::arg("x"), nb::arg("angle"),
        "Angle of the vectors (x, y) [rad], written into angle.");
    m.def(
        "acos", [](In x, Out a) { cspace::kernels::acos_n(x.data(), a.data(), x.size()); }, nb::arg("x"),
        nb::arg("angle"), "Inverse cosine of x (n,) [rad], written into angle.");
    m.def(
        "asin", [](In x, Out a) { cspace::kernels::asin_n(x.data(), a.data(), x.size()); }, nb::arg("x"),
        nb::arg("angle"), "Inverse sine of x (n,) [rad], written into angle.");
}
