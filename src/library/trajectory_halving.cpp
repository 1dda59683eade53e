#include "trajectory_halving.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
    Gains(GridMotion before, const std::vector<double>& squared_speed, const std::vector<double>& seconds,
          const std::vector<std::uint32_t>& parent)
        : change_(std::move(before.squared_speed)), weight_(std::move(before.seconds)), gained_(weight_) {
        for (size_t i = 0; i < weight_.size(); ++i) {
            const double sum = change_[i] + change_[i + 1];
            weight_[i] = sum > 0.0 ? 0.5 * weight_[i] / sum : 0.0;
        }
        visit_range(0, parent.size(), [&](size_t i) {
            gained_[parent[i]] -= seconds[i];
            if (i == 0 || parent[i] != parent[i - 1])
                change_[parent[i]] = squared_speed[i] - change_[parent[i]];
        });
        change_.back() = squared_speed.back() - change_.back();
    }

    // Of every interval: an interval that is passed faster raises the speeds after it, or before it where the
    // motion brakes, up to where another limit binds.
    std::vector<double> find() && {
        const size_t count = gained_.size();
        std::vector<double> ahead(count + 1, 0.0);
        for (size_t i = count; i-- > 0;)
            ahead[i] = weight_[i] + surviving(change_[i + 1], change_[i]) * (weight_[i] + ahead[i + 1]);
        double behind = 0.0;
        for (size_t i = 0; i < count; ++i) {
            if (i > 0)
                behind = weight_[i - 1] + surviving(change_[i - 1], change_[i]) * (weight_[i - 1] + behind);
            const double rise = change_[i + 1] - change_[i];
            const double inside = gained_[i] - weight_[i] * (change_[i] + change_[i + 1]);
            gained_[i] = std::fabs(inside) +
                         (rise > 0.0 ? rise * (weight_[i] + ahead[i + 1]) : -rise * (weight_[i] + behind));
        }
        return std::move(gained_);
    }

  private:
    std::vector<double> change_;  // of the squared speeds
    std::vector<double> weight_;  // seconds of an interval by the squared speed at one of its ends
    std::vector<double> gained_;  // seconds of an interval
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

std::vector<double> estimate_losses(GridMotion before, const std::vector<double>& squared_speed,
                                    const std::vector<double>& seconds,
                                    const std::vector<std::uint32_t>& parent,
                                    const std::vector<double>& losses) {
    const std::vector<double> gains = Gains(std::move(before), squared_speed, seconds, parent).find();
    std::vector<double> made(parent.size());
    over_parts(parent, [&](size_t part, size_t whole, bool is_half) {
        if (is_half)
            made[part] = left_over(squared_speed[part], squared_speed[part + 1]) * gains[whole];
        else
            made[part] = std::max(losses.empty() ? 0.0 : losses[whole], carried_over * gains[whole]);
    });
    return made;
}

}  // namespace cspace::trajectory
