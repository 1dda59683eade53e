// Fast marching (Sethian 1996): the time at which a front that starts at the goal reaches each cell,
// |∇T| · speed = 1, by upwind differences in the order in which the front arrives; and the way down.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/maps/clearance.hpp"
#include "cspace/maps/grid_frame.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/search/best_first.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

inline constexpr double never = std::numeric_limits<double>::infinity();

// The front as a space of best_first: T [cells, over the speed] by number of cell.
class Front {
  public:
    // slow_within: nearer to walls than this the speed falls with the clearance [cells]; 0: it is 1.
    Front(const maps::BitGrid& grid, const maps::Clearance* clearance, double slow_within,
          std::uint32_t until)
        : grid_(grid),
          clearance_(clearance),
          slow_within_(slow_within),
          until_(until),
          time_(filled_vector(grid.numbers(), never)),
          settled_(filled_vector<std::uint8_t>(grid.numbers())) {}
    template <class Queue>
    void start(maps::Cell at, Queue& queue) {
        time_[grid_.number(at)] = 0;
        queue.push({0, 0, grid_.number(at)});
    }
    bool settle(std::uint32_t n) {
        if (settled_[n]) return false;
        settled_[n] = 1;
        return true;
    }
    bool is_goal(std::uint32_t n) const { return n == until_; }
    template <class Queue>
    void expand(std::uint32_t n, Queue& queue) {
        const std::uint32_t stride = grid_.stride();
        for (const std::uint32_t m : {n + 1, n - 1, n + stride, n - stride}) {
            const maps::Cell cell = grid_.cell(m);
            if (settled_[m] || grid_.blocked(cell)) continue;
            ++edges_;
            const double time = arrival(m);
            if (!(time < time_[m])) continue;
            time_[m] = time;
            queue.push({time, 0, m});
        }
    }
    std::uint64_t edges() const { return edges_; }
    // Infinite where the front has not come.
    double time(std::uint32_t n) const { return settled_[n] ? time_[n] : never; }

  private:
    const maps::BitGrid& grid_;
    const maps::Clearance* clearance_;
    double slow_within_;
    std::uint32_t until_;
    std::vector<double> time_;
    std::vector<std::uint8_t> settled_;
    std::uint64_t edges_ = 0;

    // (T − a)² + (T − b)² = slowness² from the earlier neighbour a along rows and b along columns.
    double arrival(std::uint32_t n) const {
        const std::uint32_t stride = grid_.stride();
        const double a = std::min(time(n - 1), time(n + 1)), b = std::min(time(n - stride), time(n + stride));
        const double slow =
            clearance_ && slow_within_ > 0 ? std::max(1.0, slow_within_ / clearance_->of(n)) : 1.0;
        const double first = std::min(a, b), apart = std::abs(a - b);
        if (!(apart < slow)) return first + slow;
        return 0.5 * (a + b + std::sqrt(2 * slow * slow - apart * apart));
    }
};

// Down the times from cell to cell: between the centres of four free cells along the slope of their bilinear
// interpolation, elsewhere, and where that does not lead down, from centre to centre.
class FrontDescent {
  public:
    FrontDescent(const maps::BitGrid& grid, const Front& front) : grid_(grid), front_(front) {}

    // Points in cells, the centre of cell (row, column) at x = column, y = row; from start to goal.
    std::vector<Point> run(maps::Cell start, maps::Cell goal) {
        at_ = {double(start.column), double(start.row)};
        time_ = front_.time(grid_.number(start));
        path_ = {at_};
        const Point end = {double(goal.column), double(goal.row)};
        while (!(at_ == end)) {
            const std::size_t before = path_.size();
            if (time_ > 0 && slide()) continue;
            hop();
            if (path_.size() == before) break;
        }
        return std::move(path_);
    }

  private:
    static constexpr double stride = 0.25;  // of a slide, in cells
    const maps::BitGrid& grid_;
    const Front& front_;
    Point at_;
    double time_ = 0;
    std::vector<Point> path_;

    struct Square {  // between four centres, the first at (column, row)
        int column, row;
        double t00, t10, t01, t11;
        bool is_open() const { return std::max(std::max(t00, t10), std::max(t01, t11)) < never; }
        double at(Point p) const {
            const double u = p.x - column, v = p.y - row;
            return (1 - v) * ((1 - u) * t00 + u * t10) + v * ((1 - u) * t01 + u * t11);
        }
        Point slope(Point p) const {
            const double u = p.x - column, v = p.y - row;
            return {(1 - v) * (t10 - t00) + v * (t11 - t01), (1 - u) * (t01 - t00) + u * (t11 - t10)};
        }
    };
    double time(int row, int column) const {
        const maps::Cell cell = {row, column};
        return grid_.contains(cell) ? front_.time(grid_.number(cell)) : never;
    }
    Square square(int column, int row) const {
        return {column,
                row,
                time(row, column),
                time(row, column + 1),
                time(row + 1, column),
                time(row + 1, column + 1)};
    }
    void go(Point to, double time) {
        at_ = to;
        time_ = time;
        path_.push_back(to);
    }
    // From one end of a side of a square towards the other, by how much of a step until one is met.
    static double until_side(double at, double step, double low) {
        return step > 0 ? (low + 1 - at) / step : step < 0 ? (low - at) / step : 1;
    }
    // Down the slope of one of the squares that contain the point: within it, or, where two squares lead to
    // each other, along the side between them.
    bool slide() { return slide_within(false) || slide_within(true); }
    bool slide_within(bool along_side) {
        const int column = int(std::floor(at_.x)), row = int(std::floor(at_.y));
        Point best = at_;
        double least = time_ * (1 - tolerance::exact);
        for (int r = at_.y == row ? row - 1 : row; r <= row; ++r)
            for (int c = at_.x == column ? column - 1 : column; c <= column; ++c) {
                const Square in = square(c, r);
                if (!in.is_open()) continue;
                const Point slope = in.slope(at_);
                const double steep = norm(slope);
                if (!(steep > 0)) continue;
                const Point step = (-stride / steep) * slope;
                const double share =
                    along_side ? 1
                               : std::min({1.0, until_side(at_.x, step.x, c), until_side(at_.y, step.y, r)});
                const Point far = at_ + share * step;
                const Point to = {snapped(std::clamp(far.x, double(c), c + 1.0)),
                                  snapped(std::clamp(far.y, double(r), r + 1.0))};
                if (distance(at_, to) < 0.01) continue;
                if (const double time = in.at(to); time < least) best = to, least = time;
            }
        if (best == at_) return false;
        go(best, least);
        return true;
    }
    static double snapped(double x) {
        return std::abs(x - std::round(x)) < tolerance::cell_border ? std::round(x) : x;
    }
    // To the earliest of the centres around; from a centre, to the earliest neighbour along a side.
    void hop() {
        const int column = int(std::floor(at_.x)), row = int(std::floor(at_.y));
        const bool on_column = at_.x == column, on_row = at_.y == row;
        Point best = at_;
        double least = never;
        const auto offer = [&](int r, int c) {
            if (const double t = time(r, c); t < least) least = t, best = {double(c), double(r)};
        };
        if (on_column && on_row) {
            offer(row + 1, column), offer(row - 1, column), offer(row, column + 1), offer(row, column - 1);
            if (!(least < time_)) return;
        } else {
            offer(row, column);
            if (!on_column) offer(row, column + 1);
            if (!on_row) offer(row + 1, column);
            if (!on_column && !on_row) offer(row + 1, column + 1);
        }
        if (least < never) go(best, std::min(least, time_));
    }
};

struct MarchAnswer {
    Route route;
    double time = never;  // of the start's cell [cells, over the speed]
};

inline MarchAnswer march_front(const maps::BitGrid& grid, const maps::GridFrame& frame,
                               const maps::Clearance* clearance, double slow_within, Point start,
                               maps::Cell from, Point goal, maps::Cell to, Trace* trace) {
    MarchAnswer answer;
    std::vector<std::uint32_t> order;
    Front front(grid, clearance, slow_within, grid.number(from));
    search::PriorityQueue queue;
    search::Effort effort{0, 0, trace ? &order : nullptr};
    front.start(to, queue);
    const bool found = search::best_first(front, queue, effort) != search::no_node;
    answer.route.stats = {std::int64_t(effort.settled), std::int64_t(front.edges())};
    answer.route.status = found ? Status::found : Status::unreachable;
    for (const std::uint32_t n : order) {
        const Point at = frame.center(grid.cell(n));
        trace->push_back({0, at, at, frame.resolution * front.time(n)});
    }
    if (!found) return answer;
    answer.time = front.time(grid.number(from));
    auto& path = answer.route.path;
    path = {start};
    for (const Point p : FrontDescent(grid, front).run(from, to)) {
        const Point at = frame.origin + frame.resolution * (p + Point{0.5, 0.5});
        if (!(path.back() == at)) path.push_back(at);
    }
    if (!(path.back() == goal)) path.push_back(goal);
    if (from == to) path = {start, goal};
    answer.route.length = length_of(path);
    return answer;
}

}  // namespace cspace::navigation
