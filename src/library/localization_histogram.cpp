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

// What one thread keeps from row to row.
struct Scratch {
    std::vector<double> padded, weights, first, second;
    std::vector<const double*> rows;
    std::vector<Span> spans;
};

// A row along itself. Zeros lie in `padded`, as far as the taps reach on both sides of a row.
void filter_along(const Taps& taps, int columns, int margin, Scratch& scratch, double* row) {
    const Span span = find_span(row, columns);
    if (span.first == span.last) return;
    double* middle = &scratch.padded[std::size_t(margin)];
    std::copy(row + span.first, row + span.last, middle + span.first);
    const int count = int(taps.weights.size());
    const int first = std::clamp(span.first + taps.first, 0, columns),
              last = std::clamp(span.last + taps.first + count - 1, 0, columns);
    scratch.rows.clear();
    for (int t = 0; t < count; ++t) scratch.rows.push_back(middle + first - taps.first - t);
    std::fill(row + span.first, row + span.last, 0.0);
    if (last > first)
        kernels::mix_rows(scratch.rows.data(), taps.weights.data(), count, row + first, last - first);
    std::fill(middle + span.first, middle + span.last, 0.0);
}

// Rows `stride` apart, each mixed of its neighbours, into rows `to_stride` apart; closed: the last is next to
// the first.
void filter_across(const Taps& taps, const double* from, std::size_t stride, int count, int columns,
                   bool closed, Scratch& scratch, double* to, std::size_t to_stride) {
    auto& [padded, weights, first, second, rows, spans] = scratch;
    spans.clear();
    for (int i = 0; i < count; ++i) spans.push_back(find_span(from + std::size_t(i) * stride, columns));
    for (int i = 0; i < count; ++i) {
        double* out = to + std::size_t(i) * to_stride;
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
        if (rows.empty()) {
            std::fill(out, out + columns, 0.0);
            continue;
        }
        for (const double*& row : rows) row += span.first;
        std::fill(out, out + span.first, 0.0);
        kernels::mix_rows(rows.data(), weights.data(), int(rows.size()), out + span.first,
                          span.last - span.first);
        std::fill(out + span.last, out + columns, 0.0);
    }
}

// A plane by its shift (y, x) and its blur (y, x) in turn.
void move_plane(const std::array<double, 4>& step, double most, int rows, int columns, Scratch& scratch,
                const double* from, double* to) {
    const auto bound = [&](double cells) { return std::clamp(cells, -most, most); };
    const Taps shift = taps_of_shift(bound(step[1])), blur = taps_of_blur(std::min(step[3], most)),
               blur_y = taps_of_blur(std::min(step[2], most));
    const int margin = std::max(std::abs(shift.first) + 2, int(blur.weights.size())) + cell_chunk;
    const std::size_t width = std::size_t(columns), count = std::size_t(rows) * width;
    scratch.padded.assign(width + 2 * std::size_t(margin), 0.0);
    scratch.first.resize(count);
    const bool blurs = !blur_y.weights.empty();
    double* made = blurs ? scratch.first.data() : to;
    filter_across(taps_of_shift(bound(step[0])), from, width, rows, columns, false, scratch, made, width);
    for (std::size_t row = 0; row < count; row += width)
        filter_along(shift, columns, margin, scratch, made + row);
    if (blurs) filter_across(blur_y, made, width, rows, columns, false, scratch, to, width);
    if (blur.weights.empty()) return;
    for (std::size_t row = 0; row < count; row += width)
        filter_along(blur, columns, margin, scratch, to + row);
}

// One row of all planes, turned and blurred over the sectors.
void turn_sectors(const Taps& shift, const Taps& blur, int sectors, int columns, std::size_t plane,
                  Scratch& scratch, double* rows) {
    const std::size_t width = std::size_t(columns), count = std::size_t(sectors) * width;
    scratch.first.resize(count), scratch.second.resize(count);
    double *old = scratch.first.data(), *made = scratch.second.data();
    for (std::size_t k = 0; k < std::size_t(sectors); ++k)
        std::copy_n(rows + k * plane, width, old + k * width);
    if (blur.weights.empty())
        return filter_across(shift, old, width, sectors, columns, true, scratch, rows, plane);
    filter_across(shift, old, width, sectors, columns, true, scratch, made, width);
    filter_across(blur, made, width, sectors, columns, true, scratch, rows, plane);
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

void LatticeScores::sum(std::span<const Point> ends, int threads, std::span<std::int32_t> sums) const {
    const State& s = *state_;
    if (int(ends.size()) > most_beams) throw std::invalid_argument("more beams than a sum can hold");
    constexpr double farthest = 1e8;  // cells: whole numbers of 32 bits hold it
    for (const Point& end : ends)
        if (!(std::hypot(end.x, end.y) < farthest)) throw std::invalid_argument("a beam ends too far away");
    const std::size_t width = std::size_t(s.chunks * cell_chunk), rows = std::size_t(s.rows),
                      columns = std::size_t(s.columns);
    if (sums.size() != s.headings.size() * rows * columns)
        throw std::invalid_argument("the sums must have a number per cell");
    over_rows(s.headings.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint16_t> part(rows * width);
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            std::fill(part.begin(), part.end(), std::uint16_t(ends.size() * std::size_t(s.outside)));
            const double c = s.headings[k].x, v = s.headings[k].y;
            for (const Point& p : ends) s.add({c * p.x - v * p.y, v * p.x + c * p.y}, part.data());
            for (std::size_t row = 0; row < rows; ++row)
                std::copy_n(&part[row * width], columns, &sums[(k * rows + row) * columns]);
        }
        return true;
    });
}

bool move_belief(std::span<const double> belief, const CellShape& shape,
                 std::span<const std::array<double, 4>> steps, double turn, double turn_sigma, int threads,
                 std::span<double> moved) {
    const std::size_t columns = std::size_t(shape.columns), plane = std::size_t(shape.rows) * columns;
    if (belief.size() != plane * std::size_t(shape.sectors) || moved.size() != belief.size() ||
        steps.size() != std::size_t(shape.sectors))
        throw std::invalid_argument("the belief and its steps must have a number per cell and sector");
    const double most = shape.rows + shape.columns + shape.sectors;  // cells, beyond which nothing is left
    over_rows(steps.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        Scratch scratch;
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            move_plane(steps[k], most, shape.rows, shape.columns, scratch, &belief[k * plane],
                       &moved[k * plane]);
        }
        return true;
    });
    const Taps shift = taps_of_shift(turn), blur = taps_of_blur(std::min(turn_sigma, most));
    std::vector<double> totals(static_cast<std::size_t>(shape.rows));
    over_rows(std::size_t(shape.rows), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        Scratch scratch;
        for (std::size_t row = begin; row < end; ++row) {
            poll_interrupts();
            turn_sectors(shift, blur, shape.sectors, shape.columns, plane, scratch, &moved[row * columns]);
            for (std::size_t k = 0; k < steps.size(); ++k)
                totals[row] += kernels::sum_cells(&moved[row * columns + k * plane], shape.columns);
        }
        return true;
    });
    double total = 0;
    for (const double each : totals) total += each;
    if (!(total > 0)) return false;
    over_rows(steps.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            kernels::scale_cells(1 / total, 0.0, &moved[k * plane], std::ptrdiff_t(plane));
        return true;
    });
    return true;
}

std::int32_t weigh_belief(std::span<const double> belief, const CellShape& shape,
                          std::span<const std::int32_t> sums, std::span<const std::uint8_t> free, double unit,
                          double share, int threads, std::span<double> weighed) {
    const std::size_t plane = std::size_t(shape.rows) * std::size_t(shape.columns);
    const std::size_t sectors = std::size_t(shape.sectors);
    if (belief.size() != plane * sectors || weighed.size() != belief.size() || sums.size() != belief.size() ||
        free.size() != plane || sums.empty())
        throw std::invalid_argument("belief, sums and free must have a number per cell");
    std::int32_t least = sums[0], top = sums[0];
    for (const std::int32_t sum : sums) least = std::min(least, sum), top = std::max(top, sum);
    std::vector<double> factors, added(plane), scale(plane);
    for (std::int32_t sum = least; sum <= top; ++sum) factors.push_back(std::exp(unit * double(sum - top)));
    std::vector<std::int32_t> kept(plane);  // all bits of the sums of free cells
    std::size_t count = 0;
    for (const std::uint8_t each : free) count += each != 0;
    for (std::size_t i = 0; i < plane; ++i) {
        added[i] = free[i] ? share / (double(count) * double(sectors)) : 0.0;
        scale[i] = free[i] ? 1.0 : share;
        kept[i] = free[i] ? -1 : 0;
    }
    const CellWeights weights{factors.data(), least, 1 - share, added.data(), scale.data()};
    std::vector<double> totals(sectors);
    std::vector<std::int32_t> most_free(sectors);
    over_rows(sectors, threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            const std::int32_t* sum = &sums[k * plane];
            std::int32_t best = 0;
            for (std::size_t i = 0; i < plane; ++i) best = std::max(best, sum[i] & kept[i]);
            most_free[k] = best;
            totals[k] = kernels::weigh_cells(weights, &belief[k * plane], sum, &weighed[k * plane],
                                             std::ptrdiff_t(plane));
        }
        return true;
    });
    double total = 0;
    for (const double each : totals) total += each;
    over_rows(sectors, threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            poll_interrupts();
            kernels::scale_cells(1 / total, least_share, &weighed[k * plane], std::ptrdiff_t(plane));
        }
        return true;
    });
    return *std::max_element(most_free.begin(), most_free.end());
}

}  // namespace cspace::localization
