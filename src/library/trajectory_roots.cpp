#include "trajectory_roots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace::trajectory {

namespace {

constexpr int most_bisections = 100;              // bisection alone needs half of them
constexpr std::size_t rows_between_polls = 1024;  // less than a millisecond

struct Value {
    double value, slope;
};

Value evaluate(const double* c, std::size_t terms, double t) {
    Value e{c[terms - 1], 0.0};
    for (std::size_t i = terms - 1; i-- > 0;) {
        e.slope = e.slope * t + e.value;
        e.value = e.value * t + c[i];
    }
    return e;
}

// By Newton's method, by bisection where a step leaves the bracket. rises: from low to high.
double find_bracketed(const double* c, std::size_t terms, double low, double high, bool rises,
                      double converged) {
    double x = 0.5 * (low + high);
    for (int step = 0; step < most_bisections; ++step) {
        const Value e = evaluate(c, terms, x);
        if (e.value == 0.0) return x;
        ((e.value < 0.0) == rises ? low : high) = x;
        const double newton = x - e.value / e.slope;
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        const double moved = std::fabs(next - x);
        x = next;
        if (moved <= converged) return x;
    }
    return x;
}

// The roots of one polynomial on an interval of unit size. The roots of a derivative divide it into parts
// with at most one root each of the polynomial before it (Rolle).
class RootFinder {
  public:
    RootFinder(std::size_t terms, double converged)
        : terms_(terms), converged_(converged), derived_(terms), turns_(terms), found_(terms) {}

    // Their number; they are in roots().
    std::size_t find(const double* c, double begin, double end) {
        std::size_t count = 0;
        for (std::size_t terms = 2; terms <= terms_; ++terms) {
            derive(c, terms_ - terms);
            std::swap(turns_, found_);
            count = find_level(terms, begin, end, count);
        }
        return count;
    }
    const std::vector<double>& roots() const { return found_; }

  private:
    void derive(const double* c, std::size_t order) {
        for (std::size_t i = order; i < terms_; ++i) {
            double factor = 1.0;
            for (std::size_t k = 0; k < order; ++k) factor *= double(i - k);
            derived_[i - order] = factor * c[i];
        }
    }
    std::size_t find_level(std::size_t terms, double begin, double end, std::size_t turns) {
        std::size_t count = 0;
        const double* c = derived_.data();
        double low = begin, at_low = evaluate(c, terms, low).value;
        for (std::size_t k = 0; k <= turns; ++k) {
            const double high = k < turns ? turns_[k] : end, at_high = evaluate(c, terms, high).value;
            const auto add = [&](double root) {
                if (count < terms - 1 && (count == 0 || found_[count - 1] != root)) found_[count++] = root;
            };
            if (high > low) {
                if (at_low == 0.0) add(low);
                if (at_low * at_high < 0.0)
                    add(find_bracketed(c, terms, low, high, at_high > 0.0, converged_));
                if (at_high == 0.0) add(high);
            }
            low = high, at_low = at_high;
        }
        return count;
    }

    std::size_t terms_;
    double converged_;
    std::vector<double> derived_, turns_, found_;
};

}  // namespace

void find_roots(const double* coefficients, const double* begin, const double* end, std::size_t rows,
                std::size_t terms, double converged, double* roots) {
    RootFinder finder(terms, converged);
    std::vector<double> unit(terms);
    for (std::size_t row = 0; row < rows; ++row, roots += terms - 1) {
        if (row % rows_between_polls == 0) poll_interrupts();
        const double length = std::max(std::fabs(begin[row]), std::fabs(end[row]));
        const double scale = length > 0.0 ? length : 1.0;
        double power = 1.0;
        for (std::size_t i = 0; i < terms; ++i, power *= scale)
            unit[i] = coefficients[row * terms + i] * power;
        const std::size_t count = finder.find(unit.data(), begin[row] / scale, end[row] / scale);
        for (std::size_t k = 0; k + 1 < terms; ++k)
            roots[k] = k < count ? scale * finder.roots()[k] : std::numeric_limits<double>::quiet_NaN();
    }
}

}  // namespace cspace::trajectory
