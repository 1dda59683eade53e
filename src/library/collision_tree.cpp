#include "collision_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
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

// Keys of points: the place on the curve above the number of the point. The bits of a place are sorted by
// digits.
using Key = std::uint64_t;
constexpr int digit_bits = 11, digits = 3, most_axis_bits = digit_bits;  // as many digits as axes

struct Curve {
    std::vector<Key> keys;
    int index_bits;
    std::size_t point(std::size_t i) const { return std::size_t(keys[i] & ((Key(1) << index_bits) - 1)); }
};

// The lowest bits of x, up to 16, two zeros behind each.
Key spread_bits(Key x) {
    x = (x | x << 16) & 0x0000ff0000ff;
    x = (x | x << 8) & 0x00f00f00f00f;
    x = (x | x << 4) & 0x0c30c30c30c3;
    return (x | x << 2) & 0x249249249249;
}
Curve place_on_curve(std::span<const double> points, const Bounds& all) {
    const std::size_t n = points.size() / 3;
    Curve curve = {std::vector<Key>(n), int(std::bit_width(n))};
    const int axis_bits = std::min(most_axis_bits, (64 - curve.index_bits) / 3);
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, all.high[k] - all.low[k]);
    const double scale = extent > 0 ? ((1 << axis_bits) - 1) / extent : 0;
    visit_range(0, n, [&](std::size_t i) {
        Key place = 0;
        for (std::size_t k = 0; k < 3; ++k)
            place |= spread_bits(Key(std::int64_t((points[3 * i + k] - all.low[k]) * scale))) << k;
        curve.keys[i] = place << curve.index_bits | i;
    });
    return curve;
}
// By digits from the lowest on.
void sort_keys(Curve& curve) {
    constexpr std::size_t base = std::size_t(1) << digit_bits;
    std::vector<Key> sorted(curve.keys.size());
    std::vector<std::uint32_t> starts(base + 1);
    for (int digit = 0; digit < digits; ++digit) {
        const int shift = curve.index_bits + digit * digit_bits;
        if (shift >= 64) break;
        const auto digit_of = [&](Key key) { return std::size_t(key >> shift) & (base - 1); };
        std::fill(starts.begin(), starts.end(), 0);
        visit_range(0, sorted.size(), [&](std::size_t i) { ++starts[digit_of(curve.keys[i]) + 1]; });
        for (std::size_t d = 0; d < base; ++d) starts[d + 1] += starts[d];
        visit_range(0, sorted.size(), [&](std::size_t i) {
            const Key key = curve.keys[i];
            sorted[starts[digit_of(key)]++] = key;
        });
        curve.keys.swap(sorted);
    }
}

// Nodes over points in order: halves of whole leaves.
class PointBuilder {
  public:
    PointBuilder(std::span<const double> points, int leaf_size, std::vector<TreeNode>& nodes)
        : points_(points), leaf_size_(leaf_size), nodes_(nodes) {}
    Bounds add_node(int begin, int end) {
        const std::size_t index = nodes_.size();
        nodes_.emplace_back();
        Bounds box = nothing;
        const int leaves = (end - begin + leaf_size_ - 1) / leaf_size_;
        if (leaves <= 1) {
            box = bound_points(points_.subspan(3 * std::size_t(begin), 3 * std::size_t(end - begin)));
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
    std::span<const double> points_;
    int leaf_size_;
    std::vector<TreeNode>& nodes_;
    InterruptPoll poll_{1 << 8};
};

}  // namespace

Bounds bound_points(std::span<const double> points) {
    Bounds all = nothing;
    visit_range(0, points.size() / 3, [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = points[3 * i + k];
            all.low[k] = x < all.low[k] ? x : all.low[k];
            all.high[k] = x > all.high[k] ? x : all.high[k];
        }
    });
    return all;
}

std::vector<double> sort_points(std::span<const double> points, const Bounds& all) {
    Curve curve = place_on_curve(points, all);
    sort_keys(curve);
    std::vector<double> sorted(points.size());
    visit_range(0, curve.keys.size(), [&](std::size_t i) {
        const double* from = &points[3 * curve.point(i)];
        for (std::size_t k = 0; k < 3; ++k) sorted[3 * i + k] = from[k];
    });
    return sorted;
}

std::vector<TreeNode> build_point_tree(std::span<const double> points, int leaf_size) {
    const std::size_t n = points.size() / 3;
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
