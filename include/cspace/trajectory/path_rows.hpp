// Limits along a path as rows that are linear in the squared speeds at the two ends of an interval.
//
// On an interval of length D the squared path speed X is quadratic from x to y, with the Bernstein
// coefficients x, (x + y) / 2 + r and y; its rise r is given. The path acceleration is then linear, from
// (y − x + 2r) / 2D to (y − x − 2r) / 2D, and velocities and accelerations of the joints are polynomials of
// the place. A row bounds one of their Bernstein coefficients, so that no limit is exceeded anywhere in the
// interval: with those of q' the rows of q̈ = q''X + q'ü come of products. Where r is that of the fastest
// motion, what a row gives away falls by the square of the length instead of the length.
// (Reachability: Pham and Pham 2018; Bernstein bounds: Farouki 2012.)
#pragma once

#include <cstddef>

#include "cspace/math/rows.hpp"

namespace cspace::trajectory {

inline constexpr int joint_padding = 8;    // joints are stored in multiples of it: the widest pack
inline constexpr double no_row = 1e-60;    // coefficient of y, relative to that of x, that a row has at least
inline constexpr double no_size = 1e-150;  // and absolutely: below it the row is not a bound of y
inline constexpr double no_end = 1e30;     // squared speed where nothing bounds it [1/s²]
// Share of a limit that the rows leave to the rounding of squared speeds.
inline constexpr double rounding_share = 1e-12;

// A piece of the path and the part of it, in [0, 1], that an interval covers.
struct Interval {
    int piece;
    double from, to;
};

// The intervals of a grid.
struct Intervals {
    const int* piece;
    const double *from, *to;

    Interval operator[](std::size_t i) const { return {piece[i], from[i], to[i]}; }
    // Of the parameter, for pieces of these lengths.
    double length(std::size_t i, const double* lengths) const {
        return (to[i] - from[i]) * lengths[piece[i]];
    }
};

// Limits that are not polynomials along the path, sampled at the ends and the middles of the intervals:
// offset + along·(path acceleration) + across·(squared speed) stays within ±limit of each row, less margin.
// Row s has the values of place s / 2 of the grid; a place where two pieces meet has those of both sides, so
// that interval i owns the rows 3i, 3i + 1 and 3i + 2.
struct SampledLimits {
    const double *along, *across, *offset;  // (3 intervals, padded joints) each, or null
    const double* margin;                   // (intervals, padded joints) or null
    const double* limit;                    // (padded joints,)
    // (intervals, 3): Bernstein coefficients of what bounds the inverse of the squared path speed, or null
    const double* inverse_square;
};

// A path with its limits and the grid on which it is timed.
struct TimedRows {
    int degree, joints, padded;          // of q'; padded: joints rounded up
    const double* slopes;                // (pieces, degree + 1, padded): Bernstein coefficients of dq/ds
    const double* lengths;               // (pieces,): of their parameter
    const double* least_inverse_square;  // (pieces,): of the squared path speed
    const double* inverse_acceleration;  // (padded,) [s²/rad or s²/m], 0 without a limit
    const double* inverse_velocity;      // (padded,)
    Intervals intervals;
    const double* rises;       // (intervals,): of the squared path speed
    const signed char* stops;  // (intervals + 1,): 1 where the path has to stand
    SampledLimits sampled;

    double length(std::size_t i) const { return intervals.length(i, lengths); }
};

// Numbers of rows that build_rows writes at most, in multiples of the widest pack.
inline int row_capacity(const TimedRows& path) {
    return (path.degree + 2 + 3) * path.padded + 2 * joint_padding;
}

constexpr double binomial(int n, int k) {
    double value = 1.0;
    for (int i = 1; i <= k; ++i) value = value * double(n - k + i) / double(i);
    return value;
}
// The weights of a_i b_j in coefficient i + j of the product of polynomials of degrees m and n.
template <int m, int n>
struct ProductWeights {
    double at[m + 1][n + 1];

    constexpr ProductWeights() : at{} {
        for (int i = 0; i <= m; ++i)
            for (int j = 0; j <= n; ++j) at[i][j] = binomial(m, i) * binomial(n, j) / binomial(m + n, i + j);
    }
};
// The weights of the coefficients of a quadratic polynomial in its coefficients of degree m.
template <int m>
struct RaisedWeights {
    double at[m + 1][3];

    constexpr RaisedWeights() : at{} {
        for (int k = 0; k <= m; ++k)
            for (int j = 0; j <= 2; ++j)
                if (k - j >= 0 && k - j <= m - 2)
                    at[k][j] = binomial(2, j) * binomial(m - 2, k - j) / binomial(m, k);
    }
};

}  // namespace cspace::trajectory

namespace cspace::trajectory::inline CSPACE_ISA {

// Rows y ∈ [low + slope x, high + slope x] of one interval; largest_x and largest_y bound x and y alone, and
// y ≥ least_sum − x keeps the squared speed positive inside of it.
struct Rows {
    double *slope, *low, *high;
    int count;  // a multiple of joint_padding
    double largest_x, largest_y, least_sum;
};

// Bernstein coefficients on [from, to] from those on [0, 1], by two subdivisions.
template <int m, class V>
CSPACE_INLINE void restrict_to(V (&c)[m + 1], double from, double to) {
    if (to < 1.0)
        for (int k = 1; k <= m; ++k)
            for (int j = m; j >= k; --j) c[j] = c[j - 1] + to * (c[j] - c[j - 1]);
    if (from > 0.0) {
        const double ratio = from / to;
        for (int k = 1; k <= m; ++k)
            for (int j = 0; j <= m - k; ++j) c[j] = c[j] + ratio * (c[j + 1] - c[j]);
    }
}

// Writes a pack of rows low ≤ α x + β y ≤ high.
template <class V>
CSPACE_INLINE void write_rows(const Rows& rows, int at, V alpha, V beta, V low, V high) {
    const V size = max(abs(beta), no_row * abs(alpha) + no_size);
    const V inverse = copysign(1.0 / size, beta);
    const V a = low * inverse, b = high * inverse;
    store_lanes(rows.slope + at, -alpha * inverse);
    store_lanes(rows.low + at, min(a, b));
    store_lanes(rows.high + at, max(a, b));
}

// The rows of the accelerations of a pack of joints, one less without a rise; d: coefficients of q' over the
// limit.
//
// 2D q̈ is q' times y − x + 2r … y − x − 2r, and 2q'' times x, (x + y) / 2 + r, y. With δ_k = d_{k+1} − d_k
// and without r it has coefficients (d_k + 2k δ_{k−1}) y − (d_k − 2(m − k) δ_k) x; with r one degree more.
template <int m, class V>
CSPACE_INLINE void write_acceleration_rows(const Rows& rows, int at, int stride, const V (&d)[m + 1],
                                           double length, double rise) {
    const V bound = fill_lanes<V>(2.0 * length * (1.0 - rounding_share));
    const auto of_begin = [&](int k) { return k < m ? (2.0 * (m - k)) * (d[k + 1] - d[k]) - d[k] : -d[k]; };
    const auto of_end = [&](int k) { return k > 0 ? d[k] + (2.0 * k) * (d[k] - d[k - 1]) : d[k]; };
    if (rise == 0.0) {
        for (int k = 0; k <= m; ++k) write_rows(rows, at + k * stride, of_begin(k), of_end(k), -bound, bound);
        return;
    }
    for (int k = 0; k <= m + 1; ++k) {
        const int own = k <= m ? k : m, last = k > 0 ? k - 1 : 0;
        const double up = double(k) / (m + 1), down = 1.0 - up;
        const V gamma = (2.0 * down * (1 + 2 * k)) * d[own] - (2.0 * (up + 2.0 * k * down)) * d[last];
        const V offset = rise * gamma;
        write_rows(rows, at + k * stride, down * of_begin(own) + up * of_begin(last),
                   down * of_end(own) + up * of_end(last), -bound - offset, bound - offset);
    }
}

// Raises squares to the Bernstein coefficients of (q' / limit)², of degree 2m, of a pack of joints.
template <int m, class V>
CSPACE_INLINE void raise_squares(const V (&c)[m + 1], V (&squares)[2 * m + 1]) {
    constexpr ProductWeights<m, m> weights;
    V sums[2 * m + 1];
    for (int i = 0; i <= m; ++i) sums[2 * i] = weights.at[i][i] * c[i] * c[i];
    for (int i = 0; i < m; ++i) sums[2 * i + 1] = (2.0 * weights.at[i][i + 1]) * c[i] * c[i + 1];
    for (int apart = 2; apart <= m; ++apart)
        for (int i = 0; i + apart <= m; ++i)
            sums[2 * i + apart] += (2.0 * weights.at[i][i + apart]) * c[i] * c[i + apart];
    for (int k = 0; k <= 2 * m; ++k) squares[k] = max(squares[k], sums[k]);
}

// The largest of all lanes, in every lane.
template <class V>
CSPACE_INLINE V largest_lanes(V v) {
    if constexpr (Lanes<V>::count > 4) v = max(v, swap_lanes<4>(v));
    if constexpr (Lanes<V>::count > 2) v = max(v, swap_lanes<2>(v));
    if constexpr (Lanes<V>::count > 1) v = max(v, swap_lanes<1>(v));
    return v;
}

// Writes rows α x + β y + γ ≤ 1, less what is left to rounding; the arrays are padded to packs by rows of
// zero.
template <int padded>
CSPACE_INLINE void write_upper_rows(Rows& rows, int at, const double (&alpha)[padded],
                                    const double (&beta)[padded], const double (&gamma)[padded]) {
    using V = Pack<native_width>;
    for (int k = 0; k < padded; k += Lanes<V>::count) {
        const V a = load_lanes<V>(alpha + k), b = load_lanes<V>(beta + k), c = load_lanes<V>(gamma + k);
        const V inverse = 1.0 / max(b, no_row * a + no_size);
        store_lanes(rows.slope + at + k, -a * inverse);
        store_lanes(rows.low + at + k, (-1.0 - c) * inverse);
        store_lanes(rows.high + at + k, (1.0 - rounding_share - c) * inverse);
    }
    rows.count = at + padded;
}

constexpr int padded_rows(int count) { return (count + joint_padding - 1) / joint_padding * joint_padding; }

// The rows of the velocities, with P_k no less than the coefficients of any (q' / limit)²: those of P X ≤ 1,
// of degree 2m + 2, or 2m + 1 without a rise. The first and the last are largest_x and largest_y.
template <int m>
CSPACE_INLINE void write_velocity_rows(Rows& rows, int at, const double (&P)[2 * m + 1], double rise) {
    rows.largest_x = 1.0 / max(P[0], 1.0 / no_end);
    rows.largest_y = 1.0 / max(P[2 * m], 1.0 / no_end);
    if (rise == 0.0) {
        constexpr int last = 2 * m + 1;
        double alpha[padded_rows(last - 1)] = {}, beta[padded_rows(last - 1)] = {};
        constexpr double gamma[padded_rows(last - 1)] = {};
        for (int k = 1; k < last; ++k) {
            alpha[k - 1] = (double(last - k) / last) * P[k];
            beta[k - 1] = (double(k) / last) * P[k - 1];
        }
        return write_upper_rows(rows, at, alpha, beta, gamma);
    }
    constexpr ProductWeights<2 * m, 2> weights;
    constexpr int last = 2 * m + 2;
    double alpha[padded_rows(last - 1)] = {}, beta[padded_rows(last - 1)] = {},
                                    gamma[padded_rows(last - 1)] = {};
    for (int k = 1; k < last; ++k) {
        const double middle = weights.at[k - 1][1] * P[k - 1];
        alpha[k - 1] = (k <= 2 * m ? weights.at[k][0] * P[k] : 0.0) + 0.5 * middle;
        beta[k - 1] = (k >= 2 ? weights.at[k - 2][2] * P[k - 2] : 0.0) + 0.5 * middle;
        gamma[k - 1] = middle * rise;
    }
    write_upper_rows(rows, at, alpha, beta, gamma);
}

// Raises P to the coefficients of a quadratic polynomial.
template <int m>
CSPACE_INLINE void raise_to_quadratic(double (&P)[2 * m + 1], const double* coefficients) {
    constexpr RaisedWeights<2 * m> weights;
    for (int k = 0; k <= 2 * m; ++k) {
        double sum = 0.0;
        for (int j = 0; j <= 2; ++j) sum += weights.at[k][j] * coefficients[j];
        P[k] = max(P[k], sum);
    }
}

// The rows of sampled limits of a pack of joints at the begin, the middle and the end of interval i.
template <class V>
CSPACE_INLINE void write_sampled_rows(const Rows& rows, int at, const TimedRows& path, std::size_t i, int j,
                                      double length) {
    const SampledLimits& given = path.sampled;
    const double rise = path.rises[i];
    const std::size_t width = std::size_t(path.padded);
    V limit = load_lanes<V>(given.limit + j);
    if (given.margin) limit = limit - load_lanes<V>(given.margin + i * width + std::size_t(j));
    for (int part = 0; part < 3; ++part) {
        const std::size_t row = (3 * i + std::size_t(part)) * width + std::size_t(j);
        const V along = (0.5 / length) * load_lanes<V>(given.along + row);
        const V across = load_lanes<V>(given.across + row), offset = load_lanes<V>(given.offset + row);
        const double share = 0.5 * part;
        const V risen = (2.0 * (1 - part) * rise) * along + (part == 1 ? 0.5 * rise : 0.0) * across;
        write_rows(rows, at + part * path.padded, (1.0 - share) * across - along, share * across + along,
                   -limit - offset - risen, limit - offset - risen);
    }
}

// All rows of interval i. memory: three times row_capacity numbers.
template <int m>
CSPACE_INLINE Rows build_rows(const TimedRows& path, std::size_t i, double* memory) {
    using V = Pack<native_width>;
    const int capacity = row_capacity(path), padded = path.padded;
    const double rise = path.rises[i];
    Rows rows{memory, memory + capacity, memory + 2 * capacity, 0, no_end, no_end, -2.0 * rise};
    const Interval part = path.intervals[i];
    const double length = path.length(i);
    const double* slopes = path.slopes + std::size_t(part.piece) * std::size_t((m + 1) * padded);
    V squares[2 * m + 1];
    for (V& each : squares) each = fill_lanes<V>(0.0);
    for (int j = 0; j < padded; j += Lanes<V>::count) {
        V d[m + 1], scaled[m + 1];
        for (int k = 0; k <= m; ++k) d[k] = load_lanes<V>(slopes + k * padded + j);
        restrict_to<m>(d, part.from, part.to);
        const V per_acceleration = load_lanes<V>(path.inverse_acceleration + j);
        for (int k = 0; k <= m; ++k) scaled[k] = d[k] * per_acceleration;
        write_acceleration_rows<m>(rows, j, padded, scaled, length, rise);
        const V per_velocity = load_lanes<V>(path.inverse_velocity + j);
        for (int k = 0; k <= m; ++k) scaled[k] = d[k] * per_velocity;
        raise_squares<m>(scaled, squares);
    }
    double P[2 * m + 1];
    for (int k = 0; k <= 2 * m; ++k)
        P[k] = max(get_lane(largest_lanes(squares[k]), 0), path.least_inverse_square[part.piece]);
    if (path.sampled.inverse_square) raise_to_quadratic<m>(P, path.sampled.inverse_square + 3 * i);
    write_velocity_rows<m>(rows, (rise == 0.0 ? m + 1 : m + 2) * padded, P, rise);
    if (path.sampled.along) {
        for (int j = 0; j < padded; j += Lanes<V>::count)
            write_sampled_rows<V>(rows, rows.count + j, path, i, j, length);
        rows.count += 3 * padded;
    }
    return rows;
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
