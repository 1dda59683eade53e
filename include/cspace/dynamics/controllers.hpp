// Controllers of joints: torques that bring them to a goal, or along a motion.
//
// Takegaki and Arimoto 1981 (proportional and derivative control with gravity); Luh, Walker and Paul 1980
// (computed torque).
#pragma once

#include "cspace/dynamics/mechanics.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

// `width` values of rows i to i + count in lanes.
template <class V>
CSPACE_INLINE void load_values(const RowValues& rows, std::size_t i, int count, int width, V* values,
                               std::size_t offset = 0) {
    load_rows(rows.values + i * rows.stride + offset, rows.stride, count, width, values);
}

// tau = kp (q_goal − q) − kd q̇ + g(q) of the joints; given: kp, kd and q_goal (n,) each.
template <class V>
void pd_torques(const Mechanics& mechanics, bool carries_weight, const V* given, const State<V>& state,
                Workspace<V>& work, V* tau) {
    const int n = mechanics.bodies.n_coordinates;
    const V *kp = given, *kd = given + n, *goal = given + 2 * n, *qd = state.qd + mechanics.first();
    if (carries_weight) {
        const Vec3<V> lift = transpose_times(state.T.R, -fill_vec3<V>(mechanics.gravity));
        gravity_torques(mechanics.bodies, lift, state.q, static_cast<LinkMotion<V>*>(work.links), tau);
    }
    for (int j = 0; j < n; ++j) {
        const V pulls = kp[j] * (goal[j] - state.q[j]) - kd[j] * qd[j];
        tau[j] = carries_weight ? pulls + tau[j] : pulls;
    }
}

// The torques that give q̈ = q̈_d + kd (q̇_d − q̇) + kp (q_d − q); given: kp, kd, q_d, q̇_d and q̈_d (n,) each.
// Damping is cancelled at the velocity of the joints, dry friction at that of the motion. wanted (n,).
template <class V>
void computed_torques(const Mechanics& mechanics, const Control& control, const V* given,
                      const State<V>& state, Workspace<V>& work, V* wanted, V* tau) {
    const int n = mechanics.bodies.n_coordinates;
    const V *kp = given, *kd = given + n, *q = given + 2 * n, *qd = given + 3 * n, *qdd = given + 4 * n;
    for (int j = 0; j < n; ++j)
        wanted[j] = qdd[j] + kd[j] * (qd[j] - state.qd[j]) + kp[j] * (q[j] - state.q[j]);
    inverse_dynamics(mechanics.bodies, resting_base(mechanics, state), state.q, state.qd, wanted, false,
                     static_cast<LinkMotion<V>*>(work.links), tau);
    const V zero = fill_lanes<V>(0.0);
    for (int j = 0; j < n; ++j) {
        const V size = fill_lanes<V>(control.dry[j]);
        const V slides = select_lanes(qd[j] > zero, size, select_lanes(qd[j] < zero, -size, zero));
        tau[j] = tau[j] + control.damping[j] * state.qd[j] + slides;
    }
}

// The torques (dof,) of a control of rows i to i + count at step k; memory (5 n,).
template <class V>
void find_torques(const Mechanics& mechanics, const Control& control, std::size_t i, int count, long long k,
                  const State<V>& state, Workspace<V>& work, V* memory, V* tau) {
    const int n = mechanics.bodies.n_coordinates, first = mechanics.first();
    for (int j = 0; j < first + n; ++j) tau[j] = fill_lanes<V>(0.0);
    if (control.law == ControlLaw::given) {
        if (control.torques.values) load_values(control.torques, i, count, first + n, tau);
        return;
    }
    load_values(control.kp, i, count, n, memory);
    load_values(control.kd, i, count, n, memory + n);
    if (control.law == ControlLaw::pd) {
        load_values(control.goal, i, count, n, memory + 2 * n);
        pd_torques(mechanics, control.carries_weight, memory, state, work, tau + first);
    } else {
        const std::size_t at = std::size_t(k - control.begin) * 3 * std::size_t(n);
        load_values(control.motion, i, count, 3 * n, memory + 2 * n, at);
        computed_torques(mechanics, control, memory, state, work, work.other, tau);
    }
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
