#include "trajectory_jerk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cspace/math/banded.hpp"
#include "cspace/math/interrupts.hpp"
#include "kernels/trajectory_jerk.hpp"
#include "trajectory_aligned.hpp"

namespace cspace::trajectory {
namespace {

using std::size_t;

constexpr size_t intervals_between_polls = 512;
constexpr double slower = 1.5;       // factor from one trial of a first motion to the next
constexpr int most_trials = 60;      // of first motions: ten orders of magnitude
constexpr double first_gap = 0.1;    // of the duration: the gap of the first barrier
constexpr double sharper = 8.0;      // factor from one barrier to the next
constexpr double to_boundary = 0.9;  // of the longest step
constexpr double centered = 0.5;     // squared Newton decrement at which a barrier is sharpened
constexpr double settled = 3e-4;     // relative change of the duration, likewise
constexpr int most_steps = 400;      // of Newton's method in all
constexpr std::array<double, 3> gauss_at = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> gauss_weight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

// x(s) = C s^(4/3) of the motion s = jerk t³ / 6.
double launch_factor(double jerk) { return 0.25 * jerk * jerk * std::pow(6.0 / jerk, 4.0 / 3.0); }

// Log-barrier method for the middle coefficients of the squared speed.
class JerkTimer {
  public:
    JerkTimer(const TimingPath& path, const TimingLimits& limits, std::span<const double> jerk,
              const TimingGrid& grid, const JerkOptions& options, const TimingSamples& samples)
        : options_(options),
          count_(grid.size()),
          padded_(padded_joints(path.joints)),
          samples_(pad_samples(samples, path.joints, padded_)),
          slopes_(find_slopes(path, slope_degree(path), padded_)),
          velocity_(invert_limits(limits.velocity, padded_)),
          acceleration_(invert_limits(limits.acceleration, padded_)),
          jerk_(invert_limits(jerk, padded_)) {
        path_ = {slope_degree(path),   padded_,      slopes_.data(), path.lengths.data(),   velocity_.data(),
                 acceleration_.data(), jerk_.data(), grid.view(),    show_samples(samples_)};
        for (size_t i = 0; i < count_; ++i) length_.push_back(path_.length(i));
        rows_ = Aligned(count_ * path_.row_size());
        largest_.resize(count_);
        x_.resize(count_);
        change_.resize(count_);
        tangents_.resize(count_);
        touched_.resize(count_);
        terms_.resize(count_);
        jerks_.resize(count_ * size_t(path_.degree + 1));
        over_parts([&](size_t begin, size_t end) {
            kernels::build_all_jerk_rows(path_, begin, end, rows_.data(), largest_.data());
        });
        start_ = find_end(options.start, length_.front());
        end_ = find_end(options.end, length_.back());
    }

    JerkTiming solve() {
        JerkTiming timing{false, {}, 0.0, 0.0, 0.0, 0};
        if (!find_first_motion()) return timing;
        const double own = 2.0 / 3.0 * double(path_.own_rows());
        const double sampled = 0.5 * double(path_.torque_rows() + path_.speed_rows());
        const double rows = double(count_) * (own + sampled + 6.0) + 2.0;
        double weight = rows / (first_gap * seconds()), last = seconds();
        for (; timing.steps < most_steps; ++timing.steps) {
            double decrement;
            if (!step(weight, decrement)) break;
            const double now = seconds();
            const bool still = std::fabs(now - last) < settled * now;
            last = now;
            if (decrement > centered || !still) continue;
            if (rows / weight < options_.tolerance * now) break;
            weight *= sharper;
        }
        timing.found = true;
        for (const Squares& each : x_) timing.squares.insert(timing.squares.end(), each.at, each.at + 3);
        timing.start_jerk = options_.start.jerk * std::pow(middle_.front() / start_.largest, 1.5);
        timing.end_jerk = options_.end.jerk * std::pow(middle_.back() / end_.largest, 1.5);
        timing.duration = last + std::cbrt(6.0 * options_.start.length / timing.start_jerk) +
                          std::cbrt(6.0 * options_.end.length / timing.end_jerk);
        return timing;
    }

  private:
    // The squared speed at an end of the grid in terms of the middle coefficient beside it, and the largest
    // one.
    struct End {
        double ratio, largest;
    };

    template <class Visit>
    void over_parts(const Visit& visit) const {
        for (size_t begin = 0; begin < count_; begin += intervals_between_polls) {
            visit(begin, std::min(count_, begin + intervals_between_polls));
            poll_interrupts();
        }
    }

    // x = C s^(4/3) and x' = (4/3) C s^(1/3) at the end of the launch; the middle coefficient is x + x' D
    // / 2.
    static End find_end(const Launch& launch, double length) {
        const double x = std::pow(launch.length, 4.0 / 3.0);
        const double middle = x + (2.0 / 3.0) * std::cbrt(launch.length) * length;
        return {x / middle, launch_factor(launch.jerk) * middle};
    }

    // The coefficients of every interval from the middle ones; linear.
    void spread(const std::vector<double>& middle, std::vector<Squares>& x) const {
        for (size_t i = 0; i < count_; ++i) {
            x[i].at[1] = middle[i];
            if (i + 1 == count_) break;
            const double share = length_[i] / (length_[i] + length_[i + 1]);
            x[i].at[2] = x[i + 1].at[0] = middle[i] + share * (middle[i + 1] - middle[i]);
        }
        x.front().at[0] = start_.ratio * middle.front();
        x.back().at[2] = end_.ratio * middle.back();
    }

    double seconds() const {
        double sum = 0.0;
        for (size_t i = 0; i < count_; ++i)
            for (int k = 0; k < 3; ++k)
                sum += length_[i] * gauss_weight[k] / std::sqrt(value_at(x_[i], gauss_at[k]));
        return sum;
    }
    static double value_at(const Squares& x, double t) {
        return (1.0 - t) * (1.0 - t) * x.at[0] + 2.0 * t * (1.0 - t) * x.at[1] + t * t * x.at[2];
    }

    void touch(size_t i, double at) {
        touched_[i] = at;
        tangents_[i] = tangent_at(at);
    }

    // Motions of the law s = r³(10 − 15r + 6r²), ever slower, until one keeps all limits.
    bool find_first_motion() {
        double whole = options_.start.length + options_.end.length;
        for (const double each : length_) whole += each;
        middle_.resize(count_);
        std::vector<double> shape(count_);
        double s = options_.start.length, r = 0.0;
        for (size_t i = 0; i < count_; ++i) {
            const double share = (s + 0.5 * length_[i]) / whole;
            double low = r, high = 1.0;
            for (int k = 0; k < 60; ++k) {
                const double mid = 0.5 * (low + high);
                (mid * mid * mid * (10.0 - mid * (15.0 - 6.0 * mid)) < share ? low : high) = mid;
            }
            r = low;
            const double speed = 30.0 * r * r * (1.0 - r) * (1.0 - r) * whole;
            shape[i] = speed * speed;
            s += length_[i];
        }
        double duration = options_.duration;
        for (int trial = 0; trial < most_trials; ++trial, duration *= slower) {
            for (size_t i = 0; i < count_; ++i) middle_[i] = shape[i] / (duration * duration);
            spread(middle_, x_);
            for (size_t i = 0; i < count_; ++i) touch(i, value_at(x_[i], 0.5));
            std::fill(change_.begin(), change_.end(), Squares{});
            if (longest_step(std::vector<double>(count_, 0.0)) > 0.0) return true;
        }
        return false;
    }

    // Until a limit or a bound of the squared speeds is reached; 0 if one is exceeded already.
    double longest_step(const std::vector<double>& direction) const {
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
        within(start_.largest - middle_.front(), direction.front());
        within(end_.largest - middle_.back(), direction.back());
        if (most == 0.0) return 0.0;
        over_parts([&](size_t begin, size_t end) {
            most = std::min(most, kernels::bound_all_steps(path_, begin, end, rows_.data(), x_.data(),
                                                           change_.data(), tangents_.data()));
        });
        return most;
    }

    // Gradient and Hessian by the coefficients of interval i: the duration, the barriers of rows and bounds.
    BarrierTerms add_terms(size_t i, double weight) const {
        BarrierTerms terms = terms_[i];
        const Squares& x = x_[i];
        for (int k = 0; k < 3; ++k) {
            const double t = gauss_at[k], value = value_at(x, t),
                         share = weight * length_[i] * gauss_weight[k];
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
    bool step(double weight, double& decrement) {
        over_parts([&](size_t begin, size_t end) {
            kernels::sum_all_barriers(path_, begin, end, rows_.data(), x_.data(), tangents_.data(),
                                      terms_.data());
        });
        Pentadiagonal hessian(count_);
        std::vector<double> gradient(count_, 0.0);
        for (size_t i = 0; i < count_; ++i) add_interval(i, add_terms(i, weight), gradient, hessian);
        const auto bound = [&](size_t i, double largest) {
            const double inverse = 1.0 / (largest - middle_[i]);
            gradient[i] += inverse;
            hessian.at(i, 0) += inverse * inverse;
        };
        bound(0, start_.largest);
        bound(count_ - 1, end_.largest);
        std::vector<double> direction = gradient;
        if (!hessian.solve(direction)) return false;
        decrement = 0.0;
        for (size_t i = 0; i < count_; ++i) {
            decrement += direction[i] * gradient[i];
            direction[i] = -direction[i];
        }
        spread(direction, change_);
        const double length = std::min(1.0, to_boundary * longest_step(direction));
        if (!(length > 0.0)) return false;
        for (size_t i = 0; i < count_; ++i) middle_[i] += length * direction[i];
        spread(middle_, x_);
        move_tangents();
        return true;
    }

    // From the coefficients of an interval to the middle ones that they are made of.
    void add_interval(size_t i, const BarrierTerms& terms, std::vector<double>& gradient,
                      Pentadiagonal& hessian) const {
        double map[3][3] = {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}};  // coefficient by middle i − 1, i, i + 1
        if (i == 0) {
            map[0][1] = start_.ratio;
        } else {
            map[0][1] = length_[i - 1] / (length_[i - 1] + length_[i]);
            map[0][0] = 1.0 - map[0][1];
        }
        if (i + 1 == count_) {
            map[2][1] = end_.ratio;
        } else {
            map[2][2] = length_[i] / (length_[i] + length_[i + 1]);
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
    void move_tangents() {
        over_parts([&](size_t begin, size_t end) {
            kernels::bound_all_jerks(path_, begin, end, rows_.data(), x_.data(), jerks_.data());
        });
        for (size_t i = 0; i < count_; ++i) {
            const auto [least, most] = std::minmax({x_[i].at[0], x_[i].at[1], x_[i].at[2]});
            double best = touched_[i], room = measure_room(i, touched_[i]);
            for (const double at :
                 {value_at(x_[i], 0.5), x_[i].at[0], x_[i].at[1], x_[i].at[2], 0.75 * least + 0.25 * most}) {
                const double own = measure_room(i, at);
                if (own > room) best = at, room = own;
            }
            touch(i, best);
        }
    }
    // What the tangent at a place leaves of the limits of jerk.
    double measure_room(size_t i, double at) const {
        const Tangent tangent = tangent_at(at);
        const int m = path_.degree;
        double room = no_end;
        for (int k = 0; k <= m; ++k) {
            const double value = m == 2 ? raise<2>(k, x_[i]) : raise<4>(k, x_[i]);
            room =
                std::min(room, tangent.level - tangent.slope * value - jerks_[i * size_t(m + 1) + size_t(k)]);
        }
        return room;
    }
    template <int m>
    static double raise(int k, const Squares& x) {
        static constexpr RaisedWeights<m> weights;
        return weights.at[k][0] * x.at[0] + weights.at[k][1] * x.at[1] + weights.at[k][2] * x.at[2];
    }

    JerkOptions options_;
    size_t count_;
    int padded_;
    TimingSamples samples_;
    Aligned slopes_, rows_{0};
    std::vector<double> velocity_, acceleration_, jerk_, length_, largest_, middle_, touched_, jerks_;
    JerkPath path_{};
    std::vector<Squares> x_, change_;
    std::vector<Tangent> tangents_;
    std::vector<BarrierTerms> terms_;
    End start_{}, end_{};
};

}  // namespace

JerkTiming time_path_with_jerk(const TimingPath& path, const TimingLimits& limits,
                               std::span<const double> jerk, const TimingGrid& grid,
                               const JerkOptions& options, const TimingSamples& samples) {
    return JerkTimer(path, limits, jerk, grid, options, samples).solve();
}

}  // namespace cspace::trajectory
