// Trees of boxes: built from the middle of the boxes along their widest extent.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "cspace/collision/scene.hpp"
#include "cspace/math/vec.hpp"

namespace cspace::collision {

struct Bounds {
    std::array<double, 3> low, high;
};

// The nodes, and the order of the items: leaf items are numbers in `order`.
struct Tree {
    std::vector<TreeNode> nodes;
    std::vector<int> order;
};

// Leaves have at most so many items. The boxes are rounded outward, and grown.
Tree build_tree(const std::vector<Bounds>& items, int leaf_size, double grown);

// The tree of points of which neighbours are near each other; `first` of nodes that are no leaves is the
// first point below them.
std::vector<TreeNode> build_point_tree(std::span<const Vec3d> points, int leaf_size);

// The box around points.
Bounds bound_points(std::span<const Vec3d> points);
// The box around all items.
Bounds bound_all(const std::vector<Bounds>& items);

// Rounded down, and up.
float round_low(double x);
float round_high(double x);

// Calls visit(item) for the items of leaves whose boxes are within limit() of a point, which may shrink
// meanwhile, until it returns true; whether it did.
template <class Limit, class Visit>
bool visit_near(std::span<const TreeNode> nodes, const Vec3d& point, const Limit& limit, const Visit& visit) {
    const double at[] = {point.x, point.y, point.z};
    for (std::size_t i = 0; i < nodes.size();) {
        const TreeNode& node = nodes[i];
        const double reach = limit();
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double beyond = std::max({double(node.low[k]) - at[k], at[k] - double(node.high[k]), 0.0});
            square += beyond * beyond;
        }
        if (!(reach >= 0 && square <= reach * reach)) {
            i = std::size_t(node.next);
            continue;
        }
        for (int k = node.first; k < node.first + node.count; ++k)
            if (visit(k)) return true;
        ++i;
    }
    return false;
}

// The item that is nearest to a point; −1 if none is nearer than the root of `least`, which receives the
// square of its distance. measure(item) is the square of the distance of an item.
template <class Measure>
int find_nearest(std::span<const TreeNode> nodes, const Vec3d& point, double& least, const Measure& measure) {
    constexpr int most_levels = 64;
    const double at[] = {point.x, point.y, point.z};
    struct Open {
        int node;
        double gap;
    } open[most_levels];
    const auto look_at = [&](int node) {
        const TreeNode& box = nodes[std::size_t(node)];
        double gap = 0;
        for (int k = 0; k < 3; ++k) {
            const double beyond = std::max({double(box.low[k]) - at[k], at[k] - double(box.high[k]), 0.0});
            gap += beyond * beyond;
        }
        return Open{node, gap};
    };
    int found = -1, n = 0;
    open[n++] = look_at(0);
    while (n > 0) {
        const Open now = open[--n];
        if (now.gap > least) continue;
        const TreeNode& node = nodes[std::size_t(now.node)];
        for (int k = node.first; k < node.first + node.count; ++k)
            if (const double square = measure(k); square < least) least = square, found = k;
        if (node.count) continue;
        Open one = look_at(now.node + 1), other = look_at(nodes[std::size_t(now.node + 1)].next);
        if (one.gap > other.gap) std::swap(one, other);
        open[n++] = other;
        open[n++] = one;
    }
    return found;
}

}  // namespace cspace::collision
