// Unreachable goals, detected before any search: from the directions that the revolute axes can reach, and
// from the lengths between the axes.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

// The range of angles between two directions, from the first axis to one moved by a chain of rotations.
struct AngleRange {
    double low = 0, high = 0;
};

// What the chain between its first and its last revolute axis allows, whatever the goal is.
struct ReachBounds {
    int first = -1, last = -1;  // the two axes; none: −1
    AngleRange range;           // of the angles between them
    bool has_direction;         // along which all prismatic joints move
    Vec3d along;
    double links = 0;  // the total length of the links between them, seen along that direction [m]
    double rounding;   // of a distance in an arm of this length [m]
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double angle_between(const Vec3d& a, const Vec3d& b) {
    return 2 * std::atan2(norm(a - b), norm(a + b));
}

// The same for the next axis, which rotates about the present one at an angle `arc` from it.
inline AngleRange behind_turn(const AngleRange& range, double arc) {
    const auto gap = [&](double angle) { return max(max(range.low - angle, angle - range.high), 0.0); };
    return {gap(arc), pi - gap(pi - arc)};
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

inline ReachBounds measure_reach(const Chain& chain, double length) {
    ReachBounds out;
    out.rounding = tolerance::beyond * length;
    out.has_direction = slides_keep_direction(chain, out.along);
    bool is_flat = true;  // so far all turns are about the slides' direction
    for (int i = 0; i < chain.n; ++i) {
        if (chain.prismatic[i]) continue;
        if (out.first < 0) {
            out.first = i;
        } else {
            const Vec3d link = chain.point[i] - chain.point[out.last];
            out.links += norm(is_flat ? link - dot(out.along, link) * out.along : link);
            out.range = behind_turn(out.range, angle_between(chain.axis[out.last], chain.axis[i]));
        }
        is_flat = is_flat && norm(cross(out.along, chain.axis[i])) < tolerance::rounding;
        out.last = i;
    }
    return out;
}

// Whether no configuration reaches the goal, regardless of limits: the rotations cannot give the last
// revolute axis its direction, or it is asked to be farther from the first than the links are long. False is
// no statement.
inline bool exceeds_reach(const Chain& chain, const ReachBounds& reach, const Posed& goal) {
    if (reach.first < 0) return false;
    const Posed motion = goal * inverse(chain.tip);
    const Vec3d turned = motion.R * chain.axis[reach.last];
    const double angle = angle_between(chain.axis[reach.first], (1 / norm(turned)) * turned);
    if (angle < reach.range.low - tolerance::beyond || angle > reach.range.high + tolerance::beyond)
        return true;
    if (!reach.has_direction) return false;
    const Vec3d asked = motion * chain.point[reach.last] - chain.point[reach.first];
    const Vec3d across = asked - dot(reach.along, asked) * reach.along;
    return norm(across) > reach.links + reach.rounding + tolerance::beyond * norm(asked);
}

}  // namespace cspace::ik::inline CSPACE_ISA
