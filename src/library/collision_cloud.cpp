#include "collision_cloud.hpp"

#include <cmath>
#include <limits>

#include "cspace/math/interrupts.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::collision {

namespace {

constexpr int leaf_size = 8;  // points

}  // namespace

CloudData::CloudData(std::span<const double> points, double radius) : radius_(radius) {
    const std::size_t n = points.size() / 3;
    Tree tree = build_point_tree(points, leaf_size);
    nodes_ = std::move(tree.nodes);
    points_.resize(n), x_.resize(n), y_.resize(n), z_.resize(n);
    double largest = radius;
    bounds_ = {{points[0], points[1], points[2]}, {points[0], points[1], points[2]}};
    visit_range(0, n, [&](std::size_t i) {
        const double* p = &points[3 * std::size_t(tree.order[i])];
        points_[i] = {p[0], p[1], p[2]};
        x_[i] = float(p[0]), y_[i] = float(p[1]), z_[i] = float(p[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            largest = std::max(largest, std::fabs(p[k]));
            bounds_.low[k] = std::min(bounds_.low[k], p[k] - radius);
            bounds_.high[k] = std::max(bounds_.high[k], p[k] + radius);
        }
    });
    grown_ = largest * tolerance::float_rounding;
}

Cloud CloudData::view() const {
    return {nodes_.data(), x_.data(), y_.data(), z_.data(), int(nodes_.size()), float(radius_ + grown_)};
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

}  // namespace cspace::collision
