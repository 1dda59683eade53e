// Numerical continuation of a self-motion: the curve of configurations with the same tip pose (or the same
// tip position). Each step along the tangent is followed by Newton steps back onto the curve (Allgower &
// Georg 1990, chapter 6).
#pragma once

#include <algorithm>

#include "cspace/ik/refine.hpp"
#include "cspace/math/continuation.hpp"
#include "cspace/math/function_ref.hpp"

namespace cspace::ik {

// The constraint on the tip.
struct TipConstraint {
    Posed goal;
    bool whole_pose;
    double length;                     // of the arm [m], the unit of prismatic joints
    double most = tolerance::reached;  // error of a point of the curve
};

enum class CurveEnd {
    closed,  // the curve came back to its start, up to multiples of 2π
    far,     // a prismatic joint went endless_slide lengths of the arm: the curve is unbounded
    lost,    // no step succeeded any more
};

inline constexpr double endless_slide = 1000;
inline constexpr int most_curve_steps = 4000;
inline constexpr double longest_step = 0.2;  // along a curve [rad, arm's lengths]

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double unit_of(const Chain& chain, int i, double length) { return chain.prismatic[i] ? length : 1; }

// Converts directions of joints to the curve's own coordinates, prismatic joints over the size of the arm,
// and back.
inline void in_lengths(const Chain& chain, double length, const double* direction, double* out) {
    double size2 = 0;
    for (int i = 0; i < chain.n; ++i) {
        out[i] = direction[i] / unit_of(chain, i, length);
        size2 += out[i] * out[i];
    }
    for (int i = 0; i < chain.n; ++i) out[i] /= std::sqrt(size2);
}

// The size of the error e at q alone, the rotation to first order.
inline double constrained_error(const Chain& chain, const TipConstraint& constraint, const double* q,
                                double* e) {
    tip_error(forward_kinematics(chain, q), constraint.goal, constraint.length, e);
    for (int k = 3; k < 6 && !constraint.whole_pose; ++k) e[k] = 0;
    return std::sqrt(dot_n(e, e, 6));
}

// The error at q and its decomposed Jacobian, in joint units. near_by: `at` belongs to a configuration
// nearby.
inline double measure_constrained(const Chain& chain, const TipConstraint& constraint, const double* q,
                                  PoseError& at, bool near_by = false) {
    measure_error(chain, constraint.goal, constraint.length, q, at);
    if (!constraint.whole_pose)
        for (int k = 3; k < 6; ++k) at.e[k] = 0;
    for (int i = 0; i < chain.n; ++i)
        for (int k = 0; k < 6; ++k)
            at.jacobian.us[i][k] *=
                !constraint.whole_pose && k >= 3 ? 0 : unit_of(chain, i, constraint.length);
    decompose_matrix(at.jacobian, near_by);
    return size_of_error(at);
}

// A direction with a singular value below this does not move the tip.
inline constexpr double still = 1e-7;

// The tangent of the curve at a point: the projection of `along` onto the null space, unit. False if it
// vanishes.
inline bool tangent_at(const Chain& chain, const PoseSvd& J, const double* along, double* tangent) {
    constexpr double leading = 1e-2;  // what is left of a unit vector that points along the curve at all
    const double* basis[max_joints];
    int k = 0;
    for (int j = 0; j < J.columns; ++j)
        if (J.sigma[j] <= still) basis[k++] = J.v[j];
    for (int i = 0; i < chain.n; ++i) tangent[i] = along[i];
    return project_vector(basis, k, chain.n, tangent) > leading;
}

// Of the singular values other than that of the curve the smallest, and the smallest that does not vanish.
// They vanish where two curves cross.
struct Margin {
    double second, positive;
};
inline Margin margin_on_curve(const PoseSvd& J) {
    double least = 1e300;
    Margin out = {1e300, 1};
    for (int j = 0; j < J.columns; ++j) {
        const double sigma = J.sigma[j];
        out.second = min(out.second, max(least, sigma));
        least = min(least, sigma);
        if (sigma > still) out.positive = min(out.positive, sigma);
    }
    return out;
}

// Upper bound of a step: a longer one could switch to another curve. Towards a crossing this singular value
// decreases about in proportion to the distance. Near a curve that stays close, a step deviates by its
// square.
struct Room {
    double slope = 1;  // of the hold, the steepest of late

    double after(double margin, double last_margin, double step) {
        constexpr double forget = 0.8;
        slope = max(forget * slope, std::fabs(margin - last_margin) / step);
        return here(margin);
    }
    double here(double margin) const {
        constexpr double least = 1e-5;
        return max(0.5 * min(std::sqrt(margin), margin / slope), least);
    }
};

// Brings q onto the curve by minimum-norm steps; true if the tip satisfies the constraint. `at` belongs to q,
// its Jacobian to a configuration within `beside` of q. Newton's step is followed by others with the same
// Jacobian while they converge fast. near_by: on entry `at` belongs to a configuration nearby, whose Jacobian
// serves the first steps.
CSPACE_NOINLINE inline bool onto_curve(const Chain& chain, const TipConstraint& constraint, double* q,
                                       PoseError& at, bool near_by = false) {
    constexpr int most_steps = 12;
    constexpr double settled = tolerance::last_digits, fast = 0.1;
    // A new Jacobian costs as much as six steps. With that of a configuration nearby they go so far that one
    // more step from the new Jacobian settles.
    constexpr double slow = 0.3, close = 1e-10, beside = 1e-9;
    bool measured = !near_by;
    double size = near_by ? constrained_error(chain, constraint, q, at.e)
                          : measure_constrained(chain, constraint, q, at);
    for (int step = 0; step < most_steps && (size > settled || !measured); ++step) {
        const double rate = measured ? fast : slow, enough = measured ? settled : close;
        double e[6], next[max_joints], dq[max_joints], best = size, moved = 0;
        for (int k = 0; k < 6; ++k) e[k] = at.e[k];
        for (int i = 0; i < chain.n; ++i) next[i] = q[i];
        for (bool again = size > enough; again;) {
            least_norm_step(at.jacobian, e, 0, still, -1, dq);
            for (int i = 0; i < chain.n; ++i) next[i] += unit_of(chain, i, constraint.length) * dq[i];
            const double left = constrained_error(chain, constraint, next, e);
            again = left < rate * best && left > enough;
            if (!(left < best)) break;
            for (int k = 0; k < 6; ++k) at.e[k] = e[k];
            for (int i = 0; i < chain.n; ++i) q[i] = next[i];
            moved += std::sqrt(dot_n(dq, dq, chain.n));
            best = left;
        }
        const bool ends = measured && (!(best < size) || moved < beside);
        size = ends ? best : measure_constrained(chain, constraint, q, at, true);
        if (ends) break;
        measured = true;
    }
    // An arm whose axes are parallel to ten digits only has its self-motions to ten digits only.
    return size <= constraint.most;
}

// The second and third derivative of a curve by its length, from the tangents at the ends of two steps.
struct CurveBend {
    double length = 0;  // of the last step; 0: none yet
    double mean[max_joints] = {}, second[max_joints] = {}, third[max_joints] = {};

    // After a step of length h from a point with tangent t to one with tangent next.
    void add_step(const double* t, const double* next, double h, int n) {
        for (int i = 0; i < n; ++i) {
            const double bend = (next[i] - t[i]) / h;
            third[i] = length > 0 ? 2 * (bend - mean[i]) / (h + length) : 0;
            second[i] = bend + 0.5 * h * third[i];
            mean[i] = bend;
        }
        length = h;
    }
};

// One step of length h from q along its tangent; `at` belongs to q, then to the end. False if the curve bends
// too much for this length. bend: of the curve at q, for a guess nearer to the end.
inline bool step_along_self_motion(const Chain& chain, const TipConstraint& constraint, const double* q,
                                   const double* tangent, double h, double* next, double* next_tangent,
                                   PoseError& at, const CurveBend& bend = {}) {
    constexpr double least_cosine = 0.995, third = 1.0 / 6;
    for (int i = 0; i < chain.n; ++i) {
        const double way = tangent[i] + h * (0.5 * bend.second[i] + third * h * bend.third[i]);
        next[i] = q[i] + h * unit_of(chain, i, constraint.length) * way;
    }
    if (!onto_curve(chain, constraint, next, at, true) ||
        !tangent_at(chain, at.jacobian, tangent, next_tangent))
        return false;
    double back2 = 0;
    for (int i = 0; i < chain.n; ++i) {
        const double moved = (next[i] - q[i]) / unit_of(chain, i, constraint.length) - h * tangent[i];
        back2 += moved * moved;
    }
    return back2 <= most_correction * most_correction * h * h &&
           dot_n(tangent, next_tangent, chain.n) >= least_cosine;
}

// Whether the start lies ahead of q within one step and the curve passes it in the original direction. `lift`
// is then the start plus the multiples of 2π accumulated on the way.
inline bool start_is_next(const Chain& chain, const TipConstraint& constraint, const double* q,
                          const double* tangent, const double* start, const double* start_tangent, double h,
                          double* lift) {
    double gap[max_joints];
    for (int i = 0; i < chain.n; ++i) {
        const double d = joint_difference(chain, i, start[i] - q[i]);
        lift[i] = q[i] + d;
        gap[i] = d / unit_of(chain, i, constraint.length);
    }
    const double ahead = dot_n(gap, tangent, chain.n), size2 = dot_n(gap, gap, chain.n);
    return ahead >= 0 && size2 <= h * h && ahead * ahead >= 0.9 * size2 &&
           dot_n(tangent, start_tangent, chain.n) > 0.9;
}

inline double first_step(const PoseSvd& J) {
    constexpr double longest = 1e-3;  // [rad] nothing is known yet about how the curve bends
    return min(longest, 0.2 * Room{}.here(margin_on_curve(J).positive));
}

// The tangent at a configuration, from a guess. Where curves cross, the null space has more dimensions than
// the tangents. A short step along each of many directions is therefore corrected back, and the resulting
// direction nearest to the guess is taken. False if no curve leaves from there.
inline bool start_direction(const Chain& chain, const TipConstraint& constraint, const double* q,
                            const double* guess, double* tangent) {
    constexpr int around = 48;
    const int n = chain.n;
    PoseError at;
    measure_constrained(chain, constraint, q, at);
    const double h = first_step(at.jacobian);
    double next[max_joints], beyond[max_joints], best = -1;
    PoseError there = at;
    if (tangent_at(chain, at.jacobian, guess, tangent) &&
        step_along_self_motion(chain, constraint, q, tangent, h, next, beyond, there))
        return true;
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b)
            for (int m = 0; m < around; ++m) {
                if (at.jacobian.sigma[a] > still || at.jacobian.sigma[b] > still) break;
                const double c = std::cos(2 * pi * m / around), s = std::sin(2 * pi * m / around);
                double way[max_joints], trial[max_joints];
                for (int i = 0; i < n; ++i)
                    next[i] = q[i] + h * unit_of(chain, i, constraint.length) *
                                         (c * at.jacobian.v[a][i] + s * at.jacobian.v[b][i]);
                if (!onto_curve(chain, constraint, next, there, true)) continue;
                for (int i = 0; i < n; ++i)
                    way[i] = (next[i] - q[i]) / (h * unit_of(chain, i, constraint.length));
                if (!(dot_n(way, way, n) > 0.25) || !tangent_at(chain, at.jacobian, way, trial) ||
                    !step_along_self_motion(chain, constraint, q, trial, h, next, beyond, there))
                    continue;
                const double agrees = dot_n(trial, guess, n);
                if (agrees <= best) continue;
                best = agrees;
                for (int i = 0; i < n; ++i) tangent[i] = trial[i];
            }
    return best > -1;
}

// Follows the curve from `start` along `direction` (in joint units). Calls `visit` with every configuration,
// its tangent and the second singular value there, the start first. If the curve closes, the start also comes
// last, with its angles unwrapped.
using VisitCurve = FunctionRef<void(const double*, const double*, double)>;
CSPACE_ONCE CurveEnd follow_curve(const Chain& chain, const TipConstraint& constraint, const double* start,
                                  const double* direction, VisitCurve visit,
                                  int most_steps = most_curve_steps, double longest = longest_step) {
    constexpr double shortest = 1e-7;
    constexpr double most_turn = 0.09, straight = 1e-3;  // of a step [rad]: a tenth is refused
    const int n = chain.n;
    double q[max_joints] = {}, t[max_joints] = {}, first[max_joints] = {};
    PoseError at;
    measure_constrained(chain, constraint, start, at);
    const bool leaves = start_direction(chain, constraint, start, direction, first);
    for (int i = 0; i < n; ++i) q[i] = start[i], t[i] = leaves ? first[i] : direction[i];
    const Margin first_margin = margin_on_curve(at.jacobian);
    visit(q, t, first_margin.second);
    if (!leaves) return CurveEnd::lost;
    double h = first_step(at.jacobian);
    Margin margin = first_margin;
    Room room;
    CurveBend bend;
    for (int step = 0; step < most_steps; ++step) {
        double next[max_joints] = {}, next_t[max_joints] = {};
        if (step > 2 && start_is_next(chain, constraint, q, t, start, first, 1.5 * h, next)) {
            visit(next, first, first_margin.second);
            return CurveEnd::closed;
        }
        const double last_margin = margin.positive;
        const auto attempt = [&](double step) {
            return step_along_self_motion(chain, constraint, q, t, step, next, next_t, at, bend);
        };
        if (!halve_step(h, shortest, attempt)) return CurveEnd::lost;
        margin = margin_on_curve(at.jacobian);
        bend.add_step(t, next_t, h, n);
        double turning = 0, away = 0;
        for (int i = 0; i < n; ++i) {
            q[i] = next[i], t[i] = next_t[i];
            if (chain.prismatic[i])
                away = max(away, std::fabs(q[i] - start[i]) / constraint.length);
            else
                turning = max(turning, std::fabs(t[i]));
        }
        visit(q, t, margin.second);
        if (away > endless_slide) return CurveEnd::far;
        const double bent = std::sqrt(dot_n(bend.second, bend.second, n));
        const double longest_here =
            min(min(room.after(margin.positive, last_margin, h), longest), most_turn / (bent + straight));
        // Slides alone run along a line.
        h = turning > tolerance::resting ? min(1.5 * h, longest_here) : 2 * h;
    }
    return CurveEnd::lost;
}

// The whole self-motion: in both directions from q, or once around if it closes. Calls `visit` with the
// direction (0 or 1) and what `follow_curve` passes; each call uses one of the remaining steps. False if the
// curve was lost, or the steps were used up, before its end.
using VisitSelfMotion = FunctionRef<void(int, const double*, const double*, double)>;
inline bool follow_self_motion(const Chain& chain, const TipConstraint& constraint, const double* q,
                               const double* direction, int& steps_left, VisitSelfMotion visit,
                               double longest = longest_step) {
    constexpr int most_steps = 1000;
    bool whole = true;
    for (int way = 0; way < 2; ++way) {
        double along[max_joints];
        for (int i = 0; i < chain.n; ++i) along[i] = (way ? -1 : 1) * direction[i];
        const auto count = [&](const double* at, const double* tangent, double margin) {
            --steps_left;
            visit(way, at, tangent, margin);
        };
        const int most = std::clamp(steps_left, 0, most_steps);
        const CurveEnd end = follow_curve(chain, constraint, q, along, count, most, longest);
        if (end == CurveEnd::closed) return true;
        whole = whole && end == CurveEnd::far;
    }
    return whole;
}

}  // namespace cspace::ik::inline CSPACE_ISA
