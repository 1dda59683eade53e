// Every solution of six joints in general position, for one goal.
#pragma once

#include <algorithm>

#include "cspace/ik/general/candidates.hpp"
#include "cspace/ik/general/isolate.hpp"
#include "cspace/ik/general/recover.hpp"
#include "cspace/ik/general/two_prismatic.hpp"
#include "cspace/ik/near_singular.hpp"

namespace cspace::ik {

// What one formulation saw of a goal.
struct Certificate {
    bool complete = false;
    bool trusted = false;  // its hidden angles are all there are
    HiddenAngles hidden;   // of joint number `joint`, times `sign`
    double slip = 0;       // what the errors of its equations may do to the determinant, of its largest value
    int joint = 0;
    double sign = 1;
    int clusters = 0;
    bool shared = false;  // a hidden angle by several solutions, perhaps more than it shows
    int work = 0;         // about in units of one evaluation of the determinant
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline constexpr double clear_equation =
    1e-8;                                     // its rounding moves no pair of roots that the signs would miss
inline constexpr double clear_sheets = 1e-9;  // square of the sine that parts the two sheets
inline constexpr double rough_root = 1e-5;    // solutions are polished on the arm
inline constexpr double as_isolated = 2 * rough_root;
inline constexpr double equation_error = 3e-14;  // of their entries, with a margin
inline constexpr double trusted_alias = 1e-9;    // harmonics that must vanish: above, some noise moves roots
inline constexpr double near_roots = 3e-3;       // [rad] hidden angles this close share a null plane

// The null vectors of hidden angles, four at a time.
inline void follow_roots(const Loop& loop, const Elimination& e, const double* angle, int count, bool close,
                         Candidates& out) {
    const bool doubled = !(e.a4_rank > firm_rank);
    for_each_pack(count, [&](auto pack, int first) {
        using V = decltype(pack);
        const int lanes = std::min(count - first, Lanes<V>::count);
        V q[6], second[6];
        const Turn<V> a0 = turn_by(load_lanes<V>(angle + first, lanes));
        ReducedEquations<V> reduced;
        reduce_equations(e, a0.c, a0.s, reduced);
        V null[12];
        null_vector(reduced, null);
        joints_from(loop, e, a0, half_angles(null), q, second);
        for (int k = 0; k < lanes; ++k) {
            put_lane(out, q, k, close || doubled);
            if (doubled) put_lane(out, second, k, true);
        }
    });
}

// Both solutions of the null planes that belong to hidden angles, four at a time.
inline void split_planes(const Loop& loop, const Elimination& e, const double* angle, int count,
                         Candidates& out) {
    using V = Pack<4>;
    const bool doubled = !(e.a4_rank > firm_rank);
    for (int first = 0; first < count; first += 4) {
        const int lanes = count - first < 4 ? count - first : 4;
        V at = fill_lanes<V>(0.0);
        for (int k = 0; k < 4; ++k) set_lane(at, k, angle[first + (k < lanes ? k : lanes - 1)]);
        const Turn<V> a0 = turn_by(at);
        ReducedEquations<V> reduced;
        reduce_equations(e, a0.c, a0.s, reduced);
        V plane[2][12], both[2][12];
        weak_plane(reduced, plane);
        const mask_of<V> split = split_plane(plane, both);
        for (const auto& one : both) {
            V q[6], second[6];
            joints_from(loop, e, a0, half_angles(one), q, second);
            for (int k = 0; k < lanes; ++k) {
                if (!get_lane(split, k)) continue;
                put_lane(out, q, k, true);
                if (doubled) put_lane(out, second, k, true);
            }
        }
    }
}

// How many solutions a root announces. Where noise hides whether there is a pair of roots, it counts as one.
inline int announced_roots(const HiddenAngle& root, double slip) {
    const bool hidden_pair = root.expected == unknown || (root.expected == nearly_two && root.depth < slip);
    return hidden_pair ? 2 : std::max(root.expected, 0);
}

// How many more there are about a root than it and those beside it announce: pairs that the signs do not
// show. None of roots that are there for every goal.
inline int hidden_beside(const Certificate& seen, const HiddenAngle& root) {
    int shown = 0;
    for (int j = 0; j < seen.hidden.count; ++j) {
        const HiddenAngle& other = seen.hidden.root[j];
        if (!(std::fabs(short_way(other.angle - root.angle)) < order_seen)) continue;
        if (other.expected == spurious) return 0;
        shown += announced_roots(other, seen.slip);
    }
    return std::max(root.order - shown, 0) / 2 * 2;
}

// How many solutions the roots around a hidden angle announce, and how many there are; one may count twice.
struct Around {
    int expected = 0, there = 0;
};
inline Around count_around(const Certificate& seen, const Solutions& found, const bool* twice, double angle) {
    const auto is_near = [&](double a) { return std::fabs(short_way(a - angle)) < near_roots; };
    Around out;
    int hidden = 0;
    for (int j = 0; j < seen.hidden.count; ++j) {
        const HiddenAngle& root = seen.hidden.root[j];
        if (!is_near(root.angle)) continue;
        out.expected += announced_roots(root, seen.slip);
        if (root.order > 2) hidden = std::max(hidden, hidden_beside(seen, root));
    }
    out.expected += hidden;
    for (int j = 0; j < found.count; ++j)
        if (is_near(seen.sign * found.q[j][seen.joint])) out.there += twice[j] ? 2 : 1;
    return out;
}

// Whether every announced root has brought its solutions: around each hidden angle there are at least as many
// solutions as roots, and an even number in all.
inline bool all_matched(const Certificate& seen, const Solutions& found, const bool* twice) {
    int count = 0;
    for (int j = 0; j < found.count; ++j) count += twice[j] ? 2 : 1;
    if (count % 2 != 0) return false;
    for (int k = 0; k < seen.hidden.count; ++k) {
        const HiddenAngle& root = seen.hidden.root[k];
        if (root.expected == nearly_two && !(root.depth < seen.slip)) continue;
        const Around here = count_around(seen, found, twice, root.angle);
        if (here.there < here.expected) return false;
    }
    return true;
}

// Hidden angles that stand beside others, or are themselves more than one.
inline int mark_close(const HiddenAngles& hidden, bool* close) {
    int count = 0;
    for (int k = 0; k < hidden.count; ++k) {
        close[k] = hidden.root[k].width > 0;
        for (int j = 0; j < hidden.count && !close[k]; ++j)
            close[k] =
                j != k && std::fabs(short_way(hidden.root[j].angle - hidden.root[k].angle)) < near_roots;
        count += close[k];
    }
    return count;
}

// Whether solutions far from each other share a hidden angle and its roots may not show how many they are:
// there are more of them already, or they stand where roots are not told apart and not by the arm's nature
// (`paired`).
inline bool share_angles(const Certificate& seen, const Chain& chain, const Solutions& found,
                         const bool* twice, bool paired) {
    constexpr double far = 0.01, unresolved = 2e-4, exactly = 1e-6;
    bool close[max_roots];
    mark_close(seen.hidden, close);
    for (int k = 0; k < seen.hidden.count; ++k) {
        if (!close[k]) continue;
        const double angle = seen.hidden.root[k].angle;
        const Around here = count_around(seen, found, twice, angle);
        const double within = here.there > here.expected      ? unresolved
                              : paired                        ? 0
                              : seen.hidden.root[k].width > 0 ? as_isolated
                                                              : exactly;
        for (int i = 0; i < found.count; ++i) {
            const double own = seen.sign * found.q[i][seen.joint];
            if (!(std::fabs(short_way(own - angle)) < unresolved)) continue;
            for (int j = 0; j < i; ++j) {
                const double other = seen.sign * found.q[j][seen.joint];
                if (std::fabs(short_way(own - other)) < within &&
                    joint_distance(chain, found.q[i], found.q[j]) > far)
                    return true;
            }
        }
    }
    return false;
}

inline void mark_doubles(const GeneralPlan& plan, const Posed& goal, const Solutions& found, bool* twice) {
    for (int k = 0; k < found.count; ++k) twice[k] = is_double(plan, goal, found.q[k]);
}

// On both sheets of each hidden angle: one of them is meant, unless noise hides which.
inline bool follow_sheets(const TwoSheets& sheets, const HiddenAngles& hidden, const bool* close,
                          Candidates& out) {
    constexpr double clearly = 1e-3;
    bool doubtful = false;
    for (int k = 0; k < hidden.count; ++k) {
        const AtHiddenAngle<double> at = at_hidden_angle(sheets, turn_by(hidden.root[k].angle));
        const Turn<double> g = position_residual(at);
        const double root = std::sqrt(max(at.inside, 0.0));
        const double there[2] = {std::fabs(g.c + root * g.s), std::fabs(g.c - root * g.s)};
        for (int side = 0; side < 2; ++side) {
            if (there[1 - side] < clearly * there[side]) continue;
            double q[6];
            joints_on_sheet(sheets, at, side ? -1 : 1, q);
            const bool either = !(there[side] < clearly * there[1 - side]);
            append_candidate(out, q, close[k] || either);
            doubtful |= either;
        }
    }
    return doubtful;
}

// Null vectors of the hidden angles that stand alone, null planes of the others; these by null vectors too if
// asked `again`. True where each angle has two candidates, of which one may be a solution's twin.
inline bool follow_angles(const Loop& loop, const Elimination& e, const HiddenAngles& hidden,
                          const bool* close, bool again, Candidates& out) {
    constexpr double same_plane = 1e-4;
    double alone[max_roots], beside[max_roots], plane[max_roots], last = 100;
    int n_alone = 0, n_beside = 0, n_planes = 0;
    for (int k = 0; k < hidden.count; ++k) {
        const double angle = hidden.root[k].angle;
        (close[k] ? beside[n_beside++] : alone[n_alone++]) = angle;
        if (close[k] && !(std::fabs(angle - last) < same_plane)) plane[n_planes++] = last = angle;
    }
    if (again) {
        follow_roots(loop, e, beside, n_beside, true, out);
    } else {
        follow_roots(loop, e, alone, n_alone, false, out);
        split_planes(loop, e, plane, n_planes, out);
    }
    return !(e.a4_rank > firm_rank);
}

// Of roots that are there for every goal no solutions are expected.
inline void expect_no_spurious_roots(const GeneralPlan& plan, int number, HiddenAngles& hidden) {
    const double* const angles = plan.spurious + number * GeneralPlan::most_spurious;
    for (int k = 0; k < hidden.count; ++k) {
        HiddenAngle& root = hidden.root[k];
        const double spread = root.order > 2 ? order_seen : as_isolated;  // of several on one place
        for (int j = 0; j < plan.spurious_roots[number]; ++j)
            if (std::fabs(short_way(root.angle - angles[j])) < spread) root.expected = spurious;
    }
}

// All solutions by the roots of f, a function of the hidden angle of formulation `number`; `follow` makes
// candidates of them, and more where its first did not bring as many solutions as there must be.
template <class Function, class Follow>
inline Certificate solve_by_hidden_angle(const GeneralPlan& plan, const Posed& goal, int number,
                                         const Loop& loop, double slip, const Function& f,
                                         const Follow& follow, Refined& refined, Solutions& out) {
    Certificate seen;
    seen.slip = slip;
    HiddenAngles& hidden = seen.hidden;
    isolate_roots(f, rough_root, hidden);
    seen.joint = loop.joint[0];
    seen.sign = loop.sign;
    seen.work = hidden.evaluations;
    if (hidden.alias > regular_alias) return seen;
    expect_no_spurious_roots(plan, number, hidden);
    bool close[max_roots], folds = false;
    seen.clusters = mark_close(hidden, close);
    for (int k = 0; k < hidden.count; ++k) folds |= hidden.root[k].width > 0;
    Candidates found;
    folds |= follow(hidden, close, false, found);
    admit_candidates(plan, goal, 0, found, out);
    bool twice[max_solutions] = {};
    bool all = !folds && all_matched(seen, out, twice);
    if (!all) {
        add_near_double_roots(plan, goal, found, out);
        all = all_matched(seen, out, twice);
    }
    seen.work += found.count;
    if (!all) {
        const int direct = found.count;
        follow(hidden, close, true, found);
        admit_candidates(plan, goal, direct, found, out);
        refine_unsettled(plan, goal, found, out, refined);
        seen.work += 10 * found.count;
        mark_doubles(plan, goal, out, twice);
        all = all_matched(seen, out, twice);
    }
    seen.trusted = hidden.alias < trusted_alias && !hidden.overflow;
    seen.shared = seen.clusters > 0 && share_angles(seen, plan.chain, out, twice, plan.paired[number]);
    seen.complete = all && seen.trusted && !seen.shared;
    return seen;
}

// Whether a formulation can be asked of these joints: the hidden angle, the one that is stripped and the one
// that is eliminated last must turn.
inline bool is_possible(const Loop& loop, Formulation form) {
    int slides = 0;
    for (const bool s : loop.slides) slides += s;
    if (slides == 2) return !loop.slides[0] && !form.backwards;
    return slides < 2 && !loop.slides[0] && !loop.slides[3] && !loop.slides[5];
}

// `refined`: what the formulations before have refined.
inline Certificate solve_formulation(const GeneralPlan& plan, const Posed& goal, int number, Refined& refined,
                                     Solutions& out) {
    const Loop loop = make_loop(plan.frames, plan.chain.prismatic, goal, formulation_of(number));
    if (!is_possible(loop, formulation_of(number))) return {};
    if (plan.slides == 2) {
        const TwoSheets sheets = two_sheets(loop);
        if (!(min(sheets.square_end, sheets.square_corner) > clear_sheets)) {
            Certificate vanished;
            vanished.hidden.alias = 1;
            return vanished;
        }
        const auto f = [&](auto c, auto s) { return lack_on_both(sheets, c, s); };
        const auto follow = [&](const HiddenAngles& hidden, const bool* close, bool again,
                                Candidates& found) {
            return !again && follow_sheets(sheets, hidden, close, found);
        };
        return solve_by_hidden_angle(plan, goal, number, loop, 0, f, follow, refined, out);
    }
    const Elimination e = eliminate_angles(loop);
    const auto f = [&](auto c, auto s) { return determinant(e, c, s); };
    const auto follow = [&](const HiddenAngles& hidden, const bool* close, bool again, Candidates& found) {
        return follow_angles(loop, e, hidden, close, again, found);
    };
    const double slip = plan.sensitivity[number] * equation_error / min(e.faintest, 1.0);
    Certificate seen = solve_by_hidden_angle(plan, goal, number, loop, slip, f, follow, refined, out);
    seen.trusted = seen.trusted && e.faintest > clear_equation;
    seen.complete = seen.complete && seen.trusted;
    return seen;
}

}  // namespace cspace::ik::inline CSPACE_ISA
