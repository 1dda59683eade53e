// Points in square buckets, about one in each: those near a place are found among few. The buckets are made
// anew whenever the number of points has grown fourfold.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::search {

class Buckets {
  public:
    Buckets(Point low, Point high) : low_(low), high_(high) { make_anew(); }

    Point point(std::int32_t i) const { return points_[std::size_t(i)]; }
    std::size_t size() const { return points_.size(); }

    void add(Point p) {
        points_.push_back(p);
        next_.push_back(-1);
        if (points_.size() > 2 * heads_.size())
            make_anew();
        else
            put(std::int32_t(points_.size()) - 1);
    }

    // The nearest point, the earliest of equally near ones; -1 if there is none.
    std::int32_t nearest(Point p) const {
        const int row = row_of(p.y), column = column_of(p.x);
        std::int32_t best = -1;
        double least = std::numeric_limits<double>::infinity();
        const int most = std::max(rows_, columns_);
        for (int ring = 0; ring <= most; ++ring) {
            const double gap = (ring - 1) * side_;
            if (ring > 1 && gap * gap > least) break;
            around(row, column, ring, [&](std::int32_t i) {
                const double d = squared_norm(point(i) - p);
                if (d < least || (d == least && i < best)) least = d, best = i;
            });
        }
        return best;
    }

    // The points within a radius, by number.
    void within(Point p, double radius, std::vector<std::int32_t>& out) const {
        out.clear();
        const int top = row_of(p.y + radius), right = column_of(p.x + radius), left = column_of(p.x - radius);
        for (int row = row_of(p.y - radius); row <= top; ++row)
            for (int column = left; column <= right; ++column)
                each(row, column, [&](std::int32_t i) {
                    if (squared_norm(point(i) - p) <= radius * radius) out.push_back(i);
                });
        std::sort(out.begin(), out.end());
    }

    // The k points nearest to p, the nearest first.
    void nearest(Point p, std::size_t k, std::vector<std::int32_t>& out) const {
        k = std::min(k, points_.size());
        const double area = side_ * side_ * double(heads_.size());
        double radius = std::sqrt(2 * area * double(k + 1) / (3 * double(points_.size() + 1)));
        for (within(p, radius, out); out.size() < k; within(p, radius, out)) radius *= 1.5;
        const auto nearer = [&](std::int32_t i, std::int32_t j) {
            const double a = squared_norm(point(i) - p), b = squared_norm(point(j) - p);
            return a < b || (a == b && i < j);
        };
        std::sort(out.begin(), out.end(), nearer);
        out.resize(k);
    }

  private:
    Point low_, high_;
    double side_ = 1;
    int columns_ = 1, rows_ = 1;
    std::vector<Point> points_;
    std::vector<std::int32_t> heads_, next_;

    static int clamped(double cell, int count) {
        return cell <= 0 ? 0 : cell >= count - 1 ? count - 1 : int(cell);
    }
    int column_of(double x) const { return clamped((x - low_.x) / side_, columns_); }
    int row_of(double y) const { return clamped((y - low_.y) / side_, rows_); }
    std::int32_t& head(int row, int column) {
        return heads_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
    }

    void make_anew() {
        const double width = high_.x - low_.x, height = high_.y - low_.y;
        const double cells = 2 * double(points_.size()) + 16;
        side_ = std::max(std::sqrt(width * height / cells), std::max(width, height) / cells);
        columns_ = 1 + int(width / side_), rows_ = 1 + int(height / side_);
        heads_ = filled_vector<std::int32_t>(std::size_t(columns_) * std::size_t(rows_), -1);
        visit_range(0, points_.size(), [&](std::size_t i) { put(std::int32_t(i)); });
    }
    void put(std::int32_t i) {
        std::int32_t& first = head(row_of(point(i).y), column_of(point(i).x));
        next_[std::size_t(i)] = first;
        first = i;
    }
    template <class Visit>
    void each(int row, int column, Visit&& visit) const {
        std::int32_t i = heads_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
        for (; i >= 0; i = next_[std::size_t(i)]) visit(i);
    }
    // The buckets of a square ring around one.
    template <class Visit>
    void around(int row, int column, int ring, Visit visit) const {
        const int left = std::max(column - ring, 0), right = std::min(column + ring, columns_ - 1);
        for (int r = std::max(row - ring, 0); r <= std::min(row + ring, rows_ - 1); ++r) {
            const bool is_side = r == row - ring || r == row + ring;
            if (is_side) {
                for (int c = left; c <= right; ++c) each(r, c, visit);
                continue;
            }
            if (column - ring >= 0) each(r, column - ring, visit);
            if (column + ring < columns_) each(r, column + ring, visit);
        }
    }
};

}  // namespace cspace::search
