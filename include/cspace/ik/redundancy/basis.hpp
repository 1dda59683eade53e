// Which joints do the work of others: the rank of an arm's Jacobian where nothing special happens, and sets
// of joints that alone have that rank.
#pragma once

#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/redundancy/locked_joints.hpp"

namespace cspace {

// Joints whose columns are independent of each other.
struct Basis {
    int rank = 0;
    unsigned joints = 0;   // one bit each
    double least = 1e300;  // the least part of a column that those before it do not span
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// What is left of a column when the parts along unit columns are taken out, twice against rounding.
inline double rest_of_column(const double (*unit)[6], int count, double* column) {
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < count; ++k) {
            const double along = dot_n(unit[k], column, 6);
            for (int j = 0; j < 6; ++j) column[j] -= along * unit[k][j];
        }
    return std::sqrt(dot_n(column, column, 6));
}

// Takes joints in a given order, each unless those taken before span its column: first those that add much,
// then those that add anything.
inline Basis basis_at(const PoseError& at, const int* order, int count) {
    constexpr double much = 1e-2;
    Basis out;
    double unit[6][6];
    for (const double least : {much, tolerance::axis_relation})
        for (int k = 0; k < count && out.rank < 6; ++k) {
            if (out.joints >> order[k] & 1) continue;
            double column[6];
            for (int j = 0; j < 6; ++j) column[j] = at.jacobian.us[order[k]][j];
            const double size = rest_of_column(unit, out.rank, column);
            if (!(size > least)) continue;
            for (int j = 0; j < 6; ++j) unit[out.rank][j] = column[j] / size;
            out.joints |= 1u << order[k];
            out.least = min(out.least, size);
            ++out.rank;
        }
    return out;
}

// The same where it matters: at the one of some configurations without a pattern that tells most apart.
// Lengths count over `length`, the arm's own.
inline Basis basis_of(const ik::Chain& chain, double length, const int* order, int count) {
    constexpr int looks = 8;
    Basis best;
    for (int look = 0; look < looks; ++look) {
        double q[ik::max_joints];
        spread_configuration(look, chain.n, q);
        for (int i = 0; i < chain.n; ++i)
            if (chain.prismatic[i]) q[i] *= length;
        PoseError at;
        measure_error(chain, chain.tip, length, q, at);
        for (int i = 0; i < chain.n; ++i)
            for (int j = 0; j < 3 && chain.prismatic[i]; ++j) at.jacobian.us[i][j] *= length;
        const Basis found = basis_at(at, order, count);
        if (found.rank > best.rank || (found.rank == best.rank && found.least > best.least)) best = found;
    }
    return best;
}
inline Basis basis_of(const ik::Chain& chain, double length) {
    int order[ik::max_joints] = {};
    for (int i = 0; i < chain.n; ++i) order[i] = i;
    return basis_of(chain, length, order, chain.n);
}

}  // namespace cspace::inline CSPACE_ISA
