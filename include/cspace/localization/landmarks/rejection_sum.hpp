// When a filter is lost: a cumulative sum of rejected measurements (Page 1954).
#pragma once

#include <algorithm>

namespace cspace::localization {

// A filter is lost from where it rejected more than two thirds for a while, though some fit by chance, until
// accepted measurements have made up for all of it.
class RejectionSum {
  public:
    static constexpr int redeemed = 2;  // rejections that an accepted measurement makes up for

    explicit RejectionSum(int lost_after) : lost_after_(lost_after) {}

    void accept() {
        in_row_ = 0;
        sum_ = std::max(0, sum_ - redeemed);
        is_lost_ = is_lost_ && sum_ > 0;
    }
    // Whether so many in a row were rejected that the covariance is to be inflated: every `lost_after` ones.
    bool reject() {
        ++in_row_;
        sum_ = std::min(sum_ + 1, lost_after_);
        is_lost_ = is_lost_ || sum_ == lost_after_;
        return in_row_ % lost_after_ == 0;
    }
    bool is_lost() const { return is_lost_; }

  private:
    int lost_after_, in_row_ = 0, sum_ = 0;
    bool is_lost_ = false;
};

}  // namespace cspace::localization
