#include "collision_tree.hpp"

#include <algorithm>
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

// A point and its place on the curve.
struct Key {
    std::uint64_t place;
    int point;
};
constexpr int digit_bits = 11, digits = 4, axis_bits = 14;  // three axes in four digits

// The lowest bits of x, two zeros behind each.
std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 16) & 0x0000ff0000ff;
    x = (x | x << 8) & 0x00f00f00f00f;
    x = (x | x << 4) & 0x0c30c30c30c3;
    return (x | x << 2) & 0x249249249249;
}
std::vector<Key> place_on_curve(std::span<const double> points) {
    Bounds all = nothing;
    const std::size_t n = points.size() / 3;
    visit_range(0, n, [&](std::size_t i) {
        const double* p = &points[3 * i];
        include_box(all, {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}});
    });
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, all.high[k] - all.low[k]);
    const double scale = extent > 0 ? ((1 << axis_bits) - 1) / extent : 0;
    std::vector<Key> keys(n);
    visit_range(0, n, [&](std::size_t i) {
        std::uint64_t place = 0;
        for (std::size_t k = 0; k < 3; ++k)
            place |= spread_bits(std::uint64_t((points[3 * i + k] - all.low[k]) * scale)) << k;
        keys[i] = {place, int(i)};
    });
    return keys;
}
// By digits from the lowest on.
void sort_keys(std::vector<Key>& keys) {
    constexpr std::size_t base = std::size_t(1) << digit_bits;
    std::vector<Key> sorted(keys.size());
    for (int digit = 0; digit < digits; ++digit) {
        const auto digit_of = [&](const Key& key) { return key.place >> (digit * digit_bits) & (base - 1); };
        std::array<std::size_t, base + 1> starts = {};
        visit_range(0, keys.size(), [&](std::size_t i) { ++starts[digit_of(keys[i]) + 1]; });
        for (std::size_t d = 0; d < base; ++d) starts[d + 1] += starts[d];
        visit_range(0, keys.size(), [&](std::size_t i) { sorted[starts[digit_of(keys[i])]++] = keys[i]; });
        keys.swap(sorted);
    }
}

// Nodes over points in order: halves of whole leaves.
class PointBuilder {
  public:
    PointBuilder(std::span<const double> points, int leaf_size, Tree& tree)
        : points_(points), leaf_size_(leaf_size), tree_(tree) {}
    Bounds add_node(int begin, int end) {
        const std::size_t index = tree_.nodes.size();
        tree_.nodes.emplace_back();
        Bounds box = nothing;
        const int leaves = (end - begin + leaf_size_ - 1) / leaf_size_;
        if (leaves <= 1) {
            for (int i = begin; i < end; ++i) {
                const double* p = &points_[3 * std::size_t(tree_.order[std::size_t(i)])];
                include_box(box, {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}});
            }
            poll_.step();
        } else {
            const int middle = begin + leaves / 2 * leaf_size_;
            box = add_node(begin, middle);
            include_box(box, add_node(middle, end));
        }
        TreeNode& node = tree_.nodes[index] = round_box(box, 0);
        if (leaves <= 1) node.first = begin, node.count = end - begin;
        node.next = int(tree_.nodes.size());
        return box;
    }

  private:
    std::span<const double> points_;
    int leaf_size_;
    Tree& tree_;
    InterruptPoll poll_{1 << 8};
};

}  // namespace

Tree build_point_tree(std::span<const double> points, int leaf_size) {
    std::vector<Key> keys = place_on_curve(points);
    sort_keys(keys);
    Tree tree;
    tree.order.reserve(keys.size());
    for (const Key& key : keys) tree.order.push_back(key.point);
    tree.nodes.reserve(2 * keys.size() / std::size_t(leaf_size) + 2);
    if (!keys.empty()) PointBuilder(points, leaf_size, tree).add_node(0, int(keys.size()));
    return tree;
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
