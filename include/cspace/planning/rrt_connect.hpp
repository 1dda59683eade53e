// RRT-Connect: two trees grow towards samples and towards each other (Kuffner & LaValle 2000, "RRT-Connect:
// an efficient approach to single-query path planning"). Starts and goals are the roots of the trees. The
// smaller tree grows. Nodes near obstacles take only samples near to them (dynamic_domain.hpp). Where nothing
// grows any more, that is given up; edges get shorter then, and some samples are drawn near to nodes.
//
// A space offers:
//   space.box()                   see box.hpp
//   space.is_free(a, b)           whether the edge between two rows is free
//   space.find_nearest(tree, q)   the search::NearRow of a tree
//   space.has_time()              false ends the search
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/planning/box.hpp"
#include "cspace/planning/dynamic_domain.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/halton.hpp"
#include "cspace/search/nearest_row.hpp"

namespace cspace::planning {

enum class SearchEnd { met, edge_budget, no_time };

template <class Space>
class RrtConnect {
  public:
    using Row = std::array<float, search::most_dimensions>;
    // A node of the path that the trees make when they meet; tree 0 holds the starts.
    struct PathNode {
        int tree, node;
    };
    struct Counts {
        std::int64_t samples = 0, rejected = 0, edges = 0, blocked = 0;
    };

    RrtConnect(Space& space, const search::HaltonTable& table, std::uint64_t seed, float range)
        : space_(space),
          box_(space.box()),
          points_(table, seed),
          range_(range),
          trees_{Tree(box_.width), Tree(box_.width)} {}

    void add_start(const float* q) { add_root(0, q); }
    void add_goal(const float* q) { add_root(1, q); }

    // Searches until the trees meet, or `budget` edges are checked in all. Goes on when called again.
    SearchEnd run(std::int64_t budget) {
        if (straight_.empty()) list_straight_edges();
        while (counts_.edges < budget) {
            if (!space_.has_time()) return SearchEnd::no_time;
            if (next_straight_ < straight_.size() ? try_straight_edge() : grow()) return SearchEnd::met;
        }
        return SearchEnd::edge_budget;
    }

    // From a start to a goal.
    const std::vector<PathNode>& path() const { return path_; }
    // Removes the edge between two nodes of the path, and what hangs on it.
    void remove_edge(std::size_t i) {
        const PathNode &a = path_[i], &b = path_[i + 1];
        if (a.tree == b.tree) remove_branch(a.tree, a.tree == 0 ? b.node : a.node);
    }

    const search::ConfigurationTree& tree(int t) const { return trees_[std::size_t(t)].nodes; }
    const Counts& counts() const { return counts_; }
    // The least distance of a node of tree 0 from one of tree 1, as far as the search came to know.
    float least_distance() const { return least_distance_; }
    const Row& nearest_row(int t) const { return nearest_rows_[std::size_t(t)]; }

  private:
    struct Tree {
        explicit Tree(int width) : nodes(width) {}
        search::ConfigurationTree nodes;
        std::vector<float> radii;  // of the domains of the nodes
    };
    static constexpr float unbounded = DynamicDomain::unbounded;
    // So many samples in a row outside all domains: the trees starve. From then on edges are so much shorter,
    // and after so many samples without a new node every second one is drawn near to a node.
    static constexpr int most_rejections = 20000, most_failures = 1000;
    static constexpr float starving_range = 0.25f;

    Space& space_;
    const Box box_;
    search::HaltonPoints points_;
    float range_;
    std::array<Tree, 2> trees_;
    std::vector<std::pair<int, int>> straight_;
    std::size_t next_straight_ = 0;
    std::vector<PathNode> path_;
    Counts counts_;
    bool has_domains_ = true;
    int rejections_ = 0;
    int failures_ = 0;         // samples without domains since the last new node
    std::int64_t locals_ = 0;  // samples drawn near to nodes
    float least_distance_ = unbounded;
    std::array<Row, 2> nearest_rows_ = {};

    search::ConfigurationTree& nodes(int t) { return trees_[std::size_t(t)].nodes; }
    float& radius(int t, int node) { return trees_[std::size_t(t)].radii[std::size_t(node)]; }

    void add_root(int t, const float* q) { add_node(t, q, search::ConfigurationTree::no_parent, 0); }
    int add_node(int t, const float* q, int parent, float length) {
        const float cost = parent < 0 ? 0 : nodes(t).cost(parent) + length;
        trees_[std::size_t(t)].radii.push_back(unbounded);
        rejections_ = failures_ = 0;
        return nodes(t).add(q, parent, cost);
    }
    void remove_branch(int t, int node) {
        const std::vector<int> kept = nodes(t).remove_branch(node);
        std::vector<float>& radii = trees_[std::size_t(t)].radii;
        for (std::size_t i = 0; i < kept.size(); ++i) radii[i] = radii[std::size_t(kept[i])];
        radii.resize(kept.size());
    }

    bool check_edge(const float* a, const float* b) {
        ++counts_.edges;
        const bool is_free = space_.is_free(a, b);
        counts_.blocked += !is_free;
        return is_free;
    }

    // All pairs of a start and a goal, the nearest first.
    void list_straight_edges() {
        std::vector<std::pair<float, std::pair<int, int>>> pairs;
        Row a, b;
        InterruptPoll poll(1024);
        for (int s = 0; s < nodes(0).size(); ++s)
            for (int g = 0; g < nodes(1).size(); ++g) {
                poll.step();
                nodes(0).copy_row(s, a.data()), nodes(1).copy_row(g, b.data());
                pairs.push_back({box_.distance(a.data(), b.data()), {s, g}});
                note_distance(pairs.back().first, a.data(), b.data());
            }
        sort_polled(pairs);
        for (const auto& pair : pairs) straight_.push_back(pair.second);
    }
    bool try_straight_edge() {
        const auto [s, g] = straight_[next_straight_++];
        Row a, b;
        nodes(0).copy_row(s, a.data()), nodes(1).copy_row(g, b.data());
        if (!check_edge(a.data(), b.data())) return false;
        path_ = {{0, s}, {1, g}};
        return true;
    }

    // Draws a sample and extends the smaller tree towards it; true if the trees meet.
    bool grow() {
        const int t = nodes(0).size() < nodes(1).size() ? 0 : 1;
        Row sample, from, to;
        ++counts_.samples;
        if (has_domains_ || ++failures_ < most_failures || failures_ % 2)
            box_.scale(points_.next(), sample.data());
        else
            draw_locally(nodes(t), sample);
        const search::NearRow near = space_.find_nearest(nodes(t), sample.data());
        const float far = std::sqrt(near.square), domain = radius(t, near.row);
        if (has_domains_ && domain < far) return reject();
        const float length = std::min(far, range_);
        nodes(t).copy_row(near.row, from.data());
        if (far <= range_)
            std::copy_n(sample.data(), box_.width, to.data());
        else
            box_.interpolate(from.data(), sample.data(), range_ / far, to.data());
        if (!check_edge(from.data(), to.data())) {
            radius(t, near.row) = DynamicDomain::after_blocked(domain, range_);
            return false;
        }
        radius(t, near.row) = DynamicDomain::after_free(domain);
        return connect(t, add_node(t, to.data(), near.row, length), to.data());
    }
    // A sample near to a node: trees that starve in a narrow place grow by short edges. Each node has its
    // turn, and sizes from the range down to a hundredth of it.
    void draw_locally(const search::ConfigurationTree& tree, Row& sample) {
        constexpr std::int64_t sizes = 8;
        const std::int64_t turn = locals_++;
        const float half_side = std::ldexp(range_, -int(turn % sizes));
        Row at;
        tree.copy_row(int(turn / sizes % tree.size()), at.data());
        box_.move_within(at.data(), half_side, points_.next(), sample.data());
    }
    bool reject() {
        ++counts_.rejected;
        if (++rejections_ == most_rejections) has_domains_ = false, range_ *= starving_range;
        return false;
    }

    // Extends tree t from one of its nodes to the nearest node of the other tree; true if it arrives.
    bool connect(int t, int node, const float* from) {
        const search::NearRow near = space_.find_nearest(nodes(1 - t), from);
        const float far = std::sqrt(near.square);
        Row target, places[2];
        nodes(1 - t).copy_row(near.row, target.data());
        const int steps = std::max(1, int(std::ceil(far / range_)));
        const float* at = from;
        for (int i = 1; i <= steps; ++i) {
            const float left = far * (float(steps - i + 1) / float(steps));
            note_distance(left, t == 0 ? at : target.data(), t == 0 ? target.data() : at);
            float* const next = i == steps ? target.data() : places[i % 2].data();
            if (i < steps) box_.interpolate(from, target.data(), float(i) / float(steps), next);
            if (!check_edge(at, next)) return false;
            if (i < steps) node = add_node(t, next, node, far / float(steps));
            at = next;
        }
        join(t == 0 ? node : near.row, t == 0 ? near.row : node);
        return true;
    }
    // The path through a node of tree 0 and one of tree 1.
    void join(int from_start, int from_goal) {
        path_.clear();
        for (int n = from_start; n >= 0; n = nodes(0).parent(n)) path_.push_back({0, n});
        std::reverse(path_.begin(), path_.end());
        for (int n = from_goal; n >= 0; n = nodes(1).parent(n)) path_.push_back({1, n});
    }
    void note_distance(float distance, const float* from_start, const float* from_goal) {
        if (!(distance < least_distance_)) return;
        least_distance_ = distance;
        std::copy_n(from_start, box_.width, nearest_rows_[0].begin());
        std::copy_n(from_goal, box_.width, nearest_rows_[1].begin());
    }
};

}  // namespace cspace::planning
