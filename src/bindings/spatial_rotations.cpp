#include "kernels/spatial_rotations.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Quaternions = Array<const double, nb::shape<-1, 4>>;
using Matrices = Array<double, nb::shape<-1, 3, 3>>;

}  // namespace

void bind_spatial_rotations(nb::module_& m) {
    m.def(
        "quaternion_matrices",
        [](Quaternions q, bool scalar_last, Matrices R) {
            require_sizes(q.shape(0) == R.shape(0));
            nb::gil_scoped_release released;
            return cspace::kernels::quaternion_matrices_n(q.data(), scalar_last, R.data(), R.shape(0));
        },
        "q"_a, "scalar_last"_a, "R"_a,
        "Rotations of quaternions (n, 4) of any length, written into R (n, 3, 3); False if a row needs "
        "care.");
    m.def(
        "rotvec_matrices",
        [](Vectors w, Matrices R) {
            require_sizes(w.shape(0) == R.shape(0));
            nb::gil_scoped_release released;
            return cspace::kernels::rotvec_matrices_n(w.data(), R.data(), R.shape(0));
        },
        "w"_a, "R"_a,
        "Rotations of rotation vectors (n, 3) [rad], written into R (n, 3, 3); False if a row needs care.");
    m.def(
        "axis_angle_matrices",
        [](Vectors axis, Row angle, Matrices R) {
            require_sizes(axis.shape(0) == R.shape(0) && angle.shape(0) == R.shape(0));
            nb::gil_scoped_release released;
            return cspace::kernels::axis_angle_matrices_n(axis.data(), angle.data(), R.data(), R.shape(0));
        },
        "axis"_a, "angle"_a, "R"_a,
        "Rotations by angles (n,) [rad] about axes (n, 3) of any length, written into R (n, 3, 3); False if "
        "a row needs care.");
}
