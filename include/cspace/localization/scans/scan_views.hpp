// What the scans of a log saw: the ranges of the laser by direction.
//
// Walls that come into view for the first time lie on no other scan. In a match they draw the scan to where
// more of them lie on the map: along a corridor this shortens or lengthens every step. A match therefore uses
// the points alone that other scans saw.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::localization {

namespace views {

inline constexpr double side_margin = 0.25;  // [m] from the edge of the field of view: the reach of a bell
inline constexpr double depth_margin = 0.2;  // [m] behind a range: poses are uncertain, and walls oblique

}  // namespace views

class ScanViews {
  public:
    using Pose = PlanarSpace::Pose;

    ScanViews() = default;
    // ranges (scans × directions) [m]: how far each scan saw, in directions from `first` on, in steps, in the
    // frame of the laser [rad].
    ScanViews(std::vector<float> ranges, int directions, double first, double step, const Pose& T_base_laser)
        : ranges_(std::move(ranges)),
          directions_(directions),
          first_(first),
          step_(step),
          T_base_laser_(T_base_laser) {
        if (directions < 1 || ranges_.size() % std::size_t(directions) || !(step > 0))
            throw std::invalid_argument("the arrays of the views do not fit together");
        is_closed_ = (directions + 1) * step >= 2 * half_turn;
    }
    int scans() const { return directions_ ? int(ranges_.size() / std::size_t(directions_)) : 0; }

    // Whether a scan with base at a pose saw a place.
    bool sees(int scan, const Pose& pose, Point place) const {
        const Pose laser = PlanarSpace::compose(pose, T_base_laser_);
        const Pose at = PlanarSpace::between(laser, {place.x, place.y, 1, 0});
        const double distance = std::hypot(at.x, at.y), span = (directions_ - 1) * step_;
        if (distance <= views::side_margin) return true;
        // The angle from the first direction on, as near to the field of view as whole turns allow.
        double angle = std::atan2(at.y, at.x) - first_;
        angle -= 2 * half_turn * std::round((angle - span / 2) / (2 * half_turn));
        const double inside = views::side_margin / distance - step_ / 2;
        if (!is_closed_ && (angle < inside || angle > span - inside)) return false;
        const int direction = std::clamp(int(std::lround(angle / step_)), 0, directions_ - 1);
        const float far = ranges_[std::size_t(scan) * std::size_t(directions_) + std::size_t(direction)];
        return distance <= double(far) + views::depth_margin;
    }

  private:
    std::vector<float> ranges_;
    int directions_ = 0;
    double first_ = 0, step_ = 1;
    Pose T_base_laser_;
    bool is_closed_ = false;
};

}  // namespace cspace::localization
