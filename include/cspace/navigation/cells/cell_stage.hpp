// A quadtree as it was split so far, with its doors: it never changes, so that one question can go on from
// what another has split.
#pragma once

#include <numeric>

#include "cspace/navigation/cells/quadtree.hpp"
#include "cspace/search/cache.hpp"

namespace cspace::navigation {

struct CellStage {
    Quadtree tree;
    std::vector<CellDoor> doors;
    // The open doors between free leaves: those of leaf c are open[first[c]] up to open[first[c + 1]].
    std::vector<std::uint32_t> first, open;
    std::array<std::int64_t, 3> leaves{};  // free, mixed, full
    int depth = 0;                         // of the deepest leaf
    // The tree once more of its leaves are split.
    mutable search::LastMade<std::vector<maps::Index>, CellStage> next;

    explicit CellStage(Quadtree split) : tree(std::move(split)), doors(tree.doors()) {
        list_open_doors();
        for (maps::Index c = 0; c < maps::Index(tree.cells().size()); ++c) {
            if (!tree.is_leaf(c)) continue;
            ++leaves[std::size_t(tree[c].kind)];
            depth = std::max(depth, int(tree[c].level));
        }
    }

    std::size_t bytes() const {
        return tree.bytes() + sizeof(CellDoor) * doors.size() + 4 * (first.size() + open.size());
    }

  private:
    bool is_passage(const CellDoor& d) const {
        return d.is_open && tree[d.one].kind == QuadCell::free && tree[d.other].kind == QuadCell::free;
    }
    void list_open_doors() {
        first.assign(tree.cells().size() + 1, 0);
        for (const CellDoor& d : doors)
            if (is_passage(d)) ++first[std::size_t(d.one) + 1], ++first[std::size_t(d.other) + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        open.resize(first.back());
        std::vector<std::uint32_t> filled(first.begin(), first.end() - 1);
        for (std::uint32_t d = 0; d < std::uint32_t(doors.size()); ++d)
            if (is_passage(doors[d]))
                for (const maps::Index c : {doors[d].one, doors[d].other}) open[filled[std::size_t(c)]++] = d;
    }
};

struct CellKey {
    int depth = 0, most_depth = 0;
    bool uniform = false;
    std::size_t most_cells = 0;
    friend bool operator==(const CellKey&, const CellKey&) = default;
};

// The data stored with a world: its tree, split for the most recent options.
using CellStages = search::LastMade<CellKey, CellStage>;

}  // namespace cspace::navigation
