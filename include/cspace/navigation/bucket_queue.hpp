// A priority queue for priorities that mostly rise: what is far away waits in buckets, unsorted, and only
// what is near is kept in a heap, which therefore is small (Denardo & Fox 1979; with a heap for the first
// bucket: Cherkassky, Goldberg & Silverstein 1999, "Buckets, heaps, lists, and monotone priority queues").
// The order is that of a heap, whatever the priorities are.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cspace/navigation/best_first.hpp"

namespace cspace::navigation {

class BucketQueue {
  public:
    // Forgets everything; a bucket is so wide, in units of priority.
    void begin(double width) {
        near_.clear();
        if (is_spread_)
            for (std::size_t k = next_filled(); k < most; k = next_filled()) take(k);
        left_ = 0;
        per_unit_ = 1 / width;
        is_spread_ = false;
    }
    bool empty() const { return left_ == 0; }
    void push(const Waiting& entry) {
        ++left_;
        if (!is_spread_) {
            near_.push(entry);
            if (left_ > few) spread();
            return;
        }
        // The heap holds all before bucket `current_`.
        const double at = (entry.priority - first_) * per_unit_;
        if (!(at >= double(current_)) || current_ == most) return near_.push(entry);
        const std::size_t k = at < double(most - 1) ? std::size_t(at) : most - 1;
        if (k >= buckets_.size()) grow(k);
        filled_[k / 64] |= std::uint64_t(1) << (k % 64);
        buckets_[k].push_back(entry);
    }
    Waiting pop() {
        if (near_.empty()) {
            const std::size_t k = next_filled();
            for (const Waiting& entry : buckets_[k]) near_.push(entry);
            take(k);
        }
        --left_;
        return near_.pop();
    }
    std::size_t bytes() const {
        std::size_t sum = near_.bytes();
        for (const auto& bucket : buckets_) sum += bucket.capacity() * sizeof(Waiting) + sizeof bucket;
        return sum;
    }
    void release() {
        near_.release();
        begin(1);
        std::vector<std::vector<Waiting>>().swap(buckets_);
        filled_.clear();
    }

  private:
    static constexpr std::size_t few = 256;       // entries that need no buckets
    static constexpr std::size_t most = 1 << 16;  // the last bucket holds all that is farther

    // From one heap to a small one and buckets.
    void spread() {
        is_spread_ = true;
        first_ = near_.top().priority;
        current_ = 1;
        left_ = 0;
        for (const Waiting& entry : near_.take()) push(entry);
    }

    // The first bucket from `current_` on that is not empty, or `most`.
    std::size_t next_filled() const {
        for (std::size_t word = current_ / 64; word < filled_.size(); ++word)
            if (filled_[word]) return 64 * word + std::size_t(std::countr_zero(filled_[word]));
        return most;
    }
    void take(std::size_t k) {
        buckets_[k].clear();
        filled_[k / 64] &= filled_[k / 64] - 1;
        current_ = k + 1;
    }
    void grow(std::size_t k) {
        buckets_.resize(std::min(most, (2 * k + 64) / 64 * 64));
        filled_.resize(buckets_.size() / 64);
    }

    PriorityQueue near_;
    std::vector<std::vector<Waiting>> buckets_;
    std::vector<std::uint64_t> filled_;  // a bit for each bucket that is not empty
    std::size_t current_ = 0, left_ = 0;
    double first_ = 0, per_unit_ = 1;
    bool is_spread_ = false;
};

}  // namespace cspace::navigation
