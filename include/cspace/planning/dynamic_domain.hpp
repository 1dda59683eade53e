// The dynamic domain of a node: it takes samples no farther than a radius, which is unbounded until an
// extension from the node is blocked and then follows how often that happens (Yershova, Jaillet, Siméon &
// LaValle 2005, "Dynamic-domain RRTs").
#pragma once

#include <algorithm>
#include <limits>

namespace cspace::planning {

struct DynamicDomain {
    static constexpr float unbounded = std::numeric_limits<float>::infinity();
    // In multiples of the range: after the first blocked extension, and at least.
    static constexpr float first_radius = 4, least_radius = 1;
    // By which share blocked and free extensions change it.
    static constexpr float change = 1e-4f;

    static float after_blocked(float radius, float range) {
        return radius == unbounded ? first_radius * range
                                   : std::max(radius * (1 - change), least_radius * range);
    }
    static float after_free(float radius) { return radius * (1 + change); }
};

}  // namespace cspace::planning
