// The cheapest chain of configurations through layers, one of each layer: the way of a redundant arm along a
// path whose solutions are listed at values of its redundant joints (dynamic programming, Bellman 1957).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <vector>

namespace cspace::ik {

struct Layers {
    std::size_t dof;
    const double* q;           // (states, dof)
    const int* value;          // (states,): number of the value of the redundant joint
    const double* cost;        // (states,)
    const std::size_t* begin;  // (layers + 1,): where the states of each layer begin
    std::size_t layers;
    const double* stride;  // (dof,): how far a joint may move between neighbouring layers
    const double* period;  // (dof,): 2π where multiples of it count as one configuration, else 0
    int reach;             // how many values the redundant joint may move between neighbouring layers
    int ring;              // the number of values where the last is a neighbour of the first, else 0
    void (*poll)();        // called now and then; throws to stop
};

// The states of a chain, one per layer; fewer where none goes on.
struct LayerChain {
    std::vector<std::size_t> states;
    double cost;
};

inline int distance_of_values(const Layers& layers, std::size_t a, std::size_t b) {
    const int apart = std::abs(layers.value[a] - layers.value[b]);
    return layers.ring ? std::min(apart, layers.ring - apart) : apart;
}

// The squared distance between two states; infinite where a joint would move too far.
inline double squared_step(const Layers& layers, std::size_t a, std::size_t b) {
    const double *from = layers.q + layers.dof * a, *to = layers.q + layers.dof * b;
    double sum = 0;
    for (std::size_t j = 0; j < layers.dof; ++j) {
        double move = to[j] - from[j];
        if (layers.period[j] > 0) move -= layers.period[j] * std::nearbyint(move / layers.period[j]);
        if (!(std::abs(move) <= layers.stride[j])) return std::numeric_limits<double>::infinity();
        sum += move * move;
    }
    return sum;
}

// The sum of the costs of the states and of the squared steps between them is least.
inline LayerChain find_cheapest_chain(const Layers& layers) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const std::size_t none = std::size_t(-1);
    std::vector<double> total(layers.begin[layers.layers], never);
    std::vector<std::size_t> parent(total.size(), none);
    std::size_t reached = 0;
    for (std::size_t k = 0; k < layers.layers; ++k) {
        if (layers.poll) layers.poll();
        bool any = false;
        for (std::size_t s = layers.begin[k]; s < layers.begin[k + 1]; ++s) {
            double best = k == 0 ? 0 : never;
            for (std::size_t p = k == 0 ? s : layers.begin[k - 1]; k > 0 && p < layers.begin[k]; ++p) {
                if (!(total[p] < best) || distance_of_values(layers, p, s) > layers.reach) continue;
                const double with = total[p] + squared_step(layers, p, s);
                if (!(with < best)) continue;
                best = with;
                parent[s] = p;
            }
            total[s] = best + layers.cost[s];
            any = any || total[s] < never;
        }
        if (!any) break;
        reached = k + 1;
    }
    LayerChain chain = {{}, never};
    if (reached == 0) return chain;
    std::size_t last = layers.begin[reached - 1];
    for (std::size_t s = last; s < layers.begin[reached]; ++s)
        if (total[s] < total[last]) last = s;
    chain.cost = total[last];
    chain.states.resize(reached);
    for (std::size_t k = reached, s = last; k-- > 0; s = parent[s]) chain.states[k] = s;
    return chain;
}

}  // namespace cspace::ik
