// The queue of focal search: of all nodes whose f is at most w times the least, the one that seems nearest to
// the goal goes first (Pearl & Kim 1982, "Studies in semi-admissible heuristics", A*ε). The least f is a
// lower bound of the shortest way, so a goal taken from it is at most w times as far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cspace/navigation/best_first.hpp"

namespace cspace::navigation {

class FocalQueue {
  public:
    explicit FocalQueue(double bound) : bound_(bound) {}
    bool empty() const { return left_ == 0; }
    // priority: f; tie: how far the goal seems.
    void push(const Waiting& entry) {
        const std::uint32_t number = std::uint32_t(nodes_.size());
        nodes_.push_back(entry.node);
        taken_.push_back(0);
        all_.push({entry.priority, entry.tie, number});
        if (!near_.empty() && entry.priority <= bound_ * least_)
            near_.push({entry.tie, float(entry.priority), number});
        else
            far_.push({entry.priority, entry.tie, number});
        ++left_;
    }
    Waiting pop() {
        while (taken_[all_.top().node]) all_.pop();
        least_ = all_.top().priority;
        while (!far_.empty() && far_.top().priority <= bound_ * least_) {
            const Waiting entry = far_.pop();
            near_.push({entry.tie, float(entry.priority), entry.node});
        }
        const Waiting entry = near_.pop();
        taken_[entry.node] = 1;
        --left_;
        return {entry.priority, entry.tie, nodes_[entry.node]};
    }
    // No way to the goal is shorter.
    double least() const { return least_; }

  private:
    double bound_, least_ = 0;
    std::size_t left_ = 0;
    Heap<Waiting> all_, far_, near_;
    std::vector<std::uint32_t> nodes_;
    std::vector<std::uint8_t> taken_;
};

}  // namespace cspace::navigation
