// The most recent result, kept with its key. Threads may request it at the same time. A returned result stays
// valid when another replaces it.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

namespace cspace::search {

template <class Key, class Made>
class LastMade {
  public:
    // The result for a key, or that of make(): a shared pointer to an object with bytes(). More
    // of them than `most_bytes` are not kept. Two threads that make the same at once make it twice.
    template <class Make>
    std::shared_ptr<const Made> of(const Key& key, const Make& make, std::size_t most_bytes) {
        {
            const std::lock_guard<std::mutex> lock(busy_);
            if (made_ && key_ == key) return made_;
        }
        std::shared_ptr<const Made> made = make(), before;
        if (made->bytes() > most_bytes) return made;
        Key copy = key;
        const std::lock_guard<std::mutex> lock(busy_);
        before = std::exchange(made_, made);
        key_ = std::move(copy);
        return made;
    }

  private:
    std::mutex busy_;
    Key key_{};
    std::shared_ptr<const Made> made_;
};

// The most that is kept of one kind: some hundred thousand cells or samples [bytes].
constexpr std::size_t most_kept_bytes = std::size_t(64) << 20;

}  // namespace cspace::search
