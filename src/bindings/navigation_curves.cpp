// Curves for cars: plain checked arrays in, filled arrays out.
#include "library/navigation_curves.hpp"

#include "navigation_curves.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;

namespace {

using PosesOut = Array<double, nb::shape<-1, 3>>;
using Pieces = Array<const double, nb::shape<-1, 2>>;

void distances(bool reverses, Poses starts, Poses goals, double radius, RowOut out) {
    if (starts.shape(0) != out.size() || goals.shape(0) != out.size())
        throw nb::value_error("starts, goals and out must have equal lengths");
    const nb::gil_scoped_release free;
    const auto from = poses_of(starts), to = poses_of(goals);
    for (std::size_t k = 0; k < out.size(); ++k)
        out.data()[k] = curve_length(reverses, from[k], to[k], radius);
}

void poses_along(PoseRow start, Pieces pieces, double radius, Row s, PosesOut out) {
    if (s.size() != out.shape(0)) throw nb::value_error("out must have one pose per length");
    const nb::gil_scoped_release free;
    list_poses(pose_of(start), {pieces.data(), pieces.size()}, radius, {s.data(), s.size()},
               reinterpret_cast<CarPose*>(out.data()));
}

}  // namespace

void bind_navigation_curves(nb::module_& m) {
    m.def("_car_distances", distances, "reverses"_a, "starts"_a, "goals"_a, "radius"_a, "out"_a,
          "Lengths of Dubins or Reeds–Shepp curves between rows of poses, written into out.");
    m.def("_car_poses", poses_along, "start"_a, "pieces"_a, "radius"_a, "s"_a, "out"_a,
          "Poses at the lengths s along a curve, written into out.");
}
