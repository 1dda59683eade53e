// What a search remembers of the cells it has reached. Both kinds are kept from one query to the next and
// touch in a query only what the query touches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cspace/math/isa.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/search/node_tables.hpp"

namespace cspace::navigation {

// For searches that reach most cells of a region: pages of 4096 cells, made when they are first reached. The
// stamp of a cell records whether this query has reached it.
template <class G>
class PagedNodes {
  public:
    struct Node {
        G g;
        std::uint32_t parent;
        std::uint32_t stamp;  // 2 · query, plus 1 once it is settled
    };
    // Forgets everything; numbers of cells are below `count` from now on.
    void begin(std::size_t count) {
        if (pages_.size() < (count >> page_bits) + 1) pages_.resize((count >> page_bits) + 1);
        stamp_ += 2;
        if (stamp_ == 0) {
            for (auto& page : pages_) page.reset();
            stamp_ = 2;
        }
    }
    CSPACE_INLINE Node& at(std::uint32_t cell) {
        Node* page = pages_[cell >> page_bits].get();
        if (!page) [[unlikely]]
            page = made(cell >> page_bits);
        return page[cell & ((1u << page_bits) - 1)];
    }
    bool is_reached(const Node& node) const { return node.stamp >= stamp_; }
    bool is_settled(const Node& node) const { return node.stamp > stamp_; }
    void reach(Node& node, G g, std::uint32_t parent) { node = {g, parent, stamp_}; }
    void settle(Node& node) { node.stamp = stamp_ + 1; }
    std::size_t bytes() const {
        return made_ * (sizeof(Node) << page_bits) + pages_.capacity() * sizeof(pages_[0]);
    }

  private:
    static constexpr int page_bits = 12;
    CSPACE_COLD Node* made(std::size_t page) {
        pages_[page] = std::make_unique<Node[]>(std::size_t(1) << page_bits);
        ++made_;
        return pages_[page].get();
    }
    std::vector<std::unique_ptr<Node[]>> pages_;
    std::size_t made_ = 0;
    std::uint32_t stamp_ = 0;
};

// For searches that reach few cells, far from each other: a list of them, and the place of each in it.
class SparseNodes {
  public:
    struct Node {
        std::uint32_t cell, parent;  // parent: its place in the list
        Steps g;
        std::uint8_t pending, done;  // directions of arrival: to be expanded, and expanded
    };
    void begin() {
        nodes_.clear();
        places_.begin();
    }
    Node& operator[](std::uint32_t place) { return nodes_[place]; }
    const Node& operator[](std::uint32_t place) const { return nodes_[place]; }
    // The place of a cell; one that is new gets no g, and sets `is_new`.
    std::uint32_t find(std::uint32_t cell, bool& is_new) {
        std::uint32_t& place = places_[cell].number;
        is_new = place == search::no_node;
        if (is_new) {
            place = std::uint32_t(nodes_.size());
            nodes_.push_back({cell, 0, {}, 0, 0});
        }
        return place;
    }
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node) + places_.bytes(); }

  private:
    struct Place {
        std::uint32_t number = search::no_node;
    };
    std::vector<Node> nodes_;
    search::SparseTable<Place> places_;
};

}  // namespace cspace::navigation
