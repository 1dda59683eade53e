// Boxes around the walls in a tree: which walls come near a point.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::navigation::voronoi {

using Index = std::int32_t;
inline constexpr Index none = -1;

// What lies on one side of a line: the points x with n · x >= least. By default all.
struct Side {
    Point n;
    double least = 0;
};
using EitherSide = std::array<Side, 2>;

class EdgeTree {
  public:
    EdgeTree() = default;
    // The box of each edge.
    explicit EdgeTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        if (!order_.empty()) build(boxes, 0, Index(order_.size()));
    }

    // Calls visit(edge) for walls that may reach into the part of a disc on either of two sides, until it
    // answers false.
    template <class Visit>
    bool visit_disc(Point center, double radius, const EitherSide& side, Visit visit) const {
        return descend(
            side, [&](const Node& node) { return squared_gap(node, center) <= radius * radius; },
            [](Index) { return true; }, visit);
    }
    // The same for a disc that shrinks, of all its walls: disc() returns its current centre and radius. Those
    // near `from` come first.
    template <class Disc, class Visit>
    void visit_shrinking(Point from, const EitherSide& side, Disc disc, Visit visit) const {
        const auto reaches = [&](const Node& node) {
            const auto [center, radius] = disc();
            return squared_gap(node, center) <= radius * radius;
        };
        const auto left_first = [&](Index n) {
            return squared_gap(nodes_[std::size_t(n) + 1], from) <
                   squared_gap(nodes_[std::size_t(nodes_[std::size_t(n)].right)], from);
        };
        descend(side, reaches, left_first, [&](Index edge) { return visit(edge), true; });
    }

  private:
    struct Node : Box {
        Index begin, end, right;  // of order_; the second child, the first follows; or none
    };
    std::vector<Index> order_;
    std::vector<Node> nodes_;

    // Visits the edges of all leaves that lie within reach, until visit(edge) is false.
    template <class Reaches, class LeftFirst, class Visit>
    bool descend(const EitherSide& side, Reaches reaches, LeftFirst left_first, Visit visit) const {
        if (nodes_.empty()) return true;
        Index stack[128];
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Index n = stack[--top];
            const Node& node = nodes_[std::size_t(n)];
            if (!reaches(node) || is_beyond(node, side)) continue;
            if (node.right == none) {
                for (Index k = node.begin; k < node.end; ++k)
                    if (!visit(order_[std::size_t(k)])) return false;
                continue;
            }
            const bool is_left_first = left_first(n);
            stack[top++] = is_left_first ? node.right : n + 1;
            stack[top++] = is_left_first ? n + 1 : node.right;
        }
        return true;
    }

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

    void build(const std::vector<Box>& boxes, Index begin, Index end) {
        const std::size_t at = nodes_.size();
        Node node{boxes[std::size_t(order_[std::size_t(begin)])], begin, end, none};
        for (Index k = begin; k < end; ++k) node.include(boxes[std::size_t(order_[std::size_t(k)])]);
        nodes_.push_back(node);
        if (end - begin <= 4) return;
        const bool by_x = node.high.x - node.low.x > node.high.y - node.low.y;
        const auto middle_of = [&](Index e) {
            const Point m = boxes[std::size_t(e)].low + boxes[std::size_t(e)].high;
            return by_x ? m.x : m.y;
        };
        const Index middle = (begin + end) / 2;
        std::nth_element(
            order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
            [&](Index e, Index f) { return std::pair(middle_of(e), e) < std::pair(middle_of(f), f); });
        build(boxes, begin, middle);
        nodes_[at].right = Index(nodes_.size());
        build(boxes, middle, end);
    }
};

}  // namespace cspace::navigation::voronoi
