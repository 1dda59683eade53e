// RRT-Connect: two trees grow towards samples and towards each other (Kuffner & LaValle 2000, "RRT-Connect:
// an efficient approach to single-query path planning"). Starts and goals are the roots of the trees. The
// smaller tree grows. Nodes near obstacles take only samples near to them (dynamic_domain.hpp). Where nothing
// grows any more, that is given up; edges get shorter then, and some samples are drawn near to nodes.
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
    // So many samples in a row outside all domains: the trees starve. From then on edges are so much shorter,
    // and after so many samples without a new node every second one is drawn near to a node.
    static constexpr int most_rejections = 20000, most_failures = 1000;
    static constexpr float starving_range = 0.25f;

    Space& space_;
    const Box box_;
    search::HaltonPoints points_;
    float range_;
    Trees trees_;
    std::vector<std::pair<int, int>> straight_;
    std::size_t next_straight_ = 0;
    bool has_domains_ = true;
    int rejections_ = 0;
    int failures_ = 0;         // samples without domains since the last new node
    std::int64_t locals_ = 0;  // samples drawn near to nodes
    float least_distance_ = unbounded;
    std::array<Row, 2> nearest_rows_ = {};

    search::ConfigurationTree& nodes(int t) { return trees_.nodes(t); }
    int add_node(int t, const float* q, int parent, float cost) {
        rejections_ = failures_ = 0;
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
        if (has_domains_ || ++failures_ < most_failures || failures_ % 2)
            box_.scale(points_.next(), sample.data());
        else
            draw_locally(nodes(t), sample);
        const search::NearRow near = trees_.find_nearest(t, sample.data());
        const float far = std::sqrt(near.square), domain = trees_.radius(t, near.row);
        if (has_domains_ && domain < far) return reject();
        nodes(t).copy_row(near.row, from.data());
        trees_.steer(from.data(), sample.data(), far, range_, to.data());
        if (!trees_.check_edge(from.data(), to.data())) {
            trees_.radius(t, near.row) = DynamicDomain::after_blocked(domain, range_);
            return false;
        }
        trees_.radius(t, near.row) = DynamicDomain::after_free(domain);
        const float cost = nodes(t).cost(near.row) + std::min(far, range_);
        return connect(t, add_node(t, to.data(), near.row, cost), to.data());
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
        ++trees_.counts().rejected;
        if (++rejections_ == most_rejections) has_domains_ = false, range_ *= starving_range;
        return false;
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
