// A robot in motion: its state, what acts on it, and its accelerations.
//
// Velocities and forces have dof numbers: six of a floating base, [v; ω] and [f; n] at its origin in world
// axes, then those of the joints.
#pragma once

#include "cspace/dynamics/closed_loop_motion.hpp"
#include "cspace/dynamics/forward_dynamics.hpp"
#include "cspace/dynamics/mass_matrix.hpp"
#include "cspace/dynamics/roll_out_task.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/math/exponential.hpp"
#include "cspace/math/linear.hpp"
#include "cspace/spatial/left_jacobian.hpp"
#include "cspace/spatial/rotation.hpp"

namespace cspace::dynamics {

// q (n,), qd (dof,) and the pose of the base.
template <class V>
struct State {
    V *q, *qd;
    Pose<V> T;
};

// Memory for a pack: what the functions on links keep, the mass matrix and a factor by rows, wrenches (…, 6),
// and two vectors (dof,). loops: for one row of a mechanism; rank: in each lane, see settle_row.
template <class V>
struct Workspace {
    void* links;
    V *M, *factor, *wrenches, *force, *other;
    LoopMemory loops;
    int rank[8];
};

}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Vec3<V> vector_from(const V* values) {
    return {values[0], values[1], values[2]};
}
template <class V>
CSPACE_INLINE void put_vector(V* values, const Vec3<V>& a) {
    values[0] = a.x;
    values[1] = a.y;
    values[2] = a.z;
}
// Whether a rotation vector is below half a turn: NaN is not.
template <class V>
CSPACE_INLINE mask_of<V> below_half_turn(const Vec3<V>& u) {
    return dot(u, u) < pi * pi;
}

// The state after a displacement and a change of the velocities (dof,), into `after`; u of a base is a
// rotation vector, R ← exp(u) R. False in the lanes where it is half a turn or more.
template <class V>
CSPACE_INLINE mask_of<V> advance_state(const Mechanics& mechanics, const State<V>& state, const V* dx,
                                       const V* dv, State<V>& after) {
    const int first = mechanics.first(), dof = mechanics.dof();
    for (int j = first; j < dof; ++j) after.q[j - first] = state.q[j - first] + dx[j];
    for (int j = 0; j < dof; ++j) after.qd[j] = state.qd[j] + dv[j];
    after.T = state.T;
    if (!first) return fill_lanes<V>(0.0) == fill_lanes<V>(0.0);
    const Vec3<V> u = vector_from(dx + 3);
    after.T.t = state.T.t + vector_from(dx);
    after.T.R = spatial::rotation_of_rotvec(u) * state.T.R;
    return below_half_turn(u);
}
// The rate of the displacement dx that led to a state: its velocities, of a rotation u' = J⁻¹(u) ω.
template <class V>
CSPACE_INLINE void displacement_rate(const Mechanics& mechanics, const State<V>& state, const V* dx,
                                     V* rate) {
    for (int j = 0; j < mechanics.dof(); ++j) rate[j] = state.qd[j];
    if (mechanics.floating)
        put_vector(rate + 3,
                   spatial::left_jacobian_inverse_times(vector_from(dx + 3), vector_from(rate + 3)));
}

// Adds the forces (dof,) of the wrenches of the world, Σ Jᵀ w.
template <class V>
void add_wrenches(const Mechanics& mechanics, const State<V>& state, Workspace<V>& work, V* force) {
    for (int k = 0; k < mechanics.n_wrenches; ++k) {
        const model::Chain& chain = mechanics.wrenches[k].chain;
        V* const sines = static_cast<V*>(work.links);
        V* const cosines = sines + chain.n + 4;
        auto* const axes = reinterpret_cast<kinematics::Axis<V>*>(cosines + chain.n + 4);
        const Pose<V> tip =
            kinematics::place_axes(chain, fill_pose<V>(chain.T_base_first), state.q, sines, cosines, axes);
        Vec3<V> f = vector_from(work.wrenches + 6 * k), n = vector_from(work.wrenches + 6 * k + 3);
        f = mechanics.in_tip ? tip.R * f : transpose_times(state.T.R, f);
        n = mechanics.in_tip ? tip.R * n : transpose_times(state.T.R, n);
        V* const joints = force + mechanics.first();
        for (int i = 0; i < chain.n; ++i) {
            const model::ChainJoint& joint = chain.joints[i];
            const Vec3<V>& d = axes[i].direction;
            const V along = joint.prismatic ? dot(d, f) : dot(d, n + cross(tip.t - axes[i].point, f));
            joints[joint.coordinate] = joints[joint.coordinate] + joint.ratio * along;
        }
        if (!mechanics.floating) continue;
        put_vector(force, vector_from(force) + state.T.R * f);
        put_vector(force + 3, vector_from(force + 3) + state.T.R * (n + cross(tip.t, f)));
    }
}

// Takes off what the friction of the joints opposes to velocities (dof,).
template <class V>
void subtract_friction(const Mechanics& mechanics, const V* qd, V* force) {
    if (!mechanics.damping) return;
    const double per_speed = 1.0 / mechanics.friction_speed;
    for (int j = mechanics.first(); j < mechanics.dof(); ++j) {
        force[j] = force[j] - mechanics.damping[j] * qd[j];
        if (mechanics.dry[j] > 0.0) force[j] = force[j] - mechanics.dry[j] * tanh(per_speed * qd[j]);
    }
}

// M (dof, dof) by rows at a state.
template <class V>
void find_mass_matrix(const Mechanics& mechanics, const State<V>& state, Workspace<V>& work) {
    mass_matrix(mechanics.bodies, state.q, state.T.R, mechanics.floating,
                static_cast<LinkComposite<V>*>(work.links), work.M);
}

// M at a state, and its factor L D Lᵀ. False where it is singular.
template <class V>
mask_of<V> factor_mass_matrix(const Mechanics& mechanics, const State<V>& state, Workspace<V>& work) {
    const int dof = mechanics.dof();
    find_mass_matrix(mechanics, state, work);
    for (int i = 0; i < dof * dof; ++i) work.factor[i] = work.M[i];
    MatrixRows<V> rows = {work.factor, dof};
    mask_of<V> regular = factor_ldl(rows, dof);
    for (int j = 0; j < dof; ++j)  // the inverse pivots stand on the diagonal
        regular = regular && tolerance::singular_inertia * work.M[j * (dof + 1)] * rows[j][j] < 1.0;
    return regular;
}

// How the base moves, in its axes, where it does not accelerate; its acceleration is less gravity.
template <class V>
CSPACE_INLINE Motion<V> resting_base(const Mechanics& mechanics, const State<V>& state) {
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> rest = {zero, zero, zero};
    return {mechanics.floating ? transpose_times(state.T.R, vector_from(state.qd + 3)) : rest, rest,
            transpose_times(state.T.R, -fill_vec3<V>(mechanics.gravity))};
}

// force − b (dof,): what is left to accelerate the robot.
template <class V>
void subtract_bias(const Mechanics& mechanics, const State<V>& state, const V* force, Workspace<V>& work,
                   V* rest) {
    const int first = mechanics.first(), dof = mechanics.dof();
    const Wrench<V> on_base = inverse_dynamics(mechanics.bodies, resting_base(mechanics, state), state.q,
                                               state.qd + first, static_cast<const V*>(nullptr), false,
                                               static_cast<LinkMotion<V>*>(work.links), rest + first);
    if (first) {
        put_vector(rest, state.T.R * on_base.f);
        put_vector(rest + 3, state.T.R * on_base.n);
    }
    for (int j = 0; j < dof; ++j) rest[j] = force[j] - rest[j];
}

// M⁻¹ (force − b) with the dense mass matrix, for coordinates that move several joints.
template <class V>
mask_of<V> solve_accelerations(const Mechanics& mechanics, const State<V>& state, const V* force,
                               Workspace<V>& work, V* qdd) {
    const int dof = mechanics.dof();
    const mask_of<V> regular = factor_mass_matrix(mechanics, state, work);
    subtract_bias(mechanics, state, force, work, qdd);
    solve_ldl(MatrixRows<V>{work.factor, dof}, dof, qdd);
    return regular;
}

// Takes values of one lane, and puts them there.
template <class V>
void take_lane(const V* values, int l, int count, double* to) {
    for (int i = 0; i < count; ++i) to[i] = get_lane(values[i], l);
}
template <class V>
void put_lane(const double* values, int l, int count, V* to) {
    for (int i = 0; i < count; ++i) set_lane(to[i], l, values[i]);
}

// The accelerations of a mechanism whose loops are closed, row by row.
template <class V>
mask_of<V> constrained_accelerations(const Mechanics& mechanics, const State<V>& state, const V* force,
                                     Workspace<V>& work, V* qdd) {
    const ClosedLoops& loops = *mechanics.loops;
    LoopMemory& memory = work.loops;
    const int dof = mechanics.dof();
    find_mass_matrix(mechanics, state, work);
    subtract_bias(mechanics, state, force, work, qdd);
    V regular = fill_lanes<V>(0.0);
    for (int l = 0; l < Lanes<V>::count; ++l) {
        take_lane(state.q, l, loops.n_coordinates, memory.q);
        take_lane(state.qd, l, dof, memory.qd);
        take_lane(work.M, l, dof * dof, memory.M);
        take_lane(qdd, l, dof, memory.force);
        set_lane(regular, l, accelerate_row(loops, work.rank[l], memory) ? 1.0 : 0.0);
        put_lane(memory.x, l, dof, qdd);
    }
    return regular > 0.5;
}

// Closes the loops of a state; false in the lanes where they cannot be closed.
template <class V>
mask_of<V> settle_state(const Mechanics& mechanics, State<V>& state, Workspace<V>& work) {
    const ClosedLoops& loops = *mechanics.loops;
    LoopMemory& memory = work.loops;
    const int dof = mechanics.dof();
    find_mass_matrix(mechanics, state, work);
    V closed = fill_lanes<V>(0.0);
    for (int l = 0; l < Lanes<V>::count; ++l) {
        take_lane(state.q, l, loops.n_coordinates, memory.q);
        take_lane(state.qd, l, dof, memory.qd);
        take_lane(work.M, l, dof * dof, memory.M);
        set_lane(closed, l, settle_row(loops, work.rank[l], memory) ? 1.0 : 0.0);
        put_lane(memory.q, l, loops.n_coordinates, state.q);
        put_lane(memory.qd, l, dof, state.qd);
    }
    return closed > 0.5;
}

// The acceleration of a floating base, in its axes and less gravity, from what it feels of all links.
template <class V>
CSPACE_INLINE mask_of<V> accelerate_base(const Articulated<V>& felt, const Vec3<V>& f, const Vec3<V>& n,
                                         Motion<V>& base) {
    const Mat3<V> A = to_matrix(felt.A), C = to_matrix(felt.C);
    V inertia[6][6], x[6];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            inertia[r][c] = C.m[r][c];
            inertia[r][3 + c] = felt.B.m[c][r];
            inertia[3 + r][c] = felt.B.m[r][c];
            inertia[3 + r][3 + c] = A.m[r][c];
        }
    }
    put_vector(x, f - felt.bias.f);
    put_vector(x + 3, n - felt.bias.n);
    const mask_of<V> regular = solve_positive(inertia, 6, x);
    base.a = vector_from(x);
    base.wd = vector_from(x + 3);
    return regular;
}

// qdd (dof,) under forces (dof,) that include all but gravity and those of velocities. False in the lanes
// where M is singular.
template <class V>
mask_of<V> accelerations(const Mechanics& mechanics, const State<V>& state, const V* force,
                         Workspace<V>& work, V* qdd) {
    if (mechanics.loops) return constrained_accelerations(mechanics, state, force, work, qdd);
    if (mechanics.bodies.shares) return solve_accelerations(mechanics, state, force, work, qdd);
    const int first = mechanics.first();
    auto* const links = static_cast<LinkResponse<V>*>(work.links);
    Motion<V> base = resting_base(mechanics, state);
    mask_of<V> regular;
    const Articulated<V> felt = articulate_bodies(mechanics.bodies, base.w, state.q, state.qd + first,
                                                  force + first, false, links, regular);
    if (first) {
        const Mat3<V>& R = state.T.R;
        regular = accelerate_base(felt, transpose_times(R, vector_from(force)),
                                  transpose_times(R, vector_from(force + 3)), base) &&
                  regular;
        put_vector(qdd, R * base.a + fill_vec3<V>(mechanics.gravity));
        put_vector(qdd + 3, R * base.wd);
    }
    find_accelerations(mechanics.bodies, base.a, base.wd, links, qdd + first);
    return regular;
}

// qdd (dof,) under the torques of a control (dof,), wrenches, friction and gravity; NaN where M is singular.
template <class V>
void driven_accelerations(const Mechanics& mechanics, const State<V>& state, const V* tau, Workspace<V>& work,
                          V* qdd) {
    const int dof = mechanics.dof();
    for (int j = 0; j < dof; ++j) work.force[j] = tau[j];
    subtract_friction(mechanics, state.qd, work.force);
    add_wrenches(mechanics, state, work, work.force);
    const mask_of<V> regular = accelerations(mechanics, state, work.force, work, qdd);
    if (all(regular)) return;
    const V lost = fill_lanes<V>(std::numeric_limits<double>::quiet_NaN());
    for (int j = 0; j < dof; ++j) qdd[j] = select_lanes(regular, qdd[j], lost);
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
