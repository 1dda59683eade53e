// Cells, eight at a time: boxes q ± half of configurations, which touch nothing or touch something all over.
//
// Let joint k turn by at most h_k, from the body of a place p towards the base. If the joints before it have
// moved p by at most D, then p is at most r_k + D from its axis, where r_k is the distance at q, and it moves
// by at most D + h_k (r_k + D) in all; a prismatic joint adds h_k. The motion of one body against another is
// bounded by the sum of what the joints of either side do, those that carry both left out. A ball that is
// grown by this bound and touches nothing is free in the whole cell; one that is smaller by it and touches
// does so in the whole cell.
#pragma once

#include "cspace/collision/rows.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// How far places move within a cell.
class CellMotion {
  public:
    // half: of the cell, by coordinate. rounding: of places [m].
    CellMotion(const Block& block, const float* half, float rounding)
        : block_(block), half_(half), rounding_(rounding) {}

    // Of a place on body b against body a.
    CSPACE_INLINE Floats bound(int a, int b, const Place& at) const {
        constexpr float round_up = 1 + 1e-5f;
        Floats one = fill_floats(0.0f), other = one;
        while (a != b) {
            int& body = b > a ? b : a;
            Floats& moved = b > a ? one : other;
            const Joint& joint = block_.robot.joints[body - 1];
            const float h = std::fabs(joint.ratio) * half_[joint.coordinate];
            if (h > 0) moved = moved + (joint.is_prismatic ? fill_floats(h) : turned(body, at, moved) * h);
            body = joint.parent;
        }
        return (one + other) * round_up + 2 * rounding_;
    }

  private:
    const Block& block_;
    const float* half_;
    float rounding_;

    // How far a place that has moved may be from the axis of the joint that carries a body.
    CSPACE_INLINE Floats turned(int body, const Place& at, Floats moved) const {
        const Frame& frame = block_.frames[body];
        const Floats x = at.x - frame.p[0], y = at.y - frame.p[1], z = at.z - frame.p[2];
        const Floats a = frame.R[2], b = frame.R[5], c = frame.R[8];
        return norm({y * c - z * b, z * a - x * c, x * b - y * a}) + moved;
    }
};

// Balls grown by their motion: a lane in which none touches is free in its whole cell.
struct GrownCells : Apart {
    explicit GrownCells(const Block& block, const CellMotion& motion) : block(block), motion(motion) {}
    const Block& block;
    const CellMotion& motion;
    static Floats no_growth() { return fill_floats(0.0f); }
    CSPACE_INLINE Floats growth(int x, const Place& at) const { return motion.bound(0, x, at); }
    CSPACE_INLINE Floats pair_growth(int p, const Place& at) const {
        return motion.bound(block.robot.pairs[p].a, block.robot.pairs[p].b, at);
    }
};
// Balls smaller by their motion: a lane in which one touches is blocked in its whole cell.
struct ShrunkCells : GrownCells {
    using GrownCells::GrownCells;
    static Shrink no_growth() { return {fill_floats(0.0f)}; }
    CSPACE_INLINE Shrink growth(int x, const Place& at) const { return {GrownCells::growth(x, at)}; }
    CSPACE_INLINE Shrink pair_growth(int p, const Place& at) const {
        return {GrownCells::pair_growth(p, at)};
    }
};

// The lanes whose middles touch something, and those whose whole cells are as their middles.
struct CellVerdicts {
    unsigned touching, proved;
};

inline CellVerdicts settle_cells(Block& block, const Floats* q, const float* half, float rounding,
                                 unsigned wanted) {
    const unsigned touching = lanes_in_collision(block, q, wanted);
    const CellMotion motion(block, half, rounding);
    const auto lanes_hit = [&](unsigned lanes, const auto& balls) {
        block.hit = 0;
        block.wanted = lanes;
        if (lanes) test_lanes(block, balls);
        return block.hit & lanes;
    };
    const unsigned blocked = lanes_hit(touching, ShrunkCells(block, motion));
    const unsigned free = wanted & ~touching;
    return {touching, blocked | (free & ~lanes_hit(free, GrownCells(block, motion)))};
}

}  // namespace cspace::collision::inline CSPACE_ISA
