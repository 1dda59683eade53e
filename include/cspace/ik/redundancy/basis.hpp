// Independent joints: the generic rank of the Jacobian, and sets of joints whose columns alone have that
// rank.
#pragma once

#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/redundancy/locked_joints.hpp"

namespace cspace::ik {

// Joints with linearly independent columns.
struct Basis {
    int rank = 0;
    unsigned joints = 0;   // one bit each
    double least = 1e300;  // the least part of a column that those before it do not span
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Orthogonalises a column against unit columns, twice because of rounding; returns the norm of the remainder.
inline double rest_of_column(const double (*unit)[6], int count, double* column) {
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < count; ++k) {
            const double along = dot_n(unit[k], column, 6);
            for (int j = 0; j < 6; ++j) column[j] -= along * unit[k][j];
        }
    return std::sqrt(dot_n(column, column, 6));
}

// Selects joints in a given order. A joint is skipped if the joints before it span its column. The first pass
// takes columns with a large remainder, the second any others that are independent.
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

// A basis at a generic configuration: of several sample configurations, the one with the best-separated
// columns. Lengths are divided by `length`, the size of the arm.
inline Basis basis_of(const Chain& chain, double length, const int* order, int count) {
    constexpr int looks = 8;
    Basis best;
    for (int look = 0; look < looks; ++look) {
        double q[max_joints];
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
inline Basis basis_of(const Chain& chain, double length) {
    int order[max_joints] = {};
    for (int i = 0; i < chain.n; ++i) order[i] = i;
    return basis_of(chain, length, order, chain.n);
}

}  // namespace cspace::ik::inline CSPACE_ISA
