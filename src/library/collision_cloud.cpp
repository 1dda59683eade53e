#include "collision_cloud.hpp"

#include <algorithm>
#include <limits>

#include "cspace/math/interrupts.hpp"
#include "cspace/shapes/distance.hpp"
#include "shapes_distance.hpp"

namespace cspace::collision {

namespace {

constexpr float far_away = 1e18f;  // its square is finite
constexpr int leaf_points = 16;    // points: a point takes a third of the time of a box

}  // namespace

CloudData::CloudData(std::span<const Vec3d> points, double radius)
    : bounds_(bound_points(points)),
      grid_(points.size(), bounds_),
      points_(grid_.sort_points(points)),
      nodes_(build_point_tree(points_, leaf_points)),
      radius_(radius) {
    constexpr std::size_t lanes = 8;  // that are read at once
    const std::size_t n = points_.size();
    for (std::vector<float>* column : {&x_, &y_, &z_}) column->resize(n + lanes, far_away);
    visit_range(0, n, [&](std::size_t i) {
        x_[i] = float(points_[i].x), y_[i] = float(points_[i].y), z_[i] = float(points_[i].z);
    });
    for (std::size_t k = 0; k < 3; ++k) bounds_.low[k] -= radius, bounds_.high[k] += radius;
}

Cloud CloudData::view() const {
    return {nodes_.data(),      x_.data(),           y_.data(),   z_.data(),
            int(nodes_.size()), round_high(radius_), grid_.view()};
}

shapes::Distance CloudData::distance(const Vec3d& point, double limit) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double reach = std::max(limit + radius_, 0.0);
    double square = reach * reach;
    const int found = find_nearest(nodes_, point, square, [&](int k) {
        const Vec3d apart = point - points_[std::size_t(k)];
        return dot(apart, apart);
    });
    if (found < 0) return {infinity, {0, 0, 1}};
    return shapes::from_place(point, points_[std::size_t(found)], radius_);
}

template <class Limit, class Visit>
bool CloudData::visit_balls(const shapes::Convex& solid, const Limit& limit, const Visit& visit) const {
    const double size = shapes::bound_size(solid) + radius_;
    return visit_near(
        nodes_, shapes::find_center(solid), [&] { return size + limit(); },
        [&](int k) { return visit(shapes::make_ball(points_[std::size_t(k)], radius_)); });
}

bool CloudData::is_within(const shapes::Convex& solid, double gap) const {
    return visit_balls(
        solid, [&] { return gap; },
        [&](const shapes::Convex& ball) { return shapes::is_within(solid, ball, gap); });
}

shapes::ConvexDistance CloudData::distance(const shapes::Convex& solid, double limit) const {
    shapes::ConvexDistance best = shapes::nothing_near(shapes::find_center(solid));
    visit_balls(
        solid, [&] { return std::min(limit, best.value); },
        [&](const shapes::Convex& ball) {
            const shapes::ConvexDistance d = shapes::measure_distance(solid, ball);
            if (d.value < best.value) best = d;
            return false;
        });
    return best;
}

}  // namespace cspace::collision
