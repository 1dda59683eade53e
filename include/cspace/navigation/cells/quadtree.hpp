// A quadtree over the bounds of a polygon world: squares that are free, full, or mixed, the mixed ones split
// into four (Brooks & Lozano-Pérez 1983; Samet 1984, "The quadtree and related hierarchical data
// structures").
#pragma once

#include <array>
#include <numeric>
#include <utility>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/search/adjacency.hpp"
#include "cspace/search/cache.hpp"

namespace cspace::navigation {

struct QuadCell {
    enum Kind : std::int8_t { free, mixed, full };
    maps::Index i = 0, j = 0;  // its lower left corner, in sides of the smallest cell there can be
    std::int8_t level = 0;     // its side is that of the root over 2^level
    Kind kind = mixed;
    maps::Index children = maps::none;  // the first of four; none: a leaf
    maps::Index first = 0, count = 0;   // the walls that touch its closed square
};

// What two leaves share: a piece of a side that no wall covers, and a point of it.
struct CellDoor {
    maps::Index one, other;
    Point at;
    bool is_open;  // false: no number lies between the ends of the piece
};

class Quadtree {
  public:
    static constexpr int finest = 20;
    enum Word : std::int8_t { split_cell, free_cell };

    explicit Quadtree(const maps::PolygonWorld& world, Trace* trace = nullptr)
        : world_(world),
          trace_(trace),
          low_(world.outlines.low),
          high_(world.outlines.high),
          side_(std::max(high_.x - low_.x, high_.y - low_.y)) {
        // Corners stay apart by many roundings.
        const double far =
            std::max({std::abs(low_.x), std::abs(low_.y), std::abs(high_.x), std::abs(high_.y)});
        while (deepest_ > 0 && std::ldexp(side_, -deepest_) < far * std::ldexp(1.0, -44)) --deepest_;
        QuadCell root;
        const Box square = square_of(root);
        bool entered = false;
        for (maps::Index e = 0; e < maps::Index(world.walls.size()); ++e) {
            touching_.push_back(e);
            entered = entered || part_met(e, square) == BoxPart::inside;
        }
        root.count = maps::Index(touching_.size());
        classify(root, entered);
        cells_.push_back(root);
    }

    const std::vector<QuadCell>& cells() const { return cells_; }
    const QuadCell& operator[](maps::Index c) const { return cells_[std::size_t(c)]; }
    int deepest() const { return deepest_; }
    std::size_t bytes() const {
        return sizeof(QuadCell) * cells_.capacity() + sizeof(maps::Index) * touching_.capacity();
    }
    double side(int level) const { return std::ldexp(side_, -level); }
    bool is_leaf(maps::Index c) const { return (*this)[c].children == maps::none; }
    Point low(const QuadCell& cell) const { return {x(cell.i), y(cell.j)}; }
    Point high(const QuadCell& cell) const { return {x(cell.i + width(cell)), y(cell.j + width(cell))}; }

    void split(maps::Index c) {
        poll_.step();
        const QuadCell parent = (*this)[c];
        if (trace_) trace_->push_back({split_cell, low(parent), high(parent), double(parent.level)});
        cells_[std::size_t(c)].children = maps::Index(cells_.size());
        const maps::Index half = width(parent) / 2;
        for (int k = 0; k < 4; ++k) {
            QuadCell child;
            child.i = parent.i + (k % 2) * half, child.j = parent.j + (k / 2) * half;
            child.level = std::int8_t(parent.level + 1);
            child.kind = parent.kind;
            child.first = maps::Index(touching_.size());
            const Box square = square_of(child);
            bool entered = false;
            for (maps::Index w = parent.first; w < parent.first + parent.count; ++w) {
                const maps::Index wall = touching_[std::size_t(w)];
                const BoxPart part = part_met(wall, square);
                if (part != BoxPart::none) touching_.push_back(wall);
                entered = entered || part == BoxPart::inside;
            }
            child.count = maps::Index(touching_.size()) - child.first;
            if (parent.kind == QuadCell::mixed) classify(child, entered);
            cells_.push_back(child);
        }
    }

    // The leaves whose closed square contains a point.
    void leaves_at(Point p, std::vector<maps::Index>& out) const {
        std::vector<maps::Index> stack{0};
        for (out.clear(); !stack.empty();) {
            const maps::Index c = stack.back();
            stack.pop_back();
            const Point a = low((*this)[c]), b = high((*this)[c]);
            if (p.x < a.x || p.x > b.x || p.y < a.y || p.y > b.y) continue;
            if (is_leaf(c)) out.push_back(c);
            for (int k = 0; k < 4 && !is_leaf(c); ++k) stack.push_back((*this)[c].children + k);
        }
    }

    // The doors between leaves that are not full.
    std::vector<CellDoor> doors() const {
        std::vector<CellDoor> found;
        InterruptPoll poll(256);
        for (maps::Index c = 0; c < maps::Index(cells_.size()); ++c) {
            poll.step();
            if (!is_leaf(c) || (*this)[c].kind == QuadCell::full) continue;
            for (int beyond = 0; beyond < 4; ++beyond) {
                const maps::Index n = neighbour((*this)[c], beyond);
                if (n == maps::none || !is_leaf(n) || (*this)[n].kind == QuadCell::full) continue;
                // Of two leaves of one size the left or the lower one adds the door, else the smaller one.
                if ((*this)[n].level == (*this)[c].level && beyond > 1) continue;
                add_door(c, n, beyond, found);
            }
        }
        return found;
    }

  private:
    const maps::PolygonWorld& world_;
    Trace* trace_;
    Point low_, high_;
    double side_;
    int deepest_ = finest;
    InterruptPoll poll_{64};
    std::vector<QuadCell> cells_;
    std::vector<maps::Index> touching_;

    static maps::Index width(const QuadCell& cell) { return maps::Index(1) << (finest - cell.level); }
    double x(maps::Index i) const { return along(low_.x, high_.x, i); }
    double y(maps::Index j) const { return along(low_.y, high_.y, j); }
    // A line of the tree; one that rounding moves off the bounds lies on them.
    double along(double low, double high, maps::Index i) const {
        const double at = low + std::ldexp(side_, -finest) * i;
        return std::abs(at - high) <= std::ldexp(std::abs(low) + std::abs(high), -50) ? high : at;
    }

    Box square_of(const QuadCell& cell) const { return {low(cell), high(cell)}; }
    BoxPart part_met(maps::Index wall, const Box& square) const {
        return met_part(world_.walls.begin(wall), world_.walls.end(wall), square);
    }

    void classify(QuadCell& cell, bool is_entered) {
        const Point a = low(cell), b = high(cell), middle = 0.5 * (a + b);
        if (is_entered) {
            cell.kind = QuadCell::mixed;
            return;
        }
        std::vector<maps::Index> triangles;
        if (world_.is_inside_bounds(middle))
            world_.space.triangles_at(middle, world_.locator.near(middle), triangles);
        cell.kind = triangles.empty() ? QuadCell::full : QuadCell::free;
        if (trace_ && cell.kind == QuadCell::free) trace_->push_back({free_cell, a, b, double(cell.level)});
    }

    // The node of the same size, or the larger leaf, beyond a side: right, above, left, below.
    maps::Index neighbour(const QuadCell& cell, int beyond) const {
        constexpr maps::Index end = maps::Index(1) << finest;
        const maps::Index w = width(cell);
        const maps::Index i = beyond == 0 ? cell.i + w : beyond == 2 ? cell.i - 1 : cell.i;
        const maps::Index j = beyond == 1 ? cell.j + w : beyond == 3 ? cell.j - 1 : cell.j;
        if (i < 0 || j < 0 || i >= end || j >= end) return maps::none;
        maps::Index c = 0;
        while (!is_leaf(c) && (*this)[c].level < cell.level) {
            const int bit = finest - 1 - (*this)[c].level;
            c = (*this)[c].children + ((i >> bit) & 1) + 2 * ((j >> bit) & 1);
        }
        return c;
    }

    // The widest piece of the smaller leaf's side that no wall along it covers.
    void add_door(maps::Index c, maps::Index n, int beyond, std::vector<CellDoor>& found) const {
        const QuadCell& cell = (*this)[c];
        const Point a = low(cell), b = high(cell);
        const bool upright = beyond % 2 == 0;
        const double line = beyond == 0 ? b.x : beyond == 1 ? b.y : beyond == 2 ? a.x : a.y;
        const double from = upright ? a.y : a.x, to = upright ? b.y : b.x;
        std::vector<std::pair<double, double>> covered;
        for (maps::Index w = cell.first; w < cell.first + cell.count; ++w) {
            const Point p = world_.walls.begin(touching_[std::size_t(w)]);
            const Point q = world_.walls.end(touching_[std::size_t(w)]);
            if ((upright ? p.x : p.y) != line || (upright ? q.x : q.y) != line) continue;
            covered.push_back(upright ? std::minmax({p.y, q.y}) : std::minmax({p.x, q.x}));
        }
        std::sort(covered.begin(), covered.end());
        covered.push_back({to, to});
        double reached = from, best = from, widest = 0;
        for (const auto& [begin, end] : covered) {
            const double gap = std::min(begin, to) - reached;
            if (gap > widest) widest = gap, best = reached;
            reached = std::max(reached, end);
        }
        if (!(widest > 0)) return;
        const double middle = best + 0.5 * widest;
        const bool is_open = middle > best && middle < best + widest;
        found.push_back({c, n, upright ? Point{line, middle} : Point{middle, line}, is_open});
    }
};

// A quadtree as it was split so far, with its doors: it never changes, so that one question can go on from
// what another has split.

struct CellStage {
    Quadtree tree;
    std::vector<CellDoor> doors;
    search::Adjacency<std::uint32_t> open;  // the open doors between free leaves, at each leaf
    std::array<std::int64_t, 3> leaves{};   // free, mixed, full
    int depth = 0;                          // of the deepest leaf
    // The tree once more of its leaves are split.
    mutable search::LastMade<std::vector<maps::Index>, CellStage> next;

    explicit CellStage(Quadtree split) : tree(std::move(split)), doors(tree.doors()) {
        open = {tree.cells().size(), [&](const auto& add) {
                    visit_range(0, doors.size(), [&](std::size_t d) {
                        if (is_passage(doors[d]))
                            for (const maps::Index c : {doors[d].one, doors[d].other})
                                add(std::size_t(c), std::uint32_t(d));
                    });
                }};
        for (maps::Index c = 0; c < maps::Index(tree.cells().size()); ++c) {
            if (!tree.is_leaf(c)) continue;
            ++leaves[std::size_t(tree[c].kind)];
            depth = std::max(depth, int(tree[c].level));
        }
    }

    std::size_t bytes() const { return tree.bytes() + sizeof(CellDoor) * doors.size() + open.bytes(); }

  private:
    bool is_passage(const CellDoor& d) const {
        return d.is_open && tree[d.one].kind == QuadCell::free && tree[d.other].kind == QuadCell::free;
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
