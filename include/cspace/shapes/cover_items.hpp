// What spheres are to contain: small pieces of a surface, or cells of its inside, in a tree by place.
#pragma once

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

// Halves triangles across their longest sides until none is longer than `side`, and visits the parts.
template <class Visit>
void visit_parts(std::span<const Triangle> triangles, double side, Watch& watch, const Visit& visit) {
    std::vector<Triangle> waiting;
    for (const Triangle& whole : triangles) {
        waiting.push_back(whole);
        while (!waiting.empty()) {
            const Triangle t = waiting.back();
            waiting.pop_back();
            watch.step();
            std::size_t longest = 0;
            double square[3];
            for (std::size_t k = 0; k < 3; ++k) {
                square[k] = square_of(t[(k + 1) % 3] - t[k]);
                if (square[k] > square[longest]) longest = k;
            }
            if (square[longest] <= side * side) {
                visit(t);
                continue;
            }
            const Vec3d &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
            const Vec3d half = 0.5 * (a + b);
            waiting.push_back({a, half, c});
            waiting.push_back({half, b, c});
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
