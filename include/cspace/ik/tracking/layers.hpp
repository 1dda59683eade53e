// Layers of configurations of which a chain takes one each: plain data.
#pragma once

#include <cstddef>
#include <vector>

namespace cspace::ik {

struct Layers {
    std::size_t dof;
    const double* q;           // (states, dof)
    const double* cost;        // (states,)
    const std::size_t* begin;  // (layers · values + 1,): where the states of each value in each layer begin
    std::size_t layers;
    int values;            // of the redundant joint in each layer
    const double* stride;  // (dof,): how far a joint may move between neighbouring layers
    const bool* wraps;     // (dof,): whether multiples of 2π count as one configuration
    int reach;             // how many values the redundant joint may move between neighbouring layers
    bool is_ring;          // the last value is a neighbour of the first
    void (*poll)();        // called now and then; throws to stop
};

// The states of a chain, one per layer; fewer where none goes on.
struct LayerChain {
    std::vector<std::size_t> states;
    double cost;
};

}  // namespace cspace::ik
