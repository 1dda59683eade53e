// Point location: a raster of the bounds whose cells each name a triangle nearby, and a short walk from
// there.
#pragma once

#include "cspace/maps/free_space.hpp"

namespace cspace::maps {

class Locator {
  public:
    Locator() = default;
    Locator(const Triangulation& mesh, Point low, Point high) : low_(low) {
        const double width = high.x - low.x, height = high.y - low.y;
        const double cells = std::clamp(double(mesh.triangles.size()), 1.0, 1e6);
        side_ = std::max(std::sqrt(width * height / cells), std::max(width, height) / 4096);
        columns_ = 1 + Index(width / side_);
        rows_ = 1 + Index(height / side_);
        near_.resize(std::size_t(columns_) * std::size_t(rows_));
        Index t = 0;
        for (Index row = 0; row < rows_; ++row)
            for (Index k = 0; k < columns_; ++k) {
                const Index column = row % 2 ? columns_ - 1 - k : k;
                const Place place = mesh.locate(center(row, column), t);
                if (place.triangle != none) t = place.triangle;
                near_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)] = t;
            }
    }
    // A triangle near p.
    Index near(Point p) const {
        const auto cell = [&](double offset, Index count) {
            return std::size_t(std::clamp(offset / side_, 0.0, double(count - 1)));
        };
        return near_[cell(p.y - low_.y, rows_) * std::size_t(columns_) + cell(p.x - low_.x, columns_)];
    }

  private:
    Point low_;
    double side_ = 1;
    Index columns_ = 0, rows_ = 0;
    std::vector<Index> near_;

    Point center(Index row, Index column) const {
        return low_ + Point{(column + 0.5) * side_, (row + 0.5) * side_};
    }
};

}  // namespace cspace::maps
