// State of one tracked branch: its position on a path of poses, its next trial step, and whether the step is
// accepted.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cspace/ik/numeric/error.hpp"
#include "cspace/ik/tracking/motion.hpp"
#include "cspace/math/continuation.hpp"
#include "cspace/math/wrapping.hpp"

namespace cspace::ik {

struct Way {
    Posed from;
    Vec3d step, turn;  // of the whole way: [m] and rotation vector [rad], in base
    double length;     // |step| over the length of the arm + |turn|
};

enum class Fate : unsigned char {
    end,          // it follows the whole path
    limit,        // a joint would leave its limits
    singularity,  // the joints run into a singular configuration that lets them go no further
    jump,         // a joint would move too far between two neighbouring poses
    unreachable,  // an arm of fewer than six joints cannot keep to the poses
};

// The end of a branch.
struct BranchEnd {
    std::size_t reached;  // how many poses
    double at;            // number of a pose and the share of the way to the next
    Fate fate;
    int joint;       // the coordinate of the path that ended it, or −1
    double weakest;  // the least singular value there
};

// Data shared by all branches, and the destination of their results.
struct Track {
    const Path* path;
    const int* column;  // coordinate j of the path is coordinate column[j] of the robot
    std::size_t dof;    // coordinates of the robot
    const Posed* poses;
    const Way* ways;  // between poses; the last one is not used
    std::size_t count;
    bool whole_turns;      // a branch may begin at its start plus multiples of 2π
    const double* starts;  // (branches, dof)
    std::size_t branches;
    // Outputs, one per branch.
    double* q;     // (count, dof): of the poses it reaches
    double* last;  // (dof,): where it ends
    BranchEnd* ends;
    void (*poll)();  // called now and then; throws to stop
    double lower[max_joints], upper[max_joints];
    double stride[max_joints];  // how far a coordinate may move from one pose to the next
};

struct Walker {
    std::size_t branch;
    std::size_t row;  // the last pose reached
    double u, du;     // how far on the way to the next, and the step tried
    double reach;     // longest step that failures leave, as lengths of ways
    bool by_rows;     // the step is read off the rows before it
    bool starts, rows_tried;
    int corrections, tries;  // of this step; steps tried since the last pose
    double q[max_joints], slope[max_joints], bend[max_joints];  // at u; the latter scaled
    double trial[max_joints], planned[max_joints];              // planned: the step before its corrections
    double least[max_joints], most[max_joints];                 // run through so far
    double lower[max_joints], upper[max_joints], turns[max_joints];  // limits where it stands
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The segment between two poses: its point moves on a straight line, and its rotation about a fixed axis,
// both at constant speed.

inline Way way_between(const Posed& from, const Posed& to, double arm_length) {
    const Vec3d step = to.t - from.t, turn = spatial::rotvec_of_rotation(to.R * transpose(from.R));
    return {from, step, turn, norm(step) / arm_length + norm(turn)};
}

// The pose at the fraction u of the segment.
inline Posed pose_on(const Way& way, double u) {
    return {spatial::rotation_of_rotvec(u * way.turn) * way.from.R, way.from.t + u * way.step};
}

namespace track {
// Largest change of a coordinate in one step [rad, lengths of the path], and largest fraction of it from the
// second derivative. The neglected third derivative then contributes a few percent.
inline constexpr double longest_step = 0.25, most_bend = 0.15;
inline constexpr double free_correction = 1e-8;  // [rad, lengths] that is never too much
inline constexpr int most_corrections = 6;
// A fold takes some hundred steps, a joint a hundred per revolution. A branch that exceeds this bound makes
// no progress.
inline constexpr int most_tries = 20000;
// A correction below `small` leaves an error of its square. An error below `met` counts as zero.
inline constexpr double small = 1e-7, met = 1e-13;
// Pose error that counts as reached where the corrections do not converge to zero.
inline constexpr double feasible = 1e-9;
// Steps shorter than this fraction of a segment, or than this length, are not tried: the branch ends.
inline constexpr double least_share = 1e-8, least_length = 1e-11;
inline constexpr double slack = 1e-11;         // of limits [rad, m]
inline constexpr double singular_row = 1e-7;   // least diagonal entry that leaves joints free
inline constexpr double near_singular = 0.01;  // singular value at an end that calls it a singularity
}  // namespace track

CSPACE_INLINE double* row_of(const Track& t, const Walker& w, std::size_t row) {
    return t.q + (w.branch * t.count + row) * t.dof;
}

CSPACE_INLINE void copy_numbers(const double* from, int n, double* to) {
    for (int j = 0; j < n; ++j) to[j] = from[j];
}
// Coordinates of the robot: q on the path, the others as at the start.
inline void write_row(const Track& t, const Walker& w, const double* q, double* row) {
    copy_numbers(t.starts + w.branch * t.dof, int(t.dof), row);
    for (int j = 0; j < t.path->n; ++j) row[t.column[j]] = q[j];
}
// The step estimated from the last three rows: the parabola through them, by the lengths of the segments
// between them.
inline void plan_by_rows(const Track& t, Walker& w) {
    const double a = t.ways[w.row - 2].length, b = t.ways[w.row - 1].length, h = t.ways[w.row].length;
    const double *q0 = row_of(t, w, w.row - 2), *q1 = row_of(t, w, w.row - 1);
    for (int j = 0; j < t.path->n; ++j) {
        const double before = q0[t.column[j]], last = q1[t.column[j]];
        const double first = (last - before) / a, second = (w.q[j] - last) / b;
        const double bend = (second - first) / (a + b);
        w.planned[j] = h * (second + (b + h) * bend) / unit_of(*t.path, j);
    }
}
CSPACE_INLINE bool rows_can_tell(const Track& t, const Walker& w) {
    return w.u == 0 && w.row >= 2 && t.ways[w.row - 2].length > 0 && t.ways[w.row - 1].length > 0;
}

// The longest step that slope and second derivative allow.
inline double hopeful_step(const Track& t, const Walker& w) {
    const double slope = largest_of(w.slope, t.path->n), bend = largest_of(w.bend, t.path->n);
    const double length = t.ways[w.row].length;
    double du = 1 - w.u;
    if (length * du > w.reach) du = w.reach / length;
    if (slope * du > track::longest_step) du = track::longest_step / slope;
    if (bend * du > 2 * track::most_bend * slope && bend * du * du > track::free_correction)
        du = max(2 * track::most_bend * slope / bend, std::sqrt(track::free_correction / bend));
    return du;
}

// Sets du, planned and trial; false if the step would be too short.
inline bool plan_step(const Track& t, Walker& w) {
    const double left = 1 - w.u;
    w.corrections = 0;
    w.du = hopeful_step(t, w);
    // What slope and bend refuse the rows may still tell: they look past a singular pose.
    if (!w.rows_tried && rows_can_tell(t, w) && (w.by_rows || w.du < 1)) {
        w.rows_tried = true;
        plan_by_rows(t, w);
        w.by_rows = largest_of(w.planned, t.path->n) <= track::longest_step;
    } else {
        w.by_rows = false;
    }
    if (w.by_rows) {
        w.du = 1;
    } else {
        if (w.du < left && w.du > 0.5 * left) w.du = 0.5 * left;  // no crumbs
        if (!(w.du < left)) w.du = left;
        const bool short_step =
            w.du < track::least_share || w.du * t.ways[w.row].length < track::least_length;
        if (short_step && w.du < left) return false;
        const double from[max_joints] = {};
        predict_along(from, w.slope, w.bend, w.du, t.path->n, w.planned);
    }
    for (int j = 0; j < t.path->n; ++j) w.trial[j] = w.q[j] + unit_of(*t.path, j) * w.planned[j];
    return true;
}
CSPACE_INLINE bool to_a_row(const Walker& w) { return w.du == 1 - w.u; }

enum class Verdict { again, taken, failed, infeasible };

// Applies a correction to the trial and decides whether the step is accepted.
inline Verdict judge_step(const Track& t, Walker& w, const Motion<double>& at) {
    const int n = t.path->n;
    double total = 0;
    for (int j = 0; j < n; ++j) {
        const double scale = unit_of(*t.path, j);
        w.trial[j] += scale * at.correction[j];
        total = max(total, std::fabs((w.trial[j] - w.q[j]) / scale - w.planned[j]));
    }
    const double size = largest_of(w.planned, n), last = largest_of(at.correction, n);
    const double allowed = most_correction * size + track::free_correction;
    if (!w.starts && !(total <= allowed)) return Verdict::failed;
    // A pose that is singular itself leaves joints free: the rows before it tell where they go on.
    if (at.weakest < track::singular_row && !w.by_rows && !w.rows_tried && rows_can_tell(t, w))
        return Verdict::failed;
    if (at.error <= track::met) return Verdict::taken;
    if (n >= 6 && at.weakest > lost_direction && last <= track::small) return Verdict::taken;
    if (last <= track::small) {
        // Only what is feasible can be met; between poses the nearest will do.
        if (at.error <= track::feasible || (n < 6 && !to_a_row(w))) return Verdict::taken;
        if (w.corrections > 1) return n < 6 ? Verdict::infeasible : Verdict::failed;
    }
    return ++w.corrections < track::most_corrections ? Verdict::again : Verdict::failed;
}

// Shifts the limits of coordinate j by the smallest multiple of 2π that keeps its whole traversed range
// between them; false if none does.
inline bool fit_turns(const Track& t, Walker& w, int j) {
    if (!t.whole_turns || t.path->slides[j]) return false;
    const double turns = turns_within(w.least[j], w.most[j], t.lower[j] - track::slack,
                                      t.upper[j] + track::slack, 0, std::nan(""));
    if (std::isnan(turns)) return false;
    w.turns[j] = turns;
    w.lower[j] = t.lower[j] - 2 * pi * w.turns[j];
    w.upper[j] = t.upper[j] - 2 * pi * w.turns[j];
    return true;
}

// The amount by which q violates the limits, and the coordinate that does.
struct Outside {
    double by;
    int joint;
};
inline Outside measure_violation(const Track& t, const Walker& w, const double* q) {
    Outside worst = {-1e300, -1};
    for (int j = 0; j < t.path->n; ++j) {
        const double by = max(w.lower[j] - q[j], q[j] - w.upper[j]);
        if (by > worst.by) worst = {by, j};
    }
    worst.by -= track::slack;
    return worst;
}

// Extends the traversed ranges of the coordinates to q. Returns the coordinate whose limits no multiple of 2π
// satisfies, or −1.
inline int extend_ranges(const Track& t, Walker& w, const double* q) {
    int broken = -1;
    for (int j = 0; j < t.path->n; ++j) {
        w.least[j] = min(w.least[j], q[j]);
        w.most[j] = max(w.most[j], q[j]);
        const bool inside = q[j] >= w.lower[j] - track::slack && q[j] <= w.upper[j] + track::slack;
        if (!inside && !fit_turns(t, w, j)) broken = j;
    }
    return broken;
}

// The coordinate that has moved too far since the last pose, or −1.
inline int too_far(const Track& t, const Walker& w, const double* q) {
    const double* from = row_of(t, w, w.row);
    for (int j = 0; j < t.path->n; ++j)
        if (std::fabs(q[j] - from[t.column[j]]) > t.stride[j]) return j;
    return -1;
}

}  // namespace cspace::ik::inline CSPACE_ISA
