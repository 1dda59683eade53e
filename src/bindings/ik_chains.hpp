// An arm as the bindings are given it: its joint axes at zero.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/kinematics/forward.hpp"

// axes (n, 3), points (n, 3), slides (n,): which joints slide, T_zero (4, 4).
template <class Flag>
cspace::ik::Chain chain_from(int n, const double* axes, const double* points, const Flag* slides,
                             const double* T_zero) {
    cspace::ik::Chain chain;
    chain.n = n;
    for (int i = 0; i < n; ++i, axes += 3, points += 3) {
        chain.axis[i] = {axes[0], axes[1], axes[2]};
        chain.point[i] = {points[0], points[1], points[2]};
        chain.prismatic[i] = slides[i] != Flag{};
    }
    chain.tip = cspace::kinematics::read_matrix(T_zero);
    return chain;
}
