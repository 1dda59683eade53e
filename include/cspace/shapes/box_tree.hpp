// A tree of axis-aligned boxes around items, split at the median of the longest side.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "cspace/math/vec.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

struct Box {
    Vec3d low, high;
};

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr Box nothing = {{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}};

inline Box join_boxes(const Box& a, const Box& b) {
    return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
            {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}
inline Box box_of(std::span<const Vec3d> points) {
    Box box = nothing;
    for (const Vec3d& p : points) box = join_boxes(box, {p, p});
    return box;
}
// One of the eight parts of a box around its middle.
inline Box octant_of(const Box& box, const Vec3d& middle, int k) {
    Box part = box;
    (k & 1 ? part.low.x : part.high.x) = middle.x;
    (k & 2 ? part.low.y : part.high.y) = middle.y;
    (k & 4 ? part.low.z : part.high.z) = middle.z;
    return part;
}
inline Vec3d middle_of(const Box& box) { return 0.5 * (box.low + box.high); }
inline double square_of(const Vec3d& v) { return dot(v, v); }

// The square of the distance from a point to the nearest place of a box; 0 inside.
inline double nearest_square(const Box& box, const Vec3d& p) {
    const double x = std::max(std::max(box.low.x - p.x, p.x - box.high.x), 0.0);
    const double y = std::max(std::max(box.low.y - p.y, p.y - box.high.y), 0.0);
    const double z = std::max(std::max(box.low.z - p.z, p.z - box.high.z), 0.0);
    return x * x + y * y + z * z;
}
// The same to the farthest corner.
inline double farthest_square(const Box& box, const Vec3d& p) {
    const double x = std::max(p.x - box.low.x, box.high.x - p.x);
    const double y = std::max(p.y - box.low.y, box.high.y - p.y);
    const double z = std::max(p.z - box.low.z, box.high.z - p.z);
    return x * x + y * y + z * z;
}

class BoxTree {
  public:
    // The items order()[begin] … order()[end − 1] lie in the box. The first child follows its parent.
    struct Node {
        Box box;
        std::uint32_t begin, end;
        std::uint32_t second;  // the second child; 0: a leaf
    };

    // leaf_size: the most items of a leaf, at least 2.
    BoxTree(std::span<const Box> boxes, std::size_t leaf_size, Watch& watch) : order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        std::vector<Vec3d> middles;
        middles.reserve(boxes.size());
        for (const Box& box : boxes) middles.push_back(middle_of(box)), watch.step();
        nodes_.reserve(boxes.size() * 4 / leaf_size + 1);  // leaves are at least half full
        if (!boxes.empty()) build(boxes, middles, 0, std::uint32_t(boxes.size()), leaf_size, watch);
    }

    std::span<const std::uint32_t> order() const { return order_; }
    std::span<const Node> nodes() const { return nodes_; }
    const Node& first_child(const Node& node) const { return *(&node + 1); }
    const Node& second_child(const Node& node) const { return nodes_[node.second]; }

    // Visits nodes from the root down; enter(node) tells whether its children are visited.
    template <class Enter>
    void walk(const Enter& enter) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, deepest> waiting;
        std::size_t count = 0;
        waiting[count++] = 0;
        while (count) {
            const std::uint32_t at = waiting[--count];
            const Node& node = nodes_[at];
            if (!enter(node) || !node.second) continue;
            waiting[count++] = node.second;
            waiting[count++] = at + 1;
        }
    }

    // Calls measure(k) for places k of the order, near ones first, while boxes are nearer to p than the root
    // of `square`, which measure lowers.
    template <class Measure>
    void walk_nearest(const Vec3d& p, const double& square, const Measure& measure) const {
        if (nodes_.empty()) return;
        struct Waiting {
            std::uint32_t node;
            double square;
        };
        std::array<Waiting, deepest> waiting;
        std::size_t count = 0;
        waiting[count++] = {0, nearest_square(nodes_[0].box, p)};
        while (count) {
            const Waiting next = waiting[--count];
            if (next.square >= square) continue;
            const Node& node = nodes_[next.node];
            if (!node.second) {
                for (std::uint32_t k = node.begin; k < node.end; ++k) measure(k);
                continue;
            }
            Waiting near = {next.node + 1, nearest_square(nodes_[next.node + 1].box, p)};
            Waiting far = {node.second, nearest_square(nodes_[node.second].box, p)};
            if (far.square < near.square) std::swap(near, far);
            waiting[count++] = far;
            waiting[count++] = near;
        }
    }

  private:
    static constexpr std::size_t deepest = 72;  // halves of 2³² items, twice over
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;

    void build(std::span<const Box> boxes, std::span<const Vec3d> middles, std::uint32_t begin,
               std::uint32_t end, std::size_t leaf_size, Watch& watch) {
        const std::size_t at = nodes_.size();
        Box box = nothing, centers = nothing;
        for (std::uint32_t k = begin; k < end; ++k, watch.step()) {
            box = join_boxes(box, boxes[order_[k]]);
            centers = join_boxes(centers, {middles[order_[k]], middles[order_[k]]});
        }
        nodes_.push_back({box, begin, end, 0});
        if (end - begin <= leaf_size) return;
        const Vec3d size = centers.high - centers.low;
        double Vec3d::* const axis = size.x >= size.y && size.x >= size.z ? &Vec3d::x
                                     : size.y >= size.z                   ? &Vec3d::y
                                                                          : &Vec3d::z;
        const std::uint32_t half = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             watch.step();
                             const double x = middles[a].*axis, y = middles[b].*axis;
                             return x < y || (x == y && a < b);
                         });
        build(boxes, middles, begin, half, leaf_size, watch);
        const auto second = std::uint32_t(nodes_.size());
        build(boxes, middles, half, end, leaf_size, watch);
        nodes_[at].second = second;
    }
};

}  // namespace cspace::shapes
