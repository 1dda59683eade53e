#include "trajectory_halving.hpp"

#include <algorithm>
#include <cmath>

namespace cspace::trajectory {
namespace {

using std::size_t;

// Of what the halving of an interval gained, that one of its halves may still gain. Each loses by the third
// power of its length, or one of them by the second, so that both together gain a third. Where the speed
// nearly jumps, as from a stop to a limit of velocity, one of them loses by its length.
double left_over(double begin, double end) {
    const double a = std::sqrt(begin), b = std::sqrt(end);
    const double jump = a + b > 0.0 ? (b - a) / (a + b) : 1.0;
    return (1.0 + 5.0 * jump * jump) / 6.0;
}
// Of what it gained beside others, that an interval may still gain that was not halved itself.
constexpr double carried_over = 0.5;

// The share of a change at one place that is left at another.
double surviving(double there, double here) { return here * there > 0.0 ? std::min(1.0, there / here) : 0.0; }

// What halving gained in every interval of the grid before: by squared speeds at its ends that changed, or
// inside of it.
class Gains {
  public:
    Gains(const GridMotion& before, const GridMotion& now, const std::vector<std::uint32_t>& parent)
        : before_(before), change_(before.squared_speed.size()), seconds_(before.seconds) {
        visit_range(0, parent.size(), [&](size_t i) {
            seconds_[parent[i]] -= now.seconds[i];
            if (i == 0 || parent[i] != parent[i - 1])
                change_[parent[i]] = now.squared_speed[i] - before.squared_speed[parent[i]];
        });
        change_.back() = now.squared_speed.back() - before.squared_speed.back();
    }

    // Of every interval: an interval that is passed faster raises the speeds after it, or before it where the
    // motion brakes, up to where another limit binds.
    std::vector<double> find() const {
        const size_t count = seconds_.size();
        std::vector<double> gains(count), ahead(count + 1, 0.0);
        for (size_t i = count; i-- > 0;)
            ahead[i] = weight(i) + surviving(change_[i + 1], change_[i]) * (weight(i) + ahead[i + 1]);
        double behind = 0.0;
        for (size_t i = 0; i < count; ++i) {
            if (i > 0)
                behind = weight(i - 1) + surviving(change_[i - 1], change_[i]) * (weight(i - 1) + behind);
            const double rise = change_[i + 1] - change_[i];
            const double inside = seconds_[i] - weight(i) * (change_[i] + change_[i + 1]);
            gains[i] = std::fabs(inside) +
                       (rise > 0.0 ? rise * (weight(i) + ahead[i + 1]) : -rise * (weight(i) + behind));
        }
        return gains;
    }

  private:
    // Seconds of interval i by the squared speed at one of its ends.
    double weight(size_t i) const {
        const double sum = before_.squared_speed[i] + before_.squared_speed[i + 1];
        return sum > 0.0 ? 0.5 * before_.seconds[i] / sum : 0.0;
    }

    const GridMotion before_;
    std::vector<double> change_;   // of the squared speeds
    std::vector<double> seconds_;  // that the halving gains in every interval
};

// visit(part, its interval, whether that was halved).
template <class Visit>
void over_parts(const std::vector<std::uint32_t>& parent, const Visit& visit) {
    visit_range(0, parent.size(), [&](size_t i) {
        const bool is_half =
            (i > 0 && parent[i - 1] == parent[i]) || (i + 1 < parent.size() && parent[i + 1] == parent[i]);
        visit(i, parent[i], is_half);
    });
}

}  // namespace

std::vector<double> halve_rises(const std::vector<double>& rises, const std::vector<std::uint32_t>& parent) {
    std::vector<double> made(parent.size());
    over_parts(parent, [&](size_t part, size_t whole, bool is_half) {
        made[part] = (is_half ? 0.25 : 1.0) * rises[whole];
    });
    return made;
}

std::vector<double> estimate_losses(const GridMotion& before, const GridMotion& now,
                                    const std::vector<std::uint32_t>& parent,
                                    const std::vector<double>& losses) {
    const std::vector<double> gains = Gains(before, now, parent).find();
    std::vector<double> made(parent.size());
    over_parts(parent, [&](size_t part, size_t whole, bool is_half) {
        if (is_half)
            made[part] = left_over(now.squared_speed[part], now.squared_speed[part + 1]) * gains[whole];
        else
            made[part] = std::max(losses.empty() ? 0.0 : losses[whole], carried_over * gains[whole]);
    });
    return made;
}

}  // namespace cspace::trajectory
