// The walls of a world, sorted into square cells so that a ray meets few of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/navigation/bugs/line.hpp"
#include "cspace/search/adjacency.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

class Walls {
  public:
    explicit Walls(maps::Boundary boundary) : boundary_(std::move(boundary)), previous_(boundary_.size()) {
        for (std::size_t e = 0; e < boundary_.size(); ++e)
            previous_[std::size_t(boundary_.next[e])] = std::int32_t(e);
        choose_cells();
        fill_cells();
    }

    int size() const { return int(boundary_.size()); }
    int next(int wall) const { return boundary_.next[std::size_t(wall)]; }
    int previous(int wall) const { return previous_[std::size_t(wall)]; }
    int ring(int wall) const { return boundary_.ring[std::size_t(wall)]; }
    Point begin(int wall) const { return boundary_.begin(wall); }
    Point end(int wall) const { return boundary_.end(wall); }
    Wall wall(int name) const { return {begin(name), end(name), name}; }
    const maps::Boundary& boundary() const { return boundary_; }
    double largest() const { return largest_; }  // of the coordinates
    double extent() const { return extent_; }    // the longer side of the box around all walls

    // Calls visit(wall) for walls near the segment, those near its beginning first, at least for all that it
    // touches. Asks done(covered) on the way, where covered(p) says that all walls up to the point p of the
    // segment have been visited, and ends when it is true.
    template <class Visit, class Done>
    void along(const Line& line, Visit visit, Done done) const {
        if (cells_ == 1) {
            visit_cell(0, visit);
            return;
        }
        const Point d = line.to - line.from;
        if (std::abs(d.x) >= std::abs(d.y))
            sweep<false>(line.from, line.to, visit, done);
        else
            sweep<true>(line.from, line.to, visit, done);
    }

    // Calls visit(wall) for at least all walls that touch the point.
    template <class Visit>
    void at(Point p, Visit visit) const {
        along({p, p}, visit, [](auto) { return false; });
    }

  private:
    maps::Boundary boundary_;
    std::vector<std::int32_t> previous_;
    Point low_;
    double largest_ = 0, extent_ = 0, size_ = 1, per_ = 1,
           margin_ = 0;  // a cell's side, its inverse, by how much cells overlap
    int cells_ = 1, columns_ = 1, rows_ = 1;
    search::Adjacency<std::int32_t> in_cell_;  // the walls of each cell

    static constexpr int few = 24;  // walls that are looked through one by one

    void choose_cells() {
        if (size() == 0) return;
        const auto [low, high] = bounds_of(boundary_.points);
        low_ = low;
        const Point extent = high - low_;
        largest_ = std::max({std::abs(low_.x), std::abs(low_.y), std::abs(high.x), std::abs(high.y)});
        const double longest = extent_ = std::max(extent.x, extent.y);
        margin_ = tolerance::widening * longest + 64 * std::numeric_limits<double>::epsilon() * largest_;
        if (size() <= few || !(longest > 1e6 * std::numeric_limits<double>::epsilon() * largest_)) return;
        const double area = std::max(extent.x * extent.y, longest * longest / size());
        size_ = std::sqrt(area / size());
        columns_ = 1 + int(extent.x / size_);
        rows_ = 1 + int(extent.y / size_);
        per_ = 1 / size_;
        cells_ = columns_ * rows_;
    }

    void fill_cells() {
        in_cell_ = {std::size_t(cells_), [&](const auto& add) {
                        for (int e = 0; e < size(); ++e) {
                            const auto put = [&](int cell) { add(std::size_t(cell), e); };
                            const auto go_on = [](double) { return false; };
                            const Point d = end(e) - begin(e);
                            if (std::abs(d.x) >= std::abs(d.y))
                                cover<false>(begin(e), end(e), go_on, put);
                            else
                                cover<true>(begin(e), end(e), go_on, put);
                        }
                    }};
    }

    template <class Visit>
    void visit_cell(int cell, Visit& visit) const {
        for (const std::int32_t wall : in_cell_.of(std::size_t(cell))) visit(int(wall));
    }

    static int clamped(double cell, int count) {
        return cell <= 0 ? 0 : cell >= count - 1 ? count - 1 : int(cell);
    }

    // The cells of a segment and of its margin, slab by slab across its longer extent: put(cell) for each,
    // after each slab stop(far side of the slab).
    template <bool steep, class Stop, class Put>
    void cover(Point a, Point b, Stop stop, Put put) const {
        const auto along = [](Point p) { return steep ? p.y : p.x; };
        const auto across = [](Point p) { return steep ? p.x : p.y; };
        const int slabs = steep ? rows_ : columns_, lanes = steep ? columns_ : rows_;
        const double u0 = along(a) - along(low_), u1 = along(b) - along(low_);
        const double v0 = across(a) - across(low_), v1 = across(b) - across(low_);
        const double slope = u1 == u0 ? 0 : (v1 - v0) / (u1 - u0);
        const int step = u1 >= u0 ? 1 : -1;
        const int first = clamped((u0 - step * margin_) * per_, slabs);
        const int last = clamped((u1 + step * margin_) * per_, slabs);
        for (int slab = first; slab != last + step; slab += step) {
            const double near = std::clamp(slab * size_ - margin_, std::min(u0, u1), std::max(u0, u1));
            const double far = std::clamp((slab + 1) * size_ + margin_, std::min(u0, u1), std::max(u0, u1));
            double p = v0 + slope * (near - u0), q = v0 + slope * (far - u0);
            if (p > q) std::swap(p, q);
            const int low = clamped((p - margin_) * per_, lanes), high = clamped((q + margin_) * per_, lanes);
            for (int lane = low; lane <= high; ++lane)
                put(steep ? slab * columns_ + lane : lane * columns_ + slab);
            if (stop((step > 0 ? far : near) + along(low_))) return;
        }
    }

    template <bool steep, class Visit, class Done>
    void sweep(Point a, Point b, Visit& visit, Done& done) const {
        const double heading = steep ? b.y - a.y : b.x - a.x;
        const auto stop = [&](double far) {
            const double past = heading < 0 ? far + 2 * margin_ : far - 2 * margin_;
            return done([&](Point p) {
                return heading < 0 ? (steep ? p.y : p.x) > past : (steep ? p.y : p.x) < past;
            });
        };
        cover<steep>(a, b, stop, [&](int cell) { visit_cell(cell, visit); });
    }
};

}  // namespace cspace::navigation
