// Blocks of numbers that come and go, from large chunks of memory: a block given back serves the next request
// of about its size.
#pragma once

#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace cspace {

template <class T>
class NumberPool {
  public:
    // A block of at least so many numbers, undefined.
    T* take(std::size_t count) {
        const SizeClass fit = find_class(count);
        if (fit.index < free_.size() && !free_[fit.index].empty()) {
            T* const block = free_[fit.index].back();
            free_[fit.index].pop_back();
            return block;
        }
        if (fit.count > left_) {
            left_ = fit.count > chunk_size ? fit.count : chunk_size;
            chunks_.push_back(std::unique_ptr<T[]>(new T[left_]));
            next_ = chunks_.back().get();
        }
        left_ -= fit.count;
        return std::exchange(next_, next_ + fit.count);
    }
    // Gives back a block of so many numbers.
    void give(T* block, std::size_t count) {
        const SizeClass fit = find_class(count);
        if (fit.index >= free_.size()) free_.resize(fit.index + 1);
        free_[fit.index].push_back(block);
    }
    void clear() {
        chunks_.clear(), free_.clear();
        next_ = nullptr, left_ = 0;
    }

  private:
    static constexpr std::size_t chunk_size = 1 << 15;
    static constexpr std::size_t least = 16;

    struct SizeClass {
        std::size_t index, count;
    };
    // Sizes in steps of a quarter of the power of two below them.
    static SizeClass find_class(std::size_t count) {
        if (count <= least) return {0, least};
        const std::size_t power = std::bit_floor(count - 1), step = power / 4;
        const std::size_t quarters = (count - power + step - 1) / step;
        return {std::size_t(std::bit_width(power)) * 4 + quarters, power + quarters * step};
    }

    std::vector<std::unique_ptr<T[]>> chunks_;
    std::vector<std::vector<T*>> free_;  // by class
    T* next_ = nullptr;
    std::size_t left_ = 0;
};

}  // namespace cspace
