// Every solution of six joints in general position, for one goal.
#pragma once

#include "cspace/ik/careful.hpp"
#include "cspace/ik/general/close_pairs.hpp"
#include "cspace/ik/general/isolate.hpp"
#include "cspace/ik/general/orientation_first.hpp"
#include "cspace/ik/general/two_sheets.hpp"
#include "cspace/ik/general/weak_direction.hpp"
#include "cspace/ik/polish.hpp"

namespace cspace::ik {

// What one formulation saw of a goal.
struct Certificate {
    bool complete = false;
    double alias = 1;
    int roots = 0, clusters = 0;
    int work = 0;  // about in units of one evaluation of the determinant
};

// Configurations near solutions, before they are polished.
struct Candidates {
    static constexpr int room = 4 * max_roots;
    int count = 0;
    double q[room][6];
    bool close[room];    // beside another solution: it may have a twin, and may lead nowhere
    bool settled[room];  // polished
};

}  // namespace cspace::ik

namespace cspace::inline CSPACE_ISA {

inline constexpr double clear_equation =
    1e-8;                                   // its rounding moves no pair of roots that the signs would miss
inline constexpr double near_roots = 3e-3;  // [rad] hidden angles this close share a null plane

inline void put(ik::Candidates& out, const double* q, bool close) {
    if (out.count == ik::Candidates::room) return;
    for (int i = 0; i < 6; ++i) out.q[out.count][i] = q[i];
    out.close[out.count++] = close;
}

// Newton's method on four candidates abreast, from number `first` on.
inline void polish_candidates(const ik::GeneralPlan& plan, const Posed& goal, int first,
                              ik::Candidates& all) {
    using V = Pack<4>;
    const Pose<V> goal4 = fill_pose<V>(goal);
    for (; first < all.count; first += 4) {
        const int lanes = all.count - first < 4 ? all.count - first : 4;
        V q[6], step = fill<V>(1.0);
        load_rows(&all.q[first][0], 6, lanes, 6, q);
        for (int k = 0; k < 8 && any(step > 1e-9); ++k) step = newton_step(plan.chain, goal4, 1.0, q, 0.3);
        for (int k = 0; k < lanes; ++k) {
            all.settled[first + k] = lane(step, k) < 1e-7;
            if (!all.settled[first + k]) continue;
            for (int i = 0; i < 6; ++i) all.q[first + k][i] = lane(q[i], k);
        }
    }
}

// Whether no slide has run away: where two of them are nearly parallel Newton's method may send them where
// nothing is left of the tip but rounding.
inline bool is_sane(const ik::Chain& chain, const Posed& goal, const double* q) {
    constexpr double far = 1e4;  // lengths of the arm, and of the way to the goal
    for (int i = 0; i < chain.n; ++i)
        if (chain.prismatic[i] && !(std::fabs(q[i]) < far * (1 + norm(goal.t)))) return false;
    return true;
}

inline void drop_row(ik::Solutions& out, int row) {
    --out.count;
    for (int k = row; k < out.count; ++k)
        for (int i = 0; i < 6; ++i) out.q[k][i] = out.q[k + 1][i];
}

// Adds a polished solution unless it is there or the room is used up. Of those that differ by no more than
// what Newton's method left of them, as it does on a fold, the best one stays.
inline void admit_polished(ik::Solutions& out, const ik::GeneralPlan& plan, const Posed& goal,
                           const double* q) {
    const ik::Chain& chain = plan.chain;
    if (!is_sane(chain, goal, q)) return;
    double here = -1;
    for (int k = 0; k < out.count;) {
        const double gap = distance(chain, out.q[k], q);
        if (gap < tolerance::same_solution) return;
        if (!(gap < 1e-3)) {
            ++k;
            continue;
        }
        if (here < 0) here = miss_of(chain, goal, 1.0, q);
        const double there = miss_of(chain, goal, 1.0, out.q[k]), left = max(here, there);
        if (!(miss_halfway(chain, goal, 1.0, out.q[k], q) <= max(tolerance::halfway, left))) {
            ++k;
            continue;
        }
        if (there <= here) return;
        drop_row(out, k);
    }
    if (out.count == ik::max_solutions) return;
    const int n = out.count++;
    for (int i = 0; i < 6; ++i) out.q[n][i] = chain.prismatic[i] ? q[i] : wrap_once(short_way(q[i]));
    out.branch[n] = static_cast<signed char>(n);
    out.family[n] = false;
}

// Beside a fold a solution has a twin: along the weakest direction v the error is σ t u + ½ κ t² u + …, which
// vanishes again at t = −2 σ/κ.
inline void propose_twin(const ik::GeneralPlan& plan, const Posed& goal, const double* q,
                         ik::Candidates& out) {
    PoseError error;
    const double length = 1.0;
    measure(plan.chain, goal, length, q, error);
    const WeakDirection weak = weak_direction(&error.jacobian.us[0]);
    if (weak.sigma > 0.1) return;
    constexpr double h = 1e-3;
    double there[6], bend = 2 * dot_n(weak.u, error.e, 6);
    for (const double way : {h, -h}) {
        PoseError moved;
        for (int i = 0; i < 6; ++i) there[i] = q[i] + way * weak.v[i];
        measure(plan.chain, goal, length, there, moved);
        bend -= dot_n(weak.u, moved.e, 6);  // the error is goal less pose
    }
    bend /= h * h;
    const double t = -2 * weak.sigma / bend;
    if (!(std::fabs(t) < 0.5)) return;
    for (int i = 0; i < 6; ++i) there[i] = q[i] + t * weak.v[i];
    put(out, there, false);
}

// Roots that stand alone: null vectors of four at a time.
inline void follow_roots(const ik::Loop& loop, const Elimination& e, const ik::HiddenAngles& hidden,
                         const bool* close, ik::Candidates& out) {
    using V = Pack<4>;
    const bool doubled = !(e.a4_rank > 1e-6);
    for (int first = 0; first < hidden.count; first += 4) {
        const int lanes = hidden.count - first < 4 ? hidden.count - first : 4;
        V angle, q[6], second[6];
        for (int k = 0; k < 4; ++k)
            set_lane(angle, k, hidden.root[first + (k < lanes ? k : lanes - 1)].angle);
        const Turn<V> a0 = turn_by(angle);
        ReducedEquations<V> reduced;
        reduce_equations(e, a0.c, a0.s, reduced);
        joints_from(loop, e, a0, half_angles(null_vector(reduced)), q, second);
        double row[6];
        for (int k = 0; k < lanes; ++k) {
            for (int i = 0; i < 6; ++i) row[i] = lane(q[i], k);
            put(out, row, close[first + k] || doubled);
            if (!doubled) continue;
            for (int i = 0; i < 6; ++i) row[i] = lane(second[i], k);
            put(out, row, true);
        }
    }
}

// Roots beside each other: both solutions of their null plane.
inline void split_close_roots(const ik::Loop& loop, const Elimination& e, const ik::HiddenAngles& hidden,
                              const bool* close, ik::Candidates& out) {
    double last = 100;
    for (int k = 0; k < hidden.count; ++k) {
        if (!close[k]) continue;
        if (std::fabs(hidden.root[k].angle - last) < 1e-4) continue;  // the same plane
        last = hidden.root[k].angle;
        const Turn<double> a0 = turn_by(hidden.root[k].angle);
        ReducedEquations<double> reduced;
        reduce_equations(e, a0.c, a0.s, reduced);
        Monomials<double> both[2];
        const int count = split_plane(weak_plane(reduced), both);
        for (int j = 0; j < count; ++j) {
            double q[6], second[6];
            joints_from(loop, e, a0, half_angles(both[j]), q, second);
            put(out, q, true);
            if (!(e.a4_rank > 1e-6)) put(out, second, true);
        }
    }
}

// Polishes the candidates from number `first` on, and with them the twins that they turn out to have.
inline void admit_candidates(const ik::GeneralPlan& plan, const Posed& goal, int first, ik::Candidates& all,
                             ik::Solutions& out) {
    polish_candidates(plan, goal, first, all);
    const int direct = all.count;
    for (int k = first; k < direct; ++k) {
        if (!all.settled[k]) continue;
        const int before = out.count;
        admit_polished(out, plan, goal, all.q[k]);
        if (all.close[k] && out.count > before) propose_twin(plan, goal, all.q[k], all);
    }
    polish_candidates(plan, goal, direct, all);
    for (int k = direct; k < all.count; ++k)
        if (all.settled[k]) admit_polished(out, plan, goal, all.q[k]);
}

// Candidates that Newton's method did not settle, once more with damping.
inline void refine_unsettled(const ik::GeneralPlan& plan, const Posed& goal, ik::Candidates& all,
                             ik::Solutions& out) {
    const int count = all.count;
    for (int k = 0; k < count; ++k) {
        if (all.settled[k]) continue;
        PoseError error;
        const double left = refine(plan.chain, goal, 1.0, all.q[k], error, 10);
        if (!(left <= tolerance::reached)) continue;
        const int before = out.count;
        admit_polished(out, plan, goal, all.q[k]);
        if (all.close[k] && out.count > before) propose_twin(plan, goal, all.q[k], all);
    }
}

// Whether every announced root has brought its solutions: around each hidden angle there are at least as many
// solutions as roots. Where noise hides how many roots there are, nothing can be said.
inline bool all_matched(const ik::Loop& loop, const ik::HiddenAngles& hidden, const ik::Solutions& found) {
    const auto is_near = [](double a, double b) { return std::fabs(short_way(a - b)) < near_roots; };
    for (int k = 0; k < hidden.count; ++k) {
        if (hidden.root[k].expected == ik::nearly_two) continue;
        int expected = 0, there = 0;
        for (int j = 0; j < hidden.count; ++j) {
            if (!is_near(hidden.root[j].angle, hidden.root[k].angle)) continue;
            if (hidden.root[j].expected == ik::unknown) return false;
            expected += hidden.root[j].expected > 0 ? hidden.root[j].expected : 0;
        }
        for (int j = 0; j < found.count; ++j)
            there += is_near(loop.sign * found.q[j][loop.joint[0]], hidden.root[k].angle);
        if (there < expected) return false;
    }
    return true;
}

// On both sheets of each hidden angle: one of them is meant, unless noise hides which.
inline void follow_sheets(const TwoSheets& sheets, const ik::HiddenAngles& hidden, const bool* close,
                          ik::Candidates& out) {
    constexpr double clearly = 1e-3;
    for (int k = 0; k < hidden.count; ++k) {
        const AtHiddenAngle<double> at = at_hidden_angle(sheets, turn_by(hidden.root[k].angle));
        const Turn<double> g = lack(at);
        const double root = std::sqrt(max(at.inside, 0.0));
        const double there[2] = {std::fabs(g.c + root * g.s), std::fabs(g.c - root * g.s)};
        for (int side = 0; side < 2; ++side) {
            if (there[1 - side] < clearly * there[side]) continue;
            double q[6];
            joints_on_sheet(sheets, at, side ? -1 : 1, q);
            put(out, q, close[k] || !(there[side] < clearly * there[1 - side]));
        }
    }
}

// All solutions by the roots of f, a function of the hidden angle; `follow` makes candidates of them.
template <class Function, class Follow>
inline ik::Certificate solve_by_hidden_angle(const ik::GeneralPlan& plan, const Posed& goal,
                                             const ik::Loop& loop, const Function& f, const Follow& follow,
                                             ik::Solutions& out) {
    ik::Certificate seen;
    ik::HiddenAngles hidden;
    isolate(f, hidden);
    seen.alias = hidden.alias;
    seen.roots = hidden.count;
    seen.work = hidden.evaluations;
    if (hidden.alias > regular_alias) return seen;
    bool close[ik::max_roots] = {};
    for (int k = 0; k < hidden.count; ++k) {
        close[k] = hidden.root[k].width > 0;
        for (int j = 0; j < hidden.count && !close[k]; ++j)
            close[k] =
                j != k && std::fabs(short_way(hidden.root[j].angle - hidden.root[k].angle)) < near_roots;
        seen.clusters += close[k];
    }
    ik::Candidates found;
    follow(hidden, close, found);
    admit_candidates(plan, goal, 0, found, out);
    const auto settled_all = [&] { return out.count % 2 == 0 && all_matched(loop, hidden, out); };
    bool all = settled_all();
    seen.work += found.count;
    if (!all) {
        seen.work += 10 * found.count;
        const int direct = found.count;
        refine_unsettled(plan, goal, found, out);
        admit_candidates(plan, goal, direct, found, out);
        all = settled_all();
    }
    seen.complete = all && seen.alias < 1e-9 && !hidden.overflow;
    return seen;
}

// Whether a formulation can be asked of these joints: the hidden angle, the one that is stripped and the one
// that is eliminated last must turn.
inline bool is_possible(const ik::Loop& loop, ik::Formulation form) {
    int slides = 0;
    for (const bool s : loop.slides) slides += s;
    if (slides == 2) return !loop.slides[0] && !form.backwards;
    return slides < 2 && !loop.slides[0] && !loop.slides[3] && !loop.slides[5];
}

inline ik::Certificate solve_formulation(const ik::GeneralPlan& plan, const Posed& goal, int number,
                                         ik::Solutions& out) {
    const ik::Loop loop = make_loop(plan.frames, plan.chain.prismatic, goal, formulation(number));
    if (!is_possible(loop, formulation(number))) return {};
    if (plan.slides == 2) {
        const TwoSheets sheets = two_sheets(loop);
        if (!(sheets.square_end > 1e-9)) return {};
        const auto f = [&](Pack<4> c, Pack<4> s) { return lack_on_both(sheets, c, s); };
        const auto follow = [&](const ik::HiddenAngles& hidden, const bool* close, ik::Candidates& found) {
            follow_sheets(sheets, hidden, close, found);
        };
        return solve_by_hidden_angle(plan, goal, loop, f, follow, out);
    }
    const Elimination e = eliminate(loop);
    const auto f = [&](Pack<4> c, Pack<4> s) { return determinant(e, c, s); };
    const auto follow = [&](const ik::HiddenAngles& hidden, const bool* close, ik::Candidates& found) {
        follow_roots(loop, e, hidden, close, found);
        bool any_close = false;
        for (int k = 0; k < hidden.count; ++k) any_close |= close[k];
        if (any_close) split_close_roots(loop, e, hidden, close, found);
    };
    ik::Certificate seen = solve_by_hidden_angle(plan, goal, loop, f, follow, out);
    seen.complete = seen.complete && e.faintest > clear_equation;
    return seen;
}

// Of three joints that turn and three that slide.
inline bool solve_orientation_first(const ik::GeneralPlan& plan, const Posed& goal, ik::Solutions& out) {
    constexpr double clear = 1e-9, flat = 1e-9;
    const TwoOrientations both = two_orientations(plan.chain, orientation_first(plan.chain), goal);
    ik::Candidates found;
    for (int k = 0; k < both.count; ++k) put(found, both.q[k], both.inside < 1e-6);
    admit_candidates(plan, goal, 0, found, out);
    refine_unsettled(plan, goal, found, out);
    return both.volume > flat && std::fabs(both.inside) > clear;
}

}  // namespace cspace::inline CSPACE_ISA
