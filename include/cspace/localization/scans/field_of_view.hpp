// The directions in which a laser measures.
//
// Walls that come into view beside a robot lie on no scan before. In a match they draw the scan to where more
// of them lie on the map, which shortens every step of a robot that backs along a corridor. A match therefore
// uses the points alone that lay in the field of view of another scan.
#pragma once

#include <cmath>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::localization {

struct FieldOfView {
    // From `first` on, counter-clockwise, in the frame of the laser [rad].
    double first = -pi, span = 2 * pi;
    PlanarSpace::Pose T_base_laser;

    static constexpr double margin = 0.25;  // [m] from the edges: the reach of a bell, and of odometry

    bool is_whole() const { return span >= 2 * pi; }
    // Whether a laser on a base at a pose measures in the direction of a place, and not at the edge.
    bool contains(const PlanarSpace::Pose& pose, Point place) const {
        const PlanarSpace::Pose laser = PlanarSpace::compose(pose, T_base_laser);
        const PlanarSpace::Pose at = PlanarSpace::between(laser, {place.x, place.y, 1, 0});
        const double distance = std::hypot(at.x, at.y);
        if (is_whole() || distance <= margin) return true;
        const double off = wrap_angle(std::atan2(at.y, at.x) - first - span / 2);
        return std::fabs(off) <= span / 2 - margin / distance;
    }
};

}  // namespace cspace::localization
