// Roadmaps: nodes drawn from free space, and edges between those that are near to each other (Kavraki,
// Svestka, Latombe & Overmars 1996, "Probabilistic roadmaps for path planning in high-dimensional
// configuration spaces"). Which nodes are near, and which edges are free, is the space's to say.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/search/adjacency.hpp"

namespace cspace::search {

// Two nodes, the larger first.
using NodePair = std::pair<std::int32_t, std::int32_t>;

// What leads from a node to another, and the number of its edge.
struct RoadmapArc {
    std::int32_t to, edge;
};

// The pairs of nodes that may be joined: list(i, near) lists the nodes near to node i, which may include i.
// is_mutual: i is near to j wherever j is near to i.
template <class List>
std::vector<NodePair> choose_pairs(std::int32_t nodes, bool is_mutual, const List& list) {
    std::vector<NodePair> pairs;
    std::vector<std::int32_t> near;
    InterruptPoll poll(16);
    for (std::int32_t i = 0; i < nodes; ++i) {
        poll.step();
        list(i, near);
        for (const std::int32_t j : near)
            if (j < i || (!is_mutual && j != i)) pairs.push_back({std::max(i, j), std::min(i, j)});
    }
    if (is_mutual) return pairs;
    sort_polled(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

// What lies at each node: make_entry(node at the other end, number of the pair).
template <class Entry, class MakeEntry>
Adjacency<Entry> join_pairs(std::size_t nodes, const std::vector<NodePair>& pairs,
                            const MakeEntry& make_entry) {
    return {nodes, [&](const auto& add) {
                visit_range(0, pairs.size(), [&](std::size_t k) {
                    const auto [i, j] = pairs[k];
                    add(std::size_t(i), make_entry(j, std::int32_t(k)));
                    add(std::size_t(j), make_entry(i, std::int32_t(k)));
                });
            }};
}

// Which nodes hang together: disjoint sets with path halving (Tarjan & van Leeuwen 1984).
class Components {
  public:
    explicit Components(std::size_t nodes) : above_(nodes), count_(nodes) {
        std::iota(above_.begin(), above_.end(), 0);
    }
    std::size_t count() const { return count_; }
    std::int32_t find(std::int32_t node) {
        while (above(node) != node) node = above(node) = above(above(node));
        return node;
    }
    void join(std::int32_t i, std::int32_t j) {
        i = find(i), j = find(j);
        if (i == j) return;
        above(std::max(i, j)) = std::min(i, j);
        --count_;
    }

  private:
    std::vector<std::int32_t> above_;
    std::size_t count_;

    std::int32_t& above(std::int32_t node) { return above_[std::size_t(node)]; }
};

}  // namespace cspace::search
