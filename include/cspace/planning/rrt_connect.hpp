// RRT-Connect: two trees grow towards samples and towards each other (Kuffner & LaValle 2000, "RRT-Connect:
// an efficient approach to single-query path planning"). Starts and goals are the roots of the trees. The
// smaller tree grows. Nodes near obstacles take only samples near to them (dynamic_domain.hpp). A tree in a
// narrow place would reject nearly all samples then: where it does not grow, most of them are drawn near to
// its nodes.
//
// A space offers, besides what tree_pair.hpp needs, has_time(): false ends the search.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/planning/tree_pair.hpp"

namespace cspace::planning {

template <class Space>
class RrtConnect {
  public:
    using Trees = TreePair<Space>;
    using Row = typename Trees::Row;
    using Counts = typename Trees::Counts;

    RrtConnect(Space& space, const search::HaltonTable& table, std::uint64_t seed, float range)
        : space_(space), box_(space.box()), points_(table, seed), range_(range), trees_(space) {}

    void add_start(const float* q) { add_node(0, q, search::ConfigurationTree::no_parent, 0); }
    void add_goal(const float* q) { add_node(1, q, search::ConfigurationTree::no_parent, 0); }

    // Searches until the trees meet, or `budget` edges are checked in all. Goes on when called again.
    SearchEnd run(std::int64_t budget) {
        trees_.allow_edges(budget);
        if (straight_.empty()) list_straight_edges();
        while (counts().edges < budget) {
            if (!space_.has_time()) return SearchEnd::no_time;
            if (next_straight_ < straight_.size() ? try_straight_edge() : grow()) return SearchEnd::met;
        }
        return SearchEnd::edge_budget;
    }

    // From a start to a goal.
    const std::vector<PathNode>& path() const { return trees_.path(); }
    // Removes the edge between two nodes of the path, and what hangs on it.
    void remove_edge(std::size_t i) {
        const PathNode &a = path()[i], &b = path()[i + 1];
        if (a.tree == b.tree) trees_.remove_branch(a.tree, a.tree == 0 ? b.node : a.node);
    }

    const search::ConfigurationTree& tree(int t) const { return trees_.nodes(t); }
    const Counts& counts() const { return trees_.counts(); }
    // The least distance of a node of tree 0 from one of tree 1, as far as the search came to know.
    float least_distance() const { return least_distance_; }
    const Row& nearest_row(int t) const { return nearest_rows_[std::size_t(t)]; }

  private:
    static constexpr float unbounded = DynamicDomain::unbounded;
    // After so many samples without a new node a tree starves: all but every fourth are drawn near to nodes.
    static constexpr std::int64_t most_in_vain = 10, uniform_period = 4;

    Space& space_;
    const Box box_;
    search::HaltonPoints points_;
    float range_;
    Trees trees_;
    std::vector<std::pair<int, int>> straight_;
    std::size_t next_straight_ = 0;
    std::array<std::int64_t, 2> in_vain_ = {};  // samples of each tree since its last new node
    std::int64_t locals_ = 0;                   // samples drawn near to nodes
    float least_distance_ = unbounded;
    std::array<Row, 2> nearest_rows_ = {};

    search::ConfigurationTree& nodes(int t) { return trees_.nodes(t); }
    int add_node(int t, const float* q, int parent, float cost) {
        in_vain_[std::size_t(t)] = 0;
        return trees_.add(t, q, parent, cost);
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
        if (!trees_.check_edge(a.data(), b.data())) return false;
        trees_.set_path({{0, s}, {1, g}});
        return true;
    }

    // Draws a sample and extends the smaller tree towards it; true if the trees meet.
    bool grow() {
        const int t = nodes(0).size() < nodes(1).size() ? 0 : 1;
        Row sample, from, to;
        ++trees_.counts().samples;
        const std::int64_t in_vain = ++in_vain_[std::size_t(t)];
        const bool is_local = in_vain > most_in_vain && in_vain % uniform_period;
        if (is_local)
            draw_locally(nodes(t), sample);
        else
            box_.scale(points_.next(), sample.data());
        const search::NearRow near = trees_.find_nearest(t, sample.data());
        const float far = std::sqrt(near.square), domain = trees_.radius(t, near.row);
        if (!is_local && domain < far) return ++trees_.counts().rejected, false;
        nodes(t).copy_row(near.row, from.data());
        trees_.steer(from.data(), sample.data(), far, range_, to.data());
        if (!trees_.check_edge(from.data(), to.data())) {
            if (!is_local) trees_.radius(t, near.row) = DynamicDomain::after_blocked(domain, range_);
            return false;
        }
        trees_.radius(t, near.row) = DynamicDomain::after_free(domain);
        const float cost = nodes(t).cost(near.row) + std::min(far, range_);
        return connect(t, add_node(t, to.data(), near.row, cost), to.data());
    }
    // A sample in a cube around a node, its side four times and twice the range in turn.
    // Each node has its turn.
    void draw_locally(const search::ConfigurationTree& tree, Row& sample) {
        const std::int64_t turn = locals_++;
        Row at;
        tree.copy_row(int(turn / 2 % tree.size()), at.data());
        box_.move_within(at.data(), turn % 2 ? range_ : 2 * range_, points_.next(), sample.data());
    }

    // Extends tree t from one of its nodes to the nearest node of the other tree; true if it arrives.
    bool connect(int t, int node, const float* from) {
        const search::NearRow near = trees_.find_nearest(1 - t, from);
        return trees_.connect(t, node, from, near, range_,
                              [&](const float* at, const float* target, float left) {
                                  note_distance(left, t == 0 ? at : target, t == 0 ? target : at);
                              });
    }
    void note_distance(float distance, const float* from_start, const float* from_goal) {
        if (!(distance < least_distance_)) return;
        least_distance_ = distance;
        std::copy_n(from_start, box_.width, nearest_rows_[0].begin());
        std::copy_n(from_goal, box_.width, nearest_rows_[1].begin());
    }
};

}  // namespace cspace::planning
