// The pattern of a symmetric sparse matrix of blocks, as a graph: its nodes are the diagonal blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/math/isa.hpp"

namespace cspace {

struct BlockGraph {
    std::vector<int> sizes;           // rows of each block
    std::vector<std::size_t> starts;  // of the neighbours of each node, and their number
    std::vector<int> neighbours;      // each pair in both directions, sorted, without repetition

    int nodes() const { return int(sizes.size()); }
};

using BlockPair = std::pair<int, int>;

namespace block_graphs {

// Sorts the neighbours of each node and removes repetitions.
inline void remove_repetitions(BlockGraph& graph) {
    InterruptPoll poll(1 << 8);
    std::size_t kept = 0;
    for (int node = 0; node < graph.nodes(); ++node) {
        poll.step();
        const auto begin = graph.neighbours.begin() + std::ptrdiff_t(graph.starts[std::size_t(node)]);
        const auto end = graph.neighbours.begin() + std::ptrdiff_t(graph.starts[std::size_t(node) + 1]);
        std::sort(begin, end);
        const auto last = std::unique(begin, end);
        graph.starts[std::size_t(node)] = kept;
        std::copy(begin, last, graph.neighbours.begin() + std::ptrdiff_t(kept));
        kept += std::size_t(last - begin);
    }
    graph.starts.back() = kept;
    graph.neighbours.resize(kept);
}

}  // namespace block_graphs

// The graph of blocks of these sizes with these pairs off the diagonal, in any order and direction.
CSPACE_ONCE BlockGraph make_block_graph(std::vector<int> sizes, const std::vector<BlockPair>& pairs) {
    BlockGraph graph;
    graph.starts.assign(sizes.size() + 1, 0);
    graph.sizes = std::move(sizes);
    for (const auto& [i, j] : pairs) {
        if (i != j) ++graph.starts[std::size_t(i) + 1], ++graph.starts[std::size_t(j) + 1];
    }
    for (std::size_t node = 1; node < graph.starts.size(); ++node)
        graph.starts[node] += graph.starts[node - 1];
    graph.neighbours.resize(graph.starts.back());
    std::vector<std::size_t> next(graph.starts.begin(), graph.starts.end() - 1);
    for (const auto& [i, j] : pairs) {
        if (i == j) continue;
        graph.neighbours[next[std::size_t(i)]++] = j;
        graph.neighbours[next[std::size_t(j)]++] = i;
    }
    block_graphs::remove_repetitions(graph);
    return graph;
}

}  // namespace cspace
