// When an axis can be where it is asked to be: the shortest time, the next time from a given one on, and the
// motion for any time in which it can.
//
// A displacement P can be attained in T if T lies in the domain and P_min(T) ≤ P ≤ P_max(T). P_max crosses a
// level at most three times: once or twice in its concave head, then once.
#pragma once

#include "cspace/trajectory/reach_interval.hpp"

namespace cspace::trajectory {

inline constexpr double never = std::numeric_limits<double>::infinity();

namespace crossing {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr int most_steps = 200;  // bisection alone needs 64

// The time between low and high at which f, which is below zero at low and not at high, is zero: Halley's
// method in a bracket. f(T) returns value, slope and bend.
template <class F>
double find_root(double low, double high, const F& f) {
    double x = high;
    for (int i = 0; i < most_steps; ++i) {
        const auto [value, slope, bend] = f(x);
        if (value == 0) return x;
        (value > 0 ? high : low) = x;
        const double halley = 2 * slope * slope - value * bend;
        double next = x - (halley > 0 ? 2 * value * slope / halley : value / slope);
        if (!(next > low && next < high)) {
            // A step that leaves the bracket by rounding alone has arrived.
            if (std::fabs(next - x) <= 2 * epsilon * x) return x;
            next = 0.5 * (low + high);
        }
        if (std::fabs(next - x) <= 2 * epsilon * x || high - low <= 2 * epsilon * high) return next;
        x = next;
    }
    return high;
}

struct Value {
    double value, slope, bend;
};

// When P_max(T) = P between low, where it is less, and high, where it is not.
inline double find_crossing(const VelocityChange& q, double P, double low, double high) {
    return find_root(low, high, [&](double T) {
        const Reach r = find_farthest(q, T);
        return Value{r.displacement - P, r.slope, r.bend};
    });
}

// The end of the concave head of P_max, where its second derivative becomes positive; it is before `low`
// where P_max is convex there.
inline double end_of_head(const VelocityChange& q) {
    const double J = q.limits.jerk, a0 = q.a0, af = q.af, dv = q.vf - q.v0, sqrt3 = std::sqrt(3.0);
    const double kappa = J * dv + (a0 * a0 - af * af) / 2, w = std::sqrt(std::fabs(kappa) / sqrt3);
    const auto time_of = [&](double width) { return (2 * width - a0 + af) / J; };
    const double p = (w + kappa / w) / 2, l = p - w;
    if (!(w > 0) || (p <= q.limits.a_max && l >= q.limits.a_min)) return time_of(w);
    // p is held at a_max up to where l = p / 4 or p is no longer held; likewise l.
    const double held = kappa > 0 ? q.limits.a_max : -q.limits.a_min, size = std::fabs(kappa);
    const double until = (held * (9.0 / 16 * held + af - a0) + size) / (J * held);
    const double beyond = held * held - size;  // below zero: it is held for ever
    return beyond < 0 ? until : std::min(until, time_of(held - std::sqrt(beyond)));
}

// A time in low … high, within the head, at which P_max ≥ P, if there is one; else where it is largest.
inline double top_of_head(const VelocityChange& q, double P, double low, double high) {
    double x = high;
    for (int i = 0; i < most_steps && high - low > 2 * epsilon * high; ++i) {
        const Reach r = find_farthest(q, x);
        if (r.displacement >= P || (i == 0 && r.slope >= 0)) return x;
        (r.slope > 0 ? low : high) = x;
        const double next = x - r.slope / r.bend;
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return x;
}

}  // namespace crossing

// An axis that is to change its state and to be displaced by P meanwhile.
struct AxisTask {
    VelocityChange up, down;  // the change and its mirror image
    double P;
    Domain domain;
};

inline AxisTask make_axis_task(const VelocityChange& q, double P) {
    return {q, mirror_change(q), P, find_domain(q)};
}

// What rounding may leave of a displacement.
inline double displacement_rounding(const AxisTask& x, double T) {
    constexpr double roundings = 64 * std::numeric_limits<double>::epsilon();
    const VelocityChange& q = x.up;
    const double swing = q.limits.has_jerk()
                             ? std::min(q.limits.jerk * T * T, std::max(q.limits.a_max, -q.limits.a_min) * T)
                             : std::max(q.limits.a_max, -q.limits.a_min) * T;
    const double fastest =
        std::min(std::fabs(q.v0) + std::fabs(q.vf) + swing, std::max(q.limits.v_max, -q.limits.v_min));
    return roundings * (std::fabs(x.P) + T * fastest);
}

// The first time from A to B at which P_max(T) ≥ P, where P_max(A) < P and A … B lies in the domain. slack:
// by how much P_max may fall short of P at the end of a part of the domain, and where it turns back.
inline double first_reached(const VelocityChange& q, double P, double A, double B, double slack) {
    using namespace crossing;
    if (q.limits.has_jerk()) {
        if (const Reach r = find_farthest(q, A); r.bend < 0) {
            const double end = std::min(std::max(end_of_head(q), A), B), top = top_of_head(q, P, A, end);
            const double most = find_farthest(q, top).displacement;
            if (most >= P) return find_crossing(q, P, A, top);
            if (most >= P - slack) return top;
            A = end;
            if (A >= B) return never;
        }
    }
    if (B < never) {
        const double most = find_farthest(q, B).displacement;
        return most >= P ? find_crossing(q, P, A, B) : most >= P - slack ? B : never;
    }
    if (q.limits.v_max < never) {
        const SevenPhases touch = reach::touch_cruise(q);
        const double on = touch.duration();
        if (on <= A) return A + (P - find_farthest(q, A).displacement) / q.limits.v_max;
        const double at = displace_axis(q, touch);
        return P >= at ? on + (P - at) / q.limits.v_max : find_crossing(q, P, A, on);
    }
    double far = 2 * A;
    if (!(far > 0)) far = 1;
    while (find_farthest(q, far).displacement < P) far *= 2;
    return find_crossing(q, P, A, far);
}

// The two extreme motions for a time.
struct ExtremeMotions {
    double T = -1;
    Reach up, down;
};

// The first time from A to B, in the domain, in which P can be attained; the extreme motions for A.
inline double next_in_part(const AxisTask& x, double A, double B, ExtremeMotions& at) {
    at = {A, find_farthest(x.up, A), find_farthest(x.down, A)};
    const double up = at.up.displacement, down = -at.down.displacement;
    const double slack = displacement_rounding(x, A);
    if (x.P > up + slack) return first_reached(x.up, x.P, A, B, slack);
    if (x.P < down - slack) return first_reached(x.down, -x.P, A, B, slack);
    return A;
}

// Likewise from the beginning of a part of the domain on, where the axis is displaced by P0.
inline double first_in_part(const AxisTask& x, double A, double B, double P0) {
    const double slack = displacement_rounding(x, A);
    if (x.P > P0 + slack) return first_reached(x.up, x.P, A, B, slack);
    if (x.P < P0 - slack) return first_reached(x.down, -x.P, A, B, slack);
    return A;
}

// The shortest time.
inline double minimum_time(const AxisTask& x) {
    const Domain& d = x.domain;
    const double T = first_in_part(x, d.first, d.has_gap ? d.gap_begin : never, d.displacement);
    return T < never ? T : first_in_part(x, d.gap_end, never, d.displacement_after_gap);
}

// The next time not before T in which P can be attained; the extreme motions for T, if they were needed.
inline double next_time(const AxisTask& x, double T, ExtremeMotions& at) {
    const Domain& d = x.domain;
    if (T <= d.first) return minimum_time(x);
    if (d.has_gap && T <= d.gap_begin) {
        const double found = next_in_part(x, T, d.gap_begin, at);
        if (found < never) return found;
    }
    if (d.has_gap && T <= d.gap_end) return first_in_part(x, d.gap_end, never, d.displacement_after_gap);
    return next_in_part(x, T, never, at);
}

namespace crossing {

// A motion of seven phases as its part of a convex combination: the phase at a time, and when it ends.
struct Walk {
    const SevenPhases& f;
    double a0, jerk, sign;
    int i = -1;
    double begin = 0, end = 0;
    void advance_to(double t) {
        while (i < 6 && (i < 0 || t >= end)) {
            ++i;
            begin = end;
            end += f.t[i];
        }
    }
    Phase at(double t) const {
        const Phase p = f.phase(i, a0, jerk);
        const double j = std::isfinite(p.j) ? p.j : 0;
        return {end - t, sign * (p.a + j * (t - begin)), sign * j};
    }
};

}  // namespace crossing

// Whether an axis rests and stays where it is.
inline bool is_still(const AxisTask& x) {
    const VelocityChange& q = x.up;
    return x.P == 0 && q.v0 == 0 && q.vf == 0 && q.a0 == 0 && q.af == 0;
}

// The motion that attains P in T: the combination θ up + (1 − θ) down of the two extreme motions, which keeps
// all limits because they are convex. Appends its phases. known: the extreme motions, if they are for T.
inline void append_motion(const AxisTask& x, double T, const ExtremeMotions& known, Phases& out) {
    using namespace crossing;
    if (is_still(x)) return out.append({T, 0, 0});
    const bool is_known = known.T == T;
    const Reach up = is_known ? known.up : find_farthest(x.up, T);
    const Reach down = is_known ? known.down : find_farthest(x.down, T);
    const double width = up.displacement + down.displacement;
    const double theta = width > 0 ? std::clamp((x.P + down.displacement) / width, 0.0, 1.0) : 1.0;
    const double jerk = x.up.limits.jerk;
    Walk a{up.phases, x.up.a0, jerk, 1}, b{down.phases, x.down.a0, jerk, -1};
    for (double t = 0; t < T;) {
        a.advance_to(t);
        b.advance_to(t);
        const Phase f = a.at(t), g = b.at(t);
        const double next = std::min(std::min(a.i == 6 ? T : a.end, b.i == 6 ? T : b.end), T);
        const double other = 1 - theta;
        out.append({next - t, theta * f.a + other * g.a, theta * f.j + other * g.j});
        t = next;
    }
}

}  // namespace cspace::trajectory
