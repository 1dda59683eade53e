// What range sensors measure on maps, for cspace.maps.
#include "library/maps_sensing.hpp"

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::maps;

void bind_maps_sensing(nb::module_& m) {
    m.def("_cast_rays", cast_rays, "grid"_a, "points"_a, "angles"_a, "most"_a, WithoutLock(),
          "Ranges from rows of points at angles.");
    m.def("_likelihood_field", likelihood_field, "grid"_a, "sigma"_a, "floor"_a, WithoutLock(),
          "Scores (rows, columns) by the distance to the nearest blocked cell.");
    m.def("_likelihood_field", likelihood_field_of_known, "blocked"_a, "known"_a, "resolution"_a, "sigma"_a,
          "floor"_a, WithoutLock(), "The same of cells given as bytes, and 0 where they are not known.");
}
