// A priority queue for priorities that mostly rise: distant entries are kept in buckets, unsorted, and only
// near ones in a heap, which therefore is small (Denardo & Fox 1979; with a heap for the first
// bucket: Cherkassky, Goldberg & Silverstein 1999, "Buckets, heaps, lists, and monotone priority queues").
// The buckets lie in a ring, lists through one array of entries that are used again, so that what a search
// touches stays in the cache however far it goes. The order is that of a heap, whatever the priorities are.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cspace/search/best_first.hpp"

namespace cspace::search {

class BucketQueue {
  public:
    // Forgets everything; a bucket is so wide, in units of priority.
    void begin(double width) {
        near_.clear();
        far_.clear();
        while (filled_words_) {
            current_ = next_filled();
            heads_[slot_of(current_)] = none;
            clear_bit(slot_of(current_));
        }
        entries_.clear();
        unused_ = none;
        left_ = 0;
        per_unit_ = 1 / width;
        is_spread_ = false;
    }
    bool empty() const { return left_ == 0; }
    void push(const Waiting& entry) {
        ++left_;
        if (is_spread_) return place(entry);
        near_.push(entry);
        if (near_.size() > few) spread();
    }
    Waiting pop() {
        --left_;
        if (near_.empty()) advance();
        return near_.pop();
    }
    std::size_t bytes() const {
        return near_.bytes() + far_.bytes() + entries_.capacity() * sizeof(Linked) +
               heads_.capacity() * sizeof(std::uint32_t);
    }

  private:
    struct Linked {
        Waiting entry;
        std::uint32_t next;
    };
    static constexpr std::uint32_t none = 0xffffffff;
    static constexpr std::size_t few = 16;      // entries that need no buckets
    static constexpr std::int64_t ring = 4096;  // buckets; entries farther away are in a heap
    static constexpr std::int64_t last = std::int64_t(1) << 52;  // no bucket has this number

    // From one heap to a small one and buckets.
    void spread() {
        is_spread_ = true;
        first_ = near_.top().priority;
        current_ = 1;
        heads_.resize(std::size_t(ring), none);
        for (const Waiting& entry : near_.take()) place(entry);
    }
    double bucket_of(const Waiting& entry) const { return (entry.priority - first_) * per_unit_; }
    // The heap `near_` contains all before bucket `current_`, the ring that one and those that follow.
    void place(const Waiting& entry) {
        const double at = bucket_of(entry);
        if (!(at >= double(current_)) || current_ == last) return near_.push(entry);
        if (!(at < double(current_ + ring))) return far_.push(entry);
        link(entry, slot_of(std::int64_t(at)));
    }
    static std::size_t slot_of(std::int64_t bucket) { return std::size_t(bucket) % std::size_t(ring); }
    void link(const Waiting& entry, std::size_t slot) {
        filled_[slot / 64] |= std::uint64_t(1) << (slot % 64);
        filled_words_ |= std::uint64_t(1) << (slot / 64);
        std::uint32_t at = unused_;
        if (at == none) {
            at = std::uint32_t(entries_.size());
            entries_.push_back({entry, heads_[slot]});
        } else {
            unused_ = entries_[at].next;
            entries_[at] = {entry, heads_[slot]};
        }
        heads_[slot] = at;
    }
    // The first bucket of the ring from `current_` on that is not empty, or `last`.
    std::int64_t next_filled() const {
        if (!filled_words_) return last;
        const std::size_t at = slot_of(current_);
        const std::uint64_t rest = filled_[at / 64] >> (at % 64);
        if (rest) return current_ + std::countr_zero(rest);
        const int after = int(at / 64) + 1;
        const std::size_t word = std::size_t(after + std::countr_zero(std::rotr(filled_words_, after))) % 64;
        const std::size_t slot = 64 * word + std::size_t(std::countr_zero(filled_[word]));
        return current_ + std::int64_t(slot_of(std::int64_t(slot) - std::int64_t(at)));
    }
    // Fills the heap, which is empty, with the next bucket.
    void advance() {
        const std::int64_t in_ring = next_filled();
        std::int64_t next = in_ring;
        if (!far_.empty()) {
            const double far = bucket_of(far_.top());
            if (far < double(next)) next = std::int64_t(far);
            while (!far_.empty() && (next == last || bucket_of(far_.top()) < double(next + 1)))
                near_.push(far_.pop());
        }
        if (next == in_ring && next != last) take(slot_of(next));
        current_ = next == last ? last : next + 1;
    }
    void take(std::size_t slot) {
        std::uint32_t at = heads_[slot];
        for (;; at = entries_[at].next) {
            near_.push(entries_[at].entry);
            if (entries_[at].next == none) break;
        }
        entries_[at].next = unused_;
        unused_ = std::exchange(heads_[slot], none);
        clear_bit(slot);
    }
    void clear_bit(std::size_t slot) {
        if (!(filled_[slot / 64] &= ~(std::uint64_t(1) << (slot % 64))))
            filled_words_ &= ~(std::uint64_t(1) << (slot / 64));
    }

    PriorityQueue near_, far_;
    std::vector<Linked> entries_;
    std::vector<std::uint32_t> heads_;        // of the ring's buckets that are not empty
    std::array<std::uint64_t, 64> filled_{};  // a bit for each bucket that is not empty
    std::uint64_t filled_words_ = 0;          // and one for each word of them
    std::uint32_t unused_ = none;
    std::size_t left_ = 0;
    std::int64_t current_ = 0;
    double first_ = 0, per_unit_ = 1;
    bool is_spread_ = false;
};

}  // namespace cspace::search
