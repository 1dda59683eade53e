// Best-first search: expands the open node of least priority, and its successors become open nodes (Pearl,
// "Heuristics", 1984; Hart, Nilsson & Raphael 1968 for A*). A planner is a queue and a space:
//
//   space.settle(node)         closes the node; false if it is closed already
//   space.is_goal(node)
//   space.expand(node, queue)  pushes its successors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace::search {

inline constexpr std::uint32_t no_node = 0xffffffff;

// A node that waits; of equal priorities the smaller tie goes first.
struct Waiting {
    double priority;
    float tie;
    std::uint32_t node;
    friend bool operator<(const Waiting& x, const Waiting& y) {
        return x.priority < y.priority || (x.priority == y.priority && x.tie < y.tie);
    }
};

// A heap of four branches: half as deep as one of two, and four children share a cache line.
template <class Entry>
class Heap {
  public:
    bool empty() const { return entries_.empty(); }
    std::size_t size() const { return entries_.size(); }
    void clear() { entries_.clear(); }
    const Entry& top() const { return entries_.front(); }
    void push(const Entry& entry) {
        std::size_t at = entries_.size();
        entries_.push_back(entry);
        for (; at > 0; at = (at - 1) / 4) {
            const std::size_t above = (at - 1) / 4;
            if (!(entry < entries_[above])) break;
            entries_[at] = entries_[above];
        }
        entries_[at] = entry;
    }
    Entry pop() {
        const Entry least = entries_.front(), last = entries_.back();
        entries_.pop_back();
        if (!entries_.empty()) sink(last);
        return least;
    }
    // All entries, in no order; the heap is empty then.
    std::vector<Entry> take() { return std::exchange(entries_, {}); }
    std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

  private:
    void sink(const Entry& entry) {
        const std::size_t n = entries_.size();
        std::size_t at = 0;
        for (std::size_t child = 1; child < n; child = 4 * at + 1) {
            std::size_t least = child;
            const std::size_t end = child + 4 < n ? child + 4 : n;
            for (std::size_t k = child + 1; k < end; ++k)
                if (entries_[k] < entries_[least]) least = k;
            if (!(entries_[least] < entry)) break;
            entries_[at] = entries_[least];
            at = least;
        }
        entries_[at] = entry;
    }

    std::vector<Entry> entries_;
};

using PriorityQueue = Heap<Waiting>;

// First come, first served: the waves of a breadth-first search.
class Waves {
  public:
    bool empty() const { return next_ == nodes_.size(); }
    void clear() { nodes_.clear(), next_ = 0; }
    void push(const Waiting& entry) { nodes_.push_back(entry.node); }
    Waiting pop() { return {0, 0, nodes_[next_++]}; }
    std::size_t bytes() const { return nodes_.capacity() * sizeof(std::uint32_t); }

  private:
    std::vector<std::uint32_t> nodes_;
    std::size_t next_ = 0;
};

// What a search has cost, and, where somebody looks, the nodes in the order in which they were settled.
struct Effort {
    std::uint64_t settled = 0, pushed = 0;
    std::vector<std::uint32_t>* order = nullptr;
    std::uint64_t pause = std::numeric_limits<std::uint64_t>::max();  // after so many the search waits
};

// The best ways to the nodes of a graph that a search knows so far.
class Ways {
  public:
    explicit Ways(std::size_t nodes)
        : cost_(nodes, std::numeric_limits<double>::infinity()),
          before_(nodes, no_node),
          settled_(nodes, 0) {}

    double cost(std::uint32_t node) const { return cost_[node]; }
    // The node or edge before it; no_node at the start.
    std::uint32_t before(std::uint32_t node) const { return before_[node]; }
    bool is_settled(std::uint32_t node) const { return settled_[node]; }
    bool settle(std::uint32_t node) { return !std::exchange(settled_[node], std::uint8_t(1)); }
    // Keeps a way to a node if none of less cost is known; whether it does.
    bool improve(std::uint32_t node, double cost, std::uint32_t before) {
        if (!(cost < cost_[node]) || settled_[node]) return false;
        cost_[node] = cost, before_[node] = before;
        return true;
    }

  private:
    std::vector<double> cost_;
    std::vector<std::uint32_t> before_;
    std::vector<std::uint8_t> settled_;
};

// The goal that was reached; no_node if no open node remains, or the search is to pause: it continues
// on the next call.
template <class Space, class Queue>
std::uint32_t best_first(Space& space, Queue& queue, Effort& effort) {
    InterruptPoll poll(256);
    while (!queue.empty() && effort.settled < effort.pause) {
        poll.step();
        const std::uint32_t node = queue.pop().node;
        if (!space.settle(node)) continue;
        ++effort.settled;
        if (effort.order) effort.order->push_back(node);
        if (space.is_goal(node)) return node;
        space.expand(node, queue);
    }
    return no_node;
}

}  // namespace cspace::search
