// A priority queue for priorities that mostly rise: what is far away waits in buckets, unsorted, and only
// what is near is kept in a heap, which therefore is small (Denardo & Fox 1979; with a heap for the first
// bucket: Cherkassky, Goldberg & Silverstein 1999, "Buckets, heaps, lists, and monotone priority queues").
// The order is that of a heap, whatever the priorities are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cspace/navigation/best_first.hpp"

namespace cspace::navigation {

class BucketQueue {
  public:
    // Forgets everything; a bucket is so wide, in units of priority.
    void begin(double width) {
        near_.clear();
        for (; current_ < used_; ++current_) buckets_[current_].clear();
        current_ = used_ = 0;
        left_ = 0;
        per_unit_ = 1 / width;
        is_first_ = true;
    }
    bool empty() const { return left_ == 0; }
    void push(const Waiting& entry) {
        if (is_first_) {
            is_first_ = false;
            first_ = entry.priority;
        }
        ++left_;
        const double at = (entry.priority - first_) * per_unit_;
        if (!(at >= double(current_)) || current_ == most)
            return near_.push(entry);  // the heap holds all before bucket `current_`
        const std::size_t k = at < double(most - 1) ? std::size_t(at) : most - 1;
        if (k >= buckets_.size()) buckets_.resize(std::min(most, 2 * k + 64));
        used_ = std::max(used_, k + 1);
        buckets_[k].push_back(entry);
    }
    Waiting pop() {
        while (near_.empty()) {
            for (const Waiting& entry : buckets_[current_]) near_.push(entry);
            buckets_[current_++].clear();
        }
        --left_;
        return near_.pop();
    }
    std::size_t bytes() const {
        std::size_t sum = near_.bytes();
        for (const auto& bucket : buckets_) sum += bucket.capacity() * sizeof(Waiting) + sizeof bucket;
        return sum;
    }
    void release() { near_.release(), std::vector<std::vector<Waiting>>().swap(buckets_), begin(1); }

  private:
    static constexpr std::size_t most = 1 << 16;  // the last bucket holds all that is farther
    PriorityQueue near_;
    std::vector<std::vector<Waiting>> buckets_;
    std::size_t current_ = 0, used_ = 0, left_ = 0;
    double first_ = 0, per_unit_ = 1;
    bool is_first_ = true;
};

}  // namespace cspace::navigation
