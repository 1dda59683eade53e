// Paths: rows of configurations in doubles, moved through in straight lines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cspace::planning {

inline double row_distance(const double* a, const double* b, std::size_t width) {
    double sum = 0;
    for (std::size_t k = 0; k < width; ++k) sum += (b[k] - a[k]) * (b[k] - a[k]);
    return std::sqrt(sum);
}

// Each edge has a source: the edge of the first path that it is a part of, or `checked` if it was checked
// itself, or is a part of one that was.
class Path {
  public:
    static constexpr int checked = -1;

    explicit Path(std::size_t width) : width_(width) {}

    std::size_t width() const { return width_; }
    std::size_t size() const { return rows_.size() / width_; }
    const double* row(std::size_t i) const { return rows_.data() + i * width_; }
    const std::vector<double>& rows() const { return rows_; }
    int source(std::size_t edge) const { return sources_[edge]; }
    void set_source(std::size_t edge, int source) { sources_[edge] = source; }

    void clear() { rows_.clear(), sources_.clear(); }
    // `source`: of the edge that ends there; the first row has none.
    void append(const double* q, int source) {
        if (!rows_.empty()) sources_.push_back(source);
        rows_.insert(rows_.end(), q, q + width_);
    }

    // Both edges of an inner row are checked to its new place.
    void move_row(std::size_t i, const double* q) {
        std::copy_n(q, width_, rows_.begin() + std::ptrdiff_t(i * width_));
        sources_[i - 1] = sources_[i] = checked;
    }

    double edge_length(std::size_t edge) const { return row_distance(row(edge), row(edge + 1), width_); }
    double length() const {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < size(); ++i) sum += edge_length(i);
        return sum;
    }

  private:
    std::size_t width_;
    std::vector<double> rows_;
    std::vector<int> sources_;
};

// A place on a path: a share of an edge.
struct Place {
    std::size_t edge;
    double share;
};

// The lengths of a path up to its rows, and its places by length.
class ArcLengths {
  public:
    explicit ArcLengths(const Path& path) { measure(path); }
    void measure(const Path& path) {
        upto_.assign(1, 0.0);
        for (std::size_t i = 0; i + 1 < path.size(); ++i) upto_.push_back(upto_.back() + path.edge_length(i));
    }
    double total() const { return upto_.back(); }
    double upto(std::size_t row) const { return upto_[row]; }
    Place find_place(double length) const {
        const auto after = std::upper_bound(upto_.begin() + 1, upto_.end() - 1, length);
        const std::size_t edge = std::size_t(after - upto_.begin()) - 1;
        const double along = upto_[edge + 1] - upto_[edge];
        return {edge, along > 0 ? std::clamp((length - upto_[edge]) / along, 0.0, 1.0) : 0.0};
    }

  private:
    std::vector<double> upto_;
};

// The configuration at a place; never outside the box of the two rows, and exactly they at its ends.
inline void interpolate_path(const Path& path, const Place& place, double* q) {
    const double *a = path.row(place.edge), *b = path.row(place.edge + 1);
    if (place.share == 1) return void(std::copy_n(b, path.width(), q));
    for (std::size_t k = 0; k < path.width(); ++k)
        q[k] = std::clamp(a[k] + place.share * (b[k] - a[k]), std::min(a[k], b[k]), std::max(a[k], b[k]));
}

}  // namespace cspace::planning
