// A surface of triangles: the nearest place, and how often a closed one winds around a point.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/math/vec.hpp"
#include "cspace/shapes/box_tree.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

using Triangle = std::array<Vec3d, 3>;

// What distances from a surface may be off by, over its extent: a triangle that is thinner than this counts
// as its sides, and the unit normal of another is off by as much.
inline constexpr double surface_rounding = 1e-7;

class TriangleSurface {
  public:
    struct Nearest {
        Vec3d place;
        double square;           // of the distance [m²]
        std::uint32_t triangle;  // its place in triangles()
    };

    // faces: numbers of vertices, at least one face.
    TriangleSurface(std::span<const Vec3d> vertices, std::span<const std::array<std::int32_t, 3>> faces,
                    Watch& watch)
        : tree_(boxes_of(vertices, faces, watch), leaf_size, watch) {
        triangles_.reserve(faces.size()), facets_.reserve(faces.size());
        for (const std::uint32_t f : tree_.order()) {
            triangles_.push_back(corners_of(vertices, faces[f]));
            facets_.push_back(facet_of(triangles_.back()));
            watch.step();
        }
    }

    std::span<const Triangle> triangles() const { return triangles_; }
    Vec3d normal(std::size_t triangle) const { return facets_[triangle].normal; }  // zero where it is thin
    const BoxTree& tree() const { return tree_; }
    const Box& bounds() const { return tree_.nodes()[0].box; }
    // The diagonal of the bounding box [m].
    double extent() const { return norm(bounds().high - bounds().low); }

    Nearest nearest(const Vec3d& p) const {
        Nearest best = {p, infinite, 0};
        tree_.walk_nearest(p, best.square, [&](std::uint32_t k) { approach(p, k, best); });
        return best;
    }
    double distance(const Vec3d& p) const { return std::sqrt(nearest(p).square); }

    // How often the surface, which must be closed, winds around a point off it. Counts what a ray along an
    // axis crosses; where rounding leaves that open for all axes, sums solid angles.
    int winding(const Vec3d& p) const {
        const Box& box = bounds();
        if (nearest_square(box, p) > 0) return 0;
        for (int axis = 0; axis < 3; ++axis) {
            int crossings = 0;
            if (count_crossings(p, axis, crossings)) return crossings;
        }
        return int(std::lround(sum_angles(p)));
    }

  private:
    struct Facet {
        Vec3d normal;    // unit; zero where the triangle is thin
        Vec3d along[3];  // unit vectors of the sides, zero for sides of no length
        double length[3];
    };
    static constexpr std::size_t leaf_size = 4;
    BoxTree tree_;
    std::vector<Triangle> triangles_;
    std::vector<Facet> facets_;

    static Triangle corners_of(std::span<const Vec3d> vertices, const std::array<std::int32_t, 3>& face) {
        return {vertices[std::size_t(face[0])], vertices[std::size_t(face[1])],
                vertices[std::size_t(face[2])]};
    }
    static std::vector<Box> boxes_of(std::span<const Vec3d> vertices,
                                     std::span<const std::array<std::int32_t, 3>> faces, Watch& watch) {
        std::vector<Box> boxes;
        boxes.reserve(faces.size());
        for (const auto& face : faces) boxes.push_back(box_of(corners_of(vertices, face))), watch.step();
        return boxes;
    }
    static Facet facet_of(const Triangle& t) {
        Facet facet = {};
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d side = t[(k + 1) % 3] - t[k];
            facet.length[k] = norm(side);
            if (facet.length[k] > 0) facet.along[k] = (1 / facet.length[k]) * side;
            longest = std::max(longest, facet.length[k]);
        }
        const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
        const double twice_area = norm(n);
        if (twice_area > surface_rounding * longest * longest) facet.normal = (1 / twice_area) * n;
        return facet;
    }

    // Makes the nearest place of triangle k the best one if it is nearer.
    void approach(const Vec3d& p, std::uint32_t k, Nearest& best) const {
        const Facet& facet = facets_[k];
        const Triangle& corner = triangles_[k];
        const double height = dot(facet.normal, p - corner[0]);
        if (height * height >= best.square) return;
        const bool thin = square_of(facet.normal) == 0;
        bool above = !thin;  // p lies above the triangle, not beside it
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d d = p - corner[i];
            if (!thin && dot(cross(facet.normal, facet.along[i]), d) >= 0) continue;
            above = false;
            const double along = std::clamp(dot(facet.along[i], d), 0.0, facet.length[i]);
            const Vec3d place = corner[i] + along * facet.along[i];
            const double square = square_of(p - place);
            if (square < best.square) best = {place, square, k};
        }
        if (above) best = {p - height * facet.normal, height * height, k};
    }

    // Adds the signed crossings of the ray from p along an axis; false where rounding leaves one open.
    bool count_crossings(const Vec3d& p, int axis, int& crossings) const {
        double Vec3d::* const parts[] = {&Vec3d::x, &Vec3d::y, &Vec3d::z, &Vec3d::x, &Vec3d::y};
        const auto u = parts[axis + 1], v = parts[axis + 2], w = parts[axis];
        bool sure = true;
        tree_.walk([&](const BoxTree::Node& node) {
            const Box& b = node.box;
            if (!sure || p.*u < b.low.*u || p.*u > b.high.*u || p.*v < b.low.*v || p.*v > b.high.*v ||
                p.*w > b.high.*w)
                return false;
            if (node.second) return true;
            for (std::uint32_t k = node.begin; k < node.end && sure; ++k)
                sure = add_crossing(p, triangles_[k], u, v, w, crossings);
            return false;
        });
        return sure;
    }

    static bool add_crossing(const Vec3d& p, const Triangle& t, double Vec3d::* u, double Vec3d::* v,
                             double Vec3d::* w, int& crossings) {
        // Of a sum of products of differences, over the sum of their magnitudes: a few roundings of 2⁻⁵³.
        constexpr double rounding = 0x1p-49;
        const Vec3d d[] = {t[0] - p, t[1] - p, t[2] - p};
        if (d[0].*w < 0 && d[1].*w < 0 && d[2].*w < 0) return true;
        double area[3], height = 0, height_sum = 0;
        int left = 0, right = 0;
        for (std::size_t i = 0; i < 3; ++i) {  // opposite to corner i
            const Vec3d &a = d[(i + 1) % 3], &b = d[(i + 2) % 3];
            const double x = a.*u * b.*v, y = a.*v * b.*u;
            area[i] = x - y;
            const double sum = std::fabs(x) + std::fabs(y);
            if (area[i] > rounding * sum) ++left;
            if (area[i] < -rounding * sum) ++right;
            height += area[i] * d[i].*w;
            height_sum += sum * std::fabs(d[i].*w);
        }
        if (left && right) return true;
        if (left + right < 3) return false;
        if (!(std::fabs(height) > rounding * height_sum)) return false;
        if ((height > 0) == (left > 0)) crossings += left ? 1 : -1;
        return true;
    }

    // Solid angles over 4π (van Oosterom & Strackee 1983).
    double sum_angles(const Vec3d& p) const {
        InterruptPoll poll(1 << 10);
        double total = 0;
        for (const Triangle& t : triangles_) {
            const Vec3d a = t[0] - p, b = t[1] - p, c = t[2] - p;
            const double la = norm(a), lb = norm(b), lc = norm(c);
            const double rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            total += std::atan2(dot(a, cross(b, c)), rest);
            poll.step();
        }
        return total / (2 * std::numbers::pi);
    }
};

}  // namespace cspace::shapes
