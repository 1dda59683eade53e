// The distance of convex solids, compiled in one file of the library.
#pragma once

#include "cspace/shapes/convex_distance.hpp"

namespace cspace::shapes::detail {

extern template Simplex find_nearest_simplex(const ConvexPair&, double, double);
extern template ConvexDistance measure_cores(const Convex&, const Convex&);

}  // namespace cspace::shapes::detail
