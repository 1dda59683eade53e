// Feasible intervals of a locked joint: the values for which each branch of the six other joints exists and
// satisfies its limits. A branch changes only at known critical values: points at limits, and folds. Between
// two critical values one sample decides.
#pragma once

#include "cspace/ik/redundancy/limits.hpp"
#include "cspace/ik/redundancy/turning_points.hpp"

namespace cspace::ik {

// What ends an interval, if not a joint: nothing (the interval is the full circle), or a fold.
inline constexpr int end_none = -1, end_fold = -2;

struct Interval {
    double lower, upper;  // of the parameter [rad or m]
    int branch;
    int end[2];            // the joint that stops it, end_fold or end_none
    int side[2];           // at its lower (0) or upper (1) limit
    double q[max_joints];  // a configuration in its middle
};
struct Intervals {
    static constexpr int room = 128;
    int count = 0;
    bool complete = true;
    Interval interval[room];
};

// A value of the parameter at which a branch may change.
struct Critical {
    double value;
    int end, side;
    int branch = -1;  // the branch that meets its limit there, where that is known
};
struct CriticalValues {
    static constexpr int room = LimitPoints::room + FoldValues::room + 2;
    int count = 0;
    Critical at[room];
};

// A sample in a cell between two critical values: the branches that exist, and those that satisfy their
// limits.
struct CellView {
    unsigned there = 0, within = 0;
    double q[max_branches][max_joints];
};

// Samples taken during the search for one change. Other branches change at the same values.
struct Looks {
    static constexpr int room = 64;
    int count = 0;
    double at[room];
    CellView view[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The value itself, or the value plus a multiple of 2π that lies in the domain or just above it.
inline double into_domain(const Domain& domain, bool slides, double value) {
    if (slides) return value;
    const double moved = wrap_above(value, domain.lower);
    // Rounding below the lower end is not a turn above it.
    return moved - domain.lower > 2 * pi - limit_slack ? domain.lower : moved;
}

inline void insert_sorted(CriticalValues& all, const Critical& c) {
    int at = all.count++;
    for (; at > 0 && all.at[at - 1].value > c.value; --at) all.at[at] = all.at[at - 1];
    all.at[at] = c;
}

inline CellView view_of(const Redundant& arm, const SweptRows& rows, int parameter) {
    CellView out;
    for (int k = 0; k < rows.count; ++k) {
        const int b = rows.branch[k];
        if (b >= max_branches) continue;
        out.there |= 1u << b;
        if (others_within(arm, rows.q[k], parameter, 0)) out.within |= 1u << b;
        for (int i = 0; i < arm.chain.n; ++i) out.q[b][i] = rows.q[k][i];
    }
    return out;
}
inline const CellView& look_at(const Redundant& arm, const Sweep& sweep, Looks& looks, double value) {
    for (int k = 0; k < looks.count && k < Looks::room; ++k)
        if (looks.at[k] == value) return looks.view[k];
    const int at = looks.count++ % Looks::room;
    looks.at[at] = value;
    sweep_values(sweep, &value, 1,
                 [&](int, const SweptRows& rows) { looks.view[at] = view_of(arm, rows, sweep.parameter); });
    return looks.view[at];
}

// By bisection, the value at which a branch changes between two values with different results, and the cause.
inline Critical bisect_change(const Redundant& arm, const Sweep& sweep, Looks& looks, int branch, double in,
                              double out) {
    constexpr double found_to = 1e-13;
    int cause = end_fold, side = 0;
    for (int step = 0; step < 60 && std::fabs(out - in) > found_to; ++step) {
        const double middle = 0.5 * (in + out);
        const CellView& there = look_at(arm, sweep, looks, middle);
        if (there.within >> branch & 1) {
            in = middle;
            continue;
        }
        out = middle;
        cause = end_fold;
        for (int i = 0; i < arm.chain.n && there.there >> branch & 1; ++i) {
            const double q = there.q[branch][i];
            if (i == sweep.parameter || !(excess(arm, i, q) > 0)) continue;
            cause = i;
            side = std::fabs(short_way(q - arm.upper[i])) < std::fabs(short_way(q - arm.lower[i]));
        }
    }
    return {in, cause, side, branch};
}

// The state while the cells are visited in ascending order.
struct Walk {
    const Redundant* arm;
    const Sweep* sweep;
    const CriticalValues* critical;
    Domain domain;
    Intervals* out;
    Looks* looks;
    int open[max_branches];  // the interval that a branch is in, or −1
    CellView first, before;
    double first_at, before_at;
    double fuzz;  // how far apart changes may lie that count as one place
};

// The cause for which a branch is feasible on one side of a boundary only, and the exact value. turn: the
// multiple of 2π added to the boundary on a circle.
inline Critical end_between(const Walk& walk, int branch, const CellView& out, double in_at, double out_at,
                            double boundary, double turn = 0) {
    const bool vanishes = !(out.there >> branch & 1);
    for (const bool by_fold : {vanishes, !vanishes})
        for (int k = 0; k < walk.critical->count; ++k) {
            const Critical& c = walk.critical->at[k];
            if (!(std::fabs(c.value + turn - boundary) <= walk.fuzz)) continue;
            const bool folds = c.end == end_fold && (c.branch < 0 || c.branch == branch);
            if (by_fold ? vanishes && folds : c.end != end_fold && c.branch == branch)
                return {c.value + turn, c.end, c.side, branch};
        }
    return bisect_change(*walk.arm, *walk.sweep, *walk.looks, branch, in_at, out_at);
}

inline void open_interval(Walk& walk, int branch, const CellView& view, const Critical& end) {
    Intervals& out = *walk.out;
    if (out.count == Intervals::room) {
        out.complete = false;
        return;
    }
    Interval& made = out.interval[walk.open[branch] = out.count++];
    made = {end.value, end.value, branch, {end.end, end_none}, {end.side, 0}, {}};
    for (int i = 0; i < walk.arm->chain.n; ++i) made.q[i] = view.q[branch][i];
}
inline void close_interval(Walk& walk, int branch, const Critical& end) {
    if (walk.open[branch] < 0) return;
    Interval& made = walk.out->interval[walk.open[branch]];
    made.upper = end.value;
    made.end[1] = end.end;
    made.side[1] = end.side;
    walk.open[branch] = -1;
}

// Crosses `boundary` from the previous cell to the next.
inline void cross_boundary(Walk& walk, const CellView& next, double next_at, double boundary) {
    for (int b = 0; b < max_branches; ++b) {
        const bool was = walk.before.within >> b & 1, is = next.within >> b & 1;
        if (was && !is)
            close_interval(walk, b, end_between(walk, b, next, walk.before_at, next_at, boundary));
        else if (is && !was)
            open_interval(walk, b, next,
                          end_between(walk, b, walk.before, next_at, walk.before_at, boundary));
    }
    walk.before = next;
    walk.before_at = next_at;
}

// On a circle the last cell is followed by the first.
inline void close_circle(Walk& walk, double boundary) {
    constexpr double turn = 2 * pi;
    Intervals& out = *walk.out;
    for (int b = 0; b < max_branches; ++b) {
        const bool was = walk.before.within >> b & 1, is = walk.first.within >> b & 1;
        const double first_at = walk.first_at + turn;
        int head = -1;  // the interval that the first cell began in
        for (int k = 0; k < out.count && is; ++k)
            if (head < 0 && out.interval[k].branch == b && out.interval[k].end[0] == end_none) head = k;
        if (was && !is) {
            close_interval(walk, b,
                           end_between(walk, b, walk.first, walk.before_at, first_at, boundary, turn));
        } else if (is && !was && head >= 0) {
            const Critical end = end_between(walk, b, walk.before, first_at, walk.before_at, boundary, turn);
            out.interval[head].lower = end.value - turn;
            out.interval[head].end[0] = end.end;
            out.interval[head].side[0] = end.side;
        } else if (was && is && head >= 0 && walk.open[b] == head) {
            out.interval[head].lower = -pi;
            out.interval[head].upper = pi;
        } else if (was && is && head >= 0 && walk.open[b] >= 0) {
            Interval& tail = out.interval[walk.open[b]];
            tail.upper = out.interval[head].upper + turn;
            tail.end[1] = out.interval[head].end[1];
            tail.side[1] = out.interval[head].side[1];
            out.interval[head].branch = -1;
        }
    }
    int kept = 0;
    for (int k = 0; k < out.count; ++k)
        if (out.interval[k].branch >= 0) out.interval[kept++] = out.interval[k];
    out.count = kept;
}

// [rad, m] Distance from a branch up to which a point at a limit belongs to it.
inline constexpr double on_branch = 1e-4;

// Assigns each point at a limit to its branch.
inline void name_branches(const Sweep& sweep, const LimitPoints& points, int* branch) {
    double values[LimitPoints::room];
    for (int k = 0; k < points.count; ++k) values[k] = points.point[k].q[sweep.parameter];
    sweep_values(sweep, values, points.count, [&](int k, const SweptRows& rows) {
        double least = on_branch;
        branch[k] = -1;
        for (int j = 0; j < rows.count; ++j) {
            const double gap = joint_gap(sweep.locked->whole, rows.q[j], points.point[k].q);
            if (!(gap < least)) continue;
            least = gap;
            branch[k] = rows.branch[j];
        }
    });
}

// The values at which a branch may change, in ascending order, once per cause.
inline void collect_critical(const Redundant& arm, const Sweep& sweep, const Domain& domain,
                             const LimitPoints& points, const FoldValues& folds, CriticalValues& out) {
    const int p = sweep.parameter;
    const bool slides = arm.chain.prismatic[p];
    const auto add = [&](double value, int end, int side, int branch) {
        const double v = into_domain(domain, slides, value);
        if (v >= domain.lower && v <= domain.upper) insert_sorted(out, {v, end, side, branch});
    };
    int branch[LimitPoints::room];
    name_branches(sweep, points, branch);
    for (int k = 0; k < points.count; ++k) {
        const LimitPoint& point = points.point[k];
        add(point.q[p], point.joint, point.side, branch[k]);
    }
    for (int k = 0; k < folds.count; ++k) add(folds.value[k], end_fold, 0, folds.branch[k]);
    if (domain.is_circle) return;
    insert_sorted(out, {domain.lower, p, 0, -1});
    insert_sorted(out, {domain.upper, p, 1, -1});
}

// For one locked joint at an end of the chain and a closed form with known folds.
inline void walk_cells(const Redundant& arm, const Sweep& sweep, const CriticalValues& critical,
                       const Domain& domain, Intervals& out) {
    // [rad, m] The square root of the form's error.
    constexpr double merging = 1e-6, merging_idealised = 1e-4;
    // Where two branches all but meet, nothing can be told from a value in between.
    const double fuzz = sweep.locked->arm.plan.idealised ? merging_idealised : merging;
    double boundary[CriticalValues::room + 1], middle[CriticalValues::room + 1];
    int n = 0;
    for (int k = 0; k < critical.count; ++k)
        if (n == 0 || critical.at[k].value - boundary[n - 1] > fuzz) boundary[n++] = critical.at[k].value;
    if (domain.is_circle) {
        boundary[n] = n ? boundary[0] + 2 * pi : pi;
        if (n == 0) boundary[n++] = -pi, boundary[n] = pi;
        ++n;
    }
    for (int k = 0; k + 1 < n; ++k) middle[k] = 0.5 * (boundary[k] + boundary[k + 1]);
    Looks looks;
    Walk walk{&arm, &sweep, &critical, domain, &out, &looks, {}, {}, {}, 0, 0, fuzz};
    for (int& k : walk.open) k = -1;
    sweep_values(sweep, middle, n - 1, [&](int k, const SweptRows& rows) {
        const CellView view = view_of(arm, rows, sweep.parameter);
        out.complete = out.complete && rows.complete;
        if (k > 0) {
            cross_boundary(walk, view, middle[k], boundary[k]);
            return;
        }
        walk.first = walk.before = view;
        walk.first_at = walk.before_at = middle[k];
        const int end = domain.is_circle ? end_none : sweep.parameter;
        for (int b = 0; b < max_branches; ++b)
            if (view.within >> b & 1) open_interval(walk, b, view, {boundary[0], end, 0, b});
    });
    if (domain.is_circle) {
        close_circle(walk, boundary[n - 1]);
        return;
    }
    for (int b = 0; b < max_branches; ++b) close_interval(walk, b, {boundary[n - 1], sweep.parameter, 1, b});
}

// Removes empty intervals that rounding produces at interval ends.
inline void drop_empty(Intervals& out) {
    int kept = 0;
    for (int k = 0; k < out.count; ++k)
        if (out.interval[k].upper - out.interval[k].lower > limit_slack)
            out.interval[kept++] = out.interval[k];
    out.count = kept;
}

// Returns true if this method applies to the arm. `out.complete` then states whether the intervals are
// complete.
inline bool intervals_by_cells(const Redundant& arm, const LimitArms& arms, const Posed& goal,
                               Intervals& out) {
    if (arm.redundancy_degree != 1) return false;
    const int p = arm.locked.locked_joint[0];
    const Sweep sweep = make_sweep(arm.locked, p, goal, arm.middle);
    const FoldValues folds = fold_values(arm, sweep);
    if (!folds.exact) return false;
    LimitPoints points;
    find_limit_points(arm, arms, goal, p, points);
    const Domain domain = domain_of(arm, p, goal);
    CriticalValues critical;
    collect_critical(arm, sweep, domain, points, folds, critical);
    out.count = 0;
    out.complete = points.complete;
    walk_cells(arm, sweep, critical, domain, out);
    drop_empty(out);
    return true;
}

}  // namespace cspace::ik::inline CSPACE_ISA
