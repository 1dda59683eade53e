// Feasible intervals of a locked joint: the values for which each branch of the six other joints exists and
// satisfies its limits. A branch changes only at known critical values: points at limits, and folds. Between
// two critical values one sample decides.
#pragma once

#include "cspace/ik/redundancy/limits.hpp"
#include "cspace/ik/redundancy/turning_points.hpp"
#include "cspace/ik/solution.hpp"

namespace cspace::ik {

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

// The cells between neighbouring critical values. Cell k reaches from boundary k to boundary k + 1. On a
// circle the first cell follows the last.
struct Cells {
    static constexpr int room = CriticalValues::room + 1;
    int count = 0;
    bool is_circle;
    double fuzz;  // how far apart changes may lie that count as one place
    double boundary[room + 1], middle[room];
    unsigned there[room], within[room];  // as of CellView
    Looks looks;
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
        if (is_within(arm, rows.q[k], limit_slack, parameter)) out.within |= 1u << b;
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
            if (i == sweep.parameter || !(limit_excess(arm, i, q) > limit_slack)) continue;
            cause = i;
            side = std::fabs(short_way(q - arm.upper[i])) < std::fabs(short_way(q - arm.lower[i]));
        }
    }
    return {in, cause, side, branch};
}

// Why a branch is feasible on one side of boundary c alone, above it or below, and the exact value.
// Boundaries beyond the last are those of the next turn.
inline Critical end_at(const Redundant& arm, const Sweep& sweep, const CriticalValues& critical, Cells& cells,
                       int c, int branch, bool above) {
    const int n = cells.count;
    if (!cells.is_circle && (c == 0 || c == n)) return {cells.boundary[c], sweep.parameter, c == n, branch};
    const int round = c < 1 ? -1 : c > n, high = c - n * round, outside = above ? high - 1 : high % n;
    const double turn = high == n ? 2 * pi : 0, moved = 2 * pi * round;
    const bool vanishes = !(cells.there[outside] >> branch & 1);
    for (const bool by_fold : {vanishes, !vanishes})
        for (int k = 0; k < critical.count; ++k) {
            const Critical& at = critical.at[k];
            if (!(std::fabs(at.value + turn - cells.boundary[high]) <= cells.fuzz)) continue;
            const bool folds = at.end == end_fold && (at.branch < 0 || at.branch == branch);
            if (by_fold ? vanishes && folds : at.end != end_fold && at.branch == branch)
                return {at.value + turn + moved, at.end, at.side, branch};
        }
    const double sides[2] = {cells.middle[high - 1], cells.middle[high % n] + turn};
    Critical found = bisect_change(arm, sweep, cells.looks, branch, sides[above], sides[!above]);
    found.value += moved;
    return found;
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

// The boundaries and middles of the cells, those of nearly equal critical values once.
inline void divide_domain(const CriticalValues& critical, Cells& cells) {
    double* boundary = cells.boundary;
    int n = 0;
    for (int k = 0; k < critical.count; ++k)
        if (n == 0 || critical.at[k].value - boundary[n - 1] > cells.fuzz)
            boundary[n++] = critical.at[k].value;
    if (cells.is_circle) {
        if (n == 0) boundary[n++] = -pi;
        boundary[n] = boundary[0] + 2 * pi;
    } else {
        --n;
    }
    cells.count = n;
    for (int k = 0; k < n; ++k) cells.middle[k] = 0.5 * (boundary[k] + boundary[k + 1]);
}

// Whether short cells have the same feasible branches towards both of their ends as in the middle. Two limit
// points next to a fold may have been taken for one.
inline bool are_short_cells_uniform(const Redundant& arm, const Sweep& sweep, const Cells& cells) {
    constexpr double longest = 1e-2;  // [rad, m]
    double value[2 * Cells::room];
    int cell[2 * Cells::room], count = 0;
    for (int k = 0; k < cells.count; ++k) {
        const double length = cells.boundary[k + 1] - cells.boundary[k];
        for (const double part : {-0.4, 0.4}) {
            if (length > longest) continue;
            cell[count] = k;
            value[count++] = cells.middle[k] + part * length;
        }
    }
    bool same = true;
    sweep_values(sweep, value, count, [&](int i, const SweptRows& rows) {
        same = same && view_of(arm, rows, sweep.parameter).within == cells.within[cell[i]];
    });
    return same;
}

// For one locked joint at an end of the chain and a closed form with known folds. An interval is a run of
// cells in which one branch is feasible.
inline void walk_cells(const Redundant& arm, const Sweep& sweep, const CriticalValues& critical,
                       bool is_circle, Intervals& out) {
    Cells cells;
    cells.is_circle = is_circle;
    cells.fuzz = fuzz_of(sweep.locked->arm.plan);
    divide_domain(critical, cells);
    const int n = cells.count;
    int first[Intervals::room], kept = 0;
    sweep_values(sweep, cells.middle, n, [&](int k, const SweptRows& rows) {
        const CellView view = view_of(arm, rows, sweep.parameter);
        out.complete = out.complete && rows.complete;
        cells.there[k] = view.there;
        cells.within[k] = view.within;
        const unsigned begun = view.within & ~(k ? cells.within[k - 1] : 0);
        for (int b = 0; b < max_branches; ++b) {
            if (!(begun >> b & 1)) continue;
            if (out.count == Intervals::room) {
                out.complete = false;
                return;
            }
            first[out.count] = k;
            Interval& made = out.interval[out.count++];
            made.branch = b;
            for (int i = 0; i < arm.chain.n; ++i) made.q[i] = view.q[b][i];
        }
    });
    out.complete = out.complete && are_short_cells_uniform(arm, sweep, cells);
    for (int i = 0; i < out.count; ++i) {
        Interval made = out.interval[i];
        const auto holds = [&](int cell) { return cells.within[cell % n] >> made.branch & 1; };
        const int farthest = is_circle ? first[i] + n - 1 : n - 1;
        int last = first[i];
        while (last < farthest && holds(last + 1)) ++last;
        Critical low = {-pi, end_none, 0}, high = {pi, end_none, 0};
        if (!is_circle || last - first[i] < n - 1) {
            if (is_circle && first[i] == 0 && holds(n - 1)) continue;  // the run that began below goes on
            low = end_at(arm, sweep, critical, cells, first[i], made.branch, true);
            high = end_at(arm, sweep, critical, cells, last + 1, made.branch, false);
        }
        if (!(high.value - low.value > limit_slack)) continue;  // what rounding leaves of none
        made.lower = low.value, made.upper = high.value;
        made.end[0] = low.end, made.end[1] = high.end;
        made.side[0] = low.side, made.side[1] = high.side;
        out.interval[kept++] = made;
    }
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
    walk_cells(arm, sweep, critical, domain.is_circle, out);
    return true;
}

}  // namespace cspace::ik::inline CSPACE_ISA
