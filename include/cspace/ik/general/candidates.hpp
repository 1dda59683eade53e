// Configurations near solutions become solutions: refined, distinguished, with their partners near folds.
#pragma once

#include <algorithm>
#include <initializer_list>

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/general/isolate.hpp"
#include "cspace/ik/general/loop.hpp"
#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::ik {

// Configurations near solutions, before they are polished.
struct Candidates {
    static constexpr int room = 4 * max_roots;
    int count = 0;
    double q[room][6];
    double last[room][6];  // where Newton's method stopped that was not settled
    bool close[room];      // beside another solution: it may have a twin, and may lead nowhere
    bool settled[room];    // polished
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline void append_candidate(Candidates& out, const double* q, bool close) {
    if (out.count == Candidates::room) return;
    for (int i = 0; i < 6; ++i) out.q[out.count][i] = q[i];
    out.close[out.count++] = close;
}

template <class V>
inline void put_lane(Candidates& out, const V* q, int k, bool close) {
    double row[6];
    for (int i = 0; i < 6; ++i) row[i] = get_lane(q[i], k);
    append_candidate(out, row, close);
}

// Newton's method on four candidates abreast, from number `first` on.
inline void polish_candidates(const GeneralPlan& plan, const Posed& goal, int first, Candidates& all) {
    constexpr double last_step = 1e-9;  // [rad] the step after it squares the error
    constexpr double converged = 1e-7;  // [rad] a larger step was the first of many, or cut short
    for_each_pack(all.count - first, [&](auto pack, int i) {
        using V = decltype(pack);
        const int row = first + i, lanes = std::min(all.count - row, Lanes<V>::count);
        const Pose<V> goals = fill_pose<V>(goal);
        V q[6], step = fill_lanes<V>(1.0);
        load_rows(&all.q[row][0], 6, lanes, 6, q);
        for (int k = 0; k < 8 && any(step > last_step); ++k)
            step = newton_step(plan.chain, goals, 1.0, q, 0.3);
        for (int k = 0; k < lanes; ++k) {
            all.settled[row + k] = get_lane(step, k) < converged;
            double* const to = all.settled[row + k] ? all.q[row + k] : all.last[row + k];
            for (int j = 0; j < 6; ++j) to[j] = get_lane(q[j], k);
        }
    });
}

// Whether no slide has run away: where two of them are nearly parallel Newton's method may send them where
// nothing is left of the tip but rounding.
inline bool is_sane(const Chain& chain, const Posed& goal, const double* q) {
    constexpr double far = 1e4;  // lengths of the arm, and of the way to the goal
    for (int i = 0; i < chain.n; ++i)
        if (chain.prismatic[i] && !(std::fabs(q[i]) < far * (1 + norm(goal.t)))) return false;
    return true;
}

inline void drop_row(Solutions& out, int row) {
    --out.count;
    for (int k = row; k < out.count; ++k)
        for (int i = 0; i < 6; ++i) out.q[k][i] = out.q[k + 1][i];
}

// Adds a polished solution unless it is there or the room is used up. Of those that differ by no more than
// what Newton's method left of them, as it does on a fold, the best one stays.
inline void admit_polished(Solutions& out, const GeneralPlan& plan, const Posed& goal, const double* q) {
    const Chain& chain = plan.chain;
    if (!is_sane(chain, goal, q)) return;
    constexpr double wide = 1e-2, near = 1e-3;
    double here = -1;
    for (int k = 0; k < out.count;) {
        const double gap = joint_distance(chain, out.q[k], q, wide);
        if (gap < tolerance::same_solution) return;
        if (!(gap < wide)) {
            ++k;
            continue;
        }
        if (here < 0) here = miss_of(chain, goal, 1.0, q);
        const double there = miss_of(chain, goal, 1.0, out.q[k]), left = max(here, there);
        if (!are_one(chain, goal, 1.0, out.q[k], q, gap, near, left)) {
            ++k;
            continue;
        }
        if (there <= here) return;
        drop_row(out, k);
    }
    if (out.count < max_solutions) append_solution(chain, q, out.count, out);
}

// Second derivative of the error below which a valley is straight: differences of errors leave some 1e-9.
inline constexpr double least_bend = 1e-4;

// Beside a fold a solution has a near-double: along the weakest direction v the error is σ t u + ½ κ t² u +
// …, which vanishes again at t = −2 σ/κ. False where there is no fold (σ is more than `most`, κ less than
// `least`): a self-motion does not bend.
inline bool find_near_double(const GeneralPlan& plan, const Posed& goal, const double* q, double* near_double,
                             double most = 0.1, double least = least_bend) {
    PoseError error;
    const double length = 1.0;
    measure_error(plan.chain, goal, length, q, error);
    const WeakDirection weak = weak_direction(error.jacobian, most);
    if (weak.sigma > most) return false;
    constexpr double h = 1e-3;
    double bend = 2 * dot_n(weak.u, error.e, 6);
    for (const double way : {h, -h}) {
        PoseError moved;
        for (int i = 0; i < 6; ++i) near_double[i] = q[i] + way * weak.v[i];
        measure_error(plan.chain, goal, length, near_double, moved);
        bend -= dot_n(weak.u, moved.e, 6);  // the error is goal less pose
    }
    bend /= h * h;
    const double t = -2 * weak.sigma / bend;
    for (int i = 0; i < 6; ++i) near_double[i] = q[i] + t * weak.v[i];
    return std::fabs(t) < 0.5 && std::fabs(bend) > least;
}
// Whether a solution is its own twin, as far as rounding can tell: two in one.
inline bool is_double(const GeneralPlan& plan, const Posed& goal, const double* q) {
    constexpr double close = 1e-3;  // [rad] farther apart, rounding does not merge two solutions
    double near_double[6];
    if (!find_near_double(plan, goal, q, near_double)) return false;
    return joint_distance(plan.chain, q, near_double) < close &&
           miss_between(plan.chain, goal, 1.0, q, near_double) <= tolerance::halfway;
}

// Polishes the candidates from number `first` on.
inline void admit_candidates(const GeneralPlan& plan, const Posed& goal, int first, Candidates& all,
                             Solutions& out) {
    polish_candidates(plan, goal, first, all);
    for (int k = first; k < all.count; ++k)
        if (all.settled[k]) admit_polished(out, plan, goal, all.q[k]);
}

// The twins of solutions that stand beside others, or may.
inline void add_near_double_roots(const GeneralPlan& plan, const Posed& goal, Candidates& all,
                                  Solutions& out) {
    const int direct = all.count;
    double near_double[6];
    for (int k = 0; k < direct; ++k)
        if (all.close[k] && all.settled[k] && find_near_double(plan, goal, all.q[k], near_double))
            append_candidate(all, near_double, false);
    admit_candidates(plan, goal, direct, all, out);
}

// Candidates that Newton's method did not settle, once more with damping; those that came where another one
// has been refined from are not.
inline void refine_unsettled(const GeneralPlan& plan, const Posed& goal, Candidates& all, Solutions& out,
                             Refined& refined) {
    const int direct = all.count;
    for (int k = 0; k < direct; ++k) {
        if (all.settled[k]) continue;
        const int same = find_refined(plan.chain, refined, all.q[k], all.last[k]);
        if (same >= 0) {
            std::copy(refined.end[same], refined.end[same] + 6, all.q[k]);
            continue;
        }
        double start[6];
        std::copy(all.q[k], all.q[k] + 6, start);
        if (miss_of(plan.chain, goal, 1.0, all.last[k]) < miss_of(plan.chain, goal, 1.0, start))
            std::copy(all.last[k], all.last[k] + 6, all.q[k]);
        PoseError error;
        const double left = refine_solution(plan.chain, goal, 1.0, all.q[k], error, 10);
        note_refined(refined, start, all.last[k], all.q[k]);
        // Beside solutions a valley that almost reaches the goal is none of them.
        if (!(left <= (out.count ? tolerance::exact : tolerance::reached))) continue;
        const int before = out.count;
        admit_polished(out, plan, goal, all.q[k]);
        double near_double[6];
        if (all.close[k] && out.count > before && find_near_double(plan, goal, all.q[k], near_double))
            append_candidate(all, near_double, false);
    }
    admit_candidates(plan, goal, direct, all, out);
}

// The solutions near the candidates that list(add) adds by add(q, close). Returns what list returns.
template <class List>
inline bool admit_listed(const GeneralPlan& plan, const Posed& goal, const List& list, Solutions& out) {
    Candidates found;
    const bool result = list([&](const double* q, bool close) { append_candidate(found, q, close); });
    admit_candidates(plan, goal, 0, found, out);
    add_near_double_roots(plan, goal, found, out);
    Refined refined;
    refine_unsettled(plan, goal, found, out, refined);
    return result;
}

}  // namespace cspace::ik::inline CSPACE_ISA
