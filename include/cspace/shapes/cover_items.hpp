// What spheres are to contain: small pieces of a surface, or cells of its inside, in a tree by place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cspace/shapes/box_tree.hpp"
#include "cspace/shapes/smallest_ball.hpp"
#include "cspace/shapes/triangle_surface.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

// Thrown where a cover would need more items than are allowed.
struct TooFine {};

// Consecutive items.
struct Run {
    std::uint32_t begin, end;
};

inline Box box_around(const Triangle& triangle) { return box_of(triangle); }
inline Box box_around(const Box& box) { return box; }
// The square of the distance from a point to the farthest place of an item.
inline double farthest_square(const Triangle& t, const Vec3d& p) {
    return std::max({square_of(t[0] - p), square_of(t[1] - p), square_of(t[2] - p)});
}

template <class Item>
class CoverItems {
  public:
    CoverItems(const std::vector<Item>& items, Watch& watch)
        : tree_(boxes_of(items, watch), leaf_size, watch) {
        items_.reserve(items.size());
        for (const std::uint32_t k : tree_.order()) items_.push_back(items[k]), watch.step();
    }
    std::size_t size() const { return items_.size(); }
    const Item& operator[](std::size_t k) const { return items_[k]; }

    // The items that lie whole in a ball.
    void find_inside(const Vec3d& center, double radius, std::vector<Run>& runs) const {
        runs.clear();
        const double square = radius > 0 ? radius * radius : -1;
        const auto append = [&](std::uint32_t begin, std::uint32_t end) {
            if (!runs.empty() && runs.back().end == begin)
                runs.back().end = end;
            else
                runs.push_back({begin, end});
        };
        tree_.walk([&](const BoxTree::Node& node) {
            if (nearest_square(node.box, center) > square) return false;
            if (farthest_square(node.box, center) <= square) return append(node.begin, node.end), false;
            if (node.second) return true;
            for (std::uint32_t k = node.begin; k < node.end; ++k)
                if (farthest_square(items_[k], center) <= square) append(k, k + 1);
            return false;
        });
    }

  private:
    static constexpr std::size_t leaf_size = 4;
    BoxTree tree_;
    std::vector<Item> items_;

    static std::vector<Box> boxes_of(const std::vector<Item>& items, Watch& watch) {
        std::vector<Box> boxes;
        boxes.reserve(items.size());
        for (const Item& item : items) boxes.push_back(box_around(item)), watch.step();
        return boxes;
    }
};

inline double area_of(const Triangle& t) { return 0.5 * norm(cross(t[1] - t[0], t[2] - t[0])); }

// A triangle as its longest side from a to b, and the corner c, in the same sense.
struct LongSide {
    Vec3d a, b, c;
    double square;
};
inline LongSide find_long_side(const Triangle& t) {
    std::size_t longest = 0;
    double square[3];
    for (std::size_t k = 0; k < 3; ++k) {
        square[k] = square_of(t[(k + 1) % 3] - t[k]);
        if (square[k] > square[longest]) longest = k;
    }
    return {t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3], square[longest]};
}

inline std::array<Triangle, 2> halve_triangle(const LongSide& t) {
    const Vec3d half = 0.5 * (t.a + t.b);
    return {Triangle{t.a, half, t.c}, Triangle{half, t.b, t.c}};
}

// Cuts a long triangle across its longest side into strips of about this width, each one or two triangles.
// Halves of halves would be many more.
inline void cut_strips(const LongSide& t, double width, std::vector<Triangle>& parts) {
    const double share = std::clamp(dot(t.c - t.a, t.b - t.a) / t.square, 0.0, 1.0);
    constexpr double most = 64;  // longer triangles are cut again
    const Vec3d foot = t.a + share * (t.b - t.a);
    for (const bool forward : {true, false}) {
        const Vec3d& end = forward ? t.b : t.a;
        const double strips = std::clamp(std::ceil(norm(end - foot) / width), 1.0, most);
        Vec3d low = foot, high = t.c;
        for (double i = 1; i <= strips; ++i) {
            const bool last = i == strips;
            const Vec3d next_low = last ? end : foot + (i / strips) * (end - foot);
            const Vec3d next_high = last ? end : t.c + (i / strips) * (end - t.c);
            parts.push_back(forward ? Triangle{low, next_low, high} : Triangle{low, high, next_low});
            if (!last)
                parts.push_back(forward ? Triangle{next_low, next_high, high}
                                        : Triangle{next_low, high, next_high});
            low = next_low, high = next_high;
        }
    }
}

// Divides triangles until no side is longer than `side`, and visits the parts: halves across the longest
// side, and strips of triangles that are more than `slender` times as long as high.
template <class Visit>
void visit_parts(std::span<const Triangle> triangles, double side, Watch& watch, const Visit& visit) {
    constexpr double slender = 3, diagonal = 0.7;  // a strip as wide as this and as high is `side` across
    std::vector<Triangle> waiting;
    for (const Triangle& whole : triangles) {
        waiting.push_back(whole);
        while (!waiting.empty()) {
            const Triangle t = waiting.back();
            waiting.pop_back();
            watch.step();
            const LongSide longest = find_long_side(t);
            const double twice_area = 2 * area_of(t);
            if (longest.square <= side * side) {
                visit(t);
            } else if (longest.square > slender * twice_area) {
                cut_strips(longest, std::max(diagonal * side, twice_area / std::sqrt(longest.square)),
                           waiting);
            } else {
                for (const Triangle& half : halve_triangle(longest)) waiting.push_back(half);
            }
        }
    }
}

// These parts. Throws TooFine for more than `most`.
inline std::vector<Triangle> split_triangles(std::span<const Triangle> triangles, double side,
                                             std::size_t most, Watch& watch) {
    std::size_t count = 0;
    visit_parts(triangles, side, watch, [&](const Triangle&) {
        if (++count > most) throw TooFine();
    });
    std::vector<Triangle> parts;
    parts.reserve(count);  // a vector that grows is copied, which takes long
    visit_parts(triangles, side, watch, [&](const Triangle& t) { parts.push_back(t); });
    return parts;
}

}  // namespace cspace::shapes
