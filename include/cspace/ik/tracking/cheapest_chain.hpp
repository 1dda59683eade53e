// The cheapest chain of configurations through layers, one of each layer: the way of a redundant arm along a
// path whose solutions are listed at values of its redundant joints (dynamic programming, Bellman 1957).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/ik/tracking/layers.hpp"
#include "cspace/math/wrapping.hpp"

namespace cspace::ik {

// The squared distance between two states; infinite where a joint would move too far.
inline double squared_step(const Layers& layers, std::size_t a, std::size_t b) {
    const double *from = layers.q + layers.dof * a, *to = layers.q + layers.dof * b;
    double sum = 0;
    for (std::size_t j = 0; j < layers.dof; ++j) {
        double move = to[j] - from[j];
        if (layers.wraps[j] && std::abs(move) > pi) move = short_way(move);
        if (!(std::abs(move) <= layers.stride[j])) return std::numeric_limits<double>::infinity();
        sum += move * move;
    }
    return sum;
}

// Totals of the states so far, and the state before each.
struct ChainTable {
    std::vector<double> total;
    std::vector<std::size_t> parent;
};

// The number of a value, brought into the ring; −1 where there is none.
inline int neighbour_value(const Layers& layers, int value) {
    if (layers.is_ring) return (value + layers.values) % layers.values;
    return value < layers.values ? value : -1;  // negative ones stay so
}

// The cheapest state before state s, among those of one value of the layer before.
inline void try_parents(const Layers& layers, const std::size_t* begin, std::size_t s, ChainTable& table,
                        double& best) {
    for (std::size_t p = begin[0]; p < begin[1]; ++p) {
        if (!(table.total[p] < best)) continue;
        const double with = table.total[p] + squared_step(layers, p, s);
        if (!(with < best)) continue;
        best = with;
        table.parent[s] = p;
    }
}

// True if a state of the layer can be reached.
inline bool extend_chains(const Layers& layers, std::size_t layer, ChainTable& table) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const std::size_t values = std::size_t(layers.values);
    const std::size_t *here = layers.begin + values * layer, *before = layer ? here - values : here;
    const int reach = std::min(layers.reach, (layers.values - 1) / (layers.is_ring ? 2 : 1));
    bool any = false;
    for (int v = 0; v < layers.values; ++v)
        for (std::size_t s = here[v]; s < here[v + 1]; ++s) {
            double best = layer ? never : 0.0;
            for (int k = 0; layer && k <= 2 * reach; ++k) {  // the nearest first: they leave little to try
                const int value = neighbour_value(layers, v + (k % 2 ? (k + 1) / 2 : -k / 2));
                if (value >= 0) try_parents(layers, before + value, s, table, best);
            }
            table.total[s] = best + layers.cost[s];
            any = any || table.total[s] < never;
        }
    return any;
}

// The sum of the costs of the states and of the squared steps between them is least.
inline LayerChain find_cheapest_chain(const Layers& layers) {
    const std::size_t values = std::size_t(layers.values), count = layers.begin[layers.layers * values];
    ChainTable table = {std::vector<double>(count, std::numeric_limits<double>::infinity()),
                        std::vector<std::size_t>(count, 0)};
    std::size_t reached = 0;
    while (reached < layers.layers && extend_chains(layers, reached, table)) {
        ++reached;
        if (layers.poll) layers.poll();
    }
    LayerChain chain = {{}, std::numeric_limits<double>::infinity()};
    if (reached == 0) return chain;
    std::size_t last = layers.begin[(reached - 1) * values];
    for (std::size_t s = last; s < layers.begin[reached * values]; ++s)
        if (table.total[s] < table.total[last]) last = s;
    chain.cost = table.total[last];
    chain.states.resize(reached);
    for (std::size_t k = reached; k-- > 0; last = table.parent[last]) chain.states[k] = last;
    return chain;
}

}  // namespace cspace::ik
