// Configurations along a Cartesian path: each is corrected to its pose by Newton's method, with the first two
// derivatives of the joints by the parameter s of the path, one row per lane.
//
// With the twist t = [v; ω] of the path by s and its derivative t',
//     J q' = t,    J q'' = t' − J' q'.
#pragma once

#include <algorithm>
#include <cstddef>

#include "cspace/ik/tracking/walker.hpp"

namespace cspace::ik {

struct PathRows {
    const Path* path;
    const int* column;  // coordinate j of the path is column[j] of a row
    std::size_t dof, count;
    const Posed* poses;
    const double *twists, *rates;  // (count, 6): t and t'
    double* q;                     // (count, dof): guesses, corrected
    double *slope, *bend;          // (count, dof): q' and q''; columns that do not move are left alone
    int locked;                    // a coordinate of the path that stays as it is, −1 for none
    double* info;    // (count, 2): pose error that is left, the least diagonal entry of the factored J
    void (*poll)();  // called now and then; throws to stop
};

inline constexpr int path_row_info = 2;

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline Twist<double> scaled_twist(const Path& path, const double* twist) {
    const double per = 1 / path.length;
    return {{per * twist[0], per * twist[1], per * twist[2], twist[3], twist[4], twist[5]}};
}

// Lanes of rows; the last row fills the lanes that are left over.
template <class V>
struct RowLanes {
    Pose<V> goal;
    Twist<V> twist, rate;
    V q[max_joints];
};

template <class V>
CSPACE_INLINE void load_path_rows(const PathRows& rows, std::size_t first, RowLanes<V>& lanes) {
    for (int l = 0; l < Lanes<V>::count; ++l) {
        const std::size_t k = std::min(first + std::size_t(l), rows.count - 1);
        set_pose_lane(lanes.goal, l, rows.poses[k]);
        const Twist<double> twist = scaled_twist(*rows.path, rows.twists + 6 * k),
                            rate = scaled_twist(*rows.path, rows.rates + 6 * k);
        for (int r = 0; r < 6; ++r) {
            set_lane(lanes.twist.entry[r], l, twist.entry[r]);
            set_lane(lanes.rate.entry[r], l, rate.entry[r]);
        }
        for (int j = 0; j < rows.path->n; ++j)
            set_lane(lanes.q[j], l, rows.q[k * rows.dof + std::size_t(rows.column[j])]);
    }
}

template <class V>
CSPACE_INLINE void store_path_rows(const PathRows& rows, std::size_t first, const RowLanes<V>& lanes,
                                   const Motion<V>& motion) {
    for (int l = 0; l < Lanes<V>::count && first + std::size_t(l) < rows.count; ++l) {
        const std::size_t k = first + std::size_t(l);
        for (int j = 0; j < rows.path->n; ++j) {
            const std::size_t at = k * rows.dof + std::size_t(rows.column[j]);
            const double unit = unit_of(*rows.path, j);
            rows.q[at] = get_lane(lanes.q[j], l);
            rows.slope[at] = unit * get_lane(motion.slope[j], l);
            rows.bend[at] = unit * get_lane(motion.bend[j], l);
        }
        rows.info[path_row_info * k] = get_lane(motion.error, l);
        rows.info[path_row_info * k + 1] = get_lane(motion.weakest, l);
    }
}

// Newton's method; a lane whose error is within rounding stays where it is.
template <class V>
CSPACE_INLINE void correct_rows(const Path& path, int locked, RowLanes<V>& lanes, Motion<V>& motion) {
    for (int k = 0;; ++k) {
        measure_motion(path, lanes.goal, lanes.twist, &lanes.rate, lanes.q, motion, locked);
        const mask_of<V> off = motion.error > track::met;
        if (k == track::most_corrections || !any(off)) return;
        for (int j = 0; j < path.n; ++j)
            lanes.q[j] =
                mul_add(keep_lanes(off, fill_lanes<V>(unit_of(path, j))), motion.correction[j], lanes.q[j]);
    }
}

template <class V>
void correct_path(const PathRows& rows) {
    RowLanes<V> lanes;
    Motion<V> motion;
    for (std::size_t first = 0; first < rows.count; first += std::size_t(Lanes<V>::count)) {
        if (rows.poll) rows.poll();
        load_path_rows(rows, first, lanes);
        correct_rows(*rows.path, rows.locked, lanes, motion);
        store_path_rows(rows, first, lanes, motion);
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
