// Goals that no configuration meets, told before any search: by the directions that the turning axes can give
// each other, and by the lengths between them.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::inline CSPACE_ISA {

inline double angle_between(const Vec3d& a, const Vec3d& b) {
    return 2 * std::atan2(norm(a - b), norm(a + b));
}

// The angles that two directions can make, from the first axis to one that a chain of turns carries.
struct AngleRange {
    double low = 0, high = 0;
};

// The same for the next axis, which turns about the present one at an angle `arc` from it.
inline AngleRange behind_turn(const AngleRange& range, double arc) {
    const auto gap = [&](double angle) { return max(max(range.low - angle, angle - range.high), 0.0); };
    return {gap(arc), pi - gap(pi - arc)};
}

// Whether the turns cannot give the last turning axis its direction. `motion`: of the tip from its pose at
// zero.
inline bool is_turned_too_far(const ik::Chain& chain, const Posed& motion) {
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

// A direction along which all slides of a chain move, whatever its turns do; none (false) if there is no
// such.
inline bool slides_keep_direction(const ik::Chain& chain, Vec3d& along) {
    along = {0, 0, 0};
    const auto is_along = [&](const Vec3d& h) { return norm(cross(along, h)) < tolerance::rounding; };
    for (int i = chain.n - 1; i >= 0; --i) {
        const bool is_set = dot(along, along) > 0;
        if (is_set && !is_along(chain.axis[i])) return false;
        if (!is_set && chain.prismatic[i]) along = chain.axis[i];
    }
    return true;
}

// Whether the last turning axis is to be farther from the first than the links between them are long, seen
// along the slides.
inline bool is_out_of_reach(const ik::Chain& chain, const Posed& motion, double length) {
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

// Whether no configuration meets the goal, limits aside; false says nothing.
inline bool exceeds_reach(const ik::Chain& chain, const Posed& goal, double length) {
    const Posed motion = goal * inverse(chain.tip);
    return is_turned_too_far(chain, motion) || is_out_of_reach(chain, motion, length);
}

}  // namespace cspace::inline CSPACE_ISA
