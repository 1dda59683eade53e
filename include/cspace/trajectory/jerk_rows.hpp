// Limits of acceleration and jerk along a path as rows over whole intervals.
//
// The squared path speed x(s) is a quadratic B-spline: on an interval of length D it has Bernstein
// coefficients X_0, X_1, X_2, so that the path acceleration u = x'/2 is linear and κ = u' constant. Then
// q̈ = q''x + q'u is a polynomial of degree m + 1, where q' has degree m, and the jerk is √x (q'''x + 3q''u +
// q'κ), whose second factor has degree m. |second factor| ≤ J x^(−1/2) is not convex, but x^(−1/2) is: its
// tangent at any x̂ is below it, and linear. Speeds that keep the tangent keep the limit.
#pragma once

#include "cspace/trajectory/path_rows.hpp"

namespace cspace::trajectory {

inline constexpr int most_slopes = 5;  // coefficients of q' at most

// A path, its limits and its grid; as of TimedRows.
struct JerkPath {
    int degree, padded;
    const double *slopes, *lengths;
    const double *inverse_velocity, *inverse_acceleration, *inverse_jerk;
    Intervals intervals;
    SampledLimits sampled;  // those of torques, or none

    double length(std::size_t i) const { return intervals.length(i, lengths); }
    // Numbers of one interval: three factors of X for every row of the accelerations, then of the jerks; then
    // three factors and an offset for the sampled limits at three places, and for the speed of a frame.
    std::size_t own_rows() const { return std::size_t(3 * (2 * degree + 3) * padded); }
    std::size_t torque_rows() const { return sampled.along ? std::size_t(12 * padded) : 0; }
    std::size_t speed_rows() const { return sampled.inverse_square ? std::size_t(4 * joint_padding) : 0; }
    std::size_t row_size() const { return own_rows() + torque_rows() + speed_rows(); }
};

// The squared speed on an interval: its Bernstein coefficients, or changes of them.
struct Squares {
    double at[3];
};

// What a barrier adds to the gradient (0, 1, 2) and the Hessian (00, 01, 02, 11, 12, 22) by the coefficients.
struct BarrierTerms {
    double gradient[3], hessian[6];
};

// The tangent of x^(−1/2) at x̂ is level − slope x.
struct Tangent {
    double level, slope;
};
inline Tangent tangent_at(double x) {
    const double root = std::sqrt(x);
    return {1.5 / root, 0.5 / (x * root)};
}

}  // namespace cspace::trajectory

namespace cspace::trajectory::inline CSPACE_ISA {

// Adds factor · product of a polynomial p of degree m with one that is linear in X: parts[j] are the factors
// of X in its coefficient j.
template <int m, int n, class V>
CSPACE_INLINE void add_product(const V* p, const double (&parts)[n + 1][3], double factor, V (*rows)[3]) {
    constexpr ProductWeights<m, n> weights;
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) {
            const double weight = factor * weights.at[i][j];
            for (int a = 0; a < 3; ++a)
                if (parts[j][a] != 0.0) rows[i + j][a] += (weight * parts[j][a]) * p[i];
        }
}

// The rows of the sampled limits at the begin, the middle and the end of interval i, each divided by its
// limit.
CSPACE_INLINE void build_sampled_rows(const JerkPath& path, std::size_t i, double* rows) {
    using V = Pack<native_width>;
    const SampledLimits& given = path.sampled;
    const double per = 1.0 / path.length(i);
    const double squares[3][3] = {{1, 0, 0}, {0.25, 0.5, 0.25}, {0, 0, 1}};
    const double accelerations[3][3] = {{-per, per, 0}, {-0.5 * per, 0, 0.5 * per}, {0, -per, per}};
    const std::size_t width = std::size_t(path.padded);
    for (int part = 0; part < 3; ++part)
        for (int j = 0; j < path.padded; j += Lanes<V>::count) {
            V limit = load_lanes<V>(given.limit + j);
            if (given.margin) limit = limit - load_lanes<V>(given.margin + i * width + std::size_t(j));
            const auto exists = limit > 0.0;
            limit = select_lanes(exists, limit, fill_lanes<V>(1.0));
            const std::size_t at = (3 * i + std::size_t(part)) * width + std::size_t(j);
            const V along = load_lanes<V>(given.along + at), across = load_lanes<V>(given.across + at);
            double* own = rows + 4 * part * path.padded + j;
            for (int a = 0; a < 3; ++a)
                store_lanes(own + a * path.padded,
                            (squares[part][a] * across + accelerations[part][a] * along) / limit);
            // A limit that the margin uses up leaves no motion.
            const V offset = load_lanes<V>(given.offset + at) / limit;
            store_lanes(own + 3 * path.padded, select_lanes(exists, offset, fill_lanes<V>(2.0)));
        }
}

// The rows of the speed of a frame on interval i: Bernstein coefficients of the squared speed over its limit,
// a product of two quadratic polynomials. Those of one pack are rows of one limit.
CSPACE_INLINE void build_speed_rows(const JerkPath& path, std::size_t i, double* rows) {
    constexpr ProductWeights<2, 2> weights;
    for (int k = 0; k < 4 * joint_padding; ++k) rows[k] = 0.0;
    for (int k = 0; k <= 2; ++k)
        for (int a = 0; a <= 2; ++a)
            rows[a * joint_padding + k + a] +=
                weights.at[k][a] * path.sampled.inverse_square[3 * i + std::size_t(k)];
}

// The rows of interval i, each divided by its limit, and the largest squared speed that keeps the velocities.
template <int m>
inline double build_jerk_rows(const JerkPath& path, std::size_t i, double* rows) {
    using V = Pack<native_width>;
    const double length = path.length(i), per = 1.0 / length;
    const Interval part = path.intervals[i];
    const double* slopes = path.slopes + std::size_t(part.piece) * std::size_t((m + 1) * path.padded);
    const double squares[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double accelerations[2][3] = {{-per, per, 0}, {0, -per, per}};
    const double changes[1][3] = {{per * per, -2 * per * per, per * per}};
    V most = fill_lanes<V>(1.0 / no_end);
    for (int j = 0; j < path.padded; j += Lanes<V>::count) {
        V d[m + 1], e[m], f[m - 1], made[2 * m + 3][3];
        for (auto& row : made)
            for (V& each : row) each = fill_lanes<V>(0.0);
        for (int k = 0; k <= m; ++k) d[k] = load_lanes<V>(slopes + k * path.padded + j);
        restrict_to<m>(d, part.from, part.to);
        const V per_velocity = load_lanes<V>(path.inverse_velocity + j);
        for (int k = 0; k <= m; ++k) most = max(most, (d[k] * per_velocity) * (d[k] * per_velocity));
        for (int k = 0; k < m; ++k) e[k] = (m * per) * (d[k + 1] - d[k]);
        for (int k = 0; k + 1 < m; ++k) f[k] = ((m - 1) * per) * (e[k + 1] - e[k]);
        add_product<m - 1, 2>(e, squares, 1.0, made);
        add_product<m, 1>(d, accelerations, 1.0, made);
        add_product<m - 2, 2>(f, squares, 1.0, made + m + 2);
        add_product<m - 1, 1>(e, accelerations, 3.0, made + m + 2);
        add_product<m, 0>(d, changes, 1.0, made + m + 2);
        const V per_acceleration = load_lanes<V>(path.inverse_acceleration + j);
        const V per_jerk = load_lanes<V>(path.inverse_jerk + j);
        for (int r = 0; r < 2 * m + 3; ++r)
            for (int a = 0; a < 3; ++a)
                store_lanes(rows + (3 * r + a) * path.padded + j,
                            made[r][a] * (r < m + 2 ? per_acceleration : per_jerk));
    }
    if (path.sampled.along) build_sampled_rows(path, i, rows + path.own_rows());
    if (path.sampled.inverse_square) build_speed_rows(path, i, rows + path.own_rows() + path.torque_rows());
    return (1.0 - rounding_share) / get_lane(largest_lanes(most), 0);
}

// Adds the terms of the barrier of |c·X| ≤ limit − fall·X for a pack of rows: fall(a) by coefficient a.
template <class V>
struct BarrierSum {
    V g[3], h[6];

    CSPACE_INLINE void clear() {
        for (V& each : g) each = fill_lanes<V>(0.0);
        for (V& each : h) each = fill_lanes<V>(0.0);
    }
    CSPACE_INLINE void add(const V (&row)[3], V slack) {
        const V inverse = 1.0 / slack;
        const V a = row[0] * inverse, b = row[1] * inverse, c = row[2] * inverse;
        g[0] += a, g[1] += b, g[2] += c;
        h[0] += a * a, h[1] += a * b, h[2] += a * c;
        h[3] += b * b, h[4] += b * c, h[5] += c * c;
    }
};
template <class V>
CSPACE_INLINE double sum_lanes(V v) {
    double sum = 0.0;
    for (int k = 0; k < Lanes<V>::count; ++k) sum += get_lane(v, k);
    return sum;
}

// Calls visit(row, low, high, fall) for each pack of rows of an interval: −low ≤ row · X ≤ high, where these
// are the limits at X, which fall by fall · dX.
template <int m, class Visit>
CSPACE_INLINE void visit_rows(const JerkPath& path, const double* rows, const Squares& x,
                              const Tangent& tangent, const Visit& visit) {
    using V = Pack<native_width>;
    constexpr RaisedWeights<m> weights;
    for (int r = 0; r < 2 * m + 3; ++r) {
        double fall[3] = {0.0, 0.0, 0.0}, limit = 1.0 - rounding_share;
        if (r >= m + 2) {
            limit = tangent.level * (1.0 - rounding_share);
            for (int a = 0; a < 3; ++a) {
                fall[a] = tangent.slope * weights.at[r - m - 2][a];
                limit -= fall[a] * x.at[a];
            }
        }
        for (int j = 0; j < path.padded; j += Lanes<V>::count) {
            V row[3];
            for (int a = 0; a < 3; ++a) row[a] = load_lanes<V>(rows + (3 * r + a) * path.padded + j);
            visit(row, fill_lanes<V>(limit), fill_lanes<V>(limit), fall);
        }
    }
    const double still[3] = {0.0, 0.0, 0.0};
    const auto visit_sampled = [&](const double* own, int width) {
        for (int j = 0; j < width; j += Lanes<V>::count) {
            V row[3];
            for (int a = 0; a < 3; ++a) row[a] = load_lanes<V>(own + a * width + j);
            const V offset = load_lanes<V>(own + 3 * width + j);
            visit(row, 1.0 + offset, 1.0 - offset, still);
        }
    };
    const double* sampled = rows + path.own_rows();
    for (int part = 0; path.sampled.along && part < 3; ++part)
        visit_sampled(sampled + 4 * part * path.padded, path.padded);
    if (path.sampled.inverse_square) visit_sampled(sampled + path.torque_rows(), joint_padding);
}

// The terms of the barriers of all rows of an interval.
template <int m>
inline BarrierTerms sum_barriers(const JerkPath& path, const double* rows, const Squares& x,
                                 const Tangent& tangent) {
    using V = Pack<native_width>;
    BarrierSum<V> sum;
    sum.clear();
    visit_rows<m>(path, rows, x, tangent, [&](const V(&row)[3], V low, V high, const double (&fall)[3]) {
        const V value = row[0] * x.at[0] + row[1] * x.at[1] + row[2] * x.at[2];
        const V above[3] = {fall[0] + row[0], fall[1] + row[1], fall[2] + row[2]};
        const V below[3] = {fall[0] - row[0], fall[1] - row[1], fall[2] - row[2]};
        sum.add(above, high - value);
        sum.add(below, low + value);
    });
    BarrierTerms terms;
    for (int a = 0; a < 3; ++a) terms.gradient[a] = sum_lanes(sum.g[a]);
    for (int a = 0; a < 6; ++a) terms.hessian[a] = sum_lanes(sum.h[a]);
    return terms;
}

// The longest step along a change after which no row of an interval is exceeded; 0 if one is already.
template <int m>
inline double bound_step(const JerkPath& path, const double* rows, const Squares& x, const Squares& change,
                         const Tangent& tangent) {
    using V = Pack<native_width>;
    V most = fill_lanes<V>(0.0);  // of decrease over slack: the inverse of the step
    V least = fill_lanes<V>(1.0);
    visit_rows<m>(path, rows, x, tangent, [&](const V(&row)[3], V low, V high, const double (&fall)[3]) {
        const V value = row[0] * x.at[0] + row[1] * x.at[1] + row[2] * x.at[2];
        const V moved = row[0] * change.at[0] + row[1] * change.at[1] + row[2] * change.at[2];
        const double lower = fall[0] * change.at[0] + fall[1] * change.at[1] + fall[2] * change.at[2];
        const V above = high - value, below = low + value;
        least = min(least, min(above, below));
        most = max(most, max((lower + moved) / above, (lower - moved) / below));
    });
    if (get_lane(largest_lanes(-least), 0) >= 0.0) return 0.0;
    return 1.0 / max(get_lane(largest_lanes(most), 0), 1.0 / no_end);
}

// For each coefficient k of the jerk the largest of its rows at X, into most (m + 1).
template <int m>
inline void bound_jerks(const JerkPath& path, const double* rows, const Squares& x, double* most) {
    using V = Pack<native_width>;
    for (int k = 0; k <= m; ++k) {
        V largest = fill_lanes<V>(0.0);
        for (int j = 0; j < path.padded; j += Lanes<V>::count) {
            V value = fill_lanes<V>(0.0);
            for (int a = 0; a < 3; ++a)
                value += load_lanes<V>(rows + (3 * (m + 2 + k) + a) * path.padded + j) * x.at[a];
            largest = max(largest, abs(value));
        }
        most[k] = get_lane(largest_lanes(largest), 0);
    }
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
