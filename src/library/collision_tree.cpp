#include "collision_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cspace/math/interrupts.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::collision {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Bounds nothing = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

void include_box(Bounds& all, const Bounds& box) {
    for (std::size_t k = 0; k < 3; ++k) {
        all.low[k] = std::min(all.low[k], box.low[k]);
        all.high[k] = std::max(all.high[k], box.high[k]);
    }
}

// Bounds in registers.
struct Extent {
    Vec3d low = {infinity, infinity, infinity}, high = {-infinity, -infinity, -infinity};
    void include(const Vec3d& p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
};

TreeNode round_box(const Bounds& box, double grown) {
    TreeNode node = {};
    for (std::size_t k = 0; k < 3; ++k) {
        node.low[k] = round_low(box.low[k] - grown);
        node.high[k] = round_high(box.high[k] + grown);
    }
    return node;
}

class Builder {
  public:
    Builder(const std::vector<Bounds>& items, int leaf_size, double grown)
        : items_(items), leaf_size_(leaf_size), grown_(grown) {
        tree_.order.resize(items.size());
        std::iota(tree_.order.begin(), tree_.order.end(), 0);
        tree_.nodes.reserve(2 * items.size() / std::size_t(leaf_size) + 1);
    }
    Tree build() {
        if (!items_.empty()) add_node(0, int(items_.size()));
        return std::move(tree_);
    }

  private:
    const std::vector<Bounds>& items_;
    int leaf_size_;
    double grown_;
    Tree tree_;
    InterruptPoll poll_{1 << 12};

    void add_node(int begin, int end) {
        const std::size_t index = tree_.nodes.size();
        const bool is_leaf = end - begin <= leaf_size_;
        tree_.nodes.push_back(bound_items(begin, end, is_leaf));
        if (!is_leaf) {
            const int middle = begin + (end - begin) / 2;
            split_items(begin, middle, end);
            add_node(begin, middle);
            add_node(middle, end);
        }
        tree_.nodes[index].next = int(tree_.nodes.size());
    }
    TreeNode bound_items(int begin, int end, bool is_leaf) {
        Bounds box = nothing;
        for (int i = begin; i < end; ++i) {
            include_box(box, item(i));
            poll_.step();
        }
        TreeNode node = round_box(box, grown_);
        if (is_leaf) node.first = begin, node.count = end - begin;
        return node;
    }
    // Half of the items on either side, by their centres along the axis where these differ most.
    void split_items(int begin, int middle, int end) {
        Bounds centers = nothing;
        for (int i = begin; i < end; ++i) {
            const Bounds& box = item(i);
            Bounds center;
            for (std::size_t k = 0; k < 3; ++k) center.low[k] = center.high[k] = box.low[k] + box.high[k];
            include_box(centers, center);
            poll_.step();
        }
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (centers.high[k] - centers.low[k] > centers.high[axis] - centers.low[axis]) axis = k;
        const auto order = tree_.order.begin();
        std::nth_element(order + begin, order + middle, order + end, [&](int a, int b) {
            poll_.step();
            const Bounds &x = items_[std::size_t(a)], &y = items_[std::size_t(b)];
            return x.low[axis] + x.high[axis] < y.low[axis] + y.high[axis];
        });
    }
    const Bounds& item(int i) const { return items_[std::size_t(tree_.order[std::size_t(i)])]; }
};

// Nodes over points in order: halves of whole leaves.
class PointBuilder {
  public:
    PointBuilder(std::span<const Vec3d> points, int leaf_size, std::vector<TreeNode>& nodes)
        : points_(points), leaf_size_(leaf_size), nodes_(nodes) {}
    Bounds add_node(int begin, int end) {
        const std::size_t index = nodes_.size();
        nodes_.emplace_back();
        Bounds box = nothing;
        const int leaves = (end - begin + leaf_size_ - 1) / leaf_size_;
        if (leaves <= 1) {
            box = bound_points(points_.subspan(std::size_t(begin), std::size_t(end - begin)));
            poll_.step();
        } else {
            const int middle = begin + leaves / 2 * leaf_size_;
            box = add_node(begin, middle);
            include_box(box, add_node(middle, end));
        }
        TreeNode& node = nodes_[index] = round_box(box, 0);
        node.first = begin;
        if (leaves <= 1) node.count = end - begin;
        node.next = int(nodes_.size());
        return box;
    }

  private:
    std::span<const Vec3d> points_;
    int leaf_size_;
    std::vector<TreeNode>& nodes_;
    InterruptPoll poll_{1 << 8};
};

}  // namespace

Bounds bound_points(std::span<const Vec3d> points) {
    Extent even, odd;  // two chains of comparisons at once
    visit_range(0, points.size() / 2, [&](std::size_t i) {
        even.include(points[2 * i]);
        odd.include(points[2 * i + 1]);
    });
    if (points.size() % 2) even.include(points.back());
    if (points.size() > 1) even.include(odd.low), even.include(odd.high);
    return {{even.low.x, even.low.y, even.low.z}, {even.high.x, even.high.y, even.high.z}};
}

std::vector<TreeNode> build_point_tree(std::span<const Vec3d> points, int leaf_size) {
    const std::size_t n = points.size();
    std::vector<TreeNode> nodes;
    nodes.reserve(2 * n / std::size_t(leaf_size) + 2);
    if (n > 0) PointBuilder(points, leaf_size, nodes).add_node(0, int(n));
    return nodes;
}

float round_low(double x) { return float(x - 2 * tolerance::float_rounding * std::fabs(x)); }
float round_high(double x) { return float(x + 2 * tolerance::float_rounding * std::fabs(x)); }

Bounds bound_all(const std::vector<Bounds>& items) {
    Bounds all = nothing;
    for (const Bounds& box : items) include_box(all, box);
    return all;
}

Tree build_tree(const std::vector<Bounds>& items, int leaf_size, double grown) {
    return Builder(items, leaf_size, grown).build();
}

}  // namespace cspace::collision
