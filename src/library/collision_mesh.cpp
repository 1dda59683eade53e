#include "collision_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/collision/tree_gap.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/shapes/triangle.hpp"
#include "cspace/tolerances.hpp"
#include "shapes_distance.hpp"

namespace cspace::collision {

namespace {

using shapes::Corners;

constexpr int leaf_triangles = 2;  // triangles: a triangle takes as long as three boxes

Vec3d read_vector(const double* v) { return {v[0], v[1], v[2]}; }
void copy_rounded(const Vec3d& from, float* to) {
    to[0] = float(from.x), to[1] = float(from.y), to[2] = float(from.z);
}

Bounds bound_triangle(const double* t) {
    Bounds box;
    for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min({t[k], t[3 + k], t[6 + k]});
        box.high[k] = std::max({t[k], t[3 + k], t[6 + k]});
    }
    return box;
}

// The corners turned so that a and b are the ends of the longest side.
Corners turn_longest(const Corners& t) {
    const auto square = [](const Vec3d& v) { return dot(v, v); };
    const double ab = square(t.b - t.a), bc = square(t.c - t.b), ca = square(t.a - t.c);
    if (ab >= bc && ab >= ca) return t;
    if (bc >= ca) return {t.b, t.c, t.a};
    return {t.c, t.a, t.b};
}
float invert_square(double x, double y) {
    constexpr double least = 1e-36;  // [m²]: corners that are equal as floats
    const double square = x * x + y * y;
    return square > least ? float(1 / square) : 0.0f;
}
Triangle round_triangle(const Corners& given) {
    const Corners t = turn_longest(given);
    const Vec3d ab = t.b - t.a, ac = t.c - t.a;
    const double side = norm(ab);
    Triangle rounded = {};
    copy_rounded(t.a, rounded.corner);
    const Vec3d x = side > 0 ? (1 / side) * ab : Vec3d{1, 0, 0};
    const double along = dot(ac, x);
    const Vec3d across = ac - along * x;
    const double height = norm(across);
    const bool is_flat = height <= shapes::flat_triangle * side;
    const Vec3d y = is_flat ? any_perpendicular(x) : (1 / height) * across;
    copy_rounded(x, rounded.axes);
    copy_rounded(y, rounded.axes + 3);
    copy_rounded(cross(x, y), rounded.axes + 6);
    rounded.side = float(side);
    rounded.apex[0] = float(along), rounded.apex[1] = is_flat ? 0.0f : float(height);
    const double c_x = rounded.apex[0], c_y = rounded.apex[1];
    rounded.inverse_a_c = invert_square(c_x, c_y);
    rounded.inverse_b_c = invert_square(c_x - double(rounded.side), c_y);
    return rounded;
}

template <class S>
Facet<S> make_facet(const Corners& t) {
    const Vec3d* order[] = {&t.a, &t.b, &t.c};
    S turn = 1;
    const auto sort_two = [&](int i, int j) {
        if (S(order[i]->y) <= S(order[j]->y)) return;
        std::swap(order[i], order[j]);
        turn = -turn;
    };
    sort_two(0, 1), sort_two(1, 2), sort_two(0, 1);
    const Vec3d normal = cross(*order[1] - *order[0], *order[2] - *order[0]);
    const double length = norm(normal), scale = length > 0 ? 1 / length : 0;
    Facet<S> facet = {};
    const auto copy = [](const Vec3d& from, S* to) {
        to[0] = S(from.x), to[1] = S(from.y), to[2] = S(from.z);
    };
    copy(*order[0], facet.low), copy(*order[1], facet.middle), copy(*order[2], facet.high);
    copy(scale * normal, facet.normal);
    facet.bottom = std::min({facet.low[2], facet.middle[2], facet.high[2]});
    facet.top = std::max({facet.low[2], facet.middle[2], facet.high[2]});
    facet.turn = turn;
    return facet;
}

}  // namespace

MeshData::MeshData(std::span<const double> triangles, bool is_solid) {
    const std::size_t n = triangles.size() / 9;
    std::vector<Bounds> boxes(n);
    double largest = 0;
    visit_range(0, n, [&](std::size_t i) {
        const Bounds& box = boxes[i] = bound_triangle(&triangles[9 * i]);
        for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, box.high[k] - box.low[k]);
    });
    bounds_ = bound_all(boxes);
    // Corners of a triangle that a ball touches are beyond its centre by the size of the triangle at most.
    // The slack of robots covers the rounding of places as far away as the centre, this the rest.
    grown_ = 4 * largest * tolerance::float_rounding;
    Tree tree = build_tree(boxes, leaf_triangles, grown_);
    nodes_ = std::move(tree.nodes);
    visit_range(0, n, [&](std::size_t i) {
        const double* t = &triangles[9 * std::size_t(tree.order[i])];
        corners_.push_back({read_vector(t), read_vector(t + 3), read_vector(t + 6)});
        triangles_.push_back(round_triangle(corners_.back()));
        if (!is_solid) return;
        facets_.push_back(make_facet<float>(corners_.back()));
    });
}

Mesh MeshData::view() const {
    return {nodes_.data(), triangles_.data(), facets_.empty() ? nullptr : facets_.data(), int(nodes_.size()),
            float(grown_)};
}

bool MeshData::contains(const Vec3d& point) const {
    if (facets_.empty()) return false;
    const auto is_under = [&](const TreeNode& node) {
        return point.x > double(node.low[0]) && point.x < double(node.high[0]) &&
               point.y > double(node.low[1]) && point.y < double(node.high[1]) &&
               point.z < double(node.high[2]);
    };
    if (!is_under(nodes_[0]) || point.z < double(nodes_[0].low[2])) return false;
    double exits = 0;
    for (std::size_t i = 0; i < nodes_.size();) {
        const TreeNode& node = nodes_[i];
        if (!is_under(node)) {
            i = std::size_t(node.next);
            continue;
        }
        for (int k = node.first; k < node.first + node.count; ++k)
            exits += count_exits(make_facet<double>(corners_[std::size_t(k)]), point.x, point.y, point.z);
        ++i;
    }
    return exits > 0.5;
}

bool MeshData::is_within(const shapes::Convex& solid, double gap) const {
    const Vec3d center = shapes::find_center(solid);
    const double reach = shapes::bound_size(solid) + gap;
    const auto touches = [&](int k) { return shapes::is_within(solid, triangle_at(k), gap); };
    return visit_near(nodes_, center, [&] { return reach; }, touches) || contains(center);
}

std::optional<shapes::ConvexDistance> MeshData::distance(const shapes::Convex& solid, double limit) const {
    const Vec3d center = shapes::find_center(solid);
    const double size = shapes::bound_size(solid);
    if (contains(center)) return {};
    shapes::ConvexDistance best = shapes::nothing_near(center);
    const bool touches = visit_near(
        nodes_, center, [&] { return size + std::min(limit, best.value); },
        [&](int k) {
            const shapes::ConvexDistance d = shapes::measure_distance(solid, triangle_at(k));
            if (d.value < best.value) best = d;
            return d.value <= 0;
        });
    if (touches) return {};
    return best;
}

shapes::Convex MeshData::triangle_at(int k) const {
    const Corners& t = corners_[std::size_t(k)];
    const Vec3d points[] = {t.a, t.b, t.c};
    return shapes::make_points(points, 3, 0);
}

shapes::Distance MeshData::distance(const Vec3d& point, double limit) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool is_inside = contains(point);
    double square = is_inside || limit == infinity ? infinity : std::max(limit, 0.0) * std::max(limit, 0.0);
    const int found = find_nearest(nodes_, point, square, [&](int k) {
        const Vec3d foot = shapes::nearest_on_triangle(point, corners_[std::size_t(k)]);
        return dot(point - foot, point - foot);
    });
    if (found < 0) return {infinity, {0, 0, 1}};
    const Vec3d nearest = shapes::nearest_on_triangle(point, corners_[std::size_t(found)]);
    const Vec3d apart = point - nearest;
    const double length = norm(apart);
    if (length > 0) {
        const double sign = is_inside ? -1 : 1;
        return {sign * length, (sign / length) * apart};
    }
    const Corners& t = corners_[std::size_t(found)];
    const Vec3d normal = cross(t.b - t.a, t.c - t.a);
    const double size = norm(normal);
    return {0, size > 0 ? (1 / size) * normal : Vec3d{0, 0, 1}};
}

}  // namespace cspace::collision
