// Local minima of the distance to a seed along the arcs of a self-motion. Several arcs are followed at once,
// one per lane, each from a start to the next start on it, to its own end, or to where it is far from the
// seed.
//
// The determinant of the Jacobian's rows and the tangent has the same sign along all of an arc where its rank
// is full. That gives every arc one direction: from each start it is followed forwards, and backwards from
// those starts alone that no other one led to.
#pragma once

#include <algorithm>

#include "cspace/ik/redundancy/continuation.hpp"
#include "cspace/ik/redundancy/nearest_step.hpp"

namespace cspace::ik {

// Points of the self-motion from which arcs are followed.
struct ArcStarts {
    static constexpr int room = 192;
    int count = 0;
    double q[room][max_joints], distance[room];
    double joint[max_joints][room];  // the joints once more, one after the other
    bool is_reached[room];           // from the start before it on its arc
};

// Points near local minima of the distance. No point between the two points of the arc that they lie between
// is nearer to the seed than `bound`.
struct ArcMinima {
    static constexpr int room = 128;
    int count = 0;
    double q[room][max_joints], distance[room], bound[room];
};

// Where the search is given up along an arc.
struct ArcReach {
    double beyond;   // of the distance of the best configuration
    double outside;  // of the limits [rad]
};

// What is followed.
struct ArcSearch {
    const Redundant* arm;
    const Target* target;
    ArcStarts* starts;
    ArcMinima* minima;
    const Nearest* best;
    ArcReach reach;
};

// The arcs that are followed now.
template <class V>
struct ArcLanes {
    static constexpr int lanes = Lanes<V>::count;
    CurvePoints<V> at, to;
    V third[max_joints], fourth[max_joints];  // derivatives of the arc ahead
    V stride, slope, distance;                // slope: of half the square of the distance
    int start[lanes], steps[lanes];           // start: −1 where a lane is idle
    double sense;                             // 1 forwards, −1 backwards
    int order[ArcStarts::room], count, next;  // the starts that follow
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Adds a start unless it is there already.
inline void add_arc_start(const Redundant& arm, const double* q, double distance, ArcStarts& out) {
    constexpr double same = 1e-6;
    if (out.count == ArcStarts::room) return;
    for (int k = 0; k < out.count; ++k)
        if (std::fabs(out.distance[k] - distance) < same && joint_gap(arm.chain, out.q[k], q) < same) return;
    const int k = out.count++;
    for (int i = 0; i < arm.chain.n; ++i) out.q[k][i] = out.joint[i][k] = q[i];
    out.distance[k] = distance;
    out.is_reached[k] = false;
}

// The most that a joint is outside its limits.
inline double most_outside(const Redundant& arm, const double* q) {
    double most = 0;
    for (int i = 0; i < arm.chain.n; ++i) most = max(most, limit_excess(arm, i, q[i]));
    return most;
}

inline bool is_worth_following(const ArcSearch& search, const double* q, double distance) {
    return distance < search.best->distance + search.reach.beyond &&
           (!search.target->within_limits || most_outside(*search.arm, q) < search.reach.outside);
}

template <class V>
inline void take_start(const ArcSearch& search, ArcLanes<V>& arcs, int l) {
    const ArcStarts& starts = *search.starts;
    arcs.start[l] = -1;
    arcs.steps[l] = -1;
    while (arcs.next < arcs.count && arcs.start[l] < 0) {
        const int k = arcs.order[arcs.next++];
        if (arcs.sense < 0 && starts.is_reached[k]) continue;
        if (is_worth_following(search, starts.q[k], starts.distance[k])) arcs.start[l] = k;
    }
    const double* const q = starts.q[std::max(arcs.start[l], 0)];
    for (int i = 0; i < search.arm->chain.n; ++i) {
        set_lane(arcs.at.q[i], l, q[i]);
        for (V* value : {arcs.at.tangent, arcs.at.bend, arcs.third, arcs.fourth}) set_lane(value[i], l, 0.0);
    }
    set_lane(arcs.stride, l, 0.0);
}

// Adds the place between two points of an arc where the distance is least.
inline void add_arc_minimum(const ArcSearch& search, const double* from, const double* to, double part,
                            double distance, double bound) {
    ArcMinima& out = *search.minima;
    if (!(bound < search.best->distance) || out.count == ArcMinima::room) return;
    const int k = out.count, n = search.arm->chain.n;
    for (int i = 0; i < n; ++i) out.q[k][i] = from[i] + part * (to[i] - from[i]);
    out.distance[k] = distance;
    out.bound[k] = bound;
    ++out.count;
}

// Whether a step passed a start; where it is another one, it is reached.
inline bool passes_start(const ArcSearch& search, const double* from, const double* to, int own, int steps,
                         double distance, double longest) {
    constexpr double beyond = 1.1, aside = 1.3;  // of a chord: the chord and its tube
    using V = Pack<4>;
    ArcStarts& starts = *search.starts;
    const Chain& chain = search.arm->chain;
    bool passed = false;
    for (int first = 0; first < starts.count; first += 4) {
        const int count = std::min(4, starts.count - first);
        const V off = load_lanes<V>(starts.distance + first, count) - distance;
        unsigned near_by = bits_of(abs(off) <= aside * longest) & ((1u << count) - 1);
        for (int i = 0; i < chain.n && near_by; ++i) {
            const V gap = load_lanes<V>(starts.joint[i] + first, count) - to[i];
            near_by &= bits_of(abs(joint_difference(chain, i, gap)) <= beyond * longest);
        }
        for (int k = first; near_by; ++k, near_by >>= 1) {
            if (!(near_by & 1) || (k == own && steps == 0)) continue;
            if (!(part_of_chord(chain, from, to, starts.q[k]) > 0)) continue;
            starts.is_reached[k] = passed = true;
        }
    }
    return passed;
}

// After a step of lane l: keeps a minimum in it; returns whether the arc goes on.
template <class V>
inline bool goes_on(const ArcSearch& search, ArcLanes<V>& arcs, int l, double slope, double distance) {
    constexpr int most_steps = 400;
    constexpr double bent = 1.05;  // an arc of a step is shorter than so many chords
    const int n = search.arm->chain.n;
    const double before = get_lane(arcs.slope, l), from_distance = get_lane(arcs.distance, l);
    double from[max_joints], to[max_joints], longest2 = 0;
    for (int i = 0; i < n; ++i) {
        from[i] = get_lane(arcs.at.q[i], l);
        to[i] = get_lane(arcs.to.q[i], l);
        longest2 += (to[i] - from[i]) * (to[i] - from[i]);
    }
    const double chord = std::sqrt(longest2), way = bent * chord;
    const double nearer = min(distance, from_distance), bound = 0.5 * (distance + from_distance - way);
    if (std::fabs(distance - from_distance) > way) {  // a joint goes on from its other limit
        add_arc_minimum(search, from, to, 0, from_distance, nearer - way);
        add_arc_minimum(search, from, to, 1, distance, nearer - way);
    } else if (before < 0 && slope >= 0) {
        add_arc_minimum(search, from, to, before / (before - slope), nearer, bound);
    }
    if (passes_start(search, from, to, arcs.start[l], arcs.steps[l], distance, chord)) return false;
    return ++arcs.steps[l] < most_steps && is_worth_following(search, to, distance);
}

// The derivatives ahead: see look_ahead.
template <int N, class V>
CSPACE_INLINE void look_ahead(ArcLanes<V>& arcs, int size, mask_of<V> moved) {
    constexpr double shortest = 1e-3, arc = 1.0 / 24;
    const int n = size_or<N>(size);
    V chord2 = fill_lanes<V>(0.0), bend2 = chord2;
    for (int i = 0; i < n; ++i) {
        const V way = arcs.to.q[i] - arcs.at.q[i];
        chord2 = mul_add(way, way, chord2);
        bend2 = mul_add(arcs.to.bend[i], arcs.to.bend[i], bend2);
    }
    moved = moved && chord2 > shortest * shortest;
    const V h = select_lanes(moved, sqrt(chord2) * (1.0 + arc * chord2 * bend2), fill_lanes<V>(1.0)),
            per = 1.0 / h;
    for (int i = 0; i < n; ++i) {
        const V turned = per * per * (arcs.at.tangent[i] - arcs.to.tangent[i] + h * arcs.to.bend[i]);
        const V curled = per * (arcs.at.bend[i] - arcs.to.bend[i]);
        const V third = 6.0 * turned + 2.0 * curled;
        arcs.third[i] = keep_lanes<V>(moved, third);
        arcs.fourth[i] = keep_lanes<V>(moved, 2.0 * per * (curled + third));
    }
}

// Tries a step of every lane. Returns the lanes in which it stayed close to the arc, as in step_along_arc;
// factor: of the next strides, at most, by how the Jacobian changed.
template <int N, class V>
CSPACE_INLINE mask_of<V> try_steps(const ArcSearch& search, const Pose<V>& goal, ArcLanes<V>& arcs,
                                   mask_of<V> begins, V& factor) {
    constexpr double small = 1e-4, third = 1.0 / 6, fourth = 1.0 / 24, most_change = 0.5;
    constexpr double still = 1e-3;  // a change that restrains no step
    const Redundant& arm = *search.arm;
    const int n = size_or<N>(arm.chain.n);
    CurvePoints<V>&at = arcs.at, &to = arcs.to;
    const V h = arcs.stride, h3 = h * h * h;
    V bent[max_joints], moved = fill_lanes<V>(0.0), away = moved, cosine = moved;
    for (int i = 0; i < n; ++i) {
        bent[i] = mul_add(h, mul_add(0.5 * h, at.bend[i], at.tangent[i]), at.q[i]);
        to.q[i] = mul_add(h3, third * arcs.third[i] + fourth * h * arcs.fourth[i], bent[i]);
    }
    for (int pass = 0; pass < 3; ++pass) {
        V before[max_joints];
        for (int i = 0; i < n; ++i) before[i] = to.q[i];
        step_onto_curve<N>(arm.chain, 6, goal, arm.length, to);
        moved = fill_lanes<V>(0.0);
        for (int i = 0; i < n; ++i) moved = max(moved, abs(to.q[i] - before[i]));
        if (!any(moved > small)) break;
    }
    V sign = fill_lanes<V>(arcs.sense);
    for (int k = 0; k < 6; ++k) sign = copysign(fill_lanes<V>(1.0), to.split.diagonal[k]) * sign;
    for (int i = 0; i < n; ++i) {
        to.tangent[i] = sign * to.tangent[i];
        away = max(away, abs(to.q[i] - bent[i]));
        cosine = mul_add(to.tangent[i], at.tangent[i], cosine);
    }
    const mask_of<V> close = moved <= small && away < most_correction * h && cosine > 0.95;
    V change = jacobian_change<N>(at, to, n);
    if (any(close && !(change < most_change))) change = min(change, jacobian_change<N>(to, at, n));
    const mask_of<V> moves = begins || (close && change < most_change);
    const V usual = max(fill_lanes<V>(0.25), 0.8 * most_change / (change + still));
    factor = min(fill_lanes<V>(2.0), select_lanes(close, usual, fill_lanes<V>(0.5)));
    return moves;
}

// Takes the new points in the lanes `moved`, and the strides of all.
template <int N, class V>
CSPACE_INLINE void take_steps(ArcLanes<V>& arcs, int size, mask_of<V> moved, mask_of<V> begins, V factor) {
    constexpr double first = 0.05, longest = 0.35, straight = 1e-3;
    const int n = size_or<N>(size);
    look_ahead<N>(arcs, n, moved && !begins);
    V fastest = fill_lanes<V>(0.0), bend2 = fastest;
    const auto take = [&](V& to, const V& from) { to = select_lanes(moved, from, to); };
    for (int i = 0; i < n; ++i) {
        take(arcs.at.q[i], arcs.to.q[i]);
        take(arcs.at.tangent[i], arcs.to.tangent[i]);
        take(arcs.at.bend[i], arcs.to.bend[i]);
        for (int k = 0; k < 6; ++k) {
            take(arcs.at.motion.column[i][k], arcs.to.motion.column[i][k]);
            take(arcs.at.split.A[i][k], arcs.to.split.A[i][k]);
        }
        fastest = max(fastest, abs(arcs.at.tangent[i]));
        bend2 = mul_add(arcs.at.bend[i], arcs.at.bend[i], bend2);
    }
    for (int k = 0; k < 6; ++k) take(arcs.at.split.diagonal[k], arcs.to.split.diagonal[k]);
    const V next = select_lanes(begins, fill_lanes<V>(first), factor * arcs.stride);
    const V most = min(longest / fastest, 0.25 / (sqrt(bend2) + straight));
    arcs.stride = select_lanes(moved, min(next, most), factor * arcs.stride);
}

// Follows the arcs from all starts in one direction.
template <int N, class V>
inline void follow_arcs(const ArcSearch& search, const Pose<V>& goal, ArcLanes<V>& arcs, double sense) {
    constexpr double shortest = 1e-5;
    constexpr int most_rounds = 4000;
    const Redundant& arm = *search.arm;
    arcs.sense = sense;
    arcs.next = 0;
    for (int l = 0; l < arcs.lanes; ++l) take_start(search, arcs, l);
    for (int round = 0; round < most_rounds; ++round) {
        V begun = fill_lanes<V>(0.0);
        bool active = false;
        for (int l = 0; l < arcs.lanes; ++l) {
            set_lane(begun, l, arcs.steps[l]);
            active = active || arcs.start[l] >= 0;
        }
        if (!active) return;
        const mask_of<V> begins = begun < 0.0;
        V factor, square = fill_lanes<V>(0.0), slope = square;
        const mask_of<V> moved = try_steps<N>(search, goal, arcs, begins, factor);
        for (int i = 0; i < size_or<N>(arm.chain.n); ++i) {
            const V gap = gap_from_seed(arm.chain, *search.target, i, arcs.to.q[i]);
            const V weighted = arm.weight[i] * gap;
            square = mul_add(weighted, gap, square);
            slope = mul_add(weighted, arcs.to.tangent[i], slope);
        }
        const V distance = sqrt(square);
        const unsigned done = bits_of(moved), fresh = bits_of(begins);
        unsigned ends = 0;
        for (int l = 0; l < arcs.lanes; ++l) {
            if (arcs.start[l] < 0) continue;
            if (!(done >> l & 1))
                ends |= unsigned(get_lane(arcs.stride, l) < shortest) << l;
            else if (fresh >> l & 1)
                arcs.steps[l] = 0;
            else
                ends |= unsigned(!goes_on(search, arcs, l, get_lane(slope, l), get_lane(distance, l))) << l;
        }
        take_steps<N>(arcs, arm.chain.n, moved, begins, factor);
        arcs.slope = select_lanes(moved, slope, arcs.slope);
        arcs.distance = select_lanes(moved, distance, arcs.distance);
        for (int l = 0; l < arcs.lanes; ++l)
            if (ends >> l & 1) take_start(search, arcs, l);
    }
}

// All local minima along the arcs through the starts, up to where they are given up.
template <int N, class V>
CSPACE_NOINLINE void find_arc_minima(const ArcSearch& search, const Posed& goal) {
    ArcLanes<V> arcs = {};
    arcs.count = search.starts->count;
    for (int k = 0; k < arcs.count; ++k) arcs.order[k] = k;
    std::sort(arcs.order, arcs.order + arcs.count,
              [&](int a, int b) { return search.starts->distance[a] < search.starts->distance[b]; });
    const Pose<V> goals = fill_pose<V>(goal);
    follow_arcs<N>(search, goals, arcs, 1.0);
    follow_arcs<N>(search, goals, arcs, -1.0);
}

}  // namespace cspace::ik::inline CSPACE_ISA
