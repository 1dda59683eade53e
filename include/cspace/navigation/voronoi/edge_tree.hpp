// The walls in a tree of boxes: which of them come near a point.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "cspace/navigation/voronoi/sites.hpp"

namespace cspace::navigation::voronoi {

// What lies on one side of a line: the points x with n · x >= least. By default all.
struct Side {
    Point n;
    double least = 0;
};
using EitherSide = std::array<Side, 2>;

class EdgeTree {
  public:
    EdgeTree() = default;
    explicit EdgeTree(const Sites& sites) : order_(std::size_t(sites.size())) {
        for (Index i = 0; i < sites.size(); ++i) order_[std::size_t(i)] = i;
        if (!order_.empty()) build(sites, 0, Index(order_.size()));
    }

    // Calls visit(edge) for walls that may reach into the part of a disc on either of two sides, until it
    // answers false.
    template <class Visit>
    bool visit_disc(Point center, double radius, const EitherSide& side, Visit visit) const {
        if (nodes_.empty()) return true;
        Index stack[128];
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Index n = stack[--top];
            const Node& node = nodes_[std::size_t(n)];
            if (squared_gap(node, center) > radius * radius || is_beyond(node, side)) continue;
            if (node.right != none) {
                stack[top++] = node.right;
                stack[top++] = n + 1;
                continue;
            }
            for (Index k = node.begin; k < node.end; ++k)
                if (!visit(order_[std::size_t(k)])) return false;
        }
        return true;
    }
    // The same for a disc that shrinks: disc() returns its current centre and radius. Those near `from`
    // come first.
    template <class Disc, class Visit>
    void visit_shrinking(Point from, const EitherSide& side, Disc disc, Visit visit) const {
        if (nodes_.empty()) return;
        Index stack[128];
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Index n = stack[--top];
            const Node& node = nodes_[std::size_t(n)];
            const auto [center, radius] = disc();
            if (!(squared_gap(node, center) <= radius * radius) || is_beyond(node, side)) continue;
            if (node.right == none) {
                for (Index k = node.begin; k < node.end; ++k) visit(order_[std::size_t(k)]);
                continue;
            }
            const bool left_first = squared_gap(nodes_[std::size_t(n) + 1], from) <
                                    squared_gap(nodes_[std::size_t(node.right)], from);
            stack[top++] = left_first ? node.right : n + 1;
            stack[top++] = left_first ? n + 1 : node.right;
        }
    }

  private:
    struct Node {
        Point low, high;
        Index begin, end, right;  // of order_; the second child, the first follows; or none
    };
    std::vector<Index> order_;
    std::vector<Node> nodes_;

    static double squared_gap(const Node& node, Point p) {
        const double dx = std::max({node.low.x - p.x, p.x - node.high.x, 0.0});
        const double dy = std::max({node.low.y - p.y, p.y - node.high.y, 0.0});
        return dx * dx + dy * dy;
    }

    static bool is_beyond(const Node& node, const EitherSide& sides) {
        for (const auto& [n, least] : sides)
            if (!(n.x * (n.x > 0 ? node.high.x : node.low.x) + n.y * (n.y > 0 ? node.high.y : node.low.y) <
                  least))
                return false;
        return true;
    }

    void build(const Sites& sites, Index begin, Index end) {
        const std::size_t at = nodes_.size();
        constexpr double far = std::numeric_limits<double>::infinity();
        Node node{{far, far}, {-far, -far}, begin, end, none};
        for (Index k = begin; k < end; ++k)
            for (const Point p : {sites.begin(order_[std::size_t(k)]), sites.end(order_[std::size_t(k)])}) {
                node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y)};
                node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y)};
            }
        nodes_.push_back(node);
        if (end - begin <= 4) return;
        const bool by_x = node.high.x - node.low.x > node.high.y - node.low.y;
        const auto middle_of = [&](Index e) {
            const Point m = sites.begin(e) + sites.end(e);
            return by_x ? m.x : m.y;
        };
        const Index middle = (begin + end) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](Index e, Index f) {
                             const double x = middle_of(e), y = middle_of(f);
                             return x != y ? x < y : e < f;
                         });
        build(sites, begin, middle);
        nodes_[at].right = Index(nodes_.size());
        build(sites, middle, end);
    }
};

}  // namespace cspace::navigation::voronoi
