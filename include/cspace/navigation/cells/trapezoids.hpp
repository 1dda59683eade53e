// Free space as trapezoids: a vertical line through every corner of the walls, up and down to the next wall
// (de Berg, Cheong, van Kreveld & Overmars 2008, "Computational Geometry", chapters 2 and 6). A sweep from
// left to right keeps the walls that it crosses in order. Corners with one x are passed from below upwards,
// as if the plane were sheared a little: trapezoids without width between them are cells like any other, and
// vertical walls are walls like any other.
#pragma once

#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/predicates.hpp"

namespace cspace::navigation {

using Index = std::int32_t;

inline bool is_before(Point a, Point b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

// A piece of wall from its left to its right end, and on which sides there is free space.
struct SweptWall {
    Point left, right;
    bool free_above = false, free_below = false;

    int side(Point p) const { return orientation(left, right, p); }  // +1: p above
    double y_at(double x) const {
        if (left.x == right.x) return left.y;
        return std::clamp(left.y + (x - left.x) * ((right.y - left.y) / (right.x - left.x)),
                          std::min(left.y, right.y), std::max(left.y, right.y));
    }
};

struct Trapezoid {
    Index bottom, top;  // walls
    Point left, right;  // the corners that its left and right side pass through
};

// A shared piece of side: all of it below or above a corner.
struct Door {
    Index left, right;  // trapezoids
    Point corner;
    bool is_above;
};

class Trapezoids {
  public:
    std::vector<SweptWall> walls;
    std::vector<Trapezoid> cells;
    std::vector<Door> doors;

    explicit Trapezoids(const maps::Boundary& boundary) {
        gather(boundary);
        sweep();
    }

    // Whether a point lies in a closed cell that has width: those fill free space.
    bool contains(Index cell, Point p) const {
        const Trapezoid& c = cells[std::size_t(cell)];
        return c.left.x < c.right.x && p.x >= c.left.x && p.x <= c.right.x && wall(c.bottom).side(p) >= 0 &&
               wall(c.top).side(p) <= 0;
    }
    const SweptWall& wall(Index w) const { return walls[std::size_t(w)]; }

  private:
    struct Below {  // the order of walls that one vertical line crosses, and of points on it
        using is_transparent = void;
        const Trapezoids* all;
        bool operator()(Index a, Index b) const { return a != b && all->is_below(a, b); }
        bool operator()(Index a, Point p) const { return all->wall(a).side(p) > 0; }
        bool operator()(Point p, Index a) const { return all->wall(a).side(p) < 0; }
    };
    using Crossed = std::set<Index, Below>;

    std::vector<Index> above_;  // of each wall that is crossed: the cell on top of it

    bool is_below(Index a, Index b) const {
        const SweptWall &u = wall(a), &v = wall(b);
        if (is_before(v.left, u.left)) {
            const int side = v.side(u.left);
            return side != 0 ? side < 0 : v.side(u.right) < 0;
        }
        const int side = u.side(v.left);
        return side != 0 ? side > 0 : u.side(v.right) > 0;
    }

    // Each wall once, from left to right.
    void gather(const maps::Boundary& boundary) {
        for (Index e = 0; e < Index(boundary.size()); ++e) {
            const Point a = boundary.begin(e), b = boundary.end(e);
            walls.push_back(is_before(a, b) ? SweptWall{a, b, true, false} : SweptWall{b, a, false, true});
        }
        const auto order = [](const SweptWall& u, const SweptWall& v) {
            return u.left == v.left ? is_before(u.right, v.right) : is_before(u.left, v.left);
        };
        std::sort(walls.begin(), walls.end(), order);
        std::size_t kept = 0;
        for (const SweptWall& w : walls) {
            if (kept > 0 && walls[kept - 1].left == w.left && walls[kept - 1].right == w.right) {
                walls[kept - 1].free_above |= w.free_above;
                walls[kept - 1].free_below |= w.free_below;
            } else {
                walls[kept++] = w;
            }
        }
        walls.resize(kept);
    }

    void sweep() {
        std::vector<std::pair<Point, Index>> ends;
        for (Index w = 0; w < Index(walls.size()); ++w) {
            ends.push_back({wall(w).left, w});
            ends.push_back({wall(w).right, w});
        }
        std::sort(ends.begin(), ends.end(),
                  [](const auto& a, const auto& b) { return is_before(a.first, b.first); });
        Crossed crossed(Below{this});
        above_.assign(walls.size(), -1);
        std::vector<Index> ending, starting;
        InterruptPoll poll(64);
        for (std::size_t i = 0; i < ends.size();) {
            poll.step();
            const Point at = ends[i].first;
            ending.clear();
            starting.clear();
            for (; i < ends.size() && ends[i].first == at; ++i) {
                const Index w = ends[i].second;
                (wall(w).left == at ? starting : ending).push_back(w);
            }
            pass(at, ending, starting, crossed);
        }
    }

    // The sweep passes a corner: cells to the left of it end, cells to the right begin.
    void pass(Point at, std::vector<Index>& ending, std::vector<Index>& starting, Crossed& crossed) {
        std::sort(ending.begin(), ending.end(), Below{this});
        std::sort(starting.begin(), starting.end(), Below{this});
        auto next = ending.empty() ? crossed.lower_bound(at) : std::next(crossed.find(ending.back()));
        const Index above = next == crossed.end() ? -1 : *next;
        for (const Index w : ending) crossed.erase(w);
        const Index below = next == crossed.begin() ? -1 : *std::prev(next);

        const Spaces old = visit_spaces(below, ending, above, [&](Index under, Index over) {
            const Index cell = under >= 0 && over >= 0 ? above_[std::size_t(under)] : -1;
            if (cell >= 0) cells[std::size_t(cell)].right = at;
            return cell;
        });
        for (const Index w : starting) crossed.insert(next, w);
        const Spaces made = visit_spaces(below, starting, above, [&](Index under, Index over) {
            const bool is_cell = under >= 0 && over >= 0 && wall(under).free_above;
            const Index cell = is_cell ? Index(cells.size()) : -1;
            if (is_cell) cells.push_back({under, over, at, at});
            if (under >= 0) above_[std::size_t(under)] = cell;
            return cell;
        });
        if (old.low >= 0 && made.low >= 0) doors.push_back({old.low, made.low, at, false});
        if (old.high >= 0 && made.high >= 0) doors.push_back({old.high, made.high, at, true});
    }

    // The cells on one side of a corner, next to it: below and above.
    struct Spaces {
        Index low, high;
    };
    // Visits the spaces between a wall below a corner, those that meet in it, and one above: visit(under,
    // over) returns the cell there, or −1.
    template <class Visit>
    static Spaces visit_spaces(Index below, const std::vector<Index>& meeting, Index above, Visit visit) {
        Spaces found{-1, -1};
        Index under = below;
        for (std::size_t i = 0; i <= meeting.size(); ++i) {
            const Index over = i < meeting.size() ? meeting[i] : above;
            found.high = visit(under, over);
            if (i == 0) found.low = found.high;
            under = over;
        }
        return found;
    }
};

}  // namespace cspace::navigation
