#include "shapes_distance.hpp"

namespace cspace::shapes::detail {

template Simplex find_nearest_simplex(const ConvexPair&, double, double);
template ConvexDistance measure_cores(const Convex&, const Convex&);

}  // namespace cspace::shapes::detail
