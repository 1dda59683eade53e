// Random arms of one, two and three joints of every kind, for the tests.
#pragma once

#include "cspace/ik/chain.hpp"
#include "random.hpp"

namespace few_joints {

using namespace cspace;
using check::Random;

inline constexpr int words = 2 + 4 + 8;
// Word w as joint types: R, P, RR, RP, PR, PP, RRR, …
inline ik::Chain word(int w) {
    ik::Chain chain;
    chain.n = w < 2 ? 1 : w < 6 ? 2 : 3;
    const int bits = w < 2 ? w : w < 6 ? w - 2 : w - 6;
    for (int i = 0; i < chain.n; ++i) chain.prismatic[i] = bits >> (chain.n - 1 - i) & 1;
    return chain;
}
inline Vec3d related_axis(Random& random, const Vec3d& other, bool wild) {
    const int kind = wild ? random.below(4) : 3;
    if (kind == 0) return other;
    if (kind == 1) {
        const Vec3d across = cross(other, random.axis());
        return (1 / norm(across)) * across;
    }
    return random.axis();
}
// wild: axes parallel, square or meeting, the tip on an axis.
inline ik::Chain random_arm(Random& random, int w, bool wild) {
    ik::Chain chain = word(w);
    for (int i = 0; i < chain.n; ++i) {
        chain.axis[i] = i ? related_axis(random, chain.axis[i - 1], wild) : random.axis();
        chain.point[i] = wild && i && random.below(2) ? chain.point[i - 1] : random.vector();
    }
    const int last = chain.n - 1;
    const Vec3d on_axis = chain.point[last] + random.uniform(-1, 1) * chain.axis[last];
    chain.tip = {identity_pose().R, wild && random.below(4) == 0 ? on_axis : random.vector()};
    return chain;
}
inline void random_joints(Random& random, const ik::Chain& chain, double* q) {
    for (int i = 0; i < chain.n; ++i)
        q[i] = chain.prismatic[i] ? random.uniform(-1.5, 1.5) : random.uniform(-pi, pi);
}
inline double apart(const ik::Chain& chain, const double* a, const double* b) {
    double most = 0;
    for (int i = 0; i < chain.n; ++i) {
        const double d = a[i] - b[i];
        most = std::fmax(most, std::fabs(chain.prismatic[i] ? d : 2 * std::sin(0.5 * d)));
    }
    return most;
}

}  // namespace few_joints
