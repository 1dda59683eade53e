// Solutions near singular poses: the careful solver for a pose that the closed form alone cannot settle. Two
// solutions may be about to merge, a joint may be free at this pose, or the form may idealise the arm. Every
// candidate is refined on the true chain and classified by its residual. Near-double roots are distinguished
// by the conditioning, and each solution is tested for self-motion.
#pragma once

#include <algorithm>

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/ik/self_motion/self_motion.hpp"
#include "cspace/ik/solution.hpp"
#include "cspace/ik/three_parallel.hpp"
#include "cspace/ik/wrist_bend.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::ik {

// Candidates of a goal that were refined with damping: where each started, where Newton's method had stopped,
// and where the refinement ended.
struct Refined {
    static constexpr int room = 64;
    int count = 0;
    double start[room][6], last[room][6], end[room][6];
};

// Points of self-motions that were followed, with their tangents. No other solution lies within `tube` of the
// curve beside them.
struct FollowedCurves {
    static constexpr int room = 400;
    int count = 0;
    double q[room][max_arm], tangent[room][max_arm], tube[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Appends a configuration, as no member of a self-motion; returns its row.
inline int append_solution(const Chain& chain, const double* q, int branch, Solutions& out) {
    const int n = out.count++;
    for (int i = 0; i < chain.n; ++i) out.q[n][i] = wrap_joint(chain, i, q[i]);
    out.branch[n] = static_cast<signed char>(branch);
    out.self_motion[n] = false;
    out.conditioning[n] = 0;
    if (out.status == Status::unreachable) out.status = Status::exact;
    return n;
}

// The largest joint difference between two configurations, angles by the shorter way; of those farther apart
// than `enough` the first that is. Prismatic joints far from zero are known only to a relative accuracy.
inline double joint_distance(const Chain& chain, const double* a, const double* b, double enough = 1e300) {
    double worst = 0;
    for (int i = 0; i < chain.n && worst < enough; ++i) {
        const double d = a[i] - b[i];
        worst = max(worst, std::fabs(chain.prismatic[i] ? d / max(1.0, std::fabs(a[i])) : short_way(d)));
    }
    return worst;
}

// The error between two configurations: at their midpoint, on the floor of the valley between them. Between
// two solutions that are about to merge it is larger than at them; between two copies of one solution it is
// not.
inline double miss_between(const Chain& chain, const Posed& goal, double length, const double* a,
                           const double* b) {
    double q[max_joints], dq[max_joints];
    for (int i = 0; i < chain.n; ++i) q[i] = a[i] + 0.5 * joint_difference(chain, i, b[i] - a[i]);
    PoseError error;
    measure_error(chain, goal, length, q, error);
    double least = size_of_error(error);
    for (int step = 0; step < 2; ++step) {
        decompose_matrix(error.jacobian);
        step_to_floor(error, weakest_direction(error.jacobian), dq);
        least = min(least, take_step(chain, goal, length, q, dq, q, error));
    }
    return least;
}

// Whether two configurations are the same solution, given their distance and the larger error `left` of the
// two. Those within `near`, the uncertainty from rounding, count as distinct only with evidence.
inline bool are_one(const Chain& chain, const Posed& goal, double length, const double* a, const double* b,
                    double gap, double near, double left) {
    constexpr double wide = 1e-2;
    if (!(gap < max(near, wide))) return false;
    return miss_between(chain, goal, length, a, b) <=
           max(left, gap < near ? tolerance::halfway : tolerance::last_digits);
}

// The row of a regular solution to which Newton's method converges from q, or −1. The second derivatives of
// the pose are at most 6 [1/rad], so that no other solution lies within a third of the smallest singular
// value (Kantorovich's theorem: Ortega & Rheinboldt 1970, section 12.6).
inline int listed_beside(const Solutions& out, const Chain& chain, const double* q) {
    constexpr double alone = 0.05;  // in the largest joint difference
    for (int k = 0; k < out.count; ++k) {
        const double near = alone * out.conditioning[k];
        if (near > 0 && joint_distance(chain, out.q[k], q, near) < near) return k;
    }
    return -1;
}

// Refines q; a start exactly on a fold, where the error is stationary along the weakest direction, once more
// from beside it. Returns the remaining error.
inline double refine_branch(const Chain& chain, const Posed& goal, double length, double* q, PoseError& error,
                            int most_steps) {
    constexpr double aside = 1e-5, stationary = 1e-6;  // [rad], smallest singular value
    double size = refine_solution(chain, goal, length, q, error, most_steps);
    const int weak = weakest_direction(error.jacobian);
    if (size > tolerance::rounding && size <= tolerance::reached && error.jacobian.sigma[weak] < stationary) {
        double other[max_joints];
        for (int i = 0; i < chain.n; ++i) other[i] = q[i] + aside * error.jacobian.v[weak][i];
        PoseError there;
        const double left = refine_solution(chain, goal, length, other, there, most_steps);
        if (left < size) {
            size = left, error = there;
            for (int i = 0; i < chain.n; ++i) q[i] = other[i];
        }
    }
    return size;
}

// What counts as a solution: by how much it may miss the goal, and whether a start on a fold is refined once
// more from beside it.
struct Acceptance {
    double most = tolerance::reached;
    bool aside = false;
};

// Refines q and adds it unless it misses the goal or is already listed. Returns its row, or −1; `error`
// belongs to q where it is new.
inline int add_distinct(Solutions& out, const Chain& chain, const Posed& goal, double length, double* q,
                        int branch, int most_steps, PoseError& error, const Acceptance& accept = {}) {
    const int beside = listed_beside(out, chain, q);
    if (beside >= 0) return beside;
    const double size = accept.aside ? refine_branch(chain, goal, length, q, error, most_steps)
                                     : refine_solution(chain, goal, length, q, error, most_steps);
    if (!(size <= accept.most) || out.count == max_solutions) return -1;
    const int weak = weakest_direction(error.jacobian);
    const double conditioning = max(error.jacobian.sigma[weak], tolerance::always_singular);
    const double near = 10 * max(size, tolerance::last_digits) / conditioning;
    for (int k = 0; k < out.count; ++k) {
        const double gap = joint_distance(chain, out.q[k], q);
        if (gap < tolerance::same_solution) return k;
        if (are_one(chain, goal, length, out.q[k], q, gap, near, size)) return k;
    }
    const int n = append_solution(chain, q, branch, out);
    out.conditioning[n] = error.jacobian.sigma[weak];
    return n;
}

// Adds q to the solutions unless it is not a solution or is already listed. Returns its row, or −1.
CSPACE_ONCE int accept_solution(Solutions& out, const Chain& chain, const Posed& goal, double length,
                                double* q, int branch, int most_steps) {
    PoseError error;
    const int before = out.count, n = add_distinct(out, chain, goal, length, q, branch, most_steps, error);
    if (n < before) return n;
    out.self_motion[n] = find_self_motion(chain, goal, length, out.q[n], error.jacobian, out.direction[n]);
    if (out.self_motion[n]) out.status = Status::singular;
    return n;
}

// Value of a virtual joint [rad] up to which it counts as zero near a singularity, on an exact form.
inline constexpr double rounded_stray = 1e-3;

// The branches of the plan to try, the tolerated values of virtual joints [rad], and the number of steps per
// candidate.
struct CandidateSearch {
    int first = 0, last = max_branches;
    double stray = rounded_stray;
    int most_steps = 60;  // of the refinement
};

// The configuration of the chain for angles of the form. Returns by how much its virtual joints stray.
inline double configuration_of(const Plan& plan, const double* t, double* q) {
    double stray = 0;
    for (int i = 0; i < 6; ++i) {
        const double angle = joint_angle(plan, i, t[i]);
        if (plan.joint[i] >= 0)
            q[plan.joint[i]] = angle;
        else
            stray = max(stray, std::fabs(angle));
    }
    return stray;
}

// Whether the arm can go on from q along `direction` and miss the goal by no more than a solution may.
inline bool goes_on(const Plan& plan, const Posed& goal, const double* q, const double* direction) {
    for (const double stride : {0.05, -0.05}) {
        const double kept = kept_of_stride(plan.chain, goal, plan.form.length, q, direction, stride, true,
                                           tolerance::reached);
        if (0.8 < kept && kept < 1.25) return true;
    }
    return false;
}

// Adds a branch of an exact closed form. A solution whose wrist is bent by more than rounding is isolated,
// however little the tip moves when the wrist rolls. Where rounding decides about the roll or the elbow, they
// are free as far as the goal tells, and nothing else is. Other branches may leave no certificate.
inline void add_branch(const Plan& plan, const Posed& goal, double* q, int branch, int most_steps,
                       Solutions& out) {
    PoseError error;
    const int before = out.count;
    const int n = add_distinct(out, plan.chain, goal, plan.form.length, q, branch, most_steps, error,
                               {tolerance::fold_band, !plan.idealised});
    if (n < 0) return;
    const Looseness loose = looseness_of(plan, q);
    if (n == before && loose != Looseness::none) {
        double* const direction = out.direction[n];
        bool moves =
            find_self_motion(plan.chain, goal, plan.form.length, out.q[n], error.jacobian, direction);
        if (!moves && loose == Looseness::as_rounded) {
            const double* weakest = error.jacobian.v[weakest_direction(error.jacobian)];
            std::copy(weakest, weakest + 6, direction);
            if (plan.family == Family::spherical_wrist) roll_of_wrist(plan, out.q[n], direction);
            moves = goes_on(plan, goal, out.q[n], direction);
        }
        out.self_motion[n] = moves;
        if (moves) out.status = Status::singular;
        out.settled[n] = moves && (loose == Looseness::as_rounded || turns_first_joint(plan, out.q[n]));
    }
    if (n == before && loose == Looseness::none) out.settled[n] = true;
    out.complete = out.complete && (out.self_motion[n] || leaves_certificate(plan, q, loose));
}

// The branches of the plan for one choice of unconstrained joints, as configurations of the chain.
inline void closed_form_candidates(const Plan& plan, const Posed& goal_form,
                                   const ClosedFormSettings& settings, Solutions& out, const Posed& goal,
                                   const CandidateSearch& search = {}) {
    const Branches<double> b = solve_closed_form(plan, goal_form, settings);
    for (int k = search.first; k < search.last; ++k) {
        if (!b.ok[k]) continue;
        double q[max_joints] = {};
        const double stray = configuration_of(plan, b.t[k], q);
        if (is_exact(plan))
            add_branch(plan, goal, q, k, search.most_steps, out);
        else if (stray <= search.stray)
            accept_solution(out, plan.chain, goal, plan.form.length, q, k, search.most_steps);
    }
}

// The angles t_i of unconstrained joints, from the joints of the chain. The free sum of three parallel joints
// is the sum of their values.
inline void set_unconstrained(const Plan& plan, const double* unconstrained, ClosedFormSettings& settings,
                              double* t) {
    for (int i = 0; i < 6; ++i) {
        const double q = plan.joint[i] >= 0 && unconstrained ? unconstrained[plan.joint[i]] : 0.0;
        t[i] = plan.sign[i] * q + plan.form.offset[i];
    }
    if (plan.family == Family::three_parallel) t[3] += t[1] + t[2];
    for (int i = 0; i < 6; ++i) settings.unconstrained[i] = {std::cos(t[i]), std::sin(t[i])};
}

// Whether the branches depend on the angle of joint i when it is free.
inline bool is_free(const Plan& plan, const Posed& goal_form, const ClosedFormSettings& settings, double t,
                    int i) {
    constexpr double changed = 1e-3;  // [rad] rounding next to a singularity stays below
    const Branches<double> b = solve_closed_form(plan, goal_form, settings);
    ClosedFormSettings other = settings;
    other.unconstrained[i] = {std::cos(t + 2.4), std::sin(t + 2.4)};
    const Branches<double> moved = solve_closed_form(plan, goal_form, other);
    for (int k = 0; k < max_branches; ++k) {
        if (b.ok[k] != moved.ok[k]) return true;
        for (int j = 0; j < 6 && b.ok[k]; ++j)
            if (std::fabs(short_way(b.t[k][j] - moved.t[k][j])) > changed) return true;
    }
    return false;
}

// Where a joint of the form is free but the joint of the arm is not (the form idealises the arm, or has
// virtual joints), the solutions lie somewhere on the self-motion of the form. Starts are angles on the full
// circle.
inline void sweep_free_joints(const Plan& plan, const Posed& goal_form, const ClosedFormSettings& settings,
                              const double* t, Solutions& out, const Posed& goal) {
    constexpr int turns = 16;
    for (int i = 0; i < 6; ++i) {
        if (!is_free(plan, goal_form, settings, t[i], i)) continue;
        for (int k = 1; k < turns; ++k) {
            ClosedFormSettings turned = settings;
            const double angle = t[i] + k * (2 * pi / turns);
            turned.unconstrained[i] = {std::cos(angle), std::sin(angle)};
            closed_form_candidates(plan, goal_form, turned, out, goal, {0, max_branches, pi, 20});
        }
    }
}

// Near a singularity of the completed arm that the arm itself does not have, the error of the idealised form
// grows to its square root. Starts are the branches of goals at that distance.
inline void try_perturbed_goals(const Plan& plan, const Posed& goal_form, ClosedFormSettings settings,
                                Solutions& out, const Posed& goal) {
    settings.band = std::sqrt(settings.band);
    if (solve_closed_form(plan, goal_form, settings).doubt)
        closed_form_candidates(plan, goal_form, settings, out, goal, {0, max_branches, pi});
}

// If the wrist of three parallel axes is free and its preferred angle puts the goal out of reach of the
// planar arm: the nearest angle that does not.
inline void turn_free_wrist(const Plan& plan, const Posed& goal_form, ClosedFormSettings settings,
                            double unconstrained, Solutions& out, const Posed& goal) {
    constexpr double merging = 1e-6;  // sine: two shoulders that merge pass their error on to the wrist
    settings.free = max(settings.free, merging);
    constexpr int half = max_branches / 2;
    for (int i = 0; i < 2; ++i) {
        bool found = false;
        for (int k = 0; k < out.count; ++k) found = found || out.branch[k] / half == i;
        if (found) continue;
        const FreeSums sums = free_sums(plan.parallel, goal_form, i, unconstrained, settings);
        const int before = out.count;
        for (int k = 0; k < sums.count && out.count == before; ++k) {
            settings.unconstrained[3] = {std::cos(sums.sum[k]), std::sin(sums.sum[k])};
            closed_form_candidates(plan, goal_form, settings, out, goal, {half * i, half * (i + 1)});
        }
    }
}

// If the wrist of three parallel axes is on the first axis, joint 1 may have any value that leaves the wrist
// in reach of the planar arm. These values form arcs, one or more for each side of the wrist, or single ones.
// Of each arc without the preferred value t1, the solutions in its middle.
inline void turn_free_shoulder(const Plan& plan, const Posed& goal_form, const ClosedFormSettings& settings,
                               double t1, Solutions& out, const Posed& goal) {
    const Vec3d& p = goal_form.t;
    const double free = settings.free * plan.form.length;
    if (p.x * p.x + p.y * p.y > free * free) return;
    // Places from t1 once around: the ends, and the middles between them.
    const ShoulderEnds ends = shoulder_ends(plan.parallel, goal_form, settings, t1);
    constexpr int most = 2 * ShoulderEnds::most + 1;
    double place[most];
    bool in_reach[2][most];
    const int count = 2 * ends.count + 1;
    for (int m = 0; m < count; ++m) {
        const int k = m / 2;
        const double low = k > 0 ? ends.angle[k - 1] : 0, high = k < ends.count ? ends.angle[k] : 2 * pi;
        place[m] = m % 2 ? high : (low + high) / 2;
    }
    const auto turned = [&](double angle) {
        ClosedFormSettings at = settings;
        at.unconstrained[0] = {std::cos(t1 + angle), std::sin(t1 + angle)};
        return at;
    };
    for (int m = 0; m < count; ++m) {
        const Branches<double> b = solve_closed_form(plan, goal_form, turned(place[m]));
        for (int side = 0; side < 2; ++side) in_reach[side][m] = b.ok[2 * side] || b.ok[2 * side + 1];
    }
    for (int side = 0; side < 2; ++side)
        for (int m = 0; m < count; ++m) {
            const int begin = m;
            while (m < count && in_reach[side][m]) ++m;
            if (m == begin || begin == 0 || m == count) continue;  // nothing, or joined to t1
            if (out.count + 2 > max_branches) {
                out.complete = false;
                return;
            }
            const ClosedFormSettings middle = turned((place[begin] + place[m - 1]) / 2);
            closed_form_candidates(plan, goal_form, middle, out, goal, {2 * side, 2 * side + 2});
        }
}

// A wrist of three parallel axes that is almost free passes its rounding on to the elbow, and may move it
// past a fold. There the branches within a wider band are candidates too.
inline void widen_fold_band(const Plan& plan, const Posed& goal_form, ClosedFormSettings settings,
                            Solutions& out, const Posed& goal) {
    constexpr double almost_free = 1e-5;  // sine of the wrist's angle
    constexpr double wide = 1e-6;
    const Branches<double> b = solve_closed_form(plan, goal_form, settings);
    bool widen = false;
    for (const auto& t : b.t) widen = widen || std::fabs(std::sin(t[4])) < almost_free;
    settings.band = max(settings.band, wide);
    if (widen) closed_form_candidates(plan, goal_form, settings, out, goal);
}

// Solutions found by other methods get the number of the nearest branch. Each branch is used once, the
// nearest pairs first. The others get numbers beyond the branches.
inline void number_by_branches(const Plan& plan, const Posed& goal, Solutions& out) {
    ClosedFormSettings settings = closed_form_settings(plan);
    settings.spread = 4 * plan.form.deviation;
    const Branches<double> b = solve_closed_form(plan, goal_in_form(plan, goal), settings);
    const auto gap = [&](int m, int k) {
        double worst = 0;
        for (int i = 0; i < 6; ++i)
            worst =
                max(worst, std::fabs(short_way(out.q[m][plan.joint[i]] - joint_angle(plan, i, b.t[k][i]))));
        return worst;
    };
    bool used[max_branches] = {};
    for (int m = 0; m < out.count; ++m) out.branch[m] = -1;
    for (int round = 0; round < out.count; ++round) {
        int solution = -1, branch = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int m = 0; m < out.count; ++m)
            for (int k = 0; k < max_branches && out.branch[m] < 0; ++k)
                if (b.ok[k] && !used[k] && gap(m, k) < least) least = gap(m, k), solution = m, branch = k;
        if (solution < 0) break;
        out.branch[solution] = static_cast<signed char>(branch);
        used[branch] = true;
    }
    int beyond = max_branches;
    for (int m = 0; m < out.count; ++m)
        if (out.branch[m] < 0) out.branch[m] = static_cast<signed char>(beyond++);
}

// All solutions of a goal. `unconstrained`: the values of the chain's joints that are
// free at the goal.
inline Solutions solve_carefully(const Plan& plan, const Posed& goal, const double* unconstrained) {
    Solutions out;
    ClosedFormSettings settings = closed_form_settings(plan);
    constexpr double wide = 1e-5;  // by so much rounding of a joint before may move a fold
    const double slack = 4 * plan.form.deviation;
    settings.free = max(tolerance::free_joint, slack);
    double t[6];
    set_unconstrained(plan, unconstrained, settings, t);
    const Posed goal_form = goal_in_form(plan, goal);
    // Near singularities of the completed arm an idealised form leaves virtual joints far from zero.
    const CandidateSearch search = {0, max_branches, plan.idealised ? 0.1 : rounded_stray};
    if (is_exact(plan)) settings.band = max(settings.band, wide);
    closed_form_candidates(plan, goal_form, settings, out, goal, search);
    if (plan.idealised) {
        settings.spread = slack;
        closed_form_candidates(plan, goal_form, settings, out, goal, search);
    }
    if (plan.idealised && plan.virtual_joints && out.count == 0)
        try_perturbed_goals(plan, goal_form, settings, out, goal);
    if (!is_exact(plan) && (plan.idealised || plan.virtual_joints))
        sweep_free_joints(plan, goal_form, settings, t, out, goal);
    if (plan.family == Family::three_parallel) {
        if (!is_exact(plan)) widen_fold_band(plan, goal_form, settings, out, goal);
        turn_free_wrist(plan, goal_form, settings, t[3], out, goal);
        turn_free_shoulder(plan, goal_form, settings, t[0], out, goal);
    }
    if (is_exact(plan) && plan.family == Family::three_parallel &&
        !covers_curves(plan, goal_form, settings, out))
        for (int k = 0; k < out.count; ++k) out.settled[k] = out.settled[k] && !out.self_motion[k];
    out.crowded = plan.virtual_joints == 0;  // most goals are settled before they come here
    // Merging pairs of the true arm may lie where the form has none.
    if (plan.form.deviation > tolerance::visible_deviation &&
        solve_closed_form(plan, goal_form, closed_form_settings(plan)).doubt)
        out.complete = false;
    return out;
}

// The row of a candidate that was refined from the same place, or −1.
inline int find_refined(const Chain& chain, const Refined& refined, const double* start, const double* last) {
    constexpr double same_start = 1e-5, same_last = 3e-4;  // [rad]
    for (int k = 0; k < refined.count; ++k)
        if (joint_distance(chain, refined.start[k], start, same_start) < same_start ||
            joint_distance(chain, refined.last[k], last, same_last) < same_last)
            return k;
    return -1;
}
inline void note_refined(Refined& refined, const double* start, const double* last, const double* end) {
    if (refined.count == Refined::room) return;
    const int n = refined.count++;
    for (int i = 0; i < 6; ++i)
        refined.start[n][i] = start[i], refined.last[n][i] = last[i], refined.end[n][i] = end[i];
}

// Whether q lies in the tube about a curve that was followed: then it leads to the curve alone.
inline bool is_on_followed(const Chain& chain, const Posed& goal, double length, const FollowedCurves& curves,
                           const double* q) {
    constexpr double reach = 1.2 * longest_step;
    const TipConstraint constraint = {goal, true, length};
    int nearest = -1;
    double least2 = reach * reach, gap[max_joints];
    const auto measure_gap = [&](const double* from) {
        for (int i = 0; i < chain.n; ++i)
            gap[i] = joint_difference(chain, i, q[i] - from[i]) / unit_of(chain, i, length);
        return dot_n(gap, gap, chain.n);
    };
    for (int k = 0; k < curves.count; ++k) {
        const double size2 = measure_gap(curves.q[k]);
        if (size2 < least2) least2 = size2, nearest = k;
    }
    if (nearest < 0) return false;
    measure_gap(curves.q[nearest]);
    const double* const tangent = curves.tangent[nearest];
    const double along = dot_n(gap, tangent, chain.n);
    double beside[max_joints];
    for (int i = 0; i < chain.n; ++i)
        beside[i] = curves.q[nearest][i] + along * unit_of(chain, i, length) * tangent[i];
    PoseError at;
    if (!onto_curve(chain, constraint, beside, at)) return false;
    const double tube = curves.tube[nearest];
    return measure_gap(beside) < tube * tube;
}

// What a search has met already: a descent that comes there brings nothing new.
struct Met {
    Refined refined;
    FollowedCurves curves;
};

// Perturbed goals: at a singular pose a solver may lose solutions. Goals slightly displaced from it in
// several directions are regular, and Newton's method leads from their solutions back to the goal.

inline constexpr int perturbed_goals = 12;

// Whether the k-th perturbed goal is one of those farther away.
inline bool is_far(int k) { return k % 4 < 2; }
// The k-th perturbed goal: generic directions, both senses, decreasing distances.
inline Posed perturbed_goal(const Posed& goal, double length, int k) {
    constexpr double far = 1e-2, near = 1e-3;  // [rad, arm's lengths] regular, and within Newton's reach
    double d[max_joints];
    spread_configuration(k / 4, 6, d);
    const double size = (k % 2 ? -1 : 1) * (is_far(k) ? far : near) / pi;
    const Vec3d away = size * length * Vec3d{d[0], d[1], d[2]}, turn = size * Vec3d{d[3], d[4], d[5]};
    return {spatial::rotation_of_rotvec(turn) * goal.R, goal.t + away};
}

// Descends from q and adds the result if it is a new solution. Near solutions, a valley that almost reaches
// the goal does not count.
inline void descend_to_solution(const Chain& chain, const Posed& goal, double length, double* q, int steps,
                                Solutions& out, Met* met = nullptr) {
    if (out.count == max_solutions || listed_beside(out, chain, q) >= 0) return;
    if (met &&
        (find_refined(chain, met->refined, q, q) >= 0 || is_on_followed(chain, goal, length, met->curves, q)))
        return;
    double start[max_joints];
    std::copy(q, q + chain.n, start);
    PoseError error;
    const double left = refine_solution(chain, goal, length, q, error, steps);
    if (met && chain.n == 6) note_refined(met->refined, start, start, q);
    if (!(left <= (out.count ? tolerance::exact : tolerance::reached))) return;
    if (met && is_on_followed(chain, goal, length, met->curves, q)) return;
    accept_solution(out, chain, goal, length, q, out.count, 2);
}

// Brings rows of configurations of six joints near the goal; `error`: by how much each misses it then.
inline void descend_rows(const Chain& chain, const Posed& goal, double length, double (*row)[max_joints],
                         int count, int most_steps, double* error) {
    for_each_pack(count, [&](auto pack, int first) {
        using V = decltype(pack);
        const int lanes = std::min(count - first, Lanes<V>::count);
        V q[6];
        load_rows(row[first], max_joints, lanes, 6, q);
        const V left = descend_abreast(chain, goal, length, q, most_steps);
        for (int k = 0; k < lanes; ++k) {
            error[first + k] = get_lane(left, k);
            for (int i = 0; i < 6; ++i) row[first + k][i] = get_lane(q[i], k);
        }
    });
}

// Descends from `starts` configurations spread over all joints until there are `enough` solutions: where a
// determinant vanishes all round the circle a self-motion runs through every hidden angle, and where a
// completed arm is singular the arm itself need not be.
inline void search_by_descent(const Chain& chain, const Posed& goal, double length, int starts,
                              Solutions& out, int enough = max_solutions, Met* met = nullptr) {
    constexpr int most_steps = 60, abreast = 8, first_steps = 40;
    constexpr double far = 1e-2;  // what is left there is a local minimum
    double q[abreast][max_joints], error[abreast];
    for (int first = 0; first < starts && out.count < enough; first += abreast) {
        const int count = std::min(abreast, starts - first);
        for (int k = 0; k < count; ++k) {
            spread_configuration(first + k, chain.n, q[k]);
            for (int i = 0; i < chain.n; ++i) q[k][i] *= chain.prismatic[i] ? length / pi : 1;
            error[k] = 0;
        }
        if (chain.n == 6) descend_rows(chain, goal, length, q, count, first_steps, error);
        for (int k = 0; k < count && out.count < enough; ++k)
            if (error[k] < far) descend_to_solution(chain, goal, length, q[k], most_steps, out, met);
    }
}

// list_solutions(goal, add_candidate) calls add_candidate(q) for every solution of a goal, as a configuration
// of the chain. Returns whether a new solution was found. is_empty: the solver is certain that there is none;
// then goals nearby are looked at only if one farther away has a solution.
template <class ListSolutions>
inline bool search_perturbed_goals(const Chain& chain, const Posed& goal, double length,
                                   const ListSolutions& list_solutions, Solutions& out, Met* met = nullptr,
                                   bool is_empty = false) {
    constexpr int most_steps = 40, room = 4 * max_solutions;
    constexpr double far = 1e-2;
    const int before = out.count;
    double q[room][max_joints], error[room] = {};
    int count = 0;
    const auto descend = [&] {
        if (chain.n == 6 && met) descend_rows(chain, goal, length, q, count, most_steps, error);
        for (int k = 0; k < count; ++k)
            if (error[k] < far) descend_to_solution(chain, goal, length, q[k], most_steps, out, met);
        count = 0;
    };
    const auto add_candidate = [&](const double* candidate) {
        is_empty = false;
        if (listed_beside(out, chain, candidate) >= 0) return;
        std::copy(candidate, candidate + chain.n, q[count]);
        if (++count == room) descend();
    };
    for (int k = 0; k < perturbed_goals; ++k)
        if (!is_empty || is_far(k)) list_solutions(perturbed_goal(goal, length, k), add_candidate);
    descend();
    return out.count > before;
}

}  // namespace cspace::ik::inline CSPACE_ISA
