// Samples of a curve of configurations, closer where it runs fast: towards folds like the roots of
// Chebyshev's polynomials, which keeps their steps even; and between two samples no point is nearer to the
// seed than half of what their distances exceed the way between them (a bound as in branch and bound), so
// only pairs that could hide a nearer point are divided.
#pragma once

#include "cspace/ik/redundant/folds.hpp"

namespace cspace {

struct CurveSample {
    double value;
    unsigned there;  // which branches
    double q[max_branches][ik::max_joints];
    double distance[max_branches];
    int next;  // in the order of values, or −1
};
struct CurveSamples {
    static constexpr int room = 192;
    int count = 0;
    CurveSample sample[room];
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// Whether a branch may come nearer than `best` between two neighbours.
inline bool may_hide(const ik::Redundant& arm, const CurveSample& a, const CurveSample& b, double best) {
    constexpr double least_gap = 1e-4, detour = 1.2, short_way_between = 0.15;
    if (!(b.value - a.value > least_gap)) return false;
    for (int k = 0; k < max_branches; ++k) {
        const bool in_a = a.there >> k & 1, in_b = b.there >> k & 1;
        if (!in_a || !in_b) continue;
        double way2 = 0;
        for (int i = 0; i < arm.chain.n; ++i) {
            const double gap = a.q[k][i] - b.q[k][i];
            const double way = arm.chain.prismatic[i] ? gap : short_way(gap);
            way2 += arm.weight[i] * way * way;
        }
        const double way = detour * std::sqrt(way2);
        if (way > short_way_between && a.distance[k] + b.distance[k] - way < 2 * best) return true;
    }
    return false;
}

// Adds the samples at some values; `distance(q)` from the seed. after[k]: the sample that value k follows.
template <class Distance>
inline void add_samples(const Sweep& sweep, const double* values, const int* after, int n,
                        const Distance& distance, CurveSamples& all) {
    sweep_values(sweep, values, n, [&](int k, const SweptRows& rows) {
        const int at = all.count++;
        CurveSample& made = all.sample[at];
        made.value = values[k];
        made.there = 0;
        for (int j = 0; j < rows.count; ++j) {
            const int b = rows.branch[j];
            if (b < 0 || b >= max_branches) continue;
            made.there |= 1u << b;
            for (int i = 0; i < sweep.locked->whole.n; ++i) made.q[b][i] = rows.q[j][i];
            made.distance[b] = distance(rows.q[j]);
        }
        made.next = -1;
        if (after && after[k] >= 0) {
            made.next = all.sample[after[k]].next;
            all.sample[after[k]].next = at;
        } else if (at > 0) {
            all.sample[at - 1].next = at;
        }
    });
}

// Divides until nothing nearer than `best` (or than the nearest sample) can hide.
template <class Distance>
inline void divide_samples(const ik::Redundant& arm, const Sweep& sweep, double best,
                           const Distance& distance, CurveSamples& all) {
    constexpr int most_rounds = 10;
    for (int round = 0; round < most_rounds; ++round) {
        double values[CurveSamples::room];
        int after[CurveSamples::room], n = 0;
        for (int k = 0; k < all.count; ++k)
            for (int b = 0; b < max_branches; ++b)
                if (all.sample[k].there >> b & 1) best = min(best, all.sample[k].distance[b]);
        for (int k = 0; k < all.count && all.count + n < CurveSamples::room; ++k) {
            const CurveSample& a = all.sample[k];
            if (a.next < 0 || !may_hide(arm, a, all.sample[a.next], best)) continue;
            values[n] = 0.5 * (a.value + all.sample[a.next].value);
            after[n++] = k;
        }
        if (n == 0) return;
        add_samples(sweep, values, after, n, distance, all);
    }
}

// Whether q lies on the way from sample a to sample b of one branch.
inline bool lies_between(const ik::Chain& chain, const double* a, const double* b, const double* q) {
    double along = 0, length2 = 0, off2 = 0, gap[ik::max_joints], way[ik::max_joints];
    for (int i = 0; i < chain.n; ++i) {
        const bool slides = chain.prismatic[i];
        gap[i] = slides ? q[i] - a[i] : short_way(q[i] - a[i]);
        way[i] = slides ? b[i] - a[i] : short_way(b[i] - a[i]);
        along += gap[i] * way[i];
        length2 += way[i] * way[i];
    }
    const double part = length2 > 0 ? along / length2 : 0;
    if (part < -0.1 || part > 1.1) return false;
    for (int i = 0; i < chain.n; ++i) off2 += (gap[i] - part * way[i]) * (gap[i] - part * way[i]);
    return off2 < 1e-3 * length2;
}

// Calls visit(q, distance) for the lowest samples: those below their neighbours of the same branch, unless
// `found` lies beside them.
template <class Visit>
inline void lowest_samples(const ik::Chain& chain, const CurveSamples& all, const double* found,
                           const Visit& visit) {
    const CurveSample* before = nullptr;
    for (int k = all.count ? 0 : -1; k >= 0;) {
        const CurveSample& at = all.sample[k];
        const CurveSample* after = at.next >= 0 ? &all.sample[at.next] : nullptr;
        for (int b = 0; b < max_branches; ++b) {
            if (!(at.there >> b & 1)) continue;
            bool lowest = true, is_found = false;
            for (const CurveSample* other : {before, after}) {
                if (!other || !(other->there >> b & 1)) continue;
                lowest = lowest && at.distance[b] <= other->distance[b];
                is_found = is_found || (found && lies_between(chain, at.q[b], other->q[b], found));
            }
            if (lowest && !is_found) visit(at.q[b], at.distance[b]);
        }
        before = &at;
        k = at.next;
    }
}

// Whether the branches change between neighbours, or there are none.
inline bool has_changes(const CurveSamples& all) {
    for (int k = 0; k < all.count; ++k)
        if (all.sample[k].there != all.sample[0].there || !all.sample[k].there) return true;
    return false;
}

// Values between the folds around a window of the circle, ascending; returns how many.
inline int values_between_folds(const FoldValues& folds, double middle, double half, double* values,
                                int room) {
    constexpr int each = 8;
    double fold[FoldValues::room + 1];
    const int n = sort_folds(folds, middle - pi, fold);
    int count = 0;
    for (int k = 0; k < n && count + each <= room; ++k) {
        const double from = fold[k], to = fold[k + 1];
        if (to - from < 1e-9 || to < middle - half || from > middle + half) continue;
        for (int j = 0; j < each; ++j)
            values[count++] = from + 0.5 * (to - from) * (1 - std::cos(pi * (j + 0.5) / each));
    }
    return count;
}

}  // namespace cspace::inline CSPACE_ISA
