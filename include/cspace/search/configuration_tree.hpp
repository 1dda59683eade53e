// A tree of configurations in floats: nodes in blocks of eight, coordinate by coordinate, as nearest_row.hpp
// reads them; parents, costs from the root.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace::search {

class ConfigurationTree {
  public:
    static constexpr int lanes = 8, no_parent = -1;

    explicit ConfigurationTree(int width) : width_(width) {}

    int size() const { return int(parents_.size()); }
    int width() const { return width_; }
    const float* blocks() const { return blocks_.data(); }
    int parent(int node) const { return parents_[std::size_t(node)]; }
    float cost(int node) const { return costs_[std::size_t(node)]; }
    // Of all nodes, filled up to whole blocks with a number beyond any cost.
    const float* costs() const { return costs_.data(); }
    void copy_row(int node, float* q) const {
        const float* at = blocks_.data() + place(node);
        for (int k = 0; k < width_; ++k) q[k] = at[lanes * k];
    }

    float coordinate(int node, int k) const { return blocks_[place(node) + std::size_t(lanes * k)]; }

    // The number of the new node.
    int add(const float* q, int parent, float cost) {
        constexpr float beyond = 3e38f;
        const int node = size();
        if (node % lanes == 0) {
            costs_.insert(costs_.end(), lanes, beyond);
            for (int k = 0; k < width_; ++k) blocks_.insert(blocks_.end(), lanes, q[k]);
        } else {
            float* at = blocks_.data() + place(node);
            for (int k = 0; k < width_; ++k) at[lanes * k] = q[k];
        }
        parents_.push_back(parent);
        costs_[std::size_t(node)] = cost;
        return node;
    }

    // Removes a node and all below it. The others close up; per node left, its number before.
    std::vector<int> remove_branch(int node) {
        constexpr int removed = -2;
        std::vector<int> numbers(parents_.size()), kept;
        InterruptPoll poll(1024);
        for (int i = 0; i < size(); ++i) {
            poll.step();
            const int above = parent(i);  // before i
            const bool goes = i == node || (above >= 0 && numbers[std::size_t(above)] == removed);
            numbers[std::size_t(i)] = goes ? removed : int(kept.size());
            if (!goes) kept.push_back(i);
        }
        ConfigurationTree left(width_);
        std::vector<float> q(static_cast<std::size_t>(width_));
        for (const int i : kept) {
            poll.step();
            copy_row(i, q.data());
            const int above = parent(i);
            left.add(q.data(), above < 0 ? no_parent : numbers[std::size_t(above)], cost(i));
        }
        *this = std::move(left);
        return kept;
    }

  private:
    int width_;
    std::vector<float> blocks_, costs_;
    std::vector<int> parents_;

    std::size_t place(int node) const {
        return std::size_t(node / lanes) * std::size_t(lanes * width_) + std::size_t(node % lanes);
    }
};

}  // namespace cspace::search
