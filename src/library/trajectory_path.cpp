#include "trajectory_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cspace::trajectory {

using std::size_t;

namespace {

constexpr int most_degree = 5;

// Bernstein polynomials of a degree at t.
void weigh(int degree, double t, double (&weights)[most_degree + 1]) {
    weights[0] = 1.0;
    for (int i = 1; i <= degree; ++i) {  // from those of degree i − 1 to those of degree i
        weights[i] = t * weights[i - 1];
        for (int k = i - 1; k > 0; --k) weights[k] = (1.0 - t) * weights[k] + t * weights[k - 1];
        weights[0] *= 1.0 - t;
    }
}

}  // namespace

void evaluate_path(const TimingPath& path, const PathPlaces& places) {
    const int n = path.joints, degree = path.degree;
    std::vector<double> first(path.controls.size()), second(path.controls.size());
    const size_t size = size_t((degree + 1) * n);
    for (size_t piece = 0; piece < path.lengths.size(); ++piece) {
        const double *q = path.controls.data() + piece * size, h = path.lengths[piece];
        double *d = first.data() + piece * size, *e = second.data() + piece * size;
        for (int k = 0; k < degree * n; ++k) d[k] = (q[k + n] - q[k]) * (degree / h);
        for (int k = 0; k < (degree - 1) * n; ++k) e[k] = (d[k + n] - d[k]) * ((degree - 1) / h);
    }
    const auto sum = [&](const double* controls, int own, double t, double* out) {
        double weights[most_degree + 1];
        weigh(std::max(own, 0), t, weights);
        for (int j = 0; j < n; ++j) {
            double total = 0.0;
            for (int k = 0; k <= own; ++k) total += weights[k] * controls[k * n + j];
            out[j] = total;
        }
    };
    for (size_t i = 0; i < places.local.size(); ++i) {
        const size_t at = size_t(places.piece[i]) * size, out = i * size_t(n);
        const double t = places.local[i];
        sum(path.controls.data() + at, degree, t, places.q + out);
        sum(first.data() + at, degree - 1, t, places.slope + out);
        sum(second.data() + at, degree - 2, t, places.bend + out);
    }
}

namespace {

constexpr int highest_order = 3;

// The derivatives of orders 1 to 3 of every piece at its ends.
class EndDerivatives {
  public:
    explicit EndDerivatives(const TimingPath& path) : path_(path), row_(size_t(path.joints)) {
        const size_t pieces = path.lengths.size();
        values_.resize(pieces * 2 * highest_order * row_);
        std::vector<double> points(size_t(highest_order + 1) * row_);
        for (size_t piece = 0; piece < pieces; ++piece)
            for (const bool at_end : {false, true}) differentiate(piece, at_end, points);
    }

    const double* at(size_t piece, bool at_end, int order) const {
        return values_.data() + place(piece, at_end, order);
    }

  private:
    size_t place(size_t piece, bool at_end, int order) const {
        return ((2 * piece + size_t(at_end)) * highest_order + size_t(order - 1)) * row_;
    }
    void differentiate(size_t piece, bool at_end, std::vector<double>& points) {
        const int degree = path_.degree, used = std::min(degree, highest_order);
        const double* all = path_.controls.data() + piece * size_t(degree + 1) * row_;
        std::copy_n(all + (at_end ? size_t(degree - used) * row_ : 0), size_t(used + 1) * row_,
                    points.begin());
        for (int order = 1; order <= used; ++order) {
            const double scale = (degree - order + 1) / path_.lengths[piece];
            for (size_t k = 0; k < size_t(used - order + 1) * row_; ++k)
                points[k] = (points[k + row_] - points[k]) * scale;
            std::copy_n(points.data() + (at_end ? size_t(used - order) * row_ : 0), row_,
                        values_.data() + place(piece, at_end, order));
        }
    }

    const TimingPath& path_;
    size_t row_;
    std::vector<double> values_;
};

double measure_norm(const double* v, int n) {
    double sum = 0.0;
    for (int j = 0; j < n; ++j) sum += v[j] * v[j];
    return std::sqrt(sum);
}
double measure_distance(const double* a, const double* b, int n) {
    double sum = 0.0;
    for (int j = 0; j < n; ++j) sum += (a[j] - b[j]) * (a[j] - b[j]);
    return std::sqrt(sum);
}

// Which derivatives jump between a piece and the next, as bits 1 to 3. size: of the largest control point,
// whose rounding grows in a derivative as the pieces get shorter.
int find_jumps(const TimingPath& path, const EndDerivatives& ends, size_t piece, double size, double corner) {
    const double shorter = std::min(path.lengths[piece], path.lengths[piece + 1]);
    double rough = 100.0 * std::numeric_limits<double>::epsilon() * size;
    int found = 0;
    for (int order = 1; order <= std::min(highest_order, path.degree); ++order) {
        rough *= (path.degree - order + 1) / shorter;
        const double *before = ends.at(piece, true, order), *after = ends.at(piece + 1, false, order);
        const double scale = std::max(measure_norm(before, path.joints), measure_norm(after, path.joints));
        if (measure_distance(before, after, path.joints) > corner * scale + rough) found |= 1 << order;
    }
    return found;
}

// Which joints move on a piece, and the largest norm of its slopes.
double find_moving(const TimingPath& path, size_t piece, double least, std::int8_t* moving) {
    const int n = path.joints;
    const double* q = path.controls.data() + piece * size_t((path.degree + 1) * n);
    std::vector<double> most(size_t(n), 0.0);
    double largest = 0.0;
    for (int k = 0; k < path.degree; ++k, q += n) {
        for (int j = 0; j < n; ++j) most[size_t(j)] = std::max(most[size_t(j)], std::fabs(q[n + j] - q[j]));
        largest = std::max(largest, measure_distance(q, q + n, n));
    }
    const double bound = least * *std::max_element(most.begin(), most.end());
    for (int j = 0; j < n; ++j) moving[j] = most[size_t(j)] > bound;
    return largest * path.degree / path.lengths[piece];
}

}  // namespace

PathShape examine_path(const TimingPath& path, const ShapeTolerances& tolerances) {
    const size_t pieces = path.lengths.size(), n = size_t(path.joints), row = size_t(path.degree + 1) * n;
    PathShape shape{0, 0.0, std::vector<std::int8_t>(pieces + 1), std::vector<std::int8_t>(pieces * n)};
    std::vector<double> slope(pieces);
    for (size_t k = 0; k < pieces; ++k)
        slope[k] = find_moving(path, k, tolerances.slope, shape.moving.data() + k * n);
    double size = 0.0;
    for (const double value : path.controls) size = std::max(size, std::fabs(value));
    const EndDerivatives ends(path);
    for (size_t k = 0; k + 1 < pieces; ++k) {
        const double *last = path.controls.data() + (k + 1) * row - n, *next = last + n;
        for (size_t j = 0; j < n && !shape.gap; ++j)
            shape.width = std::max(shape.width, std::fabs(next[j] - last[j]));
        if (!shape.gap && shape.width > tolerances.gap * std::max(1.0, size)) shape.gap = k + 1;
        const double small = tolerances.gap * std::max(slope[k], slope[k + 1]);
        const bool vanish = measure_norm(ends.at(k, true, 1), path.joints) <= small &&
                            measure_norm(ends.at(k + 1, false, 1), path.joints) <= small;
        shape.events[k + 1] = std::int8_t(int(vanish) | find_jumps(path, ends, k, size, tolerances.jump));
    }
    return shape;
}

}  // namespace cspace::trajectory
