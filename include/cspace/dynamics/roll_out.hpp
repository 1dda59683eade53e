// Roll-outs: the motions of many rows under torques, gravity, friction and wrenches, one row in each lane.
//
// Arrays hold the state of every row between two calls, so that a loop over steps can be interrupted
// anywhere: its results do not depend on where.
#pragma once

#include <algorithm>
#include <cmath>

#include "cspace/dynamics/controllers.hpp"
#include "cspace/dynamics/explicit_steps.hpp"
#include "cspace/dynamics/momentum.hpp"
#include "cspace/dynamics/variational_step.hpp"

namespace cspace::dynamics {

// Largest coordinate or velocity of a state: the square of a velocity times any inertia still fits a double.
inline constexpr double largest_state = 1e50;
// Shortest step of the adaptive method, relative to the time and to dt: below it time no longer advances.
inline constexpr double shortest_step = 1e-13;
// The next step of the adaptive method, relative to the one that would just do, and the bounds of its change
// (Hairer, Nørsett and Wanner 1993, section II.4); the power of the step with which its error falls.
inline constexpr double step_safety = 0.9, slowest_change = 0.2, fastest_change = 5.0, error_order = 5.0;

template <class V>
struct RollOutMemory {
    State<V> state, after;
    V *tau, *fresh, *control;  // (dof,) the torques that are held, those of now; (5 n,)
    Workspace<V> work;
    Stages<V> stages;
    VariationalMemory<V> variational;
};

// One pack of rows: i to i + count.
template <class V>
struct RollOutPack {
    std::size_t i;
    int count;
    mask_of<V> runs;
};

}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE mask_of<V> running_lanes(const RollOut& task, std::size_t i, int count) {
    V flags = fill_lanes<V>(0.0);
    for (int l = 0; l < count; ++l)
        if (task.status[i + std::size_t(l)] == running) set_lane(flags, l, 1.0);
    return flags > 0.5;
}

template <class V>
void load_state(const RollOut& task, RollOutPack<V>& pack, RollOutMemory<V>& memory) {
    const std::size_t i = pack.i;
    const int n = task.mechanics.bodies.n_coordinates, dof = task.mechanics.dof(), count = pack.count;
    pack.runs = running_lanes<V>(task, i, count);
    load_rows(task.q + i * std::size_t(n), std::size_t(n), count, n, memory.state.q);
    load_rows(task.qd + i * std::size_t(dof), std::size_t(dof), count, dof, memory.state.qd);
    load_rows(task.tau + i * std::size_t(dof), std::size_t(dof), count, dof, memory.tau);
    V matrix[16];
    load_rows(task.T + i * task.T_stride, task.T_stride, count, 16, matrix);
    memory.state.T = memory.after.T = kinematics::read_matrix(matrix);
    for (int k = 0; k < task.mechanics.n_wrenches; ++k) {
        const FrameWrench& at = task.mechanics.wrenches[k];
        load_rows(at.wrench + i * at.stride, at.stride, count, 6, memory.work.wrenches + 6 * k);
    }
    for (int l = 0; task.rank && l < Lanes<V>::count; ++l)
        memory.work.rank[l] = task.rank[i + std::size_t(std::min(l, count - 1))];
}
template <class V>
void store_state(const RollOut& task, const RollOutPack<V>& pack, const RollOutMemory<V>& memory) {
    const std::size_t i = pack.i;
    const int n = task.mechanics.bodies.n_coordinates, dof = task.mechanics.dof(), count = pack.count;
    store_rows(memory.state.q, n, task.q + i * std::size_t(n), std::size_t(n), count);
    store_rows(memory.state.qd, dof, task.qd + i * std::size_t(dof), std::size_t(dof), count);
    store_rows(memory.tau, dof, task.tau + i * std::size_t(dof), std::size_t(dof), count);
    for (int l = 0; task.rank && l < count; ++l) task.rank[i + std::size_t(l)] = memory.work.rank[l];
    if (!task.mechanics.floating) return;
    V matrix[16];
    kinematics::write_matrix(memory.state.T, matrix);
    store_rows(matrix, 16, task.T + i * task.T_stride, task.T_stride, count);
}

// The torques of the control at the beginning of step k; rows that have ended keep theirs.
template <class V>
void update_torques(const RollOut& task, const RollOutPack<V>& pack, long long k, RollOutMemory<V>& memory) {
    find_torques(task.mechanics, task.control, pack.i, pack.count, k, memory.state, memory.work,
                 memory.control, memory.fresh);
    for (int j = 0; j < task.mechanics.dof(); ++j)
        memory.tau[j] = select_lanes(pack.runs, memory.fresh[j], memory.tau[j]);
}

// The energy of a state, and its momentum: linear, and angular about the centre of mass, in axes of the
// world.
template <class V>
struct Balance {
    V energy;
    V momentum[6];
};

// memory: its momenta and slopes are written over.
template <class V>
Balance<V> find_balance(const RollOut& task, const State<V>& state, RollOutMemory<V>& memory) {
    const Mechanics& mechanics = task.mechanics;
    const int first = mechanics.first();
    const Mat3<V>& R = state.T.R;
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> gravity = fill_vec3<V>(mechanics.gravity);
    Twist<V> base = {{zero, zero, zero}, {zero, zero, zero}};
    if (first)
        base = {transpose_times(R, vector_from(state.qd)), transpose_times(R, vector_from(state.qd + 3))};
    V* const momentum = memory.work.force;
    const WholeMomentum<V> whole =
        lagrangian_rates(mechanics.bodies, base, transpose_times(R, gravity), state.q, state.qd + first,
                         static_cast<LinkMomentum<V>*>(memory.work.links), momentum, memory.work.other);
    V twice = dot(base.v, whole.momentum.f) + dot(base.w, whole.momentum.n);
    for (int j = 0; j < mechanics.bodies.n_coordinates; ++j)
        twice = twice + state.qd[first + j] * momentum[j];
    Balance<V> balance;
    balance.energy = 0.5 * twice - dot(gravity, R * whole.first + mechanics.bodies.mass * state.T.t);
    const Vec3<V> center = (1.0 / mechanics.bodies.mass) * whole.first;
    const Wrench<V> central = momentum_about(whole.momentum, center);
    const Vec3<V> l = R * central.f, k = R * central.n;
    const V both[6] = {l.x, l.y, l.z, k.x, k.y, k.z};
    std::copy(both, both + 6, balance.momentum);
    return balance;
}

// Records the states of a pack; what it writes of rows that have ended counts for nothing.
template <class V>
void write_record(const RollOut& task, const RollOutPack<V>& pack, std::size_t record,
                  RollOutMemory<V>& memory) {
    const Records& to = task.records;
    const auto write = [&](const V* values, int width, double* array) {
        const std::size_t size = std::size_t(width), at = (pack.i * to.count + record) * size;
        store_rows(values, width, array + at, to.count * size, pack.count);
    };
    const int n = task.mechanics.bodies.n_coordinates, dof = task.mechanics.dof();
    const Balance<V> balance = find_balance(task, memory.state, memory);
    write(memory.state.q, n, to.q);
    write(memory.state.qd, dof, to.qd);
    write(memory.tau, dof, to.tau);
    write(&balance.energy, 1, to.energy);
    write(balance.momentum, 6, to.momentum);
    if (!to.T) return;
    V matrix[16];
    kinematics::write_matrix(memory.state.T, matrix);
    write(matrix, 16, to.T);
}

// Rows end with a status at a time.
template <class V>
CSPACE_INLINE void end_lanes(const RollOut& task, RollOutPack<V>& pack, mask_of<V> which, Status status,
                             V time) {
    if (!any(which)) return;
    for (int l = 0; l < pack.count; ++l) {
        if (!get_lane(which, l)) continue;
        task.status[pack.i + std::size_t(l)] = status;
        task.stopped[pack.i + std::size_t(l)] = get_lane(time, l);
    }
    pack.runs = pack.runs && !which;
}

// Whether all numbers of a state are finite, and small enough to compute with.
template <class V>
CSPACE_INLINE mask_of<V> tame_state(const RollOut& task, const State<V>& state) {
    mask_of<V> tame = fill_lanes<V>(0.0) == fill_lanes<V>(0.0);
    for (int j = 0; j < task.mechanics.bodies.n_coordinates; ++j)
        tame = tame && abs(state.q[j]) < largest_state;
    for (int j = 0; j < task.mechanics.dof(); ++j) tame = tame && abs(state.qd[j]) < largest_state;
    return tame;
}

// The joints that pass a limit end their rows.
template <class V>
void end_at_limits(const RollOut& task, RollOutPack<V>& pack, const State<V>& state, mask_of<V> moved,
                   V time) {
    for (int j = 0; j < task.mechanics.bodies.n_coordinates; ++j) {
        const mask_of<V> beyond =
            pack.runs && moved && (state.q[j] < task.lower[j] || state.q[j] > task.upper[j]);
        if (!any(beyond)) continue;
        for (int l = 0; l < pack.count; ++l)
            if (get_lane(beyond, l)) task.joint[pack.i + std::size_t(l)] = j;
        end_lanes(task, pack, beyond, at_limit, time);
    }
}

// Goes on from memory.state to memory.after in the lanes that moved; rows without a next state end before,
// and rows at a limit with it.
template <class V>
void take_step(const RollOut& task, RollOutPack<V>& pack, mask_of<V> moved, mask_of<V> solved, V time,
               V time_after, RollOutMemory<V>& memory) {
    State<V>&state = memory.state, &after = memory.after;
    const mask_of<V> failed = pack.runs && moved && !(solved && tame_state(task, after));
    end_lanes(task, pack, failed, broken, time);
    const mask_of<V> goes = pack.runs && moved;
    if (task.lower) end_at_limits(task, pack, after, moved, time_after);
    for (int j = 0; j < task.mechanics.bodies.n_coordinates; ++j)
        state.q[j] = select_lanes(goes, after.q[j], state.q[j]);
    for (int j = 0; j < task.mechanics.dof(); ++j) state.qd[j] = select_lanes(goes, after.qd[j], state.qd[j]);
    if (!task.mechanics.floating) return;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            state.T.R.m[r][c] = select_lanes(goes, after.T.R.m[r][c], state.T.R.m[r][c]);
    state.T.t = {select_lanes(goes, after.T.t.x, state.T.t.x), select_lanes(goes, after.T.t.y, state.T.t.y),
                 select_lanes(goes, after.T.t.z, state.T.t.z)};
}

// Steps of one length from number k to k_end, with the look at the end that number `steps` stands for.
template <class V>
void roll_fixed_steps(const RollOut& task, std::size_t i, int count, long long k, long long k_end,
                      RollOutMemory<V>& memory) {
    RollOutPack<V> pack = {i, count, {}};
    load_state(task, pack, memory);
    const bool is_variational = task.method == Method::variational;
    const mask_of<V> always = fill_lanes<V>(0.0) == fill_lanes<V>(0.0);
    if (k == 0 && task.mechanics.loops)
        end_lanes(task, pack, pack.runs && !settle_state(task.mechanics, memory.state, memory.work), broken,
                  fill_lanes<V>(0.0));
    if (is_variational && k < task.steps && any(pack.runs))
        factor_mass_matrix(task.mechanics, memory.state, memory.work);
    for (; k < k_end && any(pack.runs); ++k) {
        const V time = fill_lanes<V>(task.find_time(k));
        update_torques(task, pack, k, memory);
        const long long record = task.find_record(k);
        if (record >= 0) write_record(task, pack, std::size_t(record), memory);
        if (k == task.steps) {
            end_lanes(task, pack, pack.runs, ended, time);
            break;
        }
        const double later = task.find_time(k + 1);
        const V h = fill_lanes<V>(later - task.find_time(k));
        mask_of<V> solved = is_variational ? step_variational(task.mechanics, memory.state, memory.tau, h,
                                                              memory.work, memory.variational, memory.after)
                                           : step_runge_kutta(task.mechanics, memory.state, memory.tau, h,
                                                              memory.work, memory.stages, memory.after);
        if (task.mechanics.loops) solved = settle_state(task.mechanics, memory.after, memory.work) && solved;
        take_step(task, pack, always, solved, time, fill_lanes<V>(later), memory);
    }
    store_state(task, pack, memory);
}

// The estimated error of a step relative to the tolerance; infinite where there is no state.
template <class V>
V relative_error(const RollOut& task, V h, RollOutMemory<V>& memory) {
    const Mechanics& mechanics = task.mechanics;
    const int first = mechanics.first(), dof = mechanics.dof();
    const Stages<V>& stages = memory.stages;
    V *const dx = memory.work.force, *const dv = memory.work.other;
    weigh_rates(dormand_prince_error, 7, stages.xs, dof, h, dx);
    weigh_rates(dormand_prince_error, 7, stages.vs, dof, h, dv);
    const Vec3<V>& at = memory.state.T.t;
    const V origin[3] = {at.x, at.y, at.z}, one = fill_lanes<V>(1.0);
    V sum = fill_lanes<V>(0.0);
    for (int j = 0; j < dof; ++j) {
        V size = one;
        if (j >= first)
            size = one + max(abs(memory.state.q[j - first]), abs(memory.after.q[j - first]));
        else if (j < 3)
            size = one + abs(origin[j]);
        const V speed = one + max(abs(memory.state.qd[j]), abs(memory.after.qd[j]));
        const V x = dx[j] / (task.tolerance * size), v = dv[j] / (task.tolerance * speed);
        sum = sum + x * x + v * v;
    }
    const V error = sqrt(sum / double(dof > 0 ? 2 * dof : 1));
    const V infinite = fill_lanes<V>(std::numeric_limits<double>::infinity());
    return select_lanes(error < infinite && tame_state(task, memory.after), error, infinite);
}

// The length of the next step relative to this one.
template <class V>
V step_factors(V error) {
    V factor = fill_lanes<V>(fastest_change);
    for (int l = 0; l < Lanes<V>::count; ++l) {
        const double e = get_lane(error, l);
        if (e == 0.0) continue;
        const double wanted = step_safety * std::pow(e, -1.0 / error_order);
        set_lane(factor, l,
                 wanted < slowest_change   ? slowest_change
                 : wanted < fastest_change ? wanted
                                           : fastest_change);
    }
    return factor;
}

// The coefficients of θ, θ², θ³ and θ⁴ of a step, (4, dof) each.
template <class V>
void find_dense(const Mechanics& mechanics, V h, Stages<V>& stages, V* dx, V* dv) {
    const int dof = mechanics.dof();
    for (int p = 0; p < 4; ++p) {
        weigh_rates(dormand_prince_dense[p], 7, stages.xs, dof, h, dx + p * dof);
        weigh_rates(dormand_prince_dense[p], 7, stages.vs, dof, h, dv + p * dof);
    }
}

// Keeps the step of each lane that takes it. dx, dv: as of find_dense.
template <class V>
void keep_pieces(const RollOut& task, const RollOutPack<V>& pack, mask_of<V> takes, V time, V h, const V* dx,
                 const V* dv, const State<V>& state, PieceBuffer& pieces, std::size_t begin) {
    const int n = task.mechanics.bodies.n_coordinates, dof = task.mechanics.dof();
    V matrix[16];
    kinematics::write_matrix(state.T, matrix);
    for (int l = 0; l < pack.count; ++l) {
        if (!get_lane(takes, l)) continue;
        const std::size_t row = pack.i - begin + std::size_t(l);
        double* to = pieces.values + (row * std::size_t(pieces.room) + std::size_t(pieces.count[row]++)) *
                                         std::size_t(task.piece_width());
        const auto put = [&](const V* values, int width) {
            for (int j = 0; j < width; ++j) *to++ = get_lane(values[j], l);
        };
        put(&time, 1);
        put(&h, 1);
        put(state.q, n);
        put(state.qd, dof);
        if (task.mechanics.floating) put(matrix, 16);
        put(dx, 4 * dof);
        put(dv, 4 * dof);
    }
}

// The state in a step, θ of the way, into memory.after. step: dx and dv as of find_dense, which take 8 dof
// values; the stages' sums are written over.
template <class V>
void interpolate(const RollOut& task, V theta, const V* dx, const V* dv, RollOutMemory<V>& memory) {
    const int dof = task.mechanics.dof();
    const auto sum = [&](const V* c, V* to) {
        for (int j = 0; j < dof; ++j)
            to[j] = theta * (c[j] + theta * (c[dof + j] + theta * (c[2 * dof + j] + theta * c[3 * dof + j])));
    };
    sum(dx, memory.stages.dx);
    sum(dv, memory.stages.dv);
    advance_state(task.mechanics, memory.state, memory.stages.dx, memory.stages.dv, memory.stages.inner);
}

// Records the states of all lanes whose next records lie after their time and up to the end of their step,
// strictly before step k_end. dx, dv: as of find_dense.
template <class V>
void write_between(const RollOut& task, const RollOutPack<V>& pack, mask_of<V> takes, V time, V h,
                   V time_after, long long k_end, const V* dx, const V* dv, RollOutMemory<V>& memory) {
    for (;;) {
        V theta = fill_lanes<V>(0.0);
        bool due[8] = {}, is_any = false;
        for (int l = 0; l < pack.count; ++l) {
            const long long k = task.next[pack.i + std::size_t(l)];
            if (!get_lane(takes, l) || k >= k_end || task.find_time(k) > get_lane(time_after, l)) continue;
            due[l] = is_any = true;
            set_lane(theta, l, (task.find_time(k) - get_lane(time, l)) / get_lane(h, l));
        }
        if (!is_any) return;
        interpolate(task, theta, dx, dv, memory);
        const State<V>& state = memory.stages.inner;
        const Balance<V> balance = find_balance(task, state, memory);
        V matrix[16];
        kinematics::write_matrix(state.T, matrix);
        const Records& to = task.records;
        for (int l = 0; l < pack.count; ++l) {
            if (!due[l]) continue;
            long long& k = task.next[pack.i + std::size_t(l)];
            const std::size_t at = (pack.i + std::size_t(l)) * to.count + std::size_t(k / task.every);
            k += task.every;
            const auto put = [&](const V* values, int width, double* array) {
                for (int j = 0; j < width; ++j)
                    array[at * std::size_t(width) + std::size_t(j)] = get_lane(values[j], l);
            };
            put(state.q, task.mechanics.bodies.n_coordinates, to.q);
            put(state.qd, task.mechanics.dof(), to.qd);
            put(memory.tau, task.mechanics.dof(), to.tau);
            put(&balance.energy, 1, to.energy);
            put(balance.momentum, 6, to.momentum);
            if (to.T) put(matrix, 16, to.T);
        }
    }
}

// Steps as long as the tolerance allows from step k to step k_end, over which what acts is smooth, each row
// with lengths of its own. is_fresh: the first call for these. begin: of the rows of the buffer, which has
// room for the steps of one call. True if all rows have come to step k_end or ended.
template <class V>
bool roll_adaptive_steps(const RollOut& task, std::size_t begin, std::size_t i, int count, long long k,
                         long long k_end, bool is_fresh, PieceBuffer& pieces, RollOutMemory<V>& memory) {
    RollOutPack<V> pack = {i, count, {}};
    load_state(task, pack, memory);
    const V until = fill_lanes<V>(task.find_time(k_end)), dt = fill_lanes<V>(task.dt);
    V time = fill_lanes<V>(task.find_time(k)), length = dt;
    if (is_fresh) {
        update_torques(task, pack, k, memory);
        const long long record = task.find_record(k);
        if (record >= 0) write_record(task, pack, std::size_t(record), memory);
        for (int l = 0; l < count; ++l) {
            task.next[i + std::size_t(l)] = k + task.every - k % task.every;
            task.time[i + std::size_t(l)] = task.find_time(k);
        }
    }
    for (int l = 0; l < count; ++l) {
        set_lane(time, l, task.time[i + std::size_t(l)]);
        set_lane(length, l, task.length[i + std::size_t(l)]);
    }
    V *const dx = memory.stages.xs + 7 * task.mechanics.dof(), *const dv = dx + 4 * task.mechanics.dof();
    bool is_done = false;
    for (int taken = 0; taken < pieces.room; ++taken) {
        const mask_of<V> active = pack.runs && time < until;
        is_done = !any(active);
        if (is_done) break;
        const mask_of<V> is_inside = time + length * (1.0 + shortest_step) < until;
        const V h = select_lanes(is_inside, length, until - time);
        const V time_after = select_lanes(is_inside, time + length, until);
        find_stages(dormand_prince, task.mechanics, memory.state, memory.tau, h, memory.work, memory.stages);
        const mask_of<V> near =
            advance_state(task.mechanics, memory.state, memory.stages.dx, memory.stages.dv, memory.after);
        V error = relative_error(task, h, memory);
        error = select_lanes(near, error, fill_lanes<V>(std::numeric_limits<double>::infinity()));
        const V next = h * step_factors(error);
        const mask_of<V> is_good = error <= 1.0;
        const mask_of<V> takes = active && (is_good || h <= shortest_step * (time + dt));
        if (any(takes)) {
            find_dense(task.mechanics, h, memory.stages, dx, dv);
            if (task.keeps_pieces)
                keep_pieces(task, pack, takes && is_good, time, h, dx, dv, memory.state, pieces, begin);
            write_between(task, pack, takes && is_good, time, h, time_after, k_end, dx, dv, memory);
            take_step(task, pack, takes, is_good, time, time_after, memory);
        }
        const V after = select_lanes(takes && !(h == length), max(length, next), next);
        length = select_lanes(active, after, length);
        time = select_lanes(takes, time_after, time);
    }
    for (int l = 0; l < count; ++l) {
        task.time[i + std::size_t(l)] = get_lane(time, l);
        task.length[i + std::size_t(l)] = get_lane(length, l);
    }
    store_state(task, pack, memory);
    return is_done;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
