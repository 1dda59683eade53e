// An arm divided in its middle. The joints from the base on and the joints from the tip back move two frames,
// which coincide where the goal is reached. Each frame depends on one half of the joints only. Second
// derivatives therefore do not couple the halves, and both halves are computed together, one per lane.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>

#include "cspace/ik/chain.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::ik {

// Lengths are divided by the size of the arm. Lane 0: the joints from the base to the middle. Lane 1: the
// joints from the tip back, with the opposite sense. A joint rotates about (translates along) the z axis of
// its frame.
struct SplitChain {
    static constexpr int longest = 4;
    bool exist = false;                              // for arms of up to eight joints
    bool slides = false;                             // whether any joint does
    int joint[longest][2];                           // −1 beyond the shorter half
    double frame[longest][9][2], at[longest][3][2];  // of each joint in the one before
    double meeting[9][2], middle[3][2];  // the frames that meet, and a point of them, in the last ones
    double turning[longest][2], sliding[longest][2];  // what a unit of the joint does: 1 or 0; 1/length or 0
    // No third derivative of that point in a direction of unit length is larger, nor one of a frame's turn;
    // `slid` is what each slide adds for each unit it is out.
    double reach[2], turn[2], slid[longest][2];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double to_the_three_halves(int k) { return k * std::sqrt(double(k)); }

// The halves of a chain with `front` joints before the middle. The middle is at the point c (at q = 0).
// length: size of the arm. The point of each joint is the nearest of its axis to the next one towards the
// middle, which gives good bounds of the third derivatives. Each is at most the cube of all angles before a
// link times the length of the link: (Σ |x_j|)³ ≤ k^(3/2) |x|³ for k of them.
inline SplitChain split_chain_at(const Chain& chain, double length, int front, const Vec3d& c) {
    SplitChain out;
    out.exist = true;
    const Mat3d last[2] = {frame_along(chain.axis[front - 1]), frame_along(chain.axis[front])};
    for (int half = 0; half < 2; ++half) {
        const int count = half ? chain.n - front : front;
        Vec3d point[SplitChain::longest];
        Vec3d next = c;
        out.reach[half] = 0;
        out.turn[half] = to_the_three_halves(count);
        for (int k = count - 1; k >= 0; --k) {
            const int i = half ? chain.n - 1 - k : k;
            const Vec3d h = chain.axis[i];
            point[k] = chain.prismatic[i] ? next : chain.point[i] + dot(h, next - chain.point[i]) * h;
            const double most = to_the_three_halves(k + 1) / length;
            out.slid[k][half] = chain.prismatic[i] ? most : 0;
            out.reach[half] += most * (norm(next - point[k]) + chain.prismatic[i]);
            next = point[k];
        }
        Posed before = half ? chain.tip : identity_pose();
        for (int k = 0; k < SplitChain::longest; ++k) {
            const int i = half ? chain.n - 1 - k : k;
            const bool real = k < count;
            const Posed now = real ? Posed{frame_along(chain.axis[i]), point[k]} : before;
            const Posed relative = inverse(before) * now;
            out.joint[k][half] = real ? i : -1;
            out.turning[k][half] = real && !chain.prismatic[i];
            out.sliding[k][half] = real && chain.prismatic[i] ? 1 / length : 0;
            out.slides = out.slides || (real && chain.prismatic[i]);
            if (!real) out.slid[k][half] = 0;
            for (int j = 0; j < 9; ++j) out.frame[k][j][half] = relative.R.m[j / 3][j % 3];
            const double t[3] = {relative.t.x, relative.t.y, relative.t.z};
            for (int j = 0; j < 3; ++j) out.at[k][j][half] = t[j] / length;
            before = now;
        }
        const Mat3d meeting = transpose(before.R) * last[0];
        for (int j = 0; j < 9; ++j) out.meeting[j][half] = meeting.m[j / 3][j % 3];
        const Vec3d from = transpose_times(before.R, c - before.t);
        const double t[3] = {from.x, from.y, from.z};
        for (int j = 0; j < 3; ++j) out.middle[j][half] = t[j] / length;
    }
    return out;
}

// Divides where the bounds are smallest, at a point of one of the axes next to the division.
inline SplitChain make_split_chain(const Chain& chain, double length) {
    constexpr int longest = SplitChain::longest;
    SplitChain best;
    if (chain.n < 2 || chain.n > 2 * longest) return best;
    double least = std::numeric_limits<double>::infinity();
    for (int front = std::max(1, chain.n - longest); front <= std::min(longest, chain.n - 1); ++front)
        for (const int beside : {front - 1, front})
            for (int i = 0; i < chain.n; ++i) {
                const Vec3d h = chain.axis[beside], p = chain.point[beside];
                const Vec3d c = p + dot(h, chain.point[i] - p) * h;
                const SplitChain found = split_chain_at(chain, length, front, c);
                const double most = max(found.reach[0], found.reach[1]);
                if (!(most < least)) continue;
                least = most;
                best = found;
            }
    return best;
}

}  // namespace cspace::ik::inline CSPACE_ISA
