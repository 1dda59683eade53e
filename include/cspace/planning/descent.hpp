// Descent of a potential over the joints, step by step, until it arrives or rests; where it rests is named.
//
// A step is −(λ I + H)⁻¹ g, with H what is positive in the second derivative: across a stiff valley it goes
// to the bottom and no farther. λ bounds its length (Moré & Sorensen 1983, "Computing a trust region step").
// Joints at their limits that are pushed outwards stay there. Where the slope jumps, the step goes down the
// least slope between those around (Burke, Lewis & Overton 2005, "A robust gradient sampling algorithm for
// nonsmooth, nonconvex optimization"). A rest is a minimum if all eigenvalues of the second derivative, by
// differences of slopes, are positive.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cspace/math/linear.hpp"
#include "cspace/math/symmetric_eigen.hpp"

namespace cspace::planning {

// The potential at a configuration: its slope (n) and what is positive in its second derivative (n × n).
struct FieldLook {
    double value = 0;
    std::vector<double> slope, stiffness;
};

enum class Rest { goal, minimum, saddle, crease, wall, budget, time };

struct Descent {
    Rest rest = Rest::budget;
    int goal = -1;                     // that was reached
    std::vector<double> rows, values;  // the configurations (m, n) and their potentials
    double force = 0;                  // that remains
    int saddles = 0;                   // that the descent left again
    std::int64_t looks = 0;            // evaluations of the potential
};

// A field offers
//   width(), lower(k), upper(k)      bounds of the coordinates, infinite where there are none
//   look(q)                          a FieldLook and what free_share needs
//   free_share(look, step)           the share of a step, at most 1, over which nothing moves by more than
//   half
//                                    of its clearance
//   find_goal(q, to)                 the nearest goal, written to `to` at the turn nearest to q
//   is_free(a, b), has_time()
template <class Field>
class JointDescent {
  public:
    using Row = std::vector<double>;
    using Look = typename Field::Look;

    // longest: of the steps; from so near the goal is approached in a straight line.
    JointDescent(Field& field, double longest, std::int64_t budget)
        : field_(field), n_(field.width()), longest_(longest), step_(longest), budget_(budget) {}

    Descent run(const double* start) {
        at_.assign(start, start + n_);
        here_ = look(at_);
        append_row();
        while (descent_.looks < budget_) {
            if (!field_.has_time()) return finish(Rest::time);
            if (arrives()) return finish(Rest::goal);
            Rest rest = Rest::wall;
            if (!descend() && !leave_rest(rest)) return finish(rest);
        }
        return finish(Rest::budget);
    }

    static constexpr double least_step = 1e-10;  // [rad, m]: shorter steps go nowhere

  private:
    static constexpr double rounding = 1e-13;      // of the potential: a gain that rounding may have made
    static constexpr double clear_gain = 1e-12;    // of the potential: a gain that leaves a saddle
    static constexpr double promise = 0.1;         // share of what the slope promises that a step must keep
    static constexpr double nearby = 4;            // steps: farther slopes say nothing of a crease here
    static constexpr std::size_t most_recent = 8;  // trials whose slopes are kept
    static constexpr double difference = 1e-3;     // of the way to half the clearance: for second derivatives
    static constexpr double closer = 0.125;        // how much closer slopes are compared to find a jump
    static constexpr double flat = 1e-7;           // of the largest curvature: differences find no sign below
    static constexpr double at_rest = 1e-4;     // [rad, m]: from a bottom that is farther the descent goes on
    static constexpr double stationary = 1e-6;  // of the slopes around a crease: their least one
    static constexpr double crease_force = 1e-2;  // of the slopes around: more is no rest
    static constexpr double neighbourhoods[] = {1e-3, 1e-4, 1e-5, 1e-6};  // of a crease, as the difference
    static constexpr double radii[] = {1e-3, 1e-2, 1e-1, 1};              // of the way to half the clearance

    Field& field_;
    const std::size_t n_;
    const double longest_;
    double step_;
    bool is_blocked_ = false;  // the last step down is not free
    const std::int64_t budget_;
    Descent descent_;
    Row at_;
    Look here_;
    struct Trial {
        Row at, slope;
    };
    std::vector<Trial> recent_;
    std::vector<std::size_t> open_;  // coordinates that no limit holds
    Row matrix_;
    std::vector<double*> rows_;  // of the matrix

    Look look(const Row& q) {
        ++descent_.looks;
        return field_.look(q.data());
    }
    void append_row() {
        descent_.rows.insert(descent_.rows.end(), at_.begin(), at_.end());
        descent_.values.push_back(here_.value);
    }
    void go(Row to, Look seen) {
        at_ = std::move(to);
        here_ = std::move(seen);
        append_row();
    }
    double noise() const { return rounding * std::fabs(here_.value); }
    Row shifted(const Row& direction, double by) const {
        Row to = at_;
        for (std::size_t k = 0; k < n_; ++k)
            to[k] = std::clamp(at_[k] + by * direction[k], field_.lower(k), field_.upper(k));
        return to;
    }
    static double dot(const Row& a, const Row& b) {
        double sum = 0;
        for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
        return sum;
    }
    static double norm(const Row& a) { return std::sqrt(dot(a, a)); }
    Row unit(std::size_t k) const {
        Row e(n_, 0.0);
        e[k] = 1;
        return e;
    }

    bool arrives() {
        Row to(n_);
        const int goal = field_.find_goal(at_.data(), to.data());
        double square = 0;
        for (std::size_t k = 0; k < n_; ++k) square += (to[k] - at_[k]) * (to[k] - at_[k]);
        if (square > longest_ * longest_ || !field_.is_free(at_.data(), to.data())) return false;
        descent_.goal = goal;
        if (square > 0) go(to, look(to));
        return true;
    }

    void find_open() {
        open_.clear();
        for (std::size_t k = 0; k < n_; ++k) {
            const double g = here_.slope[k];
            const bool is_held = (g > 0 && at_[k] <= field_.lower(k)) || (g < 0 && at_[k] >= field_.upper(k));
            if (!is_held) open_.push_back(k);
        }
    }
    double open_force() const {
        double square = 0;
        for (const std::size_t k : open_) square += here_.slope[k] * here_.slope[k];
        return std::sqrt(square);
    }

    // A step down that lowers the potential by a tenth of what the slope promises. Where slopes nearby oppose
    // the one here, which happens across a crease, the step goes down the least one between them.
    bool descend() {
        find_open();
        is_blocked_ = false;
        for (;; step_ *= 0.5) {
            if (!(step_ > least_step)) return false;
            const std::vector<Row> slopes = list_opposed();
            const bool is_smooth = slopes.size() == 1;
            const Row step = is_smooth ? damped_step(step_) : step_between(slopes);
            const double share = field_.free_share(here_, step.data()), length = share * norm(step);
            Row to = shifted(step, share);
            const double promised = -dot(here_.slope, difference_to(to));
            if (is_smooth && (!(length > least_step) || !(promised > noise()))) return false;
            if (length > 0) step_ = std::min(step_, length);
            if (!(promised > noise())) continue;
            Look seen = look(to);
            recent_.push_back({to, open_part(seen.slope)});
            if (recent_.size() > most_recent) recent_.erase(recent_.begin());
            if (!(seen.value <= here_.value - promise * promised)) continue;
            is_blocked_ = !field_.is_free(at_.data(), to.data());
            if (is_blocked_) continue;
            recent_.push_back({at_, open_part(here_.slope)});
            go(std::move(to), std::move(seen));
            step_ = std::min(2 * step_, longest_);
            return true;
        }
    }
    // The slope here, and those of the last trials nearby that point the other way.
    std::vector<Row> list_opposed() const {
        std::vector<Row> slopes = {open_part(here_.slope)};
        for (const Trial& each : recent_)
            if (dot(each.slope, slopes[0]) < 0 && norm(difference_to(each.at)) <= nearby * step_)
                slopes.push_back(each.slope);
        return slopes;
    }
    Row step_between(const std::vector<Row>& slopes) const {
        Row step = least_between(slopes);
        const double size = norm(step);
        for (double& x : step) x *= size > 0 ? -step_ / size : 0;
        return step;
    }

    Row damped_step(double longest) {
        constexpr int most_rounds = 20;
        constexpr double loose = 1e-3;        // of the length: the step is cut to it in the end
        constexpr double singular = 1e-12;    // of the trace: what rounding makes of a zero pivot
        constexpr double first_share = 1e-3;  // of the damping with which the slope alone bounds the step
        const std::size_t m = open_.size();
        Row step(n_, 0.0), x(m), bent(m);
        if (m == 0) return step;
        double trace = 0;
        for (const std::size_t k : open_) trace += here_.stiffness[k * n_ + k];
        const double first = open_force() / longest;
        double damping = 0, size = 0;
        for (int round = 0; round < most_rounds; ++round) {
            double** matrix = fill_matrix(damping);
            if (!factor_ldl(matrix, int(m), singular * trace)) {
                damping = std::max(10 * damping, first_share * first + 10 * singular * trace);
                continue;
            }
            for (std::size_t i = 0; i < m; ++i) x[i] = -here_.slope[open_[i]];
            solve_ldl(matrix, int(m), x.data());
            size = norm(x);
            if (!(size > longest * (1 + loose))) break;
            bent = x;
            solve_ldl(matrix, int(m), bent.data());
            damping += (size / longest - 1) * size * size / dot(x, bent);
        }
        const double cut = size > longest ? longest / size : 1;
        for (std::size_t i = 0; i < m; ++i) step[open_[i]] = cut * x[i];
        return step;
    }
    // Its rows.
    double** fill_matrix(double damping) {
        const std::size_t m = open_.size();
        matrix_.resize(m * m), rows_.resize(m);
        for (std::size_t i = 0; i < m; ++i) {
            rows_[i] = &matrix_[i * m];
            for (std::size_t j = 0; j < m; ++j)
                rows_[i][j] = here_.stiffness[open_[i] * n_ + open_[j]] + (i == j ? damping : 0.0);
        }
        return rows_.data();
    }

    // On from a place where no step leads down the slope: along a crease, or off a saddle. Else what it is.
    bool leave_rest(Rest& rest) {
        if (open_.empty()) return rest = Rest::minimum, false;
        if (is_blocked_) return rest = Rest::wall, false;
        Row hessian(open_.size() * open_.size());
        double jump = 0, closer_jump = 0;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            const Row e = unit(open_[i]);
            const double h = difference * field_.free_share(here_, e.data());
            if (!(h > 0)) return rest = Rest::wall, false;
            const Row far = slope_difference(e, h), near = slope_difference(e, closer * h);
            jump = std::max(jump, norm(far)), closer_jump = std::max(closer_jump, norm(near));
            for (std::size_t j = 0; j < open_.size(); ++j)
                hessian[i * open_.size() + j] = far[open_[j]] / (2 * h);
        }
        if (closer_jump > 0.5 * jump) return leave_crease(rest);
        return leave_saddle(std::move(hessian), rest);
    }
    Row slope_difference(const Row& direction, double h) {
        Row to = at_, back = at_;
        for (std::size_t k = 0; k < n_; ++k) to[k] += h * direction[k], back[k] -= h * direction[k];
        Row difference = look(to).slope;
        const Row other = look(back).slope;
        for (std::size_t k = 0; k < n_; ++k) difference[k] -= other[k];
        return difference;
    }

    bool leave_saddle(Row hessian, Rest& rest) {
        const std::size_t m = open_.size();
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = 0; j < i; ++j)
                hessian[i * m + j] = hessian[j * m + i] = 0.5 * (hessian[i * m + j] + hessian[j * m + i]);
        const SymmetricEigen eigen = decompose_symmetric(std::move(hessian), m);
        double largest = 0, left = 0;
        for (const double value : eigen.values) largest = std::max(largest, std::fabs(value));
        bool is_minimum = true;
        for (std::size_t i = 0; i < m; ++i) {
            const bool is_positive = eigen.values[i] > flat * largest;
            is_minimum = is_minimum && is_positive;
            Row along(n_, 0.0);
            double part = 0;
            for (std::size_t j = 0; j < m; ++j) {
                along[open_[j]] = eigen.vectors[i * m + j];
                part += eigen.vectors[i * m + j] * here_.slope[open_[j]];
            }
            if (!is_positive && fall_along(along)) return true;
            if (is_positive) left += (part / eigen.values[i]) * (part / eigen.values[i]);
        }
        rest = !is_minimum ? Rest::saddle : std::sqrt(left) > at_rest ? Rest::wall : Rest::minimum;
        return false;
    }
    // Down along a direction or against it, where the slope vanishes.
    bool fall_along(const Row& direction) {
        const double reach = field_.free_share(here_, direction.data());
        for (const double share : radii)
            for (const double sign : {1.0, -1.0})
                if (try_lower(shifted(direction, sign * share * reach))) return ++descent_.saddles, true;
        return false;
    }
    bool try_lower(Row to) {
        Look seen = look(to);
        if (!(seen.value < here_.value - clear_gain * std::fabs(here_.value)) ||
            !field_.is_free(at_.data(), to.data()))
            return false;
        step_ = longest_;
        go(std::move(to), std::move(seen));
        return true;
    }

    // Down the least of all slopes between those around, which leads along the crease. Those of a smaller
    // neighbourhood describe it better, those of a larger one see more of it.
    bool leave_crease(Rest& rest) {
        double share = 0;
        for (const double radius : neighbourhoods) {
            const std::vector<Row> slopes = list_slopes(radius);
            const Row least = least_between(slopes);
            const double size = norm(least), largest = norm(*std::max_element(slopes.begin(), slopes.end(),
                                                                              [](const Row& a, const Row& b) {
                                                                                  return norm(a) < norm(b);
                                                                              }));
            if (radius == neighbourhoods[0]) share = size / largest;
            if (size > stationary * largest && descend_along(least, size)) return true;
        }
        for (const std::size_t k : open_)
            if (fall_along(unit(k))) return true;
        rest = share > crease_force ? Rest::wall : Rest::crease;
        return false;
    }
    // Of this place, and on both sides of it along each open coordinate.
    std::vector<Row> list_slopes(double radius) {
        std::vector<Row> slopes = {open_part(here_.slope)};
        for (const std::size_t k : open_) {
            const Row e = unit(k);
            const double h = radius * field_.free_share(here_, e.data());
            for (const double sign : {1.0, -1.0})
                slopes.push_back(open_part(look(shifted(e, sign * h)).slope));
        }
        return slopes;
    }
    // A step against a slope of this size that lowers the potential by a tenth of what the slope promises.
    bool descend_along(const Row& slope, double size) {
        for (double length = longest_; length > least_step; length *= 0.5) {
            Row to = shifted(slope, -length / size);
            if (field_.free_share(here_, difference_to(to).data()) < 1) continue;
            Look seen = look(to);
            if (!(seen.value < here_.value - promise * length * size) ||
                !field_.is_free(at_.data(), to.data()))
                continue;
            go(std::move(to), std::move(seen));
            return true;
        }
        return false;
    }
    Row open_part(const Row& slope) const {
        Row part(n_, 0.0);
        for (const std::size_t k : open_) part[k] = slope[k];
        return part;
    }
    Row difference_to(const Row& to) const {
        Row step = to;
        for (std::size_t k = 0; k < n_; ++k) step[k] -= at_[k];
        return step;
    }
    // The point nearest to zero of the convex hull of points: weight goes from the point that lies farthest
    // along the sum to the one that lies least far, until that gains nothing.
    static Row least_between(const std::vector<Row>& points) {
        constexpr int most_rounds = 1000;
        std::vector<double> weights(points.size(), 0.0);
        weights[0] = 1;
        Row sum = points[0];
        for (int round = 0; round < most_rounds; ++round) {
            std::size_t from = 0, to = 0;
            double most = -std::numeric_limits<double>::infinity(), least = -most;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double along = dot(points[i], sum);
                if (weights[i] > 0 && along > most) most = along, from = i;
                if (along < least) least = along, to = i;
            }
            Row shift = points[to];
            for (std::size_t k = 0; k < shift.size(); ++k) shift[k] -= points[from][k];
            const double square = dot(shift, shift);
            if (!(most - least > rounding * dot(sum, sum)) || !(square > 0)) break;
            const double moved = std::min(weights[from], (most - least) / square);
            weights[from] -= moved, weights[to] += moved;
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += moved * shift[k];
        }
        return sum;
    }

    Descent finish(Rest rest) {
        find_open();
        descent_.rest = rest;
        descent_.force = open_force();
        return std::move(descent_);
    }
};

}  // namespace cspace::planning
