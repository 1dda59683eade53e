// What a search stores for the nodes of a large graph, in pages that are made when they are first reached.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace cspace::search {

template <class T>
class PagedTable {
  public:
    // Forgets everything; nodes are below `count` from now on.
    void begin(std::size_t count) {
        pages_.clear();
        pages_.resize((count >> page_bits) + 1);
    }
    T& operator[](std::uint32_t node) {
        std::unique_ptr<T[]>& page = pages_[node >> page_bits];
        if (!page) [[unlikely]]
            page = std::make_unique<T[]>(std::size_t(1) << page_bits);
        return page[node & ((1u << page_bits) - 1)];
    }

  private:
    static constexpr int page_bits = 12;
    std::vector<std::unique_ptr<T[]>> pages_;
};

}  // namespace cspace::search
