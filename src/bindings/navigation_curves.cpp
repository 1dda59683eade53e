// Curves for cars: plain checked arrays in, filled arrays out.
#include <cstdint>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/curves/dubins.hpp"
#include "cspace/navigation/curves/reeds_shepp.hpp"
#include "cspace/navigation/curves/sample.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;

namespace {

using PoseRow = Array<const double, nb::shape<3>>;
using Poses = Array<const double, nb::shape<-1, 3>>;
using PosesOut = Array<double, nb::shape<-1, 3>>;
using Pieces = Array<const double, nb::shape<-1, 2>>;

CarPose pose_of(const double* row) { return {row[0], row[1], row[2]}; }

void distances(bool reverses, Poses starts, Poses goals, double radius, RowOut out) {
    if (starts.shape(0) != out.size() || goals.shape(0) != out.size())
        throw nb::value_error("as many starts, goals and distances");
    nb::gil_scoped_release free;
    for (std::size_t k = 0; k < out.size(); ++k) {
        const CarPose from = pose_of(starts.data() + 3 * k), to = pose_of(goals.data() + 3 * k);
        out.data()[k] = reverses ? reeds_shepp_distance(from, to, radius) : dubins_distance(from, to, radius);
    }
}

void poses_along(PoseRow start, Pieces pieces, double radius, Row s, PosesOut out) {
    if (s.size() != out.shape(0)) throw nb::value_error("a pose for every length");
    std::vector<Piece> parts(pieces.shape(0));
    for (std::size_t i = 0; i < parts.size(); ++i)
        parts[i] = {int(pieces.data()[2 * i]), pieces.data()[2 * i + 1] / radius};
    const CarPose from = pose_of(start.data());
    nb::gil_scoped_release free;
    const LaidCurve curve(from, std::move(parts), radius);
    for (std::size_t k = 0; k < s.size(); ++k) {
        const CarPose at = curve.at(s.data()[k] / radius);
        out.data()[3 * k] = at.x, out.data()[3 * k + 1] = at.y, out.data()[3 * k + 2] = at.theta;
    }
}

}  // namespace

void bind_navigation_curves(nb::module_& m) {
    m.def("_car_distances", distances, "reverses"_a, "starts"_a, "goals"_a, "radius"_a, "out"_a,
          "Lengths of Dubins or Reeds–Shepp curves between rows of poses, written into out.");
    m.def("_car_poses", poses_along, "start"_a, "pieces"_a, "radius"_a, "s"_a, "out"_a,
          "Poses at the lengths s along a curve, written into out.");
}
