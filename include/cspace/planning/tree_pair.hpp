// Two trees, from the starts and from the goals, and the path that they make when they meet: what RRT-Connect
// and AORRTC share. Edges are checked by a space that offers
//
//   space.box()           see box.hpp
//   space.is_free(a, b)   whether the edge between two rows is free
//   space.find_nearest(tree, leaves, q)   the search::NearRow of a tree, whose first rows are in leaves
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/planning/box.hpp"
#include "cspace/planning/dynamic_domain.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/halton.hpp"
#include "cspace/search/nearest_row.hpp"
#include "cspace/search/row_leaves.hpp"

namespace cspace::planning {

enum class SearchEnd { met, edge_budget, no_time };

// A node of a path; tree 0 holds the starts.
struct PathNode {
    int tree, node;
};

template <class Space>
class TreePair {
  public:
    using Row = std::array<float, search::most_dimensions>;
    struct Counts {
        std::int64_t samples = 0, rejected = 0, edges = 0, blocked = 0;
    };

    explicit TreePair(Space& space)
        : space_(space), box_(space.box()), trees_{Tree(box_.width), Tree(box_.width)} {}

    const Box& box() const { return box_; }
    search::ConfigurationTree& nodes(int t) { return trees_[std::size_t(t)].nodes; }
    const search::ConfigurationTree& nodes(int t) const { return trees_[std::size_t(t)].nodes; }
    // Of the domain of a node.
    float& radius(int t, int node) { return trees_[std::size_t(t)].radii[std::size_t(node)]; }
    Counts& counts() { return counts_; }
    const Counts& counts() const { return counts_; }
    // From a start to a goal.
    const std::vector<PathNode>& path() const { return path_; }
    void set_path(std::vector<PathNode> path) { path_ = std::move(path); }

    int add(int t, const float* q, int parent, float cost) {
        Tree& tree = trees_[std::size_t(t)];
        tree.radii.push_back(DynamicDomain::unbounded);
        const int node = tree.nodes.add(q, parent, cost);
        tree.leaves.update(tree.nodes);
        return node;
    }
    void remove_branch(int t, int node) {
        Tree& tree = trees_[std::size_t(t)];
        const std::vector<int> kept = tree.nodes.remove_branch(node);
        for (std::size_t i = 0; i < kept.size(); ++i) tree.radii[i] = tree.radii[std::size_t(kept[i])];
        tree.radii.resize(kept.size());
        tree.leaves.clear();
        tree.leaves.update(tree.nodes);
    }
    search::NearRow find_nearest(int t, const float* q) {
        Tree& tree = trees_[std::size_t(t)];
        return space_.find_nearest(tree.nodes, tree.leaves, q);
    }
    // Motions that may be checked in all; further ones count as blocked without a look.
    void allow_edges(std::int64_t most) { most_edges_ = most; }
    bool check_edge(const float* a, const float* b) {
        if (counts_.edges >= most_edges_) return false;
        ++counts_.edges;
        const bool is_free = space_.is_free(a, b);
        counts_.blocked += !is_free;
        return is_free;
    }
    // The row towards a target, `far` away, that is at most the range away.
    void steer(const float* from, const float* target, float far, float range, float* to) const {
        if (far <= range)
            std::copy_n(target, box_.width, to);
        else
            box_.interpolate(from, target, range / far, to);
    }
    // Extends tree t from a node at `from` to one of the other tree, by edges no longer than the range; true
    // if it arrives: then there is a path. Calls note(at, target, left) before each edge: what is left of the
    // way.
    template <class Note>
    bool connect(int t, int node, const float* from, const search::NearRow& to, float range,
                 const Note& note) {
        const float far = std::sqrt(to.square), spent = nodes(t).cost(node);
        Row target, places[2];
        nodes(1 - t).copy_row(to.row, target.data());
        const int steps = std::max(1, int(std::ceil(far / range)));
        const float* at = from;
        for (int i = 1; i <= steps; ++i) {
            const float share = float(i) / float(steps);
            note(at, target.data(), far * (float(steps - i + 1) / float(steps)));
            float* const next = i == steps ? target.data() : places[i % 2].data();
            if (i < steps) box_.interpolate(from, target.data(), share, next);
            if (!check_edge(at, next)) return false;
            if (i < steps) node = add(t, next, node, spent + far * share);
            at = next;
        }
        join(t == 0 ? node : to.row, t == 0 ? to.row : node);
        return true;
    }

  private:
    struct Tree {
        explicit Tree(int width) : nodes(width) {}
        search::ConfigurationTree nodes;
        search::RowLeaves leaves;
        std::vector<float> radii;
    };
    Space& space_;
    const Box box_;
    std::array<Tree, 2> trees_;
    std::vector<PathNode> path_;
    Counts counts_;
    std::int64_t most_edges_ = std::numeric_limits<std::int64_t>::max();

    // The path through a node of tree 0 and one of tree 1.
    void join(int from_start, int from_goal) {
        path_.clear();
        for (int n = from_start; n >= 0; n = nodes(0).parent(n)) path_.push_back({0, n});
        std::reverse(path_.begin(), path_.end());
        for (int n = from_goal; n >= 0; n = nodes(1).parent(n)) path_.push_back({1, n});
    }
};

}  // namespace cspace::planning
