// What a search stores for the nodes it reaches, reused by the next query.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cspace::search {

// An entry for each node; an entry records the query that wrote it.
template <class T>
class DenseTable {
  public:
    void begin(std::size_t nodes) { notes_.resize(nodes); }
    void forget() { notes_.assign(notes_.size(), T{}); }
    T& operator[](std::uint32_t node) { return notes_[node]; }
    std::size_t bytes() const { return notes_.capacity() * sizeof(T); }

  private:
    std::vector<T> notes_;
};

// For nodes that are too many to have a place each: places for those that a query comes to, found by hashing,
// the next free one taken on a clash (Knuth, volume 3, section 6.4).
template <class T>
class SparseTable {
  public:
    void begin() {
        filled_ = 0;
        slots_.resize(std::size_t(1) << bits_);
        if (++stamp_ == 0) forget();
    }
    void forget() {
        slots_.assign(slots_.size(), Slot{});
        stamp_ = 1;
    }
    T& operator[](std::uint32_t node) {
        if (filled_ >> (bits_ - 1)) grow();
        Slot& slot = find(node);
        if (slot.stamp != stamp_) {
            ++filled_;
            slot = {node, stamp_, T{}};
        }
        return slot.note;
    }
    std::size_t bytes() const { return slots_.capacity() * sizeof(Slot); }

  private:
    struct Slot {
        std::uint32_t node = 0, stamp = 0;
        T note{};
    };
    Slot& find(std::uint32_t node) {
        const std::size_t mask = (std::size_t(1) << bits_) - 1;
        // The upper bits of a product with 2³² over the golden ratio.
        std::size_t at = (node * 0x9e3779b9u) >> (32 - bits_);
        while (slots_[at].stamp == stamp_ && slots_[at].node != node) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow() {
        std::vector<Slot> old(std::size_t(1) << ++bits_);
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.stamp == stamp_) find(slot.node) = slot;
    }

    std::vector<Slot> slots_;
    int bits_ = 10;  // of the number of slots
    std::uint32_t stamp_ = 0;
    std::size_t filled_ = 0;
};

}  // namespace cspace::search
