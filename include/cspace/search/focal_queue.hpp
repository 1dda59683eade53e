// The queue of focal search: of all nodes whose f is at most w times the least, the one that seems nearest to
// the goal goes first (Pearl & Kim 1982, "Studies in semi-admissible heuristics", A*ε). The least f is a
// lower bound of the shortest way, so a goal taken from it is at most w times as far.
//
// A node that a shorter way reaches later waits once more, and taken in this order nodes may do so again and
// again. After `patience` of them the least f goes first: then each is taken once more at most, for the queue
// contains the next node of every shortest path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cspace/search/best_first.hpp"

namespace cspace::search {

class FocalQueue {
  public:
    FocalQueue(double bound, std::uint64_t patience) : bound_(bound), patience_(patience) {}
    bool empty() const { return left_ == 0; }
    // priority: f; tie: how far the goal seems.
    void push(const Waiting& entry) {
        const std::uint32_t number = std::uint32_t(nodes_.size());
        nodes_.push_back(entry.node);
        taken_.push_back(0);
        all_.push({entry.priority, entry.tie, number});
        ++left_;
        if (popped_ >= patience_) return;
        if (!near_.empty() && entry.priority <= bound_ * least_)
            near_.push({entry.tie, float(entry.priority), number});
        else
            far_.push({entry.priority, entry.tie, number});
    }
    Waiting pop() {
        while (taken_[all_.top().node]) all_.pop();
        least_ = all_.top().priority;
        --left_;
        if (popped_ >= patience_) {
            const Waiting entry = all_.pop();
            return {entry.priority, entry.tie, nodes_[entry.node]};
        }
        ++popped_;
        while (!far_.empty() && far_.top().priority <= bound_ * least_) {
            const Waiting entry = far_.pop();
            near_.push({entry.tie, float(entry.priority), entry.node});
        }
        const Waiting entry = near_.pop();
        taken_[entry.node] = 1;
        return {entry.priority, entry.tie, nodes_[entry.node]};
    }
    // No way to the goal is shorter.
    double least() const { return least_; }

  private:
    double bound_, least_ = 0;
    std::uint64_t patience_, popped_ = 0;
    std::size_t left_ = 0;
    Heap<Waiting> all_, far_, near_;
    std::vector<std::uint32_t> nodes_;
    std::vector<std::uint8_t> taken_;
};

}  // namespace cspace::search
