#include "localization_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/math/threads.hpp"
#include "kernels/localization_particles.hpp"

namespace cspace::localization {

namespace {

constexpr int most_beams = 257;   // whose bytes a sum of 16 bits can hold
constexpr double blur_reach = 3;  // standard deviations at which a blur is cut off
constexpr double narrowest_blur =
    0.3;                               // standard deviation [cells] below which nothing reaches the next cell
constexpr double least_share = 1e-30;  // of the belief, below which a cell is zero: no sum shows it

int divide_down(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

// Weights of a row and of its neighbours: to[i] = Σ weights[t] · from[i − first − t].
struct Taps {
    int first = 0;
    std::vector<double> weights;
};

Taps taps_of_shift(double by) {
    const double whole = std::floor(by), part = by - whole;
    return {int(whole), {1 - part, part}};
}

Taps taps_of_blur(double sigma) {
    if (!(sigma > narrowest_blur)) return {};
    const int reach = int(std::ceil(blur_reach * sigma));
    Taps taps{-reach, {}};
    double sum = 0;
    for (int k = -reach; k <= reach; ++k)
        taps.weights.push_back(std::exp(-0.5 * (k / sigma) * (k / sigma))), sum += taps.weights.back();
    for (double& weight : taps.weights) weight /= sum;
    return taps;
}

// Columns of a row that are not zero: first … last − 1.
struct Span {
    int first = 0, last = 0;
};

Span find_span(const double* row, int columns) {
    Span span{0, columns};
    while (span.first < span.last && row[span.first] == 0) ++span.first;
    while (span.last > span.first && row[span.last - 1] == 0) --span.last;
    return span;
}

// A row along itself. `padded` holds zeros, as far as the taps reach on both sides of a row.
void filter_along(const Taps& taps, int columns, int margin, std::vector<double>& padded, double* row) {
    if (taps.weights.empty()) return;
    const Span span = find_span(row, columns);
    if (span.first == span.last) return;
    double* middle = &padded[std::size_t(margin)];
    std::copy(row + span.first, row + span.last, middle + span.first);
    const int count = int(taps.weights.size());
    const int first = std::clamp(span.first + taps.first, 0, columns),
              last = std::clamp(span.last + taps.first + count - 1, 0, columns);
    std::vector<const double*> rows;
    for (int t = 0; t < count; ++t) rows.push_back(middle + first - taps.first - t);
    std::fill(row, row + columns, 0.0);
    if (last > first) kernels::mix_rows(rows.data(), taps.weights.data(), count, row + first, last - first);
    std::fill(middle + span.first, middle + span.last, 0.0);
}

// Rows `stride` apart, each mixed of its neighbours, into `to`; closed: the last is next to the first.
void filter_across(const Taps& taps, const double* from, int count, std::size_t stride, int columns,
                   bool closed, double* to) {
    std::vector<const double*> rows;
    std::vector<double> weights;
    std::vector<Span> spans;
    for (int i = 0; i < count; ++i) spans.push_back(find_span(from + std::size_t(i) * stride, columns));
    for (int i = 0; i < count; ++i) {
        double* out = to + std::size_t(i) * stride;
        rows.clear(), weights.clear();
        Span span{columns, 0};
        for (int t = 0; t < int(taps.weights.size()); ++t) {
            int at = i - taps.first - t;
            if (closed) at -= count * divide_down(at, count);
            if (at < 0 || at >= count || spans[std::size_t(at)].first == spans[std::size_t(at)].last)
                continue;
            const Span& other = spans[std::size_t(at)];
            span = {std::min(span.first, other.first), std::max(span.last, other.last)};
            rows.push_back(from + std::size_t(at) * stride);
            weights.push_back(taps.weights[std::size_t(t)]);
        }
        std::fill(out, out + columns, 0.0);
        if (rows.empty()) continue;
        for (const double*& row : rows) row += span.first;
        kernels::mix_rows(rows.data(), weights.data(), int(rows.size()), out + span.first,
                          span.last - span.first);
    }
}

}  // namespace

struct LatticeScores::State {
    int step, rows, columns, outside, chunks;
    Point first;
    std::vector<Point> headings;
    int plane_rows, plane_columns, stride;
    std::vector<std::uint8_t> planes;  // each cell of the field, by its rests of row and column

    const std::uint8_t* plane(int row_rest, int column_rest) const {
        const std::size_t size = std::size_t(plane_rows) * std::size_t(stride);
        return &planes[size * std::size_t(row_rest * step + column_rest)];
    }
    void add(const Point& end, std::uint16_t* sums) const {
        const int row = int(std::floor(first.y + end.y)), column = int(std::floor(first.x + end.x));
        const int down = divide_down(row, step), left = divide_down(column, step);
        const int begin = std::max(0, -down), last = std::min(rows, plane_rows - down);
        const int low = std::max(0, -left) / cell_chunk;
        const int high = std::min(chunks, (plane_columns - left + cell_chunk - 1) / cell_chunk);
        if (begin >= last || low >= high) return;
        const std::uint8_t* from = plane(row - step * down, column - step * left) + cell_chunk +
                                   std::ptrdiff_t(begin + down) * stride + left + low * cell_chunk;
        const std::ptrdiff_t width = chunks * cell_chunk;
        kernels::add_bytes(from, stride, sums + begin * width + low * cell_chunk, width, last - begin,
                           high - low, outside);
    }
};

LatticeScores::LatticeScores(maps::CellBytes scores, int outside, int step, Point first, int rows,
                             int columns, std::span<const Point> headings)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    const int most = std::numeric_limits<int>::max() / 4;
    if (step < 1 || rows < 1 || columns < 1 || std::int64_t(rows) * columns > most)
        throw std::invalid_argument("the lattice has no cells, or too many");
    s.step = step, s.rows = rows, s.columns = columns, s.outside = outside, s.first = first;
    s.headings.assign(headings.begin(), headings.end());
    s.chunks = (columns + cell_chunk - 1) / cell_chunk;
    s.plane_rows = (scores.rows + step - 1) / step, s.plane_columns = (scores.columns + step - 1) / step;
    s.stride = s.plane_columns + 2 * cell_chunk;  // chunks begin or end outside
    s.planes.assign(std::size_t(step) * std::size_t(step) * std::size_t(s.plane_rows) * std::size_t(s.stride),
                    std::uint8_t(outside));
    for (int row = 0; row < scores.rows; ++row)
        for (int column = 0; column < scores.columns; ++column) {
            const std::uint8_t* plane = s.plane(row % step, column % step);
            const std::ptrdiff_t at = std::ptrdiff_t(row / step) * s.stride + cell_chunk + column / step;
            s.planes[std::size_t(plane - s.planes.data() + at)] =
                scores.data[std::ptrdiff_t(row) * scores.columns + column];
        }
}
LatticeScores::~LatticeScores() = default;

Table<std::int32_t> LatticeScores::sum(std::span<const Point> ends, int threads) const {
    const State& s = *state_;
    if (int(ends.size()) > most_beams) throw std::invalid_argument("more beams than a sum can hold");
    constexpr double farthest = 1e8;  // cells: whole numbers of 32 bits hold it
    for (const Point& end : ends)
        if (!(std::hypot(end.x, end.y) < farthest)) throw std::invalid_argument("a beam ends too far away");
    const std::size_t width = std::size_t(s.chunks * cell_chunk), rows = std::size_t(s.rows),
                      columns = std::size_t(s.columns);
    Table<std::int32_t> sums{std::vector<std::int32_t>(s.headings.size() * rows * columns), 0};
    over_rows(s.headings.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint16_t> part(rows * width);
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            std::fill(part.begin(), part.end(), std::uint16_t(ends.size() * std::size_t(s.outside)));
            const double c = s.headings[k].x, v = s.headings[k].y;
            for (const Point& p : ends) s.add({c * p.x - v * p.y, v * p.x + c * p.y}, part.data());
            for (std::size_t row = 0; row < rows; ++row)
                std::copy_n(&part[row * width], columns, &sums.values[(k * rows + row) * columns]);
        }
        return true;
    });
    return sums;
}

Table<double> move_belief(std::span<const double> belief, const CellShape& shape,
                          std::span<const std::array<double, 4>> steps, double turn, double turn_sigma,
                          int threads) {
    const std::size_t columns = std::size_t(shape.columns), plane = std::size_t(shape.rows) * columns;
    if (belief.size() != plane * std::size_t(shape.sectors) || steps.size() != std::size_t(shape.sectors))
        throw std::invalid_argument("the belief and its steps must have a number per cell and sector");
    const double most = shape.rows + shape.columns + shape.sectors;  // cells, beyond which nothing is left
    const auto bound = [&](double cells) { return std::clamp(cells, -most, most); };
    Table<double> moved{std::vector<double>(belief.begin(), belief.end()), 0};
    over_rows(steps.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<double> spare(plane);
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            double* here = &moved.values[k * plane];
            const auto& [dy, dx, sigma_y, sigma_x] = steps[k];
            const auto across = [&](const Taps& taps) {
                if (taps.weights.empty()) return;
                filter_across(taps, here, shape.rows, columns, shape.columns, false, spare.data());
                std::copy(spare.begin(), spare.end(), here);
            };
            const Taps shift = taps_of_shift(bound(dx)), blur = taps_of_blur(std::min(sigma_x, most));
            const int margin =
                std::max({std::abs(shift.first) + 2, int(blur.weights.size()), 1}) + cell_chunk;
            std::vector<double> padded(columns + 2 * std::size_t(margin));
            across(taps_of_shift(bound(dy)));
            for (int row = 0; row < shape.rows; ++row)
                filter_along(shift, shape.columns, margin, padded, here + std::size_t(row) * columns);
            across(taps_of_blur(std::min(sigma_y, most)));
            for (int row = 0; row < shape.rows; ++row)
                filter_along(blur, shape.columns, margin, padded, here + std::size_t(row) * columns);
        }
        return true;
    });
    for (const Taps& taps : {taps_of_shift(turn), taps_of_blur(std::min(turn_sigma, most))}) {
        if (taps.weights.empty()) continue;
        Table<double> turned{std::vector<double>(belief.size()), 0};
        over_rows(std::size_t(shape.rows), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                poll_interrupts();
                filter_across(taps, &moved.values[row * columns], shape.sectors, plane, shape.columns, true,
                              &turned.values[row * columns]);
            }
            return true;
        });
        moved = std::move(turned);
    }
    return moved;
}

std::tuple<Table<double>, std::int32_t> weigh_belief(std::span<const double> belief, const CellShape& shape,
                                                     std::span<const std::int32_t> sums,
                                                     std::span<const std::uint8_t> free, double unit,
                                                     double share, int threads) {
    const std::size_t plane = std::size_t(shape.rows) * std::size_t(shape.columns);
    const std::size_t sectors = std::size_t(shape.sectors);
    if (belief.size() != plane * sectors || sums.size() != belief.size() || free.size() != plane ||
        sums.empty())
        throw std::invalid_argument("belief, sums and free must have a number per cell");
    std::vector<std::int32_t> most(sectors), most_free(sectors, -1);
    const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
    const std::int32_t least = *low, top = *high;
    std::vector<double> factors;
    for (std::int32_t sum = least; sum <= top; ++sum) factors.push_back(std::exp(unit * double(sum - top)));
    std::size_t count = 0;
    for (const std::uint8_t each : free) count += each != 0;
    const double uniform = share / (double(count) * double(sectors));
    Table<double> weighed{std::vector<double>(belief.size()), 0};
    std::vector<double> totals(sectors);
    over_rows(sectors, threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            const double* old = &belief[k * plane];
            const std::int32_t* sum = &sums[k * plane];
            double* made = &weighed.values[k * plane];
            for (std::size_t i = 0; i < plane; ++i) {
                const double prior = (1 - share) * old[i];
                const double factor = factors[std::size_t(sum[i] - least)];
                made[i] = free[i] ? (prior + uniform) * factor : prior == 0 ? 0.0 : prior * factor * share;
                if (free[i]) most_free[k] = std::max(most_free[k], sum[i]);
                totals[k] += made[i];
            }
        }
        return true;
    });
    double total = 0;
    for (const double each : totals) total += each;
    over_rows(sectors, threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * plane; i < end * plane; ++i) {
            const double value = weighed.values[i] / total;
            weighed.values[i] = value < least_share ? 0.0 : value;
        }
        return true;
    });
    return {std::move(weighed), *std::max_element(most_free.begin(), most_free.end())};
}

}  // namespace cspace::localization
