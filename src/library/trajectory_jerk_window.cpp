#include "trajectory_jerk_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cspace/math/interrupts.hpp"

namespace cspace::trajectory {
namespace {

using std::size_t;

constexpr size_t intervals_between_polls = 512;
constexpr double first_gap = 0.1;    // of the duration: the gap of the first barrier
constexpr double sharper = 8.0;      // factor from one barrier to the next
constexpr double to_boundary = 0.9;  // of the longest step
constexpr double centered = 0.5;     // squared Newton decrement at which a barrier is sharpened
constexpr double settled = 3e-4;     // relative change of the duration, likewise
constexpr int patience = 12;         // steps after which that change is enough: tangents may alternate
constexpr int most_steps = 400;      // of Newton's method in all
// Relative to the diagonal of the Hessian.
constexpr double least_ridge = 1e-14, most_ridge = 1e-3;
constexpr std::array<double, 3> gauss_at = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> gauss_weight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

double value_at(const Squares& x, double t) {
    return (1.0 - t) * (1.0 - t) * x.at[0] + 2.0 * t * (1.0 - t) * x.at[1] + t * t * x.at[2];
}
template <int m>
double raise(int k, const Squares& x) {
    static constexpr RaisedWeights<m> weights;
    return weights.at[k][0] * x.at[0] + weights.at[k][1] * x.at[1] + weights.at[k][2] * x.at[2];
}

// The path from an interval on.
JerkPath skip_intervals(const JerkPath& path, size_t count) {
    JerkPath rest = path;
    const size_t width = size_t(path.padded);
    const auto skip = [](const double*& rows, size_t numbers) {
        if (rows) rows += numbers;
    };
    rest.intervals = {path.intervals.piece + count, path.intervals.from + count, path.intervals.to + count};
    skip(rest.sampled.along, 3 * count * width);
    skip(rest.sampled.across, 3 * count * width);
    skip(rest.sampled.offset, 3 * count * width);
    skip(rest.sampled.margin, count * width);
    skip(rest.sampled.inverse_square, 3 * count);
    return rest;
}

// Solves for x; where rounding leaves the matrix indefinite, with a ridge as small as possible.
bool solve_by_ridge(const Pentadiagonal& matrix, const std::vector<double>& b, std::vector<double>& x) {
    for (double ridge = 0.0; ridge < most_ridge; ridge = std::max(least_ridge, 10.0 * ridge)) {
        Pentadiagonal own = matrix;
        for (size_t i = 0; i < b.size(); ++i) own.at(i, 0) *= 1.0 + ridge;
        x = b;
        if (own.solve(x)) return true;
    }
    return false;
}

}  // namespace

template <class Visit>
void JerkWindow::over_parts(const Visit& visit) const {
    for (size_t begin = 0; begin < count_; begin += intervals_between_polls) {
        visit(begin, std::min(count_, begin + intervals_between_polls));
        poll_interrupts();
    }
}

JerkWindow::JerkWindow(JerkSection& section, size_t begin, size_t end)
    : section_(section),
      begin_(begin),
      count_(end - begin),
      path_(skip_intervals(section.path, begin)),
      rows_(count_ * path_.row_size()),
      largest_(count_),
      jerks_(count_ * size_t(path_.degree + 1)),
      x_(count_),
      change_(count_),
      tangents_(count_),
      terms_(count_) {
    over_parts([&](size_t from, size_t to) {
        kernels::build_all_jerk_rows(path_, from, to, rows_.data(), largest_.data());
    });
}

void JerkWindow::spread_middle() {
    for (size_t i = 0; i < count_; ++i) x_[i] = section_.squares(begin_ + i);
}

double gauss_seconds(double length, const Squares& x) {
    double sum = 0.0;
    for (size_t k = 0; k < 3; ++k) sum += length * gauss_weight[k] / std::sqrt(value_at(x, gauss_at[k]));
    return sum;
}
double JerkWindow::seconds() const {
    double sum = 0.0;
    for (size_t i = 0; i < count_; ++i) sum += gauss_seconds(length(i), x_[i]);
    return sum;
}

void JerkWindow::touch_middles() {
    for (size_t i = 0; i < count_; ++i) touched(i) = value_at(section_.squares(begin_ + i), 0.5);
}

bool JerkWindow::is_within() {
    spread_middle();
    for (size_t i = 0; i < count_; ++i) tangents_[i] = tangent_at(touched(i));
    std::fill(change_.begin(), change_.end(), Squares{});
    return longest_step(std::vector<double>(count_, 0.0)) > 0.0;
}

void JerkWindow::minimize(double tolerance) {
    const double own = 2.0 / 3.0 * double(path_.own_rows());
    const double sampled = 0.5 * double(path_.torque_rows() + path_.speed_rows());
    const double rows = double(count_) * (own + sampled + 6.0) + 2.0;
    double weight = rows / (first_gap * seconds()), last = seconds();
    for (int steps = 0, still = 0; steps < most_steps; ++steps) {
        double decrement;
        if (!step(weight, decrement)) break;
        const double now = seconds();
        still = std::fabs(now - last) < settled * now ? still + 1 : 0;
        last = now;
        if (still == 0 || (decrement > centered && still < patience)) continue;
        if (rows / weight < tolerance * now) break;
        weight *= sharper;
        still = 0;
    }
}

// Until a limit or a bound of the squared speeds is reached; 0 if one is exceeded already.
double JerkWindow::longest_step(const std::vector<double>& direction) const {
    double most = no_end;
    const auto within = [&](double slack, double fall) {
        if (!(slack > 0.0)) most = 0.0;
        if (fall > 0.0) most = std::min(most, slack / fall);
    };
    for (size_t i = 0; i < count_; ++i)
        for (int a = 0; a < 3; ++a) {
            within(largest_[i] - x_[i].at[a], change_[i].at[a]);
            within(x_[i].at[a], -change_[i].at[a]);
        }
    if (is_start()) within(section_.start.largest - middle(0), direction.front());
    if (is_end()) within(section_.end.largest - middle(count_ - 1), direction.back());
    if (most == 0.0) return 0.0;
    over_parts([&](size_t begin, size_t end) {
        most = std::min(most, kernels::bound_all_steps(path_, begin, end, rows_.data(), x_.data(),
                                                       change_.data(), tangents_.data()));
    });
    return most;
}

// Gradient and Hessian by the coefficients of interval i: the duration, the barriers of rows and bounds.
BarrierTerms JerkWindow::add_terms(size_t i, double weight) const {
    BarrierTerms terms = terms_[i];
    const Squares& x = x_[i];
    for (int k = 0; k < 3; ++k) {
        const double t = gauss_at[k], value = value_at(x, t), share = weight * length(i) * gauss_weight[k];
        const double w[3] = {(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t};
        const double slope = -0.5 * share / (value * std::sqrt(value)), bend = -1.5 * slope / value;
        for (int a = 0, at = 0; a < 3; ++a) {
            terms.gradient[a] += slope * w[a];
            for (int b = a; b < 3; ++b) terms.hessian[at++] += bend * w[a] * w[b];
        }
    }
    constexpr int diagonal[3] = {0, 3, 5};
    for (int a = 0; a < 3; ++a) {
        const double above = 1.0 / (largest_[i] - x.at[a]), below = 1.0 / x.at[a];
        terms.gradient[a] += above - below;
        terms.hessian[diagonal[a]] += above * above + below * below;
    }
    return terms;
}

// One step of Newton's method; false where rounding leaves none.
bool JerkWindow::step(double weight, double& decrement) {
    over_parts([&](size_t begin, size_t end) {
        kernels::sum_all_barriers(path_, begin, end, rows_.data(), x_.data(), tangents_.data(),
                                  terms_.data());
    });
    Pentadiagonal hessian(count_);
    std::vector<double> gradient(count_, 0.0);
    for (size_t i = 0; i < count_; ++i) add_interval(i, add_terms(i, weight), gradient, hessian);
    const auto bound = [&](size_t i, const SectionEnd& end) {
        const double inverse = 1.0 / (end.largest - middle(i));
        gradient[i] += inverse;
        hessian.at(i, 0) += inverse * inverse;
    };
    const auto hold = [&](size_t i) {  // the motion beside it stays
        gradient[i] = 0.0;
        for (size_t left = 0; left < 3; ++left) {
            if (i >= left) hessian.at(i, left) = 0.0;
            if (i + left < count_) hessian.at(i + left, left) = 0.0;
        }
        hessian.at(i, 0) = 1.0;
    };
    is_start() ? bound(0, section_.start) : hold(0);
    is_end() ? bound(count_ - 1, section_.end) : hold(count_ - 1);
    std::vector<double> direction;
    if (!solve_by_ridge(hessian, gradient, direction)) return false;
    decrement = 0.0;
    for (size_t i = 0; i < count_; ++i) {
        decrement += direction[i] * gradient[i];
        direction[i] = -direction[i];
    }
    const auto change = [&](size_t i) {
        return i < begin_ || i >= begin_ + count_ ? 0.0 : direction[i - begin_];
    };
    for (size_t i = 0; i < count_; ++i) change_[i] = section_.spread(begin_ + i, change);
    const double length = std::min(1.0, to_boundary * longest_step(direction));
    if (!(length > 0.0)) return false;
    for (size_t i = 0; i < count_; ++i) section_.middle[begin_ + i] += length * direction[i];
    spread_middle();
    move_tangents();
    return true;
}

// From the coefficients of an interval to the middle ones that they are made of.
void JerkWindow::add_interval(size_t i, const BarrierTerms& terms, std::vector<double>& gradient,
                              Pentadiagonal& hessian) const {
    double map[3][3] = {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}};  // coefficient by middle i − 1, i, i + 1
    const size_t own = begin_ + i;
    if (own == 0) {
        map[0][1] = section_.start.ratio;
    } else {
        map[0][1] = section_.share(own - 1);
        map[0][0] = 1.0 - map[0][1];
    }
    if (own + 1 == section_.size()) {
        map[2][1] = section_.end.ratio;
    } else {
        map[2][2] = section_.share(own);
        map[2][1] = 1.0 - map[2][2];
    }
    const double* h = terms.hessian;
    const double full[3][3] = {{h[0], h[1], h[2]}, {h[1], h[3], h[4]}, {h[2], h[4], h[5]}};
    for (size_t a = 0; a < 3; ++a) {
        if (i + a < 1 || i + a > count_) continue;
        const size_t row = i + a - 1;
        for (size_t k = 0; k < 3; ++k) gradient[row] += map[k][a] * terms.gradient[k];
        for (size_t b = 0; b <= a; ++b) {
            if (i + b < 1) continue;
            double value = 0.0;
            for (size_t k = 0; k < 3; ++k)
                for (size_t l = 0; l < 3; ++l) value += map[k][a] * full[k][l] * map[l][b];
            hessian.at(row, a - b) += value;
        }
    }
}

// The tangent of every interval at the place, of a few, that leaves the jerks the most room.
void JerkWindow::move_tangents() {
    over_parts([&](size_t begin, size_t end) {
        kernels::bound_all_jerks(path_, begin, end, rows_.data(), x_.data(), jerks_.data());
    });
    for (size_t i = 0; i < count_; ++i) {
        const auto [least, most] = std::minmax({x_[i].at[0], x_[i].at[1], x_[i].at[2]});
        double best = touched(i), room = measure_room(i, best);
        for (const double at :
             {value_at(x_[i], 0.5), x_[i].at[0], x_[i].at[1], x_[i].at[2], 0.75 * least + 0.25 * most}) {
            const double own = measure_room(i, at);
            if (own > room) best = at, room = own;
        }
        touched(i) = best;
        tangents_[i] = tangent_at(best);
    }
}
// What the tangent at a place leaves of the limits of jerk.
double JerkWindow::measure_room(size_t i, double at) const {
    const Tangent tangent = tangent_at(at);
    const int m = path_.degree;
    double room = no_end;
    for (int k = 0; k <= m; ++k) {
        const double value = m == 2 ? raise<2>(k, x_[i]) : raise<4>(k, x_[i]);
        room = std::min(room, tangent.level - tangent.slope * value - jerks_[i * size_t(m + 1) + size_t(k)]);
    }
    return room;
}

}  // namespace cspace::trajectory
