// Arms of fewer than six joints: virtual joints behind the last complete them to six. A pose that the arm
// reaches is one that the completed arm reaches with its virtual joints at zero.
#pragma once

#include <algorithm>

#include "cspace/ik/general/perturbed_arms.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// How well the arm is conditioned that virtual joints behind its own complete.
inline double completed_conditioning(const Chain& six, int joints) {
    return completed_conditioning(six, 1, [=](int i) { return i >= joints; });
}

// The chain with virtual joints, the first `slides` of which slide, in directions without a pattern.
inline Chain with_virtual_joints(const Chain& chain, int slides, int choice) {
    Chain six = chain;
    six.n = 6;
    for (int i = chain.n; i < 6; ++i) {
        const Vec3d direction = pattern_vector(7 * choice + 2 * i),
                    beside = pattern_vector(7 * choice + 2 * i + 1);
        six.axis[i] = (1 / norm(direction)) * direction;
        six.point[i] = chain.tip.t + 0.5 * beside;
        six.prismatic[i] = i - chain.n < slides;
    }
    return six;
}

// A wrist made of the revolute joints at one end and virtual ones perpendicular to them.
inline bool with_virtual_wrist(const Chain& chain, Chain& best) {
    if (chain.n < 4) return false;
    const Vec3d& last = chain.axis[chain.n - 1];
    Chain six = chain;
    six.n = 6;
    Vec3d centre = chain.point[chain.n - 1] + dot(chain.tip.t - chain.point[chain.n - 1], last) * last;
    if (chain.n == 5) {
        constexpr double crossing = 1e-3;  // sine: a wrist of axes more parallel is singular everywhere
        if (!(norm(cross(chain.axis[3], last)) > crossing)) return false;
        centre = common_normal(chain.axis[3], chain.point[3], last, chain.point[4], false, centre).from;
    }
    const Vec3d x = any_perpendicular(last);
    for (int i = chain.n; i < 6; ++i) {
        six.axis[i] = i == 5 ? cross(last, x) : x;
        six.point[i] = centre;
        six.prismatic[i] = false;
    }
    if (chain.n == 5) six.axis[5] = cross(chain.axis[3], last);
    six.axis[5] = (1 / norm(six.axis[5])) * six.axis[5];
    if (!position_first(six).applies || !(completed_conditioning(six, chain.n) > regular_enough))
        return false;
    best = six;
    return true;
}

// The more of six joints slide, up to three, the simpler their equations. Returns whether any choice makes
// the arm regular; its lengths are over its own.
inline bool complete_arm(const Chain& chain, Chain& best) {
    constexpr int choices = 12;
    if (with_virtual_wrist(chain, best)) return true;
    int sliding = 0;
    for (int i = 0; i < chain.n; ++i) sliding += chain.prismatic[i];
    for (int slides = std::min(6 - chain.n, 3 - sliding); slides >= 0; --slides) {
        double most = regular_enough;
        for (int choice = 0; choice < choices; ++choice) {
            const Chain six = with_virtual_joints(chain, slides, choice);
            const double sigma = completed_conditioning(six, chain.n);
            if (sigma > most) {
                most = sigma;
                best = six;
            }
        }
        if (most > regular_enough) return true;
    }
    return false;
}

// The solver of an arm of up to six joints none of which is to spare; false for others. `arm.alone` says
// whether it has to do without neighbours.
CSPACE_ONCE bool make_general_arm(const Chain& chain, GeneralArm& arm) {
    const bool alone = arm.alone;
    arm = {};
    arm.alone = alone;
    arm.chain = chain;
    arm.solve = &solve_general;
    arm.propose = &propose_solutions;
    const double length = characteristic_length(chain);
    Chain six = in_units_of(length, chain);
    if (chain.n > 6 || (chain.n < 6 && !complete_arm(in_units_of(length, chain), six))) return false;
    arm.plan.chain = six;
    if (is_always_singular(six, 1, tolerance::axis_relation)) return false;
    arm.position_first = position_first(six);
    if (arm.position_first.applies)
        describe_formulation(six, arm.plan);
    else
        make_general_plan(six, arm.plan);
    arm.plan.length = length;
    if (arm.position_first.applies) return true;
    if (!alone && !suffices_in_some_order(arm.plan)) make_perturbed_arms(arm);
    return arm.plan.regular > 0 || arm.has_perturbed;
}

// The same arm with other numbers, say with another value of a joint that is held: the choices that were made
// for `typical` (virtual joints, formulations and their order) stay, for to make them takes a thousand times
// as long as to use them.
CSPACE_ONCE bool renumber_general_arm(const GeneralArm& typical, const Chain& chain, GeneralArm& arm) {
    arm = typical;
    arm.chain = chain;
    const double length = characteristic_length(chain);
    Chain six = typical.plan.chain;
    const Chain own = in_units_of(length, chain);
    for (int i = 0; i < chain.n; ++i) {
        six.axis[i] = own.axis[i];
        six.point[i] = own.point[i];
    }
    six.tip = own.tip;
    arm.plan.length = length;
    arm.plan.chain = six;
    arm.plan.frames = loop_frames(six);
    forget_spurious_roots(arm.plan);
    arm.position_first = position_first(six);
    for (int k = 0; k < 2 && arm.has_perturbed; ++k) {
        arm.perturbed[k].chain = perturb_chain(six, k ? -disturbance : disturbance);
        arm.perturbed[k].frames = loop_frames(arm.perturbed[k].chain);
        forget_spurious_roots(arm.perturbed[k]);
    }
    return !is_always_singular(six, 1, tolerance::axis_relation);
}

}  // namespace cspace::ik::inline CSPACE_ISA
