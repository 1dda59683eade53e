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
        TreeNode node = {};
        for (std::size_t k = 0; k < 3; ++k) {
            node.low[k] = round_low(box.low[k] - grown_);
            node.high[k] = round_high(box.high[k] + grown_);
        }
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

}  // namespace

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
