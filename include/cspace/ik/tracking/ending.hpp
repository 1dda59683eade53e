// The end of a tracked branch: the exact point at which a limit is reached, how singular the arm is there,
// and the record of it.
#pragma once

#include "cspace/ik/tracking/walker.hpp"
#include "cspace/kinematics/singular_values.hpp"

namespace cspace::ik::inline CSPACE_ISA {

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
    kinematics::singular_values(rows, 6, path.n, sigma);
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
    Outside at_low = outside(t, w, w.q), at_high = outside(t, w, q_high), met = at_high;
    double f_low = at_low.by, f_high = at_high.by;
    int kept = 0;
    for (int step = 0; step < 100 && high - low > 1e-15 && f_low < 0; ++step) {
        const double share = step % 8 == 7 ? 0.5 : f_low / (f_low - f_high), u = low + share * (high - low);
        // Where the trial brings it or q brings it: both ends are solutions, what lies between is close.
        const double along = (u - low) / (high - low);
        for (int j = 0; j < n; ++j) q[j] = w.q[j] + along * (q_high[j] - w.q[j]);
        const Posed goal = pose_on(way, u);
        Motion<double> motion;
        for (int k = 0; k < track::most_corrections; ++k) {
            measure_motion(*t.path, goal, twist_of(way, t.path->length), q, motion);
            for (int j = 0; j < n; ++j) q[j] += scale_of(*t.path, j) * motion.correction[j];
            if (largest_of(motion.correction, n) < track::small) break;
        }
        const Outside here = outside(t, w, q);
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
    const int n = t.path->n;
    t.fate[w.branch] = fate;
    t.joint[w.branch] = joint;
    t.reached[w.branch] = std::int64_t(reached);
    t.ends[w.branch] = double(w.row) + w.u;
    t.weakest[w.branch] = least_singular_value(*t.path, w.q);
    double* last = t.last + w.branch * std::size_t(n);
    for (int j = 0; j < n; ++j) last[j] = w.q[j] + track::whole_turn * w.turns[j];
    for (int j = 0; j < n; ++j) {
        if (w.turns[j] == 0) continue;
        for (std::size_t k = 0; k < reached; ++k) row_of(t, w, k)[j] += track::whole_turn * w.turns[j];
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
