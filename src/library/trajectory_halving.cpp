#include "trajectory_halving.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cspace::trajectory {
namespace {

using std::size_t;

// Of what the halving of an interval gained, that one of its halves may still gain. Both together gain a
// third to a half of it: each loses by the third power of its length, or one of them by the second. Where the
// speed nearly jumps, as from a stop to a limit of velocity, one of them loses by its length.
double left_over(double begin, double end) {
    const double a = std::sqrt(begin), b = std::sqrt(end);
    const double jump = a + b > 0.0 ? (b - a) / (a + b) : 1.0;
    return 0.25 + 0.75 * jump * jump;
}

// Where a squared speed grew by more than this share of it, as in a small corner that is not yet resolved,
// the next halvings may gain far more than the last one.
constexpr double growing = 0.1, far_more = 30.0;

// What halving gained in every interval of the grid before: by squared speeds at its ends that changed, or
// inside of it.
class Gains {
  public:
    Gains(GridMotion before, const std::vector<double>& squared_speed, const std::vector<double>& seconds,
          const std::vector<std::uint32_t>& parent)
        : change_(std::move(before.squared_speed)),
          weight_(std::move(before.seconds)),
          gained_(weight_),
          carry_(std::move(before.carry)),
          grows_(change_.size()) {
        for (size_t i = 0; i < weight_.size(); ++i) {
            const double sum = change_[i] + change_[i + 1];
            weight_[i] = sum > 0.0 ? 0.5 * weight_[i] / sum : 0.0;
        }
        visit_range(0, parent.size(), [&](size_t i) {
            gained_[parent[i]] -= seconds[i];
            if (i == 0 || parent[i] != parent[i - 1]) note_change(parent[i], squared_speed[i]);
        });
        note_change(weight_.size(), squared_speed.back());
    }

    // Of every interval: what its own rows changed in the squared speeds, times the seconds that come of it
    // there, and at the places before or after that depend on it.
    std::vector<double> find() && {
        const size_t count = gained_.size();
        std::vector<double> ahead(count + 1, 0.0);  // seconds after a place, by its squared speed
        for (size_t i = count; i-- > 0;)
            if (!carry_[i + 1].is_from_after)
                ahead[i] = double(carry_[i + 1].ratio) * (weight_at(i + 1) + ahead[i + 1]);
        double behind = 0.0;
        for (size_t i = 0; i < count; ++i) {
            const Carry &begin = carry_[i], &end = carry_[i + 1];
            const bool brakes = begin.is_from_after && end.is_from_after;
            const double inside = gained_[i] - weight_[i] * (change_[i] + change_[i + 1]);
            gained_[i] = std::fabs(inside);
            if (begin.is_from_after) {
                const double own = change_[i] - (brakes ? double(begin.ratio) * change_[i + 1] : 0.0);
                gained_[i] += factor(i) * std::fabs(own) * std::fabs(weight_at(i) + ahead[i] + behind);
            }
            if (!end.is_from_after)
                gained_[i] += factor(i + 1) * std::fabs(change_[i + 1] - double(end.ratio) * change_[i]) *
                              std::fabs(weight_at(i + 1) + ahead[i + 1]);
            behind = brakes ? double(begin.ratio) * (weight_at(i) + behind) : 0.0;
        }
        return std::move(gained_);
    }

  private:
    void note_change(size_t place, double squared_speed) {
        const double before = change_[place];
        change_[place] = squared_speed - before;
        grows_[place] = change_[place] > growing * before;
    }
    double factor(size_t place) const { return grows_[place] ? far_more : 1.0; }
    // Seconds of both intervals beside a place.
    double weight_at(size_t place) const {
        return (place > 0 ? weight_[place - 1] : 0.0) + (place < weight_.size() ? weight_[place] : 0.0);
    }

    std::vector<double> change_;  // of the squared speeds
    std::vector<double> weight_;  // seconds of an interval by the squared speed at one of its ends
    std::vector<double> gained_;  // seconds of an interval
    std::vector<Carry> carry_;
    std::vector<char> grows_;  // whether a squared speed is not yet resolved
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
            made[part] = std::max(losses.empty() ? 0.0 : losses[whole], gains[whole]);
    });
    return made;
}

}  // namespace cspace::trajectory
