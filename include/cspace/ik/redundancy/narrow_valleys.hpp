// Adaptive sampling of a self-motion curve, for its point nearest to a seed. Samples are denser where the
// curve is fast: near folds they are placed like Chebyshev nodes, which keeps the steps even. Between two
// samples the distance to the seed has a lower bound, so only pairs that could contain a nearer point are
// divided (branch and bound). The bound is half the amount by which the sum of their two distances exceeds
// the distance between the samples.
#pragma once

#include <limits>

#include "cspace/ik/redundancy/target.hpp"
#include "cspace/ik/redundancy/turning_points.hpp"

namespace cspace::ik {

// The values of all branches are adjacent in memory, so that they are compared on lanes.
struct CurveSample {
    double value;
    unsigned there;  // which branches; the others are zero
    double q[max_joints][max_branches];
    double distance[max_branches];
    int next;  // in the order of values, or −1
};
struct CurveSamples {
    static constexpr int room = 192;
    int count = 0;
    CurveSample sample[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The sum of the squared joint differences, on four branches. difference(i): of joint i.
template <class Difference>
CSPACE_INLINE Pack<4> squared_way(const Redundant& arm, const Difference& difference) {
    Pack<4> sum = fill_lanes<Pack<4>>(0.0);
    for (int i = 0; i < arm.chain.n; ++i) {
        const Pack<4> way = joint_difference(arm.chain, i, difference(i));
        sum = mul_add(arm.weight[i] * way, way, sum);
    }
    return sum;
}

inline void copy_branch(const Chain& chain, const CurveSample& at, int branch, double* q) {
    for (int i = 0; i < chain.n; ++i) q[i] = at.q[i][branch];
}
inline bool is_acceptable(const Redundant& arm, const Target& target, const CurveSample& at, int branch) {
    double q[max_joints];
    if (!target.within_limits) return true;
    copy_branch(arm.chain, at, branch, q);
    return is_within(arm, q, limit_slack);
}

// Whether a branch may come nearer than `best` between two adjacent samples. Where the distances differ by
// more than the way between them, a joint passes from one end of its limits to the other, and the nearer
// sample alone is on its side.
inline bool may_hide(const Redundant& arm, const CurveSample& a, const CurveSample& b, double best) {
    using V = Pack<4>;
    constexpr double least_gap = 1e-4, detour = 1.2, short_way_between = 0.15;
    if (!(b.value - a.value > least_gap)) return false;
    unsigned hidden = 0;
    for (int k = 0; k < max_branches; k += 4) {
        const V way = detour * sqrt(squared_way(arm, [&](int i) {
                          return load_lanes<V>(a.q[i] + k) - load_lanes<V>(b.q[i] + k);
                      }));
        const V from = load_lanes<V>(a.distance + k), to = load_lanes<V>(b.distance + k),
                least = min(from, to);
        const V sum = select_lanes(abs(to - from) > way, 2.0 * least - way, from + to);
        hidden |= bits_of(way > short_way_between && sum - way < 2 * best) << k;
    }
    return (hidden & a.there & b.there) != 0;
}

inline void measure_sample(const Redundant& arm, const Target& target, CurveSample& at) {
    using V = Pack<4>;
    for (int k = 0; k < max_branches; k += 4) {
        V square = fill_lanes<V>(0.0);
        for (int i = 0; i < arm.chain.n; ++i) {
            const V gap = gap_from_seed(arm.chain, target, i, load_lanes<V>(at.q[i] + k));
            square = mul_add(arm.weight[i] * gap, gap, square);
        }
        store_lanes(at.distance + k, sqrt(square));
    }
}

// Adds samples at given values, with their distances from the seed. after[k]: the sample that value k
// follows.
inline void add_samples(const Redundant& arm, const Sweep& sweep, const double* values, const int* after,
                        int n, const Target& target, CurveSamples& all) {
    sweep_values(sweep, values, n, [&](int k, const SweptRows& rows) {
        const int at = all.count++;
        CurveSample& made = all.sample[at];
        made.value = values[k];
        made.there = 0;
        for (int i = 0; i < arm.chain.n; ++i)
            for (int b = 0; b < max_branches; ++b) made.q[i][b] = 0;
        for (int j = 0; j < rows.count; ++j) {
            const int b = rows.branch[j];
            if (b < 0 || b >= max_branches) continue;
            made.there |= 1u << b;
            for (int i = 0; i < arm.chain.n; ++i) made.q[i][b] = rows.q[j][i];
        }
        measure_sample(arm, target, made);
        made.next = -1;
        if (after && after[k] >= 0) {
            made.next = all.sample[after[k]].next;
            all.sample[after[k]].next = at;
        } else if (at > 0) {
            all.sample[at - 1].next = at;
        }
    });
}

// Divides until no pair can contain a point nearer than `best` (or than the nearest sample).
inline void divide_samples(const Redundant& arm, const Sweep& sweep, double best, const Target& target,
                           CurveSamples& all) {
    constexpr int most_rounds = 10;
    for (int round = 0; round < most_rounds; ++round) {
        double values[CurveSamples::room];
        int after[CurveSamples::room], n = 0;
        for (int k = 0; k < all.count; ++k)
            for (int b = 0; b < max_branches; ++b)
                if (all.sample[k].there >> b & 1 && all.sample[k].distance[b] < best &&
                    is_acceptable(arm, target, all.sample[k], b))
                    best = all.sample[k].distance[b];
        for (int k = 0; k < all.count && all.count + n < CurveSamples::room; ++k) {
            const CurveSample& a = all.sample[k];
            if (a.next < 0 || !may_hide(arm, a, all.sample[a.next], best)) continue;
            values[n] = 0.5 * (a.value + all.sample[a.next].value);
            after[n++] = k;
        }
        if (n == 0) return;
        add_samples(arm, sweep, values, after, n, target, all);
    }
}

// Whether q lies between samples a and b of a branch.
inline bool lies_between(const Chain& chain, const CurveSample& a, const CurveSample& b, int branch,
                         const double* q) {
    constexpr double aside2 = 1e-3;  // square of the share by which a branch bends between samples
    double along = 0, length2 = 0, off2 = 0, gap[max_joints], way[max_joints];
    for (int i = 0; i < chain.n; ++i) {
        const double from = a.q[i][branch];
        gap[i] = joint_difference(chain, i, q[i] - from);
        way[i] = joint_difference(chain, i, b.q[i][branch] - from);
        along += gap[i] * way[i];
        length2 += way[i] * way[i];
    }
    const double part = length2 > 0 ? along / length2 : 0;
    if (part < -0.1 || part > 1.1) return false;
    for (int i = 0; i < chain.n; ++i) off2 += (gap[i] - part * way[i]) * (gap[i] - part * way[i]);
    return off2 < aside2 * length2;
}

// Half of the detour over a point between two samples of a branch that may be that near to the seed: see
// may_hide. −∞ where the branch ends in between, or may bend more.
inline double bound_between(const Redundant& arm, const CurveSample& a, const CurveSample* b, int branch) {
    constexpr double detour = 1.2, longest = 0.2;
    if (!b) return std::numeric_limits<double>::infinity();
    if (!(b->there >> branch & 1)) return -std::numeric_limits<double>::infinity();
    double square = 0;
    for (int i = 0; i < arm.chain.n; ++i) {
        const double gap = joint_difference(arm.chain, i, a.q[i][branch] - b->q[i][branch]);
        square += arm.weight[i] * gap * gap;
    }
    const double way = detour * std::sqrt(square), from = a.distance[branch], to = b->distance[branch];
    if (way > longest) return -std::numeric_limits<double>::infinity();
    return 0.5 * ((std::fabs(to - from) > way ? 2 * min(from, to) : from + to) - way);
}

// Calls visit(q, distance, bound) for the local minima: samples below the adjacent samples of their branch,
// unless `found` is close to them. bound: no point between the adjacent samples is nearer.
template <class Visit>
inline void lowest_samples(const Redundant& arm, const CurveSamples& all, const double* found,
                           const Visit& visit) {
    const Chain& chain = arm.chain;
    const CurveSample* before = nullptr;
    for (int k = all.count ? 0 : -1; k >= 0;) {
        const CurveSample& at = all.sample[k];
        const CurveSample* beside[2] = {before, at.next >= 0 ? &all.sample[at.next] : nullptr};
        for (int b = 0; b < max_branches; ++b) {
            bool wanted = at.there >> b & 1;
            for (const CurveSample* other : beside)
                wanted =
                    wanted && (!other || !(other->there >> b & 1) || at.distance[b] <= other->distance[b]);
            for (const CurveSample* other : beside)
                wanted = wanted && !(found && other && other->there >> b & 1 &&
                                     lies_between(chain, at, *other, b, found));
            if (!wanted) continue;
            double q[max_joints];
            copy_branch(chain, at, b, q);
            visit(q, at.distance[b],
                  min(bound_between(arm, at, beside[0], b), bound_between(arm, at, beside[1], b)));
        }
        before = &at;
        k = at.next;
    }
}

// Whether the set of branches differs between adjacent samples, or is empty.
inline bool has_changes(const CurveSamples& all) {
    for (int k = 0; k < all.count; ++k)
        if (all.sample[k].there != all.sample[0].there || !all.sample[k].there) return true;
    return false;
}

// Values between the folds within a window of the circle, ascending; returns their number. closest: folds
// this close are one.
inline int values_between_folds(const FoldValues& folds, double closest, double middle, double half,
                                double* values, int room) {
    constexpr int each = 8;
    double fold[FoldValues::room + 1];
    const int n = sort_folds(folds, middle - pi, fold);
    int count = 0;
    for (int k = 0; k < n && count + each <= room; ++k) {
        const double from = fold[k], to = fold[k + 1];
        // The last of them reaches into the next revolution, and so into the window from below.
        const bool inside = (to >= middle - half && from <= middle + half) || to - 2 * pi >= middle - half;
        if (to - from < closest || !inside) continue;
        for (int j = 0; j < each; ++j)
            values[count++] = from + 0.5 * (to - from) * (1 - std::cos(pi * (j + 0.5) / each));
    }
    return count;
}

}  // namespace cspace::ik::inline CSPACE_ISA
