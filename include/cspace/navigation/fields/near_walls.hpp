// The walls near a point, from square cells that list every wall within a reach of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/math/predicates.hpp"
#include "cspace/search/adjacency.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

class NearWalls {
  public:
    NearWalls(const maps::Boundary& walls, double reach) : reach_(reach) {
        for (std::int32_t e = 0; e < std::int32_t(walls.size()); ++e) {
            const Point a = walls.begin(e), b = walls.end(e);
            walls_.push_back({a, b, b - a, {}, walls.ring[std::size_t(e)]});
        }
        for (std::size_t e = 0; e < walls_.size(); ++e)
            walls_[std::size_t(walls.next[e])].before = walls_[e].along;
        choose_cells(walls.points);
        members_ = {std::size_t(columns_) * std::size_t(rows_), [&](const auto& add) { each_member(add); }};
    }

    struct Wall {
        Point begin, end, along;
        Point before;  // along the wall before it
        std::int32_t ring;
    };
    const Wall& wall(std::int32_t e) const { return walls_[std::size_t(e)]; }

    // At least the walls within the reach of a point inside the bounds.
    template <class Visit>
    void visit(Point p, const Visit& visit) const {
        const std::size_t column = std::size_t(clamped((p.x - low_.x) / side_, columns_));
        const std::size_t row = std::size_t(clamped((p.y - low_.y) / side_, rows_));
        for (const std::int32_t wall : members_.of(row * std::size_t(columns_) + column)) visit(wall);
    }
    // Whether the segment from p to q, no longer than the reach, meets a wall between its ends that has them
    // on different sides; exact. A corner on the segment counts: it may lead into an obstacle.
    bool is_crossed(Point p, Point q) const {
        bool crossed = false;
        visit(p, [&](std::int32_t e) {
            const Point a = wall(e).begin, b = wall(e).end;
            crossed = crossed || (orientation(a, b, p) * orientation(a, b, q) < 0 &&
                                  orientation(p, q, a) * orientation(p, q, b) <= 0);
        });
        return crossed;
    }
    // Away from the walls within a tolerance of a point of free space; zero where there are none.
    Point inward(Point p, double tolerance) const {
        constexpr double folded2 = 1e-6;  // square of a sum of normals that point against each other
        Point sum, first;
        visit(p, [&](std::int32_t e) {
            const auto& [a, b, along, before, ring] = wall(e);
            if (distance(p, nearest_on(a, b, p)) > tolerance) return;
            const Point left = (1 / norm(along)) * Point{-along.y, along.x};
            if (squared_norm(first) == 0) first = left;
            sum = sum + left;
        });
        return squared_norm(sum) > folded2 ? sum : first;
    }

  private:
    static constexpr int most = 96;  // cells along the longer side
    std::vector<Wall> walls_;
    double reach_, side_ = 1;
    Point low_;
    int columns_ = 1, rows_ = 1;
    search::Adjacency<std::int32_t> members_;

    static int clamped(double at, int count) { return at <= 0 ? 0 : at >= count ? count - 1 : int(at); }
    void choose_cells(const std::vector<Point>& corners) {
        if (corners.empty()) return;
        const auto [low, high] = bounds_of(corners);
        low_ = low;
        const double longest = std::max(high.x - low_.x, high.y - low_.y);
        side_ = std::max(0.5 * reach_, longest / most);
        columns_ = std::max(1, int(std::ceil((high.x - low_.x) / side_)));
        rows_ = std::max(1, int(std::ceil((high.y - low_.y) / side_)));
    }
    template <class Put>
    void each_member(const Put& put) const {
        const double around =
            0.7072 * side_ + reach_ * (1 + tolerance::widening);  // from the centre of a cell
        for (std::int32_t e = 0; e < std::int32_t(walls_.size()); ++e) {
            const Point a = wall(e).begin, b = wall(e).end;
            const auto from = [&](double x, double low) {
                return (x - reach_ - low) / side_ - tolerance::cell_border;
            };
            const auto to = [&](double x, double low) {
                return (x + reach_ - low) / side_ + tolerance::cell_border;
            };
            const int left = clamped(from(std::min(a.x, b.x), low_.x), columns_);
            const int right = clamped(to(std::max(a.x, b.x), low_.x), columns_);
            const int bottom = clamped(from(std::min(a.y, b.y), low_.y), rows_);
            const int top = clamped(to(std::max(a.y, b.y), low_.y), rows_);
            for (int row = bottom; row <= top; ++row)
                for (int column = left; column <= right; ++column) {
                    const Point middle = low_ + side_ * Point{column + 0.5, row + 0.5};
                    if (distance(middle, nearest_on(a, b, middle)) <= around)
                        put(std::size_t(row) * std::size_t(columns_) + std::size_t(column), e);
                }
        }
    }
};

}  // namespace cspace::navigation
