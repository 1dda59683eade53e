// Shortest curves of a car that drives forwards and backwards (Reeds & Shepp 1990).
//
// The 48 words of the theorem are ten shapes, each with its mirror image and in both directions of driving.
// The formulas are derived anew, because those in print have slips. With complex numbers, the radius as unit
// and arcs t, u, v of any sign, the way between the circle on which a word begins and that on which it ends
// is
//   L(t) S(u) L(v)               u e^{it}                               v = turn − t
//   L(t) S(u) R(v)               (u − 2i) e^{it}                        v = t − turn
//   L(t) R(u) L(v)               4 sin(u/2) e^{i(t−u/2)}                v = turn − t + u
//   L(t) R(u) L(−u) R(v)         −2i (2 cos u − 1) e^{i(t−u)}           v = t − 2u − turn
//   L(t) R(u) L(u) R(v)          −2i (2 − e^{−iu}) e^{it}               v = t − turn
//   L(t) R(w) S(u) L(v)          (−2i + (u + 2i) e^{−iw}) e^{it}        v = turn − t + w
//   L(t) R(w) S(u) R(v)          (−2i + u e^{−iw}) e^{it}               v = t − w − turn
//   L(t) R(w) S(u) L(w) R(v)     (−4i + (u + 2i) e^{−iw}) e^{it}        v = t − turn
// with w a quarter turn, driven like u, where the car shifts gears before w; the two shapes with one quarter
// turn also hold read backwards. Every solution of such an equation is a curve that meets the goal, so that a
// wrong bound on its arcs cannot spoil an answer: each is taken the short way round. Of curves that are
// equally long but for rounding the first counts, and simple shapes come first.
#pragma once

#include <string_view>

#include "cspace/navigation/curves/curve.hpp"

namespace cspace::navigation {

namespace reeds_shepp {

enum class Shape { lsl, lsr, lrl, lrlr_opposed, lrlr_alike, lrsl, lrsr, lsrl, rsrl, lrslr };
// The turns of each shape, and the number of a word that is the length of each: U is −u, w the quarter turn.
struct Pattern {
    std::string_view turns, lengths;
};
constexpr Pattern patterns[] = {{"LSL", "tuv"},   {"LSR", "tuv"},    {"LRL", "tuv"},   {"LRLR", "tuUv"},
                                {"LRLR", "tuuv"}, {"LRSL", "twuv"},  {"LRSR", "twuv"}, {"LSRL", "tuwv"},
                                {"RSRL", "tuwv"}, {"LRSLR", "twuwv"}};

struct Word {
    double length = std::numeric_limits<double>::infinity();
    Shape shape = Shape::lsl;
    bool mirrored = false;
    double t = 0, u = 0, v = 0;
    double quarter = 0;
};

constexpr double half_pi = std::numbers::pi / 2;

// The words of a task that begin with L, or of its mirror image; the best is kept.
class Words {
  public:
    Words(const Task& task, bool mirrored, Word& best)
        : mirrored_(mirrored), turn_(mirrored ? -task.turn : task.turn), slack_(task.slack), best_(best) {
        const auto seen = [&](const Task::Way& way) {
            return Task::Way{way.length, mirrored ? -way.angle : way.angle};
        };
        same_ = seen(task.way[mirrored][mirrored]);
        cross_ = seen(task.way[mirrored][!mirrored]);
        const Task::Way& other = task.way[!mirrored][mirrored];
        // The way from the goal back to the start, seen from the goal.
        back_same_ = {same_.length, same_.angle + std::numbers::pi - turn_};
        back_cross_ = {other.length, (mirrored ? -other.angle : other.angle) + std::numbers::pi - turn_};
    }

    void between_like_circles() {
        const double d = same_.length, a = same_.angle;
        if (d <= slack_) return consider(Shape::lsl, turn_, 0, 0, 0);
        consider(Shape::lsl, a, d, turn_ - a, d);
        consider(Shape::lsl, a + std::numbers::pi, -d, turn_ - a - std::numbers::pi, d);
        if (d <= 4 + slack_) {
            const double u = 2 * std::asin(std::min(d / 4, 1.0));
            for (const double s : {1.0, -1.0}) {
                const double t = a + s * u / 2 + (s < 0 ? std::numbers::pi : 0);
                consider(Shape::lrl, t, s * u, turn_ - t + s * u, u);
            }
        }
        if (d * d >= 8) {  // |u| = q − 2 ≥ 0
            const double q = std::sqrt(d * d - 4), lean = std::atan2(q, 2.0);
            quarter_then_straight(Shape::lrsl, same_, turn_, q - 2, lean);
            quarter_then_straight(Shape::lsrl, back_same_, -turn_, q - 2, lean);
        }
    }

    void between_unlike_circles() {
        const double d = cross_.length, a = cross_.angle;
        const double squared = d * d - 4;
        if (squared >= -4 * slack_) {
            const double u = std::sqrt(std::max(squared, 0.0)), lean = std::atan2(2.0, u);
            consider(Shape::lsr, a + lean, u, a + lean - turn_, u);
            const double t = a + std::numbers::pi - lean;
            consider(Shape::lsr, t, -u, t - turn_, u);
            if (u >= 4) {  // w = s π/2: −4i + (su + 2i)(−si) = 2s − iq with |u| = q − 4
                for (const double s : {1.0, -1.0}) {
                    const double begin = a + (s > 0 ? half_pi - lean : half_pi + lean);
                    consider(Shape::lrslr, begin, s * (u - 4), begin - turn_, u - 4 + 2 * half_pi, s);
                }
            }
        }
        if (d <= 2 + slack_) {
            const double u = std::acos(std::min((2 + d) / 4, 1.0));
            for (const double s : {1.0, -1.0}) {
                const double t = a + half_pi + s * u;
                consider(Shape::lrlr_opposed, t, s * u, t - 2 * s * u - turn_, 2 * u);
            }
        }
        if (d >= 2 - slack_ && d * d <= 20) {
            const double c = std::min((20 - d * d) / 16, 1.0), u = std::acos(c);
            const double lean = std::atan2(std::sin(u), 2 - c);
            for (const double s : {1.0, -1.0}) {
                const double t = a + half_pi - s * lean;
                consider(Shape::lrlr_alike, t, s * u, t - turn_, 2 * u);
            }
        }
        quarter_then_straight_across(Shape::lrsr, cross_, turn_);
        quarter_then_straight_across(Shape::rsrl, back_cross_, -turn_);
    }

  private:
    // L R S L, w and u forwards or backwards; read from the goal it is L S R L.
    void quarter_then_straight(Shape shape, const Task::Way& way, double turn, double u, double lean) {
        for (const double s : {1.0, -1.0}) {  // w = s π/2: −2i + (su + 2i)(−si) = 2s − iq
            const double t = way.angle + (s > 0 ? lean : std::numbers::pi - lean);
            ends(shape, t, s * u, turn - t + s * half_pi, s);
        }
    }

    // L R S R; read from the goal, in its mirror image, it is R S R L.
    void quarter_then_straight_across(Shape shape, const Task::Way& way, double turn) {
        if (way.length < 2) return;
        for (const double s : {1.0, -1.0}) {  // w = s π/2: −2i + su (−si) = −i (2 + u)
            const double t = way.angle + half_pi;
            ends(shape, t, s * (way.length - 2), t - s * half_pi - turn, s);
        }
    }

    // A word with one quarter turn, as it is or read from its end.
    void ends(Shape shape, double t, double u, double v, double quarter) {
        const double middle = std::fabs(u) + half_pi;
        if (shape == Shape::lrsl || shape == Shape::lrsr)
            consider(shape, t, u, v, middle, quarter);
        else
            consider(shape, -v, -u, -t, middle, -quarter);
    }

    void consider(Shape shape, double t, double u, double v, double middle, double quarter = 0) {
        if (middle >= best_.length) return;
        t = wrap_angle(t);
        v = wrap_angle(v);
        const double length = std::fabs(t) + middle + std::fabs(v);
        if (length < best_.length - slack_) best_ = {length, shape, mirrored_, t, u, v, quarter * half_pi};
    }

    bool mirrored_;
    double turn_, slack_;
    Word& best_;
    Task::Way same_, cross_, back_same_, back_cross_;
};

inline Word find_shortest_word(const Task& task) {
    Word best;
    Words left(task, false, best), right(task, true, best);
    left.between_like_circles();
    right.between_like_circles();
    left.between_unlike_circles();
    right.between_unlike_circles();
    return best;
}

inline Curve curve_of(const Word& word, double nothing) {
    const auto& [turns, lengths] = patterns[std::size_t(word.shape)];
    const int left = word.mirrored ? -1 : 1;
    const auto length_of = [&](char number) {
        return number == 't'   ? word.t
               : number == 'u' ? word.u
               : number == 'U' ? -word.u
               : number == 'v' ? word.v
                               : word.quarter;
    };
    Curve curve;
    for (std::size_t k = 0; k < turns.size(); ++k)
        curve.add(turns[k] == 'S' ? 0 : turns[k] == 'L' ? left : -left, length_of(lengths[k]), nothing);
    return curve;
}

}  // namespace reeds_shepp

// The length of the shortest curve that drives forwards and backwards [m].
inline double reeds_shepp_distance(const CarPose& start, const CarPose& goal, double radius) {
    return radius * reeds_shepp::find_shortest_word(task_between(start, goal, radius)).length;
}

// The shortest curve that drives forwards and backwards.
inline Curve reeds_shepp_curve(const CarPose& start, const CarPose& goal, double radius) {
    const Task task = task_between(start, goal, radius);
    return reeds_shepp::curve_of(reeds_shepp::find_shortest_word(task), task.slack);
}

}  // namespace cspace::navigation
