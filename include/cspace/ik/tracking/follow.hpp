// Continuation of solution branches along a path of poses, one branch per lane. A step is predicted from
// slope and curvature, and corrected by Newton's method. It is shortened until the correction is small
// compared with the step (Allgower and Georg 1990). A lane whose branch has ended takes the next branch.
#pragma once

#include "cspace/ik/tracking/walker.hpp"
#include "cspace/math/singular_values.hpp"

namespace cspace::ik {

// The lanes of a track: the configurations to evaluate next.
template <class V>
struct TrackLanes {
    Pose<V> goal;
    Twist<V> twist;
    V q[max_joints];
    Motion<V> motion;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The end of a tracked branch: the exact point at which a limit is reached, how singular the arm is there,
// and the record of it.

inline Twist<double> twist_of(const Way& way, double arm_length) {
    const double per = 1 / arm_length;
    return {{per * way.step.x, per * way.step.y, per * way.step.z, way.turn.x, way.turn.y, way.turn.z}};
}

inline double least_singular_value(const Path& path, const double* q) {
    const PlacedJoints<double> at = place_joints(path, q);
    Twist<double> J[max_joints];
    columns_of(path, path.n, at, J);
    double rows[6 * max_joints], sigma[6];
    for (int j = 0; j < path.n; ++j)
        for (int r = 0; r < 6; ++r) rows[r * path.n + j] = J[j].entry[r];
    singular_values(rows, 6, path.n, sigma);
    return sigma[path.n < 6 ? path.n - 1 : 5];
}

// The point at which the first limit is reached, between w.u, where w.q is within the limits, and w.u + w.du,
// where w.trial is not; w moves there. Regula falsi that halves the value of a retained end (Dowell and
// Jarratt 1971).
inline Outside meet_limit(const Track& t, Walker& w) {
    const int n = t.path->n;
    const Way& way = t.ways[w.row];
    double low = w.u, high = w.u + w.du, q_high[max_joints], q[max_joints];
    copy_numbers(w.trial, n, q_high);
    Outside at_low = measure_violation(t, w, w.q), at_high = measure_violation(t, w, q_high), met = at_high;
    double f_low = at_low.by, f_high = at_high.by;
    int kept = 0;
    for (int step = 0; step < 100 && high - low > tolerance::last_digits && f_low < 0; ++step) {
        const double share = step % 8 == 7 ? 0.5 : f_low / (f_low - f_high), u = low + share * (high - low);
        // Where the trial brings it or q brings it: both ends are solutions, what lies between is close.
        const double along = (u - low) / (high - low);
        for (int j = 0; j < n; ++j) q[j] = w.q[j] + along * (q_high[j] - w.q[j]);
        const Posed goal = pose_on(way, u);
        Motion<double> motion;
        for (int k = 0; k < track::most_corrections; ++k) {
            measure_motion<double>(*t.path, goal, twist_of(way, t.path->length), nullptr, q, motion);
            for (int j = 0; j < n; ++j) q[j] += unit_of(*t.path, j) * motion.correction[j];
            if (largest_of(motion.correction, n) < track::small) break;
        }
        const Outside here = measure_violation(t, w, q);
        if (here.by <= 0) {
            low = u;
            copy_numbers(q, n, w.q);
            f_low = here.by;
            if (kept == -1) f_high *= 0.5;
            kept = -1;
        } else {
            high = u;
            copy_numbers(q, n, q_high);
            f_high = here.by;
            met = here;
            if (kept == 1) f_low *= 0.5;
            kept = 1;
        }
    }
    w.u = low;
    return met;
}

// Records where the branch of a walker ends, and the cause.
inline void finish_branch(const Track& t, const Walker& w, Fate fate, int joint, std::size_t reached) {
    double* last = t.last + w.branch * t.dof;
    t.ends[w.branch] = {reached, double(w.row) + w.u, fate, joint, least_singular_value(*t.path, w.q)};
    write_row(t, w, w.q, last);
    for (int j = 0; j < t.path->n; ++j) {
        if (w.turns[j] == 0) continue;
        const double shift = 2 * pi * w.turns[j];
        last[t.column[j]] += shift;
        for (std::size_t k = 0; k < reached; ++k) row_of(t, w, k)[t.column[j]] += shift;
    }
}

// Loads the trial of a walker into lane l. The evaluation there also serves the following step.
template <class V>
CSPACE_INLINE void load_trial(const Track& t, const Walker& w, int l, TrackLanes<V>& lanes) {
    const bool row = !w.starts && to_a_row(w);
    const Posed& to_row = t.poses[w.row + row];
    const Posed goal = row || w.starts ? to_row : pose_on(t.ways[w.row], w.u + w.du);
    const std::size_t next = row && w.row + 2 < t.count ? w.row + 1 : w.row;
    const Twist<double> twist = twist_of(t.ways[next], t.path->length);
    set_pose_lane(lanes.goal, l, goal);
    for (int r = 0; r < 6; ++r) set_lane(lanes.twist.entry[r], l, twist.entry[r]);
    for (int j = 0; j < t.path->n; ++j) set_lane(lanes.q[j], l, w.trial[j]);
}

// Initialises a branch at its start, which is corrected to the first pose.
inline void begin_branch(const Track& t, std::size_t branch, Walker& w) {
    w.branch = branch;
    w.row = 0;
    w.u = w.du = 0;
    w.reach = 1e300;
    w.by_rows = false;
    w.starts = w.rows_tried = true;
    w.corrections = w.tries = 0;
    const double* start = t.starts + branch * t.dof;
    for (int j = 0; j < t.path->n; ++j) {
        w.q[j] = w.trial[j] = w.least[j] = w.most[j] = start[t.column[j]];
        w.planned[j] = w.slope[j] = w.bend[j] = w.turns[j] = 0;
        w.lower[j] = t.lower[j];
        w.upper[j] = t.upper[j];
    }
}

// Records that the branch has reached its next pose; true if it is the last one.
inline bool arrive_at_pose(const Track& t, Walker& w) {
    w.u = 0;
    w.rows_tried = false;
    w.tries = 0;
    write_row(t, w, w.q, row_of(t, w, w.row));
    if (w.row + 1 < t.count) return false;
    finish_branch(t, w, Fate::end, -1, t.count);
    return true;
}

// Accepts the trial as the state of the walker; true if the branch has ended.
inline bool take_step(const Track& t, Walker& w) {
    const int broken = extend_ranges(t, w, w.trial);
    if (w.starts) {
        copy_numbers(w.trial, t.path->n, w.q);
        if (broken >= 0) finish_branch(t, w, Fate::limit, broken, 0);
        w.starts = false;
        return broken >= 0 || arrive_at_pose(t, w);
    }
    if (broken >= 0) {
        const Outside met = meet_limit(t, w);
        finish_branch(t, w, Fate::limit, met.joint, w.row + 1);
        return true;
    }
    const int far = too_far(t, w, w.trial);
    if (far >= 0) {
        finish_branch(t, w, Fate::jump, far, w.row + 1);
        return true;
    }
    const bool row = to_a_row(w);
    copy_numbers(w.trial, t.path->n, w.q);
    w.u += w.du;
    w.reach *= 2;
    w.by_rows = false;
    w.row += row;
    return row && arrive_at_pose(t, w);
}

// After a rejected step: a step estimated from the previous rows, else one half as long.
inline void plan_again(const Track& t, Walker& w) {
    if (w.by_rows) {
        w.by_rows = false;
        return;
    }
    w.by_rows = !w.rows_tried && rows_can_tell(t, w);
    w.reach = 0.5 * w.du * t.ways[w.row].length;
}

// Evaluates the trial of a walker and plans the next evaluation; true if its branch has ended.
inline bool evaluate_trial(const Track& t, Walker& w, const Motion<double>& at) {
    const std::size_t reached = w.row + !w.starts;
    switch (judge_step(t, w, at)) {
        case Verdict::again:
            return false;
        case Verdict::infeasible:
            finish_branch(t, w, Fate::unreachable, -1, reached);
            return true;
        case Verdict::failed:
            if (w.starts) {
                finish_branch(t, w, Fate::singularity, -1, 0);
                return true;
            }
            plan_again(t, w);
            break;
        case Verdict::taken:
            if (take_step(t, w)) return true;
            copy_numbers(at.slope, t.path->n, w.slope);
            copy_numbers(at.bend, t.path->n, w.bend);
    }
    if (++w.tries < track::most_tries && plan_step(t, w)) return false;
    finish_branch(t, w, Fate::singularity, -1, reached);
    BranchEnd& end = t.ends[w.branch];
    if (!(end.weakest < track::near_singular)) end.fate = Fate::jump;
    return true;
}

template <class V>
CSPACE_INLINE Motion<double> lane_of(const Motion<V>& motion, int n, int l) {
    Motion<double> out;
    out.error = get_lane(motion.error, l);
    out.weakest = get_lane(motion.weakest, l);
    for (int j = 0; j < n; ++j) {
        out.correction[j] = get_lane(motion.correction[j], l);
        out.slope[j] = get_lane(motion.slope[j], l);
        out.bend[j] = get_lane(motion.bend[j], l);
    }
    return out;
}

template <class V>
void follow_branches(const Track& t) {
    constexpr int lanes = Lanes<V>::count;
    if (t.branches == 0) return;
    Walker walker[lanes];
    bool live[lanes];
    TrackLanes<V> at;
    std::size_t next = 0;
    for (int l = 0; l < lanes; ++l) {
        live[l] = next < t.branches;
        begin_branch(t, live[l] ? next++ : 0, walker[l]);
        load_trial(t, walker[l], l, at);
    }
    constexpr unsigned between_polls = 32;
    unsigned rounds = 0;
    for (bool alive = true; alive;) {
        if (t.poll && ++rounds % between_polls == 0) t.poll();
        measure_motion<V>(*t.path, at.goal, at.twist, nullptr, at.q, at.motion);
        alive = false;
        for (int l = 0; l < lanes; ++l) {
            Walker& w = walker[l];
            if (!live[l]) continue;
            if (evaluate_trial(t, w, lane_of(at.motion, t.path->n, l))) {
                live[l] = next < t.branches;
                if (!live[l]) continue;
                begin_branch(t, next++, w);
            }
            load_trial(t, w, l, at);
            alive = true;
        }
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
