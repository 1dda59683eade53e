// Shortest curves of a car that only drives forwards (Dubins 1957; Shkel & Lumelsky 2001): an arc, a straight
// piece or a long arc the other way, an arc.
//
// With complex numbers and the radius as unit, the circle to the left of a pose p, θ has the centre p + i
// e^{iθ}, that to the right p − i e^{iθ}, and
//   L(t) S(u) L(v):  ways between left circles  = u e^{it},                v = turn − t
//   L(t) S(u) R(v):  from left to right         = (u − 2i) e^{it},         v = t − turn
//   L(t) R(u) L(v):  between left circles       = 4 sin(u/2) e^{i(t−u/2)}, v = turn − t + u
// Words that begin with R are those of the mirrored task.
#pragma once

#include "cspace/navigation/curves/curve.hpp"

namespace cspace::navigation {

namespace dubins {

struct Word {
    double length = std::numeric_limits<double>::infinity();
    int middle = 0;  // 0 a straight piece, else an arc against the first
    bool crosses = false, mirrored = false;
    double t = 0, u = 0, v = 0;
};

// An arc of [0, 2π): one that differs from 2π by no more than rounding is 0.
inline double forward_arc(double angle, double slack) {
    constexpr double whole = 2 * std::numbers::pi;
    angle = wrap_above(angle, 0);
    return whole - angle <= slack ? 0 : angle;
}

// The words that begin with L in the task, or in its mirror image.
inline void words_from_left(const Task& task, bool mirrored, Word& best) {
    constexpr double pi = std::numbers::pi;
    const double sign = mirrored ? -1 : 1, turn = sign * task.turn;
    const Task::Way same = task.way[mirrored][mirrored], cross = task.way[mirrored][!mirrored];
    const double same_angle = sign * same.angle, cross_angle = sign * cross.angle;
    const double rounding = 16 * std::numeric_limits<double>::epsilon();
    const auto consider = [&](int middle, bool crosses, double t, double u, double v, double slack) {
        t = forward_arc(t, slack);
        v = forward_arc(v, slack);
        if (t + u + v < best.length) best = {t + u + v, middle, crosses, mirrored, t, u, v};
    };
    // A straight piece of length u turns by slack / u where its ends are moved by slack.
    const auto loose = [&](double u) { return rounding + task.slack / std::max(u, 1.0); };
    if (same.length <= task.slack)
        consider(0, false, turn, 0, 0, loose(0));
    else
        consider(0, false, same_angle, same.length, turn - same_angle, loose(same.length));
    const double squared = cross.length * cross.length - 4;
    if (squared >= -4 * task.slack) {
        const double u = std::sqrt(std::max(squared, 0.0));
        const double t = cross_angle + std::atan2(2.0, u);
        consider(0, true, t, u, t - turn, loose(u));
    }
    if (same.length <= 4 + task.slack) {
        const double u = 2 * pi - 2 * std::asin(std::min(same.length / 4, 1.0));
        const double t = same_angle + u / 2;
        consider(-1, false, t, u, turn - t + u, loose(0));
    }
}

inline Word find_shortest_word(const Task& task) {
    Word best;
    words_from_left(task, false, best);
    words_from_left(task, true, best);
    return best;
}

}  // namespace dubins

// The length of the shortest curve that drives forwards alone [m].
inline double dubins_distance(const CarPose& start, const CarPose& goal, double radius) {
    return radius * dubins::find_shortest_word(task_between(start, goal, radius)).length;
}

// The shortest curve that drives forwards alone; among equals the first of LSL, LSR, LRL, RSR, RSL, RLR.
inline Curve dubins_curve(const CarPose& start, const CarPose& goal, double radius) {
    const Task task = task_between(start, goal, radius);
    const dubins::Word word = dubins::find_shortest_word(task);
    const int left = word.mirrored ? -1 : 1;
    Curve curve;
    curve.add(left, word.t, task.slack);
    curve.add(word.middle * left, word.u, task.slack);
    curve.add(word.crosses ? -left : left, word.v, task.slack);
    return curve;
}

}  // namespace cspace::navigation
