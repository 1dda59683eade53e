// Groups of edges that measure about the same: both of their ends are near in the order of the poses, and
// their errors agree.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace::localization {

inline constexpr int group_gap = 3;  // poses between ends of neighbours; every other frame may lack a loop

// The groups of edges (from, to), as lists of their numbers. agree(a, b): whether two near ones do.
template <class Agree>
std::vector<std::vector<std::size_t>> find_loop_groups(const std::vector<std::pair<int, int>>& edges,
                                                       const Agree& agree) {
    std::vector<std::size_t> order(edges.size()), root(edges.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::iota(root.begin(), root.end(), std::size_t(0));
    sort_polled(order, [&](std::size_t a, std::size_t b) {
        return edges[a] != edges[b] ? edges[a] < edges[b] : a < b;
    });
    const auto find_root = [&](std::size_t k) {
        while (root[k] != k) k = root[k] = root[root[k]];
        return k;
    };
    InterruptPoll poll(1 << 10);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const auto& edge = edges[order[k]];
        for (std::size_t m = k + 1; m < order.size(); ++m) {
            poll.step();
            const auto& other = edges[order[m]];
            if (other.first - edge.first > group_gap) break;
            if (std::abs(other.second - edge.second) <= group_gap && agree(order[k], order[m]))
                root[find_root(order[m])] = find_root(order[k]);
        }
    }
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::size_t> number(edges.size(), edges.size());
    for (std::size_t k = 0; k < edges.size(); ++k) {
        std::size_t& group = number[find_root(k)];
        if (group == edges.size()) group = groups.size(), groups.emplace_back();
        groups[group].push_back(k);
    }
    return groups;
}

}  // namespace cspace::localization
