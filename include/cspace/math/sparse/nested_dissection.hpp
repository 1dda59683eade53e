// Nested dissection: an elimination order of the blocks of a symmetric matrix with little fill, where minimum
// degree leaves much of it, on large meshes and maps (George 1973, "Nested dissection of a regular finite
// element mesh").
//
// Nodes with two neighbours at most go first: a pose graph is mostly chains. A separator of the rest is
// eliminated last, after the two parts that it leaves, and these are ordered in the same way. Small parts are
// ordered by minimum degree.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "cspace/math/sparse/block_graph.hpp"
#include "cspace/math/sparse/minimum_degree.hpp"
#include "cspace/math/sparse/separator.hpp"
#include "cspace/math/sparse/symbolic.hpp"

namespace cspace {

class NestedDissection {
  public:
    explicit NestedDissection(const BlockGraph& graph)
        : graph_(graph), stages_(std::size_t(graph.nodes()), -1) {}

    // The blocks in the order of their elimination.
    std::vector<int> find_order() {
        dissect(eliminate_chains(), 0);
        for (int& stage : stages_) stage = stage < 0 ? 0 : deepest_ + 1 - stage;
        return MinimumDegree(graph_, std::move(stages_)).find_order();
    }

  private:
    static constexpr int leaf_nodes = 200;  // of a part that minimum degree orders (found by trial)
    static constexpr int chain_degree = 2;

    // A part of the graph, and the blocks that are its nodes.
    struct Piece {
        WeightedGraph graph;
        std::vector<int> blocks;
    };

    // Orders the nodes with few neighbours; what is left, with the neighbours that they connect.
    Piece eliminate_chains() {
        const int n = graph_.nodes();
        std::vector<std::vector<int>> near(static_cast<std::size_t>(n));
        std::vector<int> waiting;
        for (int node = 0; node < n; ++node) {
            const auto begin = graph_.neighbours.begin();
            near[std::size_t(node)].assign(begin + std::ptrdiff_t(graph_.starts[std::size_t(node)]),
                                           begin + std::ptrdiff_t(graph_.starts[std::size_t(node) + 1]));
            if (int(near[std::size_t(node)].size()) <= chain_degree) waiting.push_back(node);
        }
        std::vector<char> is_gone(std::size_t(n), 0);
        InterruptPoll poll(1 << 8);
        while (!waiting.empty()) {
            poll.step();
            const int node = waiting.back();
            waiting.pop_back();
            if (is_gone[std::size_t(node)]) continue;
            is_gone[std::size_t(node)] = 1;
            const std::vector<int> ends = std::exchange(near[std::size_t(node)], {});
            for (std::size_t k = 0; k < ends.size(); ++k) {
                std::vector<int>& list = near[std::size_t(ends[k])];
                const auto at = std::find(list.begin(), list.end(), node);
                const int across = ends.size() == 2 ? ends[1 - k] : -1;
                if (across >= 0 && std::find(list.begin(), list.end(), across) == list.end())
                    *at = across;
                else
                    list.erase(at);
                if (int(list.size()) <= chain_degree) waiting.push_back(ends[k]);
            }
        }
        return make_core(near, is_gone);
    }
    Piece make_core(const std::vector<std::vector<int>>& near, const std::vector<char>& is_gone) const {
        Piece core;
        std::vector<int> number(is_gone.size(), -1);
        for (int node = 0; node < graph_.nodes(); ++node) {
            if (is_gone[std::size_t(node)]) continue;
            number[std::size_t(node)] = int(core.blocks.size());
            core.blocks.push_back(node);
            core.graph.weights.push_back(graph_.sizes[std::size_t(node)]);
        }
        for (int block : core.blocks) {
            for (int i : near[std::size_t(block)]) core.graph.neighbours.push_back(number[std::size_t(i)]);
            core.graph.starts.push_back(core.graph.neighbours.size());
        }
        core.graph.strengths.assign(core.graph.neighbours.size(), 1);
        return core;
    }

    // Gives the separators of a piece their depth.
    void dissect(Piece piece, int depth) {
        if (piece.graph.nodes() <= leaf_nodes) return;
        const std::vector<Part> parts = find_separator(piece.graph);
        Piece left = take_part(piece, parts, Part::left), right = take_part(piece, parts, Part::right);
        if (left.blocks.empty() || right.blocks.empty()) return;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (parts[k] == Part::separator) stages_[std::size_t(piece.blocks[k])] = depth;
        }
        deepest_ = std::max(deepest_, depth);
        piece = {};
        dissect(std::move(left), depth + 1);
        dissect(std::move(right), depth + 1);
    }
    static Piece take_part(const Piece& piece, const std::vector<Part>& parts, Part part) {
        Piece taken;
        std::vector<int> number(parts.size(), -1);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (parts[k] != part) continue;
            number[k] = int(taken.blocks.size());
            taken.blocks.push_back(piece.blocks[k]);
            taken.graph.weights.push_back(piece.graph.weights[k]);
        }
        for (int node = 0; node < piece.graph.nodes(); ++node) {
            if (parts[std::size_t(node)] != part) continue;
            piece.graph.visit_neighbours(node, [&](int i, int strength) {
                if (number[std::size_t(i)] < 0) return;
                taken.graph.neighbours.push_back(number[std::size_t(i)]);
                taken.graph.strengths.push_back(strength);
            });
            taken.graph.starts.push_back(taken.graph.neighbours.size());
        }
        return taken;
    }
    const BlockGraph& graph_;
    std::vector<int> stages_;  // of each block: the depth of its separator, then its stage; −1: in none
    int deepest_ = 0;
};

CSPACE_ONCE std::vector<int> order_nested_dissection(const BlockGraph& graph) {
    return NestedDissection(graph).find_order();
}

// The order of minimum degree, or that of nested dissection where the factor is large and has fewer numbers
// with it.
inline std::vector<int> order_blocks(const BlockGraph& graph) {
    constexpr double many = 3e10;  // multiplications of a factorisation, seconds: to dissect takes less
    MinimumDegree degrees(graph);
    std::vector<int> order = degrees.find_order();
    if (degrees.operations() < many) return order;
    std::vector<int> dissected = order_nested_dissection(graph);
    return count_factor(graph, dissected) < count_factor(graph, order) ? dissected : order;
}

}  // namespace cspace
