// AORRTC: RRT-Connect in the product of configurations and costs (Wilson, Thomason, Kingston & Gammell 2025,
// "AORRTC: almost-surely asymptotically optimal planning with RRT-Connect"). Below the cost of the best path
// known, a sample gets a bound on the cost at which it may be reached; only nodes that reach it below the
// bound are its neighbours. Trees that meet give a shorter path.
//
// A space offers, besides what RRT-Connect needs:
//   space.find_nearest_within(tree, q, bound)   the search::NearRow among nodes with cost + distance < bound,
//                                               its row −1 if there is none
#pragma once

#include <vector>

#include "cspace/planning/informed_samples.hpp"
#include "cspace/planning/tree_pair.hpp"

namespace cspace::planning {

template <class Space>
class CostBoundedTrees {
  public:
    using Row = InformedSamples::Row;
    using Trees = TreePair<Space>;

    CostBoundedTrees(Space& space, InformedSamples& samples, float range)
        : space_(space), box_(space.box()), samples_(samples), range_(range), trees_(space) {}

    void add_start(const float* q) { trees_.add(0, q, Tree::no_parent, 0), ++roots_[0]; }
    void add_goal(const float* q) { trees_.add(1, q, Tree::no_parent, 0), ++roots_[1]; }

    // Searches for a path shorter than `bound`, until `budget` edges are checked.
    SearchEnd run(float bound, std::int64_t budget) {
        bound_ = bound;
        trees_.allow_edges(budget);
        list_pairs();
        while (counts().edges < budget && !pairs_.empty()) {
            if (!space_.has_time()) return SearchEnd::no_time;
            if (grow()) return SearchEnd::met;
            if (++trees_.counts().samples > samples_per_edge * budget) break;
        }
        return SearchEnd::edge_budget;
    }
    const std::vector<PathNode>& path() const { return trees_.path(); }
    const search::ConfigurationTree& tree(int t) const { return trees_.nodes(t); }
    const typename Trees::Counts& counts() const { return trees_.counts(); }

  private:
    using Tree = search::ConfigurationTree;
    static constexpr std::int64_t samples_per_edge = 1000;
    // So often a cheaper parent is looked for.
    static constexpr int parent_tries = 3;
    // A path counts as shorter by this share.
    static constexpr float least_gain = 1e-3f;

    Space& space_;
    const Box box_;
    InformedSamples& samples_;
    const float range_;
    Trees trees_;
    std::array<int, 2> roots_ = {0, 0};
    std::vector<std::pair<int, int>> pairs_;
    float bound_ = 0;

    Tree& nodes(int t) { return trees_.nodes(t); }

    // The pairs of a start and a goal between which a shorter path may be.
    void list_pairs() {
        pairs_.clear();
        Row a, b;
        for (int s = 0; s < roots_[0]; ++s)
            for (int g = 0; g < roots_[1]; ++g) {
                nodes(0).copy_row(s, a.data()), nodes(1).copy_row(g, b.data());
                if (box_.distance(a.data(), b.data()) < (1 - least_gain) * bound_) pairs_.push_back({s, g});
            }
    }
    // A lower bound of the cost from the roots of a tree.
    float distance_from_roots(int t, const float* q) {
        float least = std::numeric_limits<float>::infinity();
        Row root;
        for (int i = 0; i < roots_[std::size_t(t)]; ++i) {
            nodes(t).copy_row(i, root.data());
            least = std::min(least, box_.distance(root.data(), q));
        }
        return least;
    }

    bool grow() {
        const int t = nodes(0).size() <= nodes(1).size() ? 0 : 1;
        Row sample, from, to, a, b;
        const std::size_t pick = std::size_t(samples_.uniform() * double(pairs_.size()));
        const auto [s, g] = pairs_[std::min(pick, pairs_.size() - 1)];
        nodes(0).copy_row(s, a.data()), nodes(1).copy_row(g, b.data());
        if (!samples_.draw(a.data(), b.data(), bound_, sample.data())) return false;
        const float above = distance_from_roots(t, sample.data());
        const float below = distance_from_roots(1 - t, sample.data());
        if (above + below >= bound_) return false;
        const float limit = above + float(samples_.uniform()) * (bound_ - below - above);
        const search::NearRow near = space_.find_nearest_within(nodes(t), sample.data(), limit);
        if (near.row < 0) return false;
        const float far = std::sqrt(near.square), length = std::min(far, range_);
        float& radius = trees_.radius(t, near.row);
        if (radius < far) return false;
        nodes(t).copy_row(near.row, from.data());
        trees_.steer(from.data(), sample.data(), far, range_, to.data());
        const float cost = nodes(t).cost(near.row) + length;
        const float left = distance_from_roots(1 - t, to.data());
        if (cost + left >= bound_) return false;
        if (!trees_.check_edge(from.data(), to.data())) {
            radius = DynamicDomain::after_blocked(radius, range_);
            return false;
        }
        radius = DynamicDomain::after_free(radius);
        const int node = add_cheaper(t, to.data(), near.row, cost);
        return connect(t, node, to.data());
    }

    // Adds a node below the cheapest parent that a few tries find.
    int add_cheaper(int t, const float* q, int parent, float cost) {
        const float least = distance_from_roots(t, q);
        for (int i = 0; i < parent_tries && cost > least * (1 + least_gain); ++i) {
            const float limit = least + float(samples_.uniform()) * (cost - least);
            const search::NearRow near = space_.find_nearest_within(nodes(t), q, limit);
            if (near.row < 0 || near.row == parent) continue;
            const float other = nodes(t).cost(near.row) + std::sqrt(near.square);
            Row from;
            nodes(t).copy_row(near.row, from.data());
            if (other < cost && trees_.check_edge(from.data(), q)) parent = near.row, cost = other;
        }
        return trees_.add(t, q, parent, cost);
    }

    // Extends tree t from one of its nodes to the nearest node of the other tree with which the path is
    // shorter than the bound; true if it arrives.
    bool connect(int t, int node, const float* from) {
        const float spent = nodes(t).cost(node), limit = (1 - least_gain) * bound_ - spent;
        const search::NearRow near = space_.find_nearest_within(nodes(1 - t), from, limit);
        if (near.row < 0) return false;
        return trees_.connect(t, node, from, near, range_, [](const float*, const float*, float) {});
    }
};

}  // namespace cspace::planning
