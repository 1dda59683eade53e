// What lies at each node of a graph, its neighbours or edges, in one array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cspace::search {

template <class T>
class Adjacency {
  public:
    Adjacency() = default;
    // list(add) calls add(node, value) for every entry, and is called twice: to count and to fill.
    template <class List>
    Adjacency(std::size_t nodes, const List& list) : first_(nodes + 1, 0) {
        list([&](std::size_t node, const T&) { ++first_[node + 1]; });
        for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
        entries_.resize(first_.back());
        std::vector<std::uint32_t> filled(first_.begin(), first_.end() - 1);
        list([&](std::size_t node, const T& value) { entries_[filled[node]++] = value; });
    }

    std::span<const T> of(std::size_t node) const {
        return {entries_.data() + first_[node], entries_.data() + first_[node + 1]};
    }
    std::size_t bytes() const { return 4 * first_.size() + sizeof(T) * entries_.size(); }

  private:
    std::vector<std::uint32_t> first_;
    std::vector<T> entries_;
};

}  // namespace cspace::search
