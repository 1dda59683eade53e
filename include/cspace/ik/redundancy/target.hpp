// What the nearest configuration is nearest to: a seed, with limits or without.
#pragma once

#include "cspace/ik/redundancy/redundant_arm.hpp"

namespace cspace::ik {

// The gap of revolute joint i is the shorter way from at[i], plus shift[i] = at[i] − seed. Without limits
// at[i] is the seed. Within limits, no way from at[i] to an angle inside them is longer than π, so that the
// gap is that of the multiple of 2π inside them, of several the nearest to the seed.
struct Target {
    double seed[max_joints], at[max_joints], shift[max_joints];
    bool within_limits;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline Target make_target(const Redundant& arm, const double* seed, bool within_limits) {
    Target out;
    out.within_limits = within_limits;
    for (int i = 0; i < arm.chain.n; ++i) {
        out.seed[i] = out.at[i] = seed[i];
        if (within_limits && !arm.chain.prismatic[i])
            out.at[i] =
                is_stopped(arm, i) ? arm.middle[i] : min(max(seed[i], arm.lower[i] + pi), arm.upper[i] - pi);
        out.shift[i] = out.at[i] - seed[i];
    }
    return out;
}

template <class V>
CSPACE_INLINE V gap_from_seed(const Chain& chain, const Target& target, int i, V q) {
    return joint_difference(chain, i, q - fill_lanes<V>(target.at[i])) + target.shift[i];
}

// Whether a configuration counts: within limits where they are kept; otherwise only joints without weight
// have to be in range.
inline bool is_acceptable(const Redundant& arm, const Target& target, const double* q) {
    return target.within_limits ? is_within(arm, q, limit_slack) : is_allowed(arm, q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
