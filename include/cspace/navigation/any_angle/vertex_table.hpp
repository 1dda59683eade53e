// The data that a search stores for the corners it reaches, reused by the next query.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cspace::navigation {

// An entry for each vertex of a mesh; an entry records the query that wrote it.
template <class T>
class DenseTable {
  public:
    template <class Mesh>
    explicit DenseTable(const Mesh& mesh) : notes_(mesh.points.size()) {}
    void begin() {}
    void forget() { notes_.assign(notes_.size(), T{}); }
    T& operator[](std::int32_t vertex) { return notes_[std::size_t(vertex)]; }
    std::size_t bytes() const { return notes_.capacity() * sizeof(T); }

  private:
    std::vector<T> notes_;
};

// For meshes whose vertices are too many to have a place each: places for those that a query comes to, found
// by hashing, the next free one taken on a clash (Knuth, volume 3, section 6.4).
template <class T>
class SparseTable {
  public:
    template <class Mesh>
    explicit SparseTable(const Mesh&) {}
    void begin() {
        filled_ = 0;
        if (slots_.empty()) slots_.resize(1024);
        if (++stamp_ == 0) forget();
    }
    void forget() {
        slots_.assign(slots_.size(), Slot{});
        stamp_ = 1;
    }
    T& operator[](std::int32_t vertex) {
        if (4 * filled_ >= 3 * slots_.size()) grow();
        Slot& slot = find(vertex);
        if (slot.stamp != stamp_) {
            ++filled_;
            slot = {vertex, stamp_, T{}};
        }
        return slot.note;
    }
    std::size_t bytes() const { return slots_.capacity() * sizeof(Slot); }

  private:
    struct Slot {
        std::int32_t vertex = 0;
        std::uint32_t stamp = 0;
        T note{};
    };
    Slot& find(std::int32_t vertex) {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at =
            (std::uint32_t(vertex) * 0x9e3779b9u) >> (32 - std::countr_zero(std::uint64_t(slots_.size())));
        while (slots_[at].stamp == stamp_ && slots_[at].vertex != vertex) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.stamp == stamp_) find(slot.vertex) = slot;
    }

    std::vector<Slot> slots_;
    std::uint32_t stamp_ = 0;
    std::size_t filled_ = 0;
};

}  // namespace cspace::navigation
