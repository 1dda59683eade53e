// Unreachable goals, detected before any search: from the directions that the revolute axes can reach, and
// from the lengths between the axes.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik::inline CSPACE_ISA {

inline double angle_between(const Vec3d& a, const Vec3d& b) {
    return 2 * std::atan2(norm(a - b), norm(a + b));
}

// The range of angles between two directions, from the first axis to one moved by a chain of rotations.
struct AngleRange {
    double low = 0, high = 0;
};

// The same for the next axis, which rotates about the present one at an angle `arc` from it.
inline AngleRange behind_turn(const AngleRange& range, double arc) {
    const auto gap = [&](double angle) { return max(max(range.low - angle, angle - range.high), 0.0); };
    return {gap(arc), pi - gap(pi - arc)};
}

// Whether the rotations cannot give the last revolute axis its direction. `motion`: of the tip from its pose
// at zero.
inline bool is_turned_too_far(const Chain& chain, const Posed& motion) {
    int first = -1, last = -1;
    AngleRange range;
    for (int i = 0; i < chain.n; ++i) {
        if (chain.prismatic[i]) continue;
        if (first < 0)
            first = i;
        else
            range = behind_turn(range, angle_between(chain.axis[last], chain.axis[i]));
        last = i;
    }
    if (first < 0) return false;
    const Vec3d turned = motion.R * chain.axis[last];
    const double angle = angle_between(chain.axis[first], (1 / norm(turned)) * turned);
    return angle < range.low - tolerance::beyond || angle > range.high + tolerance::beyond;
}

// A direction along which all prismatic joints of a chain move, whatever its rotations are; false if there is
// none.
inline bool slides_keep_direction(const Chain& chain, Vec3d& along) {
    along = {0, 0, 0};
    const auto is_along = [&](const Vec3d& h) { return norm(cross(along, h)) < tolerance::rounding; };
    for (int i = chain.n - 1; i >= 0; --i) {
        const bool is_set = dot(along, along) > 0;
        if (is_set && !is_along(chain.axis[i])) return false;
        if (!is_set && chain.prismatic[i]) along = chain.axis[i];
    }
    return true;
}

// Whether the required distance of the last revolute axis from the first exceeds the total length of the
// links between them, seen along the prismatic joints.
inline bool is_out_of_reach(const Chain& chain, const Posed& motion, double length) {
    Vec3d along;
    if (!slides_keep_direction(chain, along)) return false;
    const auto across = [&](const Vec3d& v) { return norm(v - dot(along, v) * along); };
    int first = -1, last = -1;
    bool is_flat = true;  // so far all turns are about the slides' direction
    double links = 0;
    for (int i = 0; i < chain.n; ++i) {
        if (chain.prismatic[i]) continue;
        if (first < 0) {
            first = i;
        } else {
            const Vec3d link = chain.point[i] - chain.point[last];
            links += is_flat ? across(link) : norm(link);
        }
        is_flat = is_flat && norm(cross(along, chain.axis[i])) < tolerance::rounding;
        last = i;
    }
    if (first < 0) return false;
    const Vec3d asked = motion * chain.point[last] - chain.point[first];
    return across(asked) > links + tolerance::beyond * (length + norm(asked));
}

// Whether no configuration reaches the goal, regardless of limits. False is no statement.
inline bool exceeds_reach(const Chain& chain, const Posed& goal, double length) {
    const Posed motion = goal * inverse(chain.tip);
    return is_turned_too_far(chain, motion) || is_out_of_reach(chain, motion, length);
}

}  // namespace cspace::ik::inline CSPACE_ISA
