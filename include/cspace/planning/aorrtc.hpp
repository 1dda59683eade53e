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
#include "cspace/planning/rrt_connect.hpp"

namespace cspace::planning {

template <class Space>
class CostBoundedTrees {
  public:
    using Row = InformedSamples::Row;
    using PathNode = typename RrtConnect<Space>::PathNode;
    using Counts = typename RrtConnect<Space>::Counts;

    CostBoundedTrees(Space& space, InformedSamples& samples, float range)
        : space_(space),
          box_(space.box()),
          samples_(samples),
          range_(range),
          trees_{Tree(box_.width), Tree(box_.width)} {}

    void add_start(const float* q) { add_node(0, q, Tree::no_parent, 0), ++roots_[0]; }
    void add_goal(const float* q) { add_node(1, q, Tree::no_parent, 0), ++roots_[1]; }

    // Searches for a path shorter than `bound`, until `budget` edges are checked.
    SearchEnd run(float bound, std::int64_t budget) {
        bound_ = bound;
        list_pairs();
        while (counts_.edges < budget && !pairs_.empty()) {
            if (!space_.has_time()) return SearchEnd::no_time;
            if (grow()) return SearchEnd::met;
            if (++counts_.samples > samples_per_edge * budget) break;
        }
        return SearchEnd::edge_budget;
    }
    const std::vector<PathNode>& path() const { return path_; }
    const search::ConfigurationTree& tree(int t) const { return trees_[std::size_t(t)]; }
    const Counts& counts() const { return counts_; }

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
    std::array<Tree, 2> trees_;
    std::array<std::vector<float>, 2> radii_;  // of the domains of the nodes
    std::array<int, 2> roots_ = {0, 0};
    std::vector<std::pair<int, int>> pairs_;
    std::vector<PathNode> path_;
    Counts counts_;
    float bound_ = 0;

    int add_node(int t, const float* q, int parent, float cost) {
        radii_[std::size_t(t)].push_back(DynamicDomain::unbounded);
        return nodes(t).add(q, parent, cost);
    }
    Tree& nodes(int t) { return trees_[std::size_t(t)]; }

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
    bool check_edge(const float* a, const float* b) {
        ++counts_.edges;
        const bool is_free = space_.is_free(a, b);
        counts_.blocked += !is_free;
        return is_free;
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
        float& radius = radii_[std::size_t(t)][std::size_t(near.row)];
        if (radius < far) return false;
        nodes(t).copy_row(near.row, from.data());
        if (far <= range_)
            std::copy_n(sample.data(), box_.width, to.data());
        else
            box_.interpolate(from.data(), sample.data(), range_ / far, to.data());
        const float cost = nodes(t).cost(near.row) + length;
        const float left = distance_from_roots(1 - t, to.data());
        if (cost + left >= bound_) return false;
        if (!check_edge(from.data(), to.data())) {
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
            if (other < cost && check_edge(from.data(), q)) parent = near.row, cost = other;
        }
        return add_node(t, q, parent, cost);
    }

    // Extends tree t from one of its nodes to the nearest node of the other tree with which the path is
    // shorter than the bound; true if it arrives.
    bool connect(int t, int node, const float* from) {
        const float spent = nodes(t).cost(node), limit = (1 - least_gain) * bound_ - spent;
        const search::NearRow near = space_.find_nearest_within(nodes(1 - t), from, limit);
        if (near.row < 0) return false;
        const float far = std::sqrt(near.square);
        Row target, places[2];
        nodes(1 - t).copy_row(near.row, target.data());
        const int steps = std::max(1, int(std::ceil(far / range_)));
        const float* at = from;
        for (int i = 1; i <= steps; ++i) {
            float* const next = i == steps ? target.data() : places[i % 2].data();
            if (i < steps) box_.interpolate(from, target.data(), float(i) / float(steps), next);
            if (!check_edge(at, next)) return false;
            if (i < steps) node = add_node(t, next, node, spent + far * (float(i) / float(steps)));
            at = next;
        }
        path_.clear();
        for (int n = t == 0 ? node : near.row; n >= 0; n = nodes(0).parent(n)) path_.push_back({0, n});
        std::reverse(path_.begin(), path_.end());
        for (int n = t == 0 ? near.row : node; n >= 0; n = nodes(1).parent(n)) path_.push_back({1, n});
        return true;
    }
};

}  // namespace cspace::planning
