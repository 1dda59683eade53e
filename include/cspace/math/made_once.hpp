// A value made when first asked for, and kept. Where two threads, or a computation and a signal handler amid
// it, make it at once, the first that is done keeps its own.
#pragma once

#include <atomic>
#include <memory>

namespace cspace {

template <class T>
class MadeOnce {
  public:
    MadeOnce() = default;
    MadeOnce(const MadeOnce&) = delete;
    MadeOnce& operator=(const MadeOnce&) = delete;
    ~MadeOnce() { delete find(); }

    // Null before it is made.
    T* find() const { return made_.load(std::memory_order_acquire); }
    // make() returns a std::unique_ptr.
    template <class Make>
    T& get(const Make& make) const {
        T* made = find();
        if (!made) {
            std::unique_ptr<T> fresh = make();
            if (made_.compare_exchange_strong(made, fresh.get())) made = fresh.release();
        }
        return *made;
    }

  private:
    mutable std::atomic<T*> made_ = nullptr;
};

}  // namespace cspace
