#include "arrays.hpp"
#include "bindings.hpp"
#include "kernels/math_trig.hpp"

namespace nb = nanobind;

// The kernels write as many values as they read.
template <class... Others>
void same_size(const Row& x, const Others&... others) {
    if (((others.size() != x.size()) || ...)) throw nb::value_error("the arrays must have equal lengths");
}

void bind_math(nb::module_& m) {
    m.def(
        "sincos",
        [](Row x, RowOut s, RowOut c) {
            same_size(x, s, c);
            cspace::kernels::sincos_n(x.data(), s.data(), c.data(), x.size());
        },
        nb::arg("x"), nb::arg("sin"), nb::arg("cos"),
        "Sine and cosine of x (n,) [rad], written into sin and cos.");
    m.def(
        "atan2",
        [](Row y, Row x, RowOut a) {
            same_size(x, y, a);
            cspace::kernels::atan2_n(y.data(), x.data(), a.data(), x.size());
        },
        nb::arg("y"), nb::arg("x"), nb::arg("angle"),
        "Angle of the vectors (x, y) [rad], written into angle.");
    m.def(
        "acos",
        [](Row x, RowOut a) {
            same_size(x, a);
            cspace::kernels::acos_n(x.data(), a.data(), x.size());
        },
        nb::arg("x"), nb::arg("angle"), "Inverse cosine of x (n,) [rad], written into angle.");
    m.def(
        "asin",
        [](Row x, RowOut a) {
            same_size(x, a);
            cspace::kernels::asin_n(x.data(), a.data(), x.size());
        },
        nb::arg("x"), nb::arg("angle"), "Inverse sine of x (n,) [rad], written into angle.");
}
