// Rows of limits over whole intervals of a path, and the fastest motion that they permit.
#include <algorithm>
#include <array>
#include <vector>

#include "check.hpp"
#include "cspace/math/banded.hpp"
#include "cspace/trajectory/speed_bounds.hpp"
#include "library/trajectory_jerk.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::trajectory;

namespace {

check::Random random_numbers{7};
double draw(double low, double high) { return random_numbers.uniform(low, high); }

// A path of one piece: q' has random Bernstein coefficients, limits are 1.
struct OnePiece {
    int degree, joints, padded = 8;
    std::vector<double> slopes, ones;
    double length, least = 0.0, rise = 0.0;
    Interval part;
    signed char stops[2] = {0, 0};

    OnePiece(int degree, int joints) : degree(degree), joints(joints), ones(8, 1.0) {
        slopes.assign(std::size_t((degree + 1) * padded), 0.0);
        for (int k = 0; k <= degree; ++k)
            for (int j = 0; j < joints; ++j) slopes[std::size_t(k * padded + j)] = draw(-1.0, 1.0);
        length = std::exp(draw(-4.0, 1.0));
        part = {0, draw(0.0, 0.6), 0.0};
        part.to = std::min(1.0, part.from + std::exp(draw(-6.0, 0.0)));
    }
    TimedRows rows() const {
        return {degree,        joints,      padded,
                slopes.data(), &length,     &least,
                ones.data(),   ones.data(), {&part.piece, &part.from, &part.to},
                &rise,         stops,       {}};
    }
    // q' and q'' of a joint at a share of the interval, by de Casteljau.
    std::array<double, 2> slope_and_bend(int j, double share) const {
        double c[5];
        const double t = part.from + share * (part.to - part.from);
        for (int k = 0; k <= degree; ++k) c[k] = slopes[std::size_t(k * padded + j)];
        for (int level = degree; level > 1; --level)
            for (int k = 0; k < level; ++k) c[k] += t * (c[k + 1] - c[k]);
        const double bend = degree * (c[1] - c[0]) / length;
        return {c[0] + t * (c[1] - c[0]), bend};
    }
    // The largest share of any limit at samples of the interval.
    double used(double x, double y) const {
        double most = 0.0;
        for (int k = 0; k <= 200; ++k) {
            const double share = k / 200.0;
            const double squared = x + share * (y - x) + 2.0 * share * (1.0 - share) * rise;
            const double u = (y - x + 2.0 * (1.0 - 2.0 * share) * rise) / (2.0 * rows().length(0));
            if (squared < -1e-9 * (x + y)) return 2.0;
            for (int j = 0; j < joints; ++j) {
                const auto [slope, bend] = slope_and_bend(j, share);
                most = std::max({most, std::fabs(slope * u + bend * squared),
                                 std::fabs(slope) * std::sqrt(std::max(squared, 0.0))});
            }
        }
        return most;
    }
};

template <int m>
void check_rows() {
    for (int round = 0; round < 2000; ++round) {
        const OnePiece piece(m, 1 + int(draw(0.0, 7.99)));
        const TimedRows path = piece.rows();
        std::vector<double> memory(std::size_t(3 * row_capacity(path)));
        SpeedRange range[2] = {{0.0, no_end}, {0.0, no_end}};
        Carry carry[2] = {{0.0, true}, {0.0, true}};
        CHECK(bound_speeds<m>(path, 0, 1, range, carry, memory.data()) == -1);
        CHECK(range[0].low == 0.0 && range[0].high > 0.0);
        const Rows rows = build_rows<m>(path, 0, memory.data());
        for (const double part : {0.0, 0.3, 1.0}) {
            const double x = part * range[0].high;
            const Edges edges = bound_next(rows, x, range[1]);
            const double low = std::max(0.0, edges.low.value), high = std::max(low, edges.high.value);
            for (const double y : {low, 0.5 * (low + high), high}) CHECK(piece.used(x, y) <= 1.0 + 1e-9);
        }
    }
}

// With rises of either sign: what the rows leave keeps the limits, and the squared speed stays positive.
template <int m>
void check_risen_rows() {
    int found = 0;
    for (int round = 0; round < 4000; ++round) {
        OnePiece piece(m, 1 + int(draw(0.0, 7.99)));
        std::vector<double> memory(std::size_t(3 * row_capacity(piece.rows())));
        SpeedRange flat[2] = {{0.0, no_end}, {0.0, no_end}};
        Carry carry[2] = {{0.0, true}, {0.0, true}};
        CHECK(bound_speeds<m>(piece.rows(), 0, 1, flat, carry, memory.data()) == -1);
        piece.rise = draw(-0.5, 0.5) * std::exp(draw(-4.0, 0.0)) * flat[0].high;
        SpeedRange range[2] = {{0.0, no_end}, {0.0, no_end}};
        if (bound_speeds<m>(piece.rows(), 0, 1, range, carry, memory.data()) >= 0) continue;
        ++found;
        const TimedRows path = piece.rows();
        const Rows rows = build_rows<m>(path, 0, memory.data());
        for (const double part : {0.0, 0.3, 1.0}) {
            const double x = range[0].low + part * (range[0].high - range[0].low);
            const Edges edges = bound_next(rows, x, range[1]);
            for (const double share : {0.0, 0.5, 1.0}) {
                const double y = edges.low.value + share * (edges.high.value - edges.low.value);
                CHECK(piece.used(x, std::max(y, 0.0)) <= 1.0 + 1e-9);
            }
        }
    }
    CHECK(found > 2000);
}

}  // namespace

TEST(no_limit_of_a_cubic_piece_is_exceeded_between_the_ends) { check_rows<2>(); }
TEST(no_limit_of_a_quintic_piece_is_exceeded_between_the_ends) { check_rows<4>(); }
TEST(no_limit_of_a_cubic_piece_is_exceeded_where_squared_speeds_are_quadratic) { check_risen_rows<2>(); }
TEST(no_limit_of_a_quintic_piece_is_exceeded_where_squared_speeds_are_quadratic) { check_risen_rows<4>(); }

// On a straight line the answer is a trapezoid of speed: d = v²/a + v t.
TEST(a_straight_line_takes_as_long_as_the_trapezoid) {
    const double controls[] = {0.0, 0.0, 3.0, -6.0}, lengths[] = {1.0};
    const signed char stops[] = {0, 0};
    const double v[] = {1.0, 1.5}, a[] = {2.0, 3.0};  // the second joint is the slower one: 6 = v²/a + v t
    const TimingPath path = {1, 2, controls, lengths, stops};
    const Timing timing = time_path(path, {v, a}, {0.0, 0.0, 1e-6}, {});
    CHECK(timing.outcome == TimingOutcome::timed && timing.converged);
    double seconds = 0.0;
    for (std::size_t i = 0; i < timing.grid.size(); ++i)
        seconds += 2.0 * (timing.grid.to[i] - timing.grid.from[i]) /
                   (std::sqrt(timing.squared_speed[i]) + std::sqrt(timing.squared_speed[i + 1]));
    CHECK_NEAR(seconds, 1.5 / 3.0 + 6.0 / 1.5, 1e-5);
}

TEST(speeds_at_the_ends_that_are_impossible_are_answered_with_the_possible_ones) {
    const double controls[] = {0.0, 1.0}, lengths[] = {1.0}, v[] = {100.0}, a[] = {2.0};
    const signed char stops[] = {0, 0};
    const TimingPath path = {1, 1, controls, lengths, stops};
    const Timing fast = time_path(path, {v, a}, {9.0, 0.0, 1e-3}, {});
    CHECK(fast.outcome == TimingOutcome::start);
    CHECK_NEAR(fast.most, 2.0, 1e-9);  // v² = 2 a d
    const Timing slow = time_path(path, {v, a}, {0.0, 9.0, 1e-3}, {});
    CHECK(slow.outcome == TimingOutcome::end);
    CHECK_NEAR(slow.most, 2.0, 1e-9);
    CHECK(time_path(path, {v, a}, {1.999, 0.0, 1e-3}, {}).outcome == TimingOutcome::timed);
}

// On a straight line from rest to rest the best motion has seven phases: T = d / v + v / a + a / j.
TEST(a_straight_line_under_jerk_limits_takes_little_longer_than_seven_phases) {
    const double controls[] = {0.0, 5.0}, lengths[] = {5.0}, v[] = {1.0}, a[] = {2.0}, j[] = {8.0};
    const signed char stops[] = {0, 0};
    const TimingPath path = {1, 1, controls, lengths, stops};
    TimingGrid grid;
    const double margin = 1e-6;
    for (double from = margin, size = margin; from < 1.0 - margin; size = std::min(1.4 * size, 0.005)) {
        const double left = 1.0 - margin - from;  // it shrinks towards the end as it grew
        const double to =
            left < 1.5 * margin ? 1.0 - margin : from + std::min(size, std::max(0.3 * left, margin));
        grid.piece.push_back(0);
        grid.from.push_back(from);
        grid.to.push_back(to);
        from = to;
    }
    const Launch launch = {5.0 * margin, 0.97 * 8.0};
    const JerkTiming timing = time_path_with_jerk(path, {v, a}, j, grid, {launch, launch, 9.0, 1e-4}, {});
    const double best = 5.0 / 1.0 + 1.0 / 2.0 + 2.0 / 8.0;
    CHECK(timing.found && timing.duration >= best && timing.duration < 1.03 * best);
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const double* x = timing.squares.data() + 3 * i;
        const double length = 5.0 * (grid.to[i] - grid.from[i]),
                     u = std::max(std::fabs(x[1] - x[0]), std::fabs(x[2] - x[1]));
        const double change = std::fabs(x[0] - 2.0 * x[1] + x[2]) / (length * length);
        const double most = std::max({x[0], x[1], x[2]});
        CHECK(most <= 1.0 + 1e-9 && u / length <= 2.0 + 1e-9 &&
              change * std::sqrt(most) <= 8.0 * (1.0 + 1e-9));
    }
}

// A path of cubic pieces, smooth up to the second derivative, with intervals that grow from both ends.
struct LongPath {
    int joints = 3, parts;
    std::vector<double> controls, lengths;
    std::vector<signed char> stops;
    TimingGrid grid;
    double margin = 1e-4;

    LongPath(int pieces, int parts_of_each, double waviness) : parts(parts_of_each) {
        for (int i = 0; i < pieces; ++i) {
            lengths.push_back(1.0);
            for (int k = 0; k < 4; ++k)  // of the uniform cubic B-spline through random points
                for (int j = 0; j < joints; ++j) {
                    const auto point = [&](int n) {
                        return 0.3 * n + std::sin(waviness * n * (1.0 + 0.37 * j) + j);
                    };
                    const double a = point(i), b = point(i + 1), c = point(i + 2), d = point(i + 3);
                    const double at[] = {(a + 4 * b + c) / 6, (2 * b + c) / 3, (b + 2 * c) / 3,
                                         (b + 4 * c + d) / 6};
                    controls.push_back(at[k]);
                }
            divide(i, i == 0, i + 1 == pieces);
        }
        stops.assign(std::size_t(pieces) + 1, 0);
    }
    TimingPath path() const { return {3, joints, controls, lengths, stops}; }

  private:
    void divide(int piece, bool first, bool last) {
        std::vector<double> places;
        for (double at = margin; first && at < 1.0 / parts; at *= 1.4) places.push_back(at);
        for (int k = 0; k < parts; ++k)
            if (k > 0 || !first) places.push_back(double(k) / parts);
        std::vector<double> ends;
        for (double at = margin; last && at < 1.0 / parts; at *= 1.4) ends.push_back(1.0 - at);
        places.insert(places.end(), ends.rbegin(), ends.rend());
        if (!last) places.push_back(1.0);
        for (std::size_t k = 0; k + 1 < places.size(); ++k) {
            grid.piece.push_back(piece);
            grid.from.push_back(places[k]);
            grid.to.push_back(places[k + 1]);
        }
    }
};

// Where waypoints are near each other, a motion brakes over many pieces: the windows have to grow.
TEST(windows_of_a_path_under_jerk_limits_give_the_motion_that_the_whole_path_gives) {
    for (const double waviness : {1.3, 0.4, 0.02}) {
        const LongPath made(120, 12, waviness);
        const std::vector<double> v(3, 2.0), a(3, 3.0), j(3, 20.0);
        const Launch launch = {made.margin, 2.0};
        const auto time = [&](std::size_t at_once) {
            return time_path_with_jerk(made.path(), {v, a}, j, made.grid,
                                       {launch, launch, 200.0, 1e-4, at_once}, {});
        };
        const JerkTiming whole = time(1 << 20);
        CHECK(whole.found);
        for (const std::size_t at_once : {200, 1000}) {
            const JerkTiming parts = time(at_once);
            CHECK(parts.found && std::fabs(parts.duration / whole.duration - 1.0) < 3e-4);
        }
    }
}

TEST(pentadiagonal_systems_are_solved) {
    const std::size_t n = 7;
    Pentadiagonal matrix(n);
    double full[n][n] = {};
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t left = 0; left <= std::min<std::size_t>(i, 2); ++left) {
            const double value = left == 0 ? 4.0 + draw(0.0, 1.0) : draw(-1.0, 1.0);
            matrix.at(i, left) = full[i][i - left] = full[i - left][i] = value;
        }
    std::vector<double> x(n), b(n, 0.0);
    for (double& each : x) each = draw(-1.0, 1.0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k) b[i] += full[i][k] * x[k];
    CHECK(matrix.solve(b));
    for (std::size_t i = 0; i < n; ++i) CHECK_NEAR(b[i], x[i], 1e-14);
    Pentadiagonal indefinite(2);
    std::vector<double> c(2, 1.0);
    CHECK(!indefinite.solve(c));
}
