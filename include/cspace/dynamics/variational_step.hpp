// The variational midpoint step, of order two: without friction it is symplectic and conserves momenta.
//
// With the mean velocity w of a step from q_k to q_{k+1}, its middle q_m and L = T − V, the momenta at the
// ends are
//     p_k     = M(q_m) w − (h/2) ∂L/∂q(q_m, w) − (h/2) τ,
//     p_{k+1} = M(q_m) w + (h/2) ∂L/∂q(q_m, w) + (h/2) τ.
// The first equation is solved for w, the second continues. Friction is part of τ; a joint that it stops
// within a step takes more of its forces at the beginning than at the end. The orientation of a floating base
// moves by exp(h ω) R, its middle is exp(h ω/2) R, and its rows are carried to the ends by the Jacobians of
// the exponential. Marsden and West 2001, sections 1.6 and 2.3; Bou-Rabee and Marsden 2009 for groups.
#pragma once

#include "cspace/dynamics/lagrangian.hpp"
#include "cspace/dynamics/mechanics.hpp"

namespace cspace::dynamics {

// Of Newton's method: each gains a digit or more at steps that resolve the motion; joints that change from
// sliding to sticking need some more.
inline constexpr int most_iterations = 80;
// Last change of the mean velocity, relative to its size: momenta are then conserved to rounding.
inline constexpr double step_converged = 1e-14;
// Change of the mean velocity, relative likewise, from which on one that no longer halves is rounding: that
// of torques whose terms cancel.
inline constexpr double step_rounded = 1e-9;
// Decay h b / m below which the split of damping is that of its series, then exact to rounding, and the
// largest whose exponential is a double.
inline constexpr double small_decay = 1e-2, most_decay = 700.0;

// Vectors (dof,) of a variational step, the matrix of its equation, and the middle.
template <class V>
struct VariationalMemory {
    V *p, *w, *momentum, *push, *residual, *late, *slope, *zero;
    State<V> middle;
};

}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// How a friction of coefficient b (dof,) splits the forces of a step: which part acts at its end, (dof,).
//
// One half without friction. In general 1/x − 1/(exp(x) − 1) with the decay x = h b/m, so that one joint
// alone decays by exp(−x) however stiff its damping is, and to the right velocity under a constant torque
// (exponential fitting; Liniger and Willoughby 1970). The order remains two.
template <class V>
void split_forces(const Mechanics& mechanics, const V* qd, const V* M, V h, V* late) {
    const int dof = mechanics.dof();
    for (int j = 0; j < dof; ++j) {
        late[j] = fill_lanes<V>(0.5);
        if (!mechanics.damping || (mechanics.damping[j] == 0.0 && mechanics.dry[j] == 0.0)) continue;
        const V speed = max(abs(qd[j]), fill_lanes<V>(mechanics.friction_speed));
        const V x = h * (mechanics.damping[j] + mechanics.dry[j] / speed) / M[j * (dof + 1)];
        const V safe = min(fill_lanes<V>(most_decay), max(fill_lanes<V>(small_decay), x));
        const V series = 0.5 - x / 12.0 + x * x * x / 720.0;
        const V split = select_lanes(x < small_decay, series, 1.0 / safe - 1.0 / expm1(safe));
        late[j] = select_lanes(x > most_decay, 1.0 / max(x, fill_lanes<V>(1.0)), split);
    }
}

// The momentum M w (dof,) and the forces ∂L/∂q + τ (dof,) in the middle of a step of mean velocity w. False
// where the base turns too far.
template <class V>
mask_of<V> find_middle(const Mechanics& mechanics, const State<V>& state, const V* tau, V h,
                       Workspace<V>& work, VariationalMemory<V>& step) {
    const int first = mechanics.first(), dof = mechanics.dof();
    State<V>& middle = step.middle;
    for (int j = 0; j < dof; ++j) step.residual[j] = 0.5 * h * step.w[j];
    const mask_of<V> near = advance_state(mechanics, state, step.residual, step.zero, middle);
    for (int j = 0; j < dof; ++j) middle.qd[j] = step.w[j];
    const V zero = fill_lanes<V>(0.0);
    const Mat3<V>& R = middle.T.R;
    Twist<V> base = {{zero, zero, zero}, {zero, zero, zero}};
    if (first)
        base = {transpose_times(R, vector_from(middle.qd)), transpose_times(R, vector_from(middle.qd + 3))};
    const Vec3<V> gravity = transpose_times(R, fill_vec3<V>(mechanics.gravity));
    const WholeMomentum<V> whole =
        lagrangian_rates(mechanics.bodies, base, gravity, middle.q, middle.qd + first,
                         static_cast<LinkMomentum<V>*>(work.links), step.momentum + first, step.push + first);
    if (first) {
        // By rotations ∂L/∂q is l × v and the torque of the weight, less ω × k, since the velocity of the
        // base is kept in axes of the world.
        const Vec3<V>&l = whole.momentum.f, &k = whole.momentum.n;
        put_vector(step.momentum, R * l);
        put_vector(step.momentum + 3, R * k);
        put_vector(step.push, mechanics.bodies.mass * fill_vec3<V>(mechanics.gravity));
        put_vector(step.push + 3, R * (cross(l, base.v) + cross(whole.first, gravity) - cross(base.w, k)));
    }
    for (int j = 0; j < dof; ++j) step.push[j] = step.push[j] + tau[j];
    subtract_friction(mechanics, middle.qd, step.push);
    add_wrenches(mechanics, middle, work, step.push);
    return near;
}

// The momentum (dof,) at the end of a step or, with sign −1, at its beginning, from its middle. One half of
// the forces on a base acts on either side.
template <class V>
CSPACE_INLINE void carry_momentum(const Mechanics& mechanics, const VariationalMemory<V>& step, double sign,
                                  V h, V* result) {
    const int first = mechanics.first(), dof = mechanics.dof();
    for (int j = first; j < dof; ++j) {
        const V part = sign > 0.0 ? step.late[j] : 1.0 - step.late[j];
        result[j] = step.momentum[j] + sign * h * part * step.push[j];
    }
    if (!first) return;
    const V half = sign * 0.5 * h;
    put_vector(result, vector_from(step.momentum) + half * vector_from(step.push));
    // The transposed Jacobians of u are those of −u.
    const Vec3<V> u = -(sign * h * vector_from(step.w + 3));
    const Vec3<V> turned = spatial::left_jacobian_times(0.5 * u, vector_from(step.push + 3));
    put_vector(result + 3,
               spatial::left_jacobian_inverse_times(u, vector_from(step.momentum + 3) + half * turned));
}

// The factor of M, and of the slope of the friction that acts at the beginning of a step of mean velocity w.
template <class V>
mask_of<V> factor_slope(const Mechanics& mechanics, V h, const Workspace<V>& work,
                        VariationalMemory<V>& step) {
    const int dof = mechanics.dof();
    for (int i = 0; i < dof * dof; ++i) step.slope[i] = work.M[i];
    const double per_speed = 1.0 / mechanics.friction_speed;
    for (int j = mechanics.first(); j < dof; ++j) {
        V rate = fill_lanes<V>(mechanics.damping[j]);
        if (mechanics.dry[j] > 0.0) {
            const V slides = tanh(per_speed * step.w[j]);
            rate = rate + (mechanics.dry[j] * per_speed) * (1.0 - slides * slides);
        }
        V& own = step.slope[j * (dof + 1)];
        own = own + h * (1.0 - step.late[j]) * rate;
    }
    MatrixRows<V> rows = {step.slope, dof};
    return factor_ldl(rows, dof);
}

// The mean velocity w (dof,) of a step; false in the lanes where none is found. Each lane stays when it has
// converged, so that others do not change it.
//
// Newton's method with M at the beginning, and the slope of friction, in place of the exact slope. A joint
// with dry friction that would change its direction stops first: from rest the iteration is monotone.
template <class V>
mask_of<V> solve_step(const Mechanics& mechanics, const State<V>& state, const V* tau, V h,
                      Workspace<V>& work, VariationalMemory<V>& step) {
    const int dof = mechanics.dof();
    const bool rubs = mechanics.damping != nullptr;
    const V zero = fill_lanes<V>(0.0);
    mask_of<V> settled = zero > zero, possible = zero == zero;
    V size = zero, last = zero, change = fill_lanes<V>(std::numeric_limits<double>::infinity());
    for (int j = 0; j < dof; ++j) step.w[j] = state.qd[j];
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        find_middle(mechanics, state, tau, h, work, step);
        carry_momentum(mechanics, step, -1.0, h, step.residual);
        for (int j = 0; j < dof; ++j) step.residual[j] = step.residual[j] - step.p[j];
        if (rubs) possible = factor_slope(mechanics, h, work, step) && possible;
        solve_ldl(MatrixRows<V>{rubs ? step.slope : work.factor, dof}, dof, step.residual);
        V largest = zero;
        last = change;
        change = zero;
        for (int j = 0; j < dof; ++j) {
            V after = step.w[j] - step.residual[j];
            if (rubs && mechanics.dry[j] > 0.0) after = select_lanes(step.w[j] * after < 0.0, zero, after);
            possible = possible && abs(after) < std::numeric_limits<double>::infinity();
            change = max(change, abs(after - step.w[j]));
            largest = max(largest, abs(step.w[j]));
            step.w[j] = select_lanes(settled, step.w[j], after);
        }
        if (iteration == 0) size = max(largest, change);
        settled = settled || change <= step_converged * size ||
                  (change <= step_rounded * size && change > 0.5 * last);
        if (all(settled || !possible)) break;
    }
    return settled && possible;
}

// The state after one step. work: M and its factor at the state, then at that after. False in the lanes whose
// equation is not solved.
template <class V>
mask_of<V> step_variational(const Mechanics& mechanics, const State<V>& state, const V* tau, V h,
                            Workspace<V>& work, VariationalMemory<V>& step, State<V>& after) {
    const int dof = mechanics.dof();
    for (int i = 0; i < dof; ++i) {
        V sum = fill_lanes<V>(0.0);
        for (int j = 0; j < dof; ++j) sum = mul_add(work.M[i * dof + j], state.qd[j], sum);
        step.p[i] = sum;
    }
    split_forces(mechanics, state.qd, work.M, h, step.late);
    mask_of<V> solved = solve_step(mechanics, state, tau, h, work, step);
    solved = find_middle(mechanics, state, tau, h, work, step) && solved;
    carry_momentum(mechanics, step, 1.0, h, step.p);
    for (int j = 0; j < dof; ++j) step.residual[j] = h * step.w[j];
    solved = advance_state(mechanics, state, step.residual, step.zero, after) && solved;
    solved = factor_mass_matrix(mechanics, after, work) && solved;
    for (int j = 0; j < dof; ++j) after.qd[j] = step.p[j];
    solve_ldl(MatrixRows<V>{work.factor, dof}, dof, after.qd);
    return solved;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
