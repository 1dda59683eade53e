// The hidden angles at which the determinant vanishes: simple roots one by one, close ones as clusters.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <type_traits>

#include "cspace/ik/general/elimination.hpp"
#include "cspace/ik/general/sampler.hpp"

namespace cspace::ik {

inline constexpr int max_roots = 48;

struct HiddenAngle {
    double angle;  // [rad]
    double width;  // of the piece that holds it; 0 where it is isolated
    int expected;  // how many solutions the signs announce: 1, or 2 for a pair; see below
    double depth;  // by how much a pair is missed, of the largest value
    int order;     // how many roots are about, where the signs leave more than a pair open
};
// Noise hides how many there are; or there are none, but so nearly two that a slip of the equations, which
// the signs do not show, may have hidden them; or they are there for every goal and lead nowhere.
inline constexpr int unknown = 0, nearly_two = -1, spurious = -2;

struct HiddenAngles {
    int count = 0;
    HiddenAngle root[max_roots];
    double alias = 0;     // what is left of harmonics that the determinant lacks: its noise
    double largest = 0;   // of the samples
    int evaluations = 0;  // of the determinant, on packs of four
    bool overflow = false;
};

// A part of the circle with the signs of its coefficients.
struct Piece {
    Arc arc;
    Variations signs;
};

// Pieces that may hold roots.
struct Pieces {
    static constexpr int room = 64;
    int count = 0;
    Piece piece[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline constexpr double cluster_width = 2e-5;  // [rad], a piece this small is not divided further
inline constexpr double near_miss = 0.02;      // [rad], a pair announced on such a piece is followed up
inline constexpr double order_seen = 4e-4;     // [rad], roots this close show together in how f grows
inline constexpr int most_samplings = 48, most_divisions = 400;  // of pieces, per goal
inline constexpr double same_vertex = 1e-2;  // of a step of differences: what their parabola is good for
inline constexpr double beside_dip = 1e-3;   // [rad] by which the root of a dip may lie outside of its piece
inline constexpr double regular_alias = 1e-6;  // above, a formulation vanishes identically or drowns in noise

inline double angle_at(const Arc& arc, double u) {
    return arc.centre + arc_angle(arc.from + (arc.to - arc.from) * u, arc.quarter);
}

// About the angle that a piece spans, to a twentieth: arcs bend their parameter little.
inline double width_of(const Arc& arc) { return 4 * arc.quarter * (arc.to - arc.from); }

// The last arc written is one of the pieces if it may hold roots.
inline void keep_if_crossed(Pieces& pieces) {
    Piece& last = pieces.piece[pieces.count];
    last.signs = count_variations<degree>(last.arc.b, last.arc.noise);
    pieces.count += last.signs.most > 0;
}

inline void append_hidden_angle(HiddenAngles& out, const HiddenAngle& root) {
    if (out.count == max_roots)
        out.overflow = true;
    else
        out.root[out.count++] = root;
}

// How many roots are about an angle: f grows with that power of the distance from them.
template <class Function>
inline int order_of_zero(const Function& f, double angle) {
    constexpr double near = order_seen, ratio = 3;
    using V = Pack<4>;
    V at, s, c;
    for (int k = 0; k < 4; ++k) set_lane(at, k, angle + (k < 2 ? -near : near) * (k % 3 ? 1 : ratio));
    sincos(at, s, c);
    const V value = abs(f(c, s));
    const double outside = get_lane(value, 0) + get_lane(value, 3),
                 inside = get_lane(value, 1) + get_lane(value, 2);
    const double order = std::round(std::log(outside / inside) / std::log(ratio));
    return order > 0 && order <= degree ? int(order) : 0;
}

// A small piece where the signs leave a pair of roots open: the parabola through its middle tells whether
// they are real and apart, together, or missing by more than noise.
template <class Function>
inline void close_roots(const Function& f, const Arc& arc, const Variations& signs, HiddenAngles& out) {
    const double from = angle_at(arc, 0), to = angle_at(arc, 1), middle = 0.5 * (from + to);
    const double h = cluster_width;
    using V = Pack<4>;
    V angle, s, c;
    for (int k = 0; k < 4; ++k) set_lane(angle, k, middle + (k - 1) * h);
    sincos(angle, s, c);
    const V value = f(c, s);
    ++out.evaluations;
    const double left = get_lane(value, 0), at = get_lane(value, 1), right = get_lane(value, 2);
    const double slope = (right - left) / (2 * h), bend = (right - 2 * at + left) / (h * h);
    double vertex = middle - slope / bend;
    if (!(std::fabs(vertex - middle) < 2 * (to - from) + 2 * h)) vertex = middle;
    const double depth = 2 * (at - 0.5 * slope * slope / bend) / bend;  // −(half distance of the roots)²
    if (signs.count == 0 && depth > 400 * h * h) return;
    for (int k = 0; k < out.count; ++k)
        if (out.root[k].width > 0 && std::fabs(out.root[k].angle - vertex) < same_vertex * h) return;
    const double apart = depth < 0 ? std::sqrt(-depth) : 0;
    const int order = signs.most > 2 ? order_of_zero(f, vertex) : 0;
    out.evaluations += signs.most > 2;
    if (apart > same_vertex * h && apart < 3 * h) {
        append_hidden_angle(out, {vertex - apart, h, 1, 0, order});
        append_hidden_angle(out, {vertex + apart, h, 1, 0, order});
    } else {
        append_hidden_angle(out, {vertex, h, signs.count >= 2 ? 2 : unknown, 0, order});
    }
}

// The pieces with one root each, four at a time, until a step is no longer than the last.
inline void find_simple_roots(const Pieces& simple, double last_step, HiddenAngles& out) {
    for_each_pack(simple.count, [&](auto pack, int first) {
        using V = decltype(pack);
        const int lanes = std::min(simple.count - first, Lanes<V>::count);
        V b[padded];
        load_rows(simple.piece[first].arc.b, sizeof(Piece) / sizeof(double), lanes, degree + 1, b);
        const V u = only_roots<degree>(b, last_step);
        for (int k = 0; k < lanes; ++k)
            append_hidden_angle(out, {angle_at(simple.piece[first + k].arc, get_lane(u, k)), 0, 1, 0, 0});
    });
}

inline double value_halfway(const Arc& arc) {
    double half[padded];
    combine_rows(sampler_tables().lower_half, arc.b, degree + 1, half);
    return half[degree];
}

// Where a small piece announced two roots and neither was found: the bottom of the dip.
inline void note_near_misses(const Pieces& dips, HiddenAngles& out) {
    const int found = out.count;
    for (int i = 0; i < dips.count; ++i) {
        const Arc& dip = dips.piece[i].arc;
        const double from = angle_at(dip, 0), to = angle_at(dip, 1);
        bool has_root = false;
        for (int k = 0; k < found; ++k)
            has_root |= out.root[k].angle > from - beside_dip && out.root[k].angle < to + beside_dip;
        if (has_root) continue;
        // The parabola through both ends and the middle.
        const double left = dip.b[0], right = dip.b[degree], middle = value_halfway(dip);
        const double slope = right - left, bend = left - 2 * middle + right;
        const double u = 0.5 - 0.25 * slope / bend, bottom = middle - 0.125 * slope * slope / bend;
        const bool inside = u > 0 && u < 1;
        append_hidden_angle(out, {angle_at(dip, inside ? u : 0.5), to - from, nearly_two,
                                  std::fabs(inside ? bottom : middle), 0});
    }
}

// Both halves of an arc, as far as they may hold roots.
inline void divide_arc(const SamplerTables& t, const Arc& arc, Pieces& pieces) {
    const double middle = 0.5 * (arc.from + arc.to);
    for (const bool upper : {false, true}) {
        Arc& half = pieces.piece[pieces.count].arc;
        combine_rows(upper ? t.upper_half : t.lower_half, arc.b, degree + 1, half.b);
        half.centre = arc.centre;
        half.quarter = arc.quarter;
        half.from = upper ? middle : arc.from;
        half.to = upper ? arc.to : middle;
        half.noise = arc.noise;
        half.resampled = arc.resampled;
        keep_if_crossed(pieces);
    }
}

// The values of f at the nodes; two registers at a time, where f takes them, since one waits for its square
// roots.
template <class Function>
inline void sample_circle(const SamplerTables& t, const Function& f, double* out) {
    constexpr int wide = 2 * native_width;
    int j = 0;
    if constexpr (std::is_invocable_v<const Function&, Pack<wide>, Pack<wide>>)
        for (; j + wide <= samples; j += wide)
            store_lanes(out + j, f(load_lanes<Pack<wide>>(t.cosine + j), load_lanes<Pack<wide>>(t.sine + j)));
    for (; j < samples; j += 4)
        store_lanes(out + j, f(load_lanes<Pack<4>>(t.cosine + j), load_lanes<Pack<4>>(t.sine + j)));
}

// f(c, s) on packs of four: a trigonometric polynomial of degree 8. The roots are as exact as Newton's method
// is behind its last step [arc].
template <class Function>
inline void isolate_roots(const Function& f, double last_step, HiddenAngles& out) {
    const SamplerTables& tables = sampler_tables();
    double sampled[2 * samples];
    sample_circle(tables, f, sampled);
    out.evaluations = samples / 4;
    double largest = 0;
    for (int j = 0; j < samples; ++j) largest = max(largest, std::fabs(sampled[j]));
    out.largest = largest;
    if (!(largest > 0) || !std::isfinite(largest)) {
        out.alias = 1;
        return;
    }
    for (int j = 0; j < samples; ++j) sampled[samples + j] = sampled[j] /= largest;
    for (const auto& harmonic : tables.alias) {
        double sum = 0;
        for (int j = 0; j < samples; ++j) sum += harmonic[j] * sampled[j];
        out.alias = max(out.alias, std::fabs(sum));
    }
    if (out.alias > regular_alias) return;
    Pieces stack, simple, dips;
    const double noise = max(30 * out.alias, tolerance::last_digits) * tables.arc_gain;
    for (int k = 0; k < arcs; ++k) {
        Arc& arc = stack.piece[stack.count].arc;
        read_arc(tables, sampled, k, arc);
        arc.noise = noise;
        keep_if_crossed(stack);
    }
    int samplings = 0, divisions = 0;
    while (stack.count > 0) {
        const Piece piece = stack.piece[--stack.count];
        const Arc& arc = piece.arc;
        const Variations& signs = piece.signs;
        const double width = width_of(arc);
        const bool whole = arc.from == 0 && arc.to == 1;
        const bool drowning = signs.largest < 1e3 * arc.noise || signs.most != signs.count;
        if (drowning && width > 2 * cluster_width && !(whole && arc.resampled) &&
            samplings < most_samplings) {
            ++samplings;
            out.evaluations += padded / 4;
            const double from = angle_at(arc, 0), to = angle_at(arc, 1);
            resample_arc(tables, f, largest, 0.5 * (from + to), 0.25 * (to - from),
                         stack.piece[stack.count].arc);
            keep_if_crossed(stack);
            continue;
        }
        if (signs.most == 1 && signs.ends_known) {
            if (simple.count == Pieces::room)
                out.overflow = true;
            else
                simple.piece[simple.count++] = piece;
            continue;
        }
        if (width < cluster_width) {
            close_roots(f, arc, signs, out);
            continue;
        }
        if (stack.count + 2 > Pieces::room || ++divisions > most_divisions) {
            out.overflow = true;
            break;
        }
        if (signs.count >= 2 && width < near_miss && width >= 0.5 * near_miss && dips.count < Pieces::room)
            dips.piece[dips.count++] = piece;
        divide_arc(tables, arc, stack);
    }
    find_simple_roots(simple, last_step, out);
    note_near_misses(dips, out);
}

}  // namespace cspace::ik::inline CSPACE_ISA
