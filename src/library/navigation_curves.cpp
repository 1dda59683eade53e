#include "navigation_curves.hpp"

#include "cspace/navigation/curves/dubins.hpp"
#include "cspace/navigation/curves/reeds_shepp.hpp"
#include "cspace/navigation/curves/sample.hpp"

namespace cspace::navigation {

Curve find_shortest_curve(bool reverses, const CarPose& start, const CarPose& goal, double radius) {
    return reverses ? reeds_shepp_curve(start, goal, radius) : dubins_curve(start, goal, radius);
}
double curve_length(bool reverses, const CarPose& start, const CarPose& goal, double radius) {
    return reverses ? reeds_shepp_distance(start, goal, radius) : dubins_distance(start, goal, radius);
}

void list_poses(const CarPose& start, std::span<const double> pieces, double radius,
                std::span<const double> s, CarPose* out) {
    std::vector<Piece> parts(pieces.size() / 2);
    for (std::size_t i = 0; i < parts.size(); ++i)
        parts[i] = {int(pieces[2 * i]), pieces[2 * i + 1] / radius};
    const LaidCurve curve(start, std::move(parts), radius);
    for (const double at : s) *out++ = curve.at(at / radius);
}

}  // namespace cspace::navigation
