// Cells, eight at a time: boxes q ± half of configurations, which touch nothing or touch something all over.
//
// Let joint k turn by at most h_k, from the body of a place p towards the base. If the joints before it have
// moved p by at most D, then p is at most ρ_k = r_k + D from its axis, where r_k is the distance at q, and it
// moves by at most D + ρ_k h_k in all; a prismatic joint has ρ = 1. The motion of one body against another is
// bounded by the sum of what the joints of either side do, those that carry both left out. A ball that is
// grown by this bound and touches nothing is free in the whole cell; one that is smaller by it and touches
// does so in the whole cell.
// Both are refined by the direction. Let n be the unit vector from the nearest point x of an obstacle to the
// centre of a ball of radius r, at a distance d. Within the cell the centre moves by at most
//     a = Σ |n · v_k| h_k + ½ κ,  κ = Σ ρ_k h_k (h_k + 2 Σ_{i towards the base} h_i)
// along n, where v_k is its velocity by joint k (see edge.hpp). If the obstacle is convex it lies behind the
// plane across n in x, and d − a > r proves the cell free. Any obstacle contains x, and (d + a)² + D² < r²
// proves it blocked.
#pragma once

#include "cspace/collision/rows.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// How far places move within a cell.
class CellMotion {
  public:
    // half: of the cell, by coordinate. rounding: of places [m].
    CellMotion(const Block& block, const float* half, float rounding)
        : block_(block), half_(half), rounding_(rounding) {}

    // An upper bound on the motion of a place on body b against body a.
    CSPACE_INLINE Floats bound(int a, int b, const Place& at) const { return bound(a, b, at, 0); }
    // The same of all places within a ball.
    CSPACE_INLINE Floats bound(int a, int b, const Place& at, float radius) const {
        Floats one = fill_floats(0.0f), other = one;
        while (a != b) {
            int& body = b > a ? b : a;
            Floats& moved = b > a ? one : other;
            const Joint& joint = block_.robot.joints[body - 1];
            if (const float h = half_of(joint); h > 0)
                moved = moved + lever(joint, body, at, moved + radius) * h;
            body = joint.parent;
        }
        return (one + other) * round_up + 2 * rounding_;
    }

    // How far a place on body b may move in all, and along the line to something on body a.
    struct Approach {
        Floats moved, along;
        bool is_known;  // a carries b
    };
    // gap: the square of the distance to it. rate_of(v) is δ · v, where δ leads from there to the place.
    template <class RateOf>
    CSPACE_INLINE Approach approach(int a, int b, const Place& at, Floats gap, const RateOf& rate_of) const {
        const Floats zero = fill_floats(0.0f);
        float before;  // what the joints towards the base turn
        if (!sum_turns(a, b, before)) return {zero, zero, false};
        Floats moved = zero, rate = zero, bend = zero;
        for (int body = b; body != a; body = block_.robot.joints[body - 1].parent) {
            const Joint& joint = block_.robot.joints[body - 1];
            const float h = half_of(joint);
            if (h == 0) continue;
            if (!joint.is_prismatic) before -= h;
            const Floats way = lever(joint, body, at, moved) * h;
            bend = bend + way * ((joint.is_prismatic ? 0.0f : 0.5f * h) + (before > 0 ? before : 0.0f));
            moved = moved + way;
            rate = rate + abs(rate_of(velocity(joint, body, at))) * h;
        }
        constexpr float nonzero = 1e-30f;  // where the distance is zero the whole motion counts
        const Floats distance = sqrt(gap);
        rate = rate + moved * rounding_;  // n is off by the rounding of places over the distance
        const Floats along =
            select_lanes(distance > nonzero, rate / max(distance, fill_floats(nonzero)), moved);
        return {moved * round_up, along + bend * round_up + moved * (round_up - 1) + 2 * rounding_, true};
    }
    float rounding() const { return rounding_; }

  private:
    static constexpr float round_up = 1 + 1e-5f;
    const Block& block_;
    const float* half_;
    float rounding_;

    CSPACE_INLINE float half_of(const Joint& joint) const {
        return std::fabs(joint.ratio) * half_[joint.coordinate];
    }
    CSPACE_INLINE Place from_origin(int body, const Place& at) const {
        const Frame& frame = block_.frames[body];
        return {at.x - frame.p[0], at.y - frame.p[1], at.z - frame.p[2]};
    }
    // The velocity of a place per unit of the joint that carries a body.
    CSPACE_INLINE Velocity velocity(const Joint& joint, int body, const Place& at) const {
        const Frame& frame = block_.frames[body];
        const Floats a = frame.R[2], b = frame.R[5], c = frame.R[8];
        if (joint.is_prismatic) return {a, b, c};
        const Place d = from_origin(body, at);
        return {b * d.z - c * d.y, c * d.x - a * d.z, a * d.y - b * d.x};
    }
    // An upper bound on its speed once the place has moved.
    CSPACE_INLINE Floats lever(const Joint& joint, int body, const Place& at, Floats moved) const {
        if (joint.is_prismatic) return fill_floats(1.0f);
        return norm(velocity(joint, body, at)) + moved;
    }
    // What the joints between body b and body a turn in all; false where a does not carry b.
    CSPACE_INLINE bool sum_turns(int a, int b, float& sum) const {
        sum = 0;
        for (; b > a; b = block_.robot.joints[b - 1].parent) {
            const Joint& joint = block_.robot.joints[b - 1];
            if (!joint.is_prismatic) sum += half_of(joint);
        }
        return a == b;
    }
};

// How far the places of a solid may move, in each lane.
class CellWay {
  public:
    CSPACE_INLINE explicit CellWay(Floats growth) { store_floats(growth_, growth); }
    bool may_close(int lane, float gap, float, const float*) const { return gap <= growth_[lane]; }

  private:
    alignas(32) float growth_[float_lanes];
};

// Balls grown by their motion: a lane in which none touches is free in its whole cell.
struct GrownCells : Apart {
    static constexpr bool is_cell = true;
    GrownCells(const Block& block, const CellMotion& motion) : block(block), motion(motion) {}
    const Block& block;
    const CellMotion& motion;
    static Floats no_growth() { return fill_floats(0.0f); }
    CSPACE_INLINE Floats growth(int x, const Place& at) const { return motion.bound(0, x, at); }
    CSPACE_INLINE Floats pair_growth(int p, const Place& at) const {
        return motion.bound(block.robot.pairs[p].a, block.robot.pairs[p].b, at);
    }
    // Body b of a pair against body a.
    template <class Cells>
    struct RelativeOf {
        const Cells& cells;
        int p;
        CSPACE_INLINE auto growth(const Place& at) const { return cells.pair_growth(p, at); }
        CSPACE_INLINE CellWay way_of(const Place& at, float radius) const {
            const BodyPair& pair = cells.block.robot.pairs[p];
            return CellWay(cells.motion.bound(pair.a, pair.b, at, radius));
        }
        CSPACE_INLINE FloatMask refine(FloatMask touching, const Place& at, const Place& other, Floats gap,
                                       float r) const {
            return cells.refine_pair(touching, p, at, other, gap, r);
        }
    };
    RelativeOf<GrownCells> relative(int p) const { return {*this, p}; }
    CSPACE_INLINE CellWay way_of(int x, const Place& at, float radius) const {
        return CellWay(motion.bound(0, x, at, radius));
    }
    CSPACE_INLINE CellMotion::Approach to_primitive(int x, int i, const Place& at, Floats gap) const {
        return motion.approach(0, x, at, gap,
                               [&](const Velocity& v) { return gap_rate(block.scene, i, at, v); });
    }
    CSPACE_INLINE CellMotion::Approach to_ball(int p, const Place& at, const Place& other, Floats gap) const {
        const BodyPair& pair = block.robot.pairs[p];
        return motion.approach(pair.a, pair.b, at, gap, [&](const Velocity& v) {
            return (at.x - other.x) * v.x + (at.y - other.y) * v.y + (at.z - other.z) * v.z;
        });
    }
    CSPACE_INLINE bool is_wanted(FloatMask lanes) const { return bits_of(lanes) & block.wanted; }
    CSPACE_INLINE FloatMask refine_primitive(FloatMask touching, int x, int i, const Place& at, Floats gap,
                                             float r) const {
        return is_wanted(touching) ? touching & may_touch(to_primitive(x, i, at, gap), gap, r) : touching;
    }
    CSPACE_INLINE FloatMask refine_pair(FloatMask touching, int p, const Place& at, const Place& other,
                                        Floats gap, float r) const {
        return is_wanted(touching) ? touching & may_touch(to_ball(p, at, other, gap), gap, r) : touching;
    }
    static CSPACE_INLINE FloatMask may_touch(const CellMotion::Approach& to, Floats gap, float r) {
        if (!to.is_known) return fill_floats(0.0f) < fill_floats(1.0f);
        return sqrt(gap) - to.along < fill_floats(r);
    }
};
// Balls smaller by their motion: a lane in which one touches is blocked in its whole cell.
struct ShrunkCells : GrownCells {
    static constexpr bool is_shrinking = true;
    using GrownCells::GrownCells;
    RelativeOf<ShrunkCells> relative(int p) const { return {*this, p}; }
    static Shrink no_growth() { return {fill_floats(0.0f)}; }
    CSPACE_INLINE Shrink growth(int x, const Place& at) const { return {GrownCells::growth(x, at)}; }
    CSPACE_INLINE Shrink pair_growth(int p, const Place& at) const {
        return {GrownCells::pair_growth(p, at)};
    }
    CSPACE_INLINE FloatMask refine_primitive(FloatMask touching, int x, int i, const Place& at, Floats gap,
                                             float r) const {
        return is_open(touching, gap, r) ? touching | must_touch(to_primitive(x, i, at, gap), gap, r)
                                         : touching;
    }
    CSPACE_INLINE FloatMask refine_pair(FloatMask touching, int p, const Place& at, const Place& other,
                                        Floats gap, float r) const {
        return is_open(touching, gap, r) ? touching | must_touch(to_ball(p, at, other, gap), gap, r)
                                         : touching;
    }
    // Whether a ball touches in a lane where its smaller one does not.
    CSPACE_INLINE bool is_open(FloatMask touching, Floats gap, float r) const {
        return bits_of(gap < fill_floats(r * r)) & ~bits_of(touching) & block.wanted;
    }
    CSPACE_INLINE FloatMask must_touch(const CellMotion::Approach& to, Floats gap, float r) const {
        if (!to.is_known) return fill_floats(1.0f) < fill_floats(0.0f);
        const float least = r - 2 * motion.rounding();
        return square(sqrt(gap) + to.along) + square(to.moved) < fill_floats(least > 0 ? least * least : 0);
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
