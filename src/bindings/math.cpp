#include "arrays.hpp"
#include "bindings.hpp"
#include "kernels/math_trig.hpp"

namespace nb = nanobind;

// Defines what calls a kernel for arrays of one length, of which it writes the last.
template <class... Arrays, class Kernel, class... Names>
void def_elementwise(nb::module_& m, const char* name, Kernel kernel, const char* doc, Names... names) {
    const auto call = [kernel](const Row& x, const Arrays&... others) {
        if (((others.size() != x.size()) || ...)) throw nb::value_error("the arrays must have equal lengths");
        kernel(x.data(), others.data()..., x.size());
    };
    m.def(name, call, nb::arg(names)..., doc);
}

void bind_math(nb::module_& m) {
    using namespace cspace::kernels;
    def_elementwise<RowOut, RowOut>(m, "sincos", sincos_n,
                                    "Sine and cosine of x (n,) [rad], written into sin and cos.", "x", "sin",
                                    "cos");
    def_elementwise<Row, RowOut>(m, "atan2", atan2_n,
                                 "Angle of the vectors (x, y) [rad], written into angle.", "y", "x", "angle");
    def_elementwise<RowOut>(m, "acos", acos_n, "Inverse cosine of x (n,) [rad], written into angle.", "x",
                            "angle");
    def_elementwise<RowOut>(m, "asin", asin_n, "Inverse sine of x (n,) [rad], written into angle.", "x",
                            "angle");
}
