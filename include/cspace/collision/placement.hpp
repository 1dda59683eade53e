// Forward kinematics of eight configurations: frames and velocities of all bodies, places of balls.
#pragma once

#include <cmath>

#include "cspace/collision/robot.hpp"
#include "cspace/math/float_trig.hpp"

namespace cspace::collision::inline CSPACE_ISA {

inline constexpr unsigned all_lanes = (1u << float_lanes) - 1;

struct Place {
    Floats x, y, z;
};
// V: Floats, or float of one configuration. Not those of kinematics: floats have twice the lanes of doubles.
template <class V>
struct FrameOf {
    V R[9], p[3];
};
using Frame = FrameOf<Floats>;
// The frame in one lane: R by rows, then p.
CSPACE_INLINE void copy_lane(const Frame& frame, int lane, float* to) {
    alignas(32) float lanes[float_lanes];
    const auto copy = [&](const Floats* from, int count) {
        for (int k = 0; k < count; ++k) {
            store_floats(lanes, from[k]);
            *to++ = lanes[lane];
        }
    };
    copy(frame.R, 9), copy(frame.p, 3);
}
CSPACE_INLINE void copy_frame(const FrameOf<float>& frame, float* to) {
    for (int k = 0; k < 9; ++k) to[k] = frame.R[k];
    for (int k = 0; k < 3; ++k) to[9 + k] = frame.p[k];
}
// Of a body, per unit of the parameter along an edge: ω and the velocity of the origin of its frame.
struct Rate {
    Floats w[3], u[3];
};

CSPACE_INLINE Floats square_distance(const Place& a, const Place& b) {
    const Floats x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return x * x + y * y + z * z;
}

CSPACE_INLINE Place place_ball(const Frame& f, const Ball& ball) {
    return {f.R[0] * ball.x + (f.R[1] * ball.y + (f.R[2] * ball.z + f.p[0])),
            f.R[3] * ball.x + (f.R[4] * ball.y + (f.R[5] * ball.z + f.p[1])),
            f.R[6] * ball.x + (f.R[7] * ball.y + (f.R[8] * ball.z + f.p[2]))};
}

CSPACE_INLINE void fill_with(Floats& to, float x) { to = fill_floats(x); }
CSPACE_INLINE void fill_with(float& to, float x) { to = x; }

// The frame of a joint at zero: parent · T_parent_joint.
template <class V>
CSPACE_INLINE void place_joint(const Joint& joint, const FrameOf<V>& parent, FrameOf<V>& frame) {
    if (joint.parent == 0) {  // the base
        for (int k = 0; k < 9; ++k) fill_with(frame.R[k], joint.R[k]);
        for (int k = 0; k < 3; ++k) fill_with(frame.p[k], joint.p[k]);
        return;
    }
    for (int r = 0; r < 3; ++r) {
        V t = parent.p[r];
        for (int k = 0; k < 3; ++k)
            if (joint.p[k] != 0) t = parent.R[3 * r + k] * joint.p[k] + t;
        frame.p[r] = t;
    }
    if (joint.is_permuted) {
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) {
                const V t = parent.R[3 * r + joint.row[c]];
                frame.R[3 * r + c] = joint.sign[c] < 0 ? -t : t;
            }
        return;
    }
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            frame.R[3 * r + c] = parent.R[3 * r] * joint.R[c] + parent.R[3 * r + 1] * joint.R[3 + c] +
                                 parent.R[3 * r + 2] * joint.R[6 + c];
}

template <class V>
CSPACE_INLINE void slide_along_z(FrameOf<V>& frame, V way) {
    for (int r = 0; r < 3; ++r) frame.p[r] = way * frame.R[3 * r + 2] + frame.p[r];
}
template <class V>
CSPACE_INLINE void turn_about_z(FrameOf<V>& frame, V s, V c) {
    for (int r = 0; r < 3; ++r) {
        const V x = frame.R[3 * r], y = frame.R[3 * r + 1];
        frame.R[3 * r] = s * y + c * x;
        frame.R[3 * r + 1] = c * y - s * x;
    }
}

// Frames of the bodies that joints first … end − 1 carry, those before them being placed; q: one entry per
// coordinate. Frame 0 is the identity and stays.
CSPACE_INLINE void place_frames(const Robot& robot, const Floats* q, int first, int end, Frame* frames) {
    for (int j = first; j < end; ++j) {
        const Joint& joint = robot.joints[j];
        Frame& frame = frames[j + 1];
        place_joint(joint, frames[joint.parent], frame);
        Floats value = q[joint.coordinate];
        if (!joint.is_plain) value = value * joint.ratio + joint.offset;
        if (joint.is_prismatic) {
            slide_along_z(frame, value);
            continue;
        }
        Floats s, c;
        sin_cos(value, s, c);
        turn_about_z(frame, s, c);
    }
}

CSPACE_INLINE void set_identity(Frame& frame) {
    for (int k = 0; k < 9; ++k) frame.R[k] = fill_floats(k % 4 == 0 ? 1.0f : 0.0f);
    for (int k = 0; k < 3; ++k) frame.p[k] = fill_floats(0.0f);
}
CSPACE_INLINE void set_resting(Rate& rate) {
    for (int k = 0; k < 3; ++k) rate.w[k] = rate.u[k] = fill_floats(0.0f);
}

// Rates of all bodies while q moves by `half` per unit; rate 0 is zero and stays.
CSPACE_INLINE void place_rates(const Robot& robot, const float* half, const Frame* frames, Rate* rates) {
    for (int j = 0; j < robot.n_joints; ++j) {
        const Joint& joint = robot.joints[j];
        const Frame &from = frames[joint.parent], &to = frames[j + 1];
        const Rate& before = rates[joint.parent];
        Rate& rate = rates[j + 1];
        const Floats speed = fill_floats(joint.ratio * half[joint.coordinate]);
        Floats d[3];
        for (int k = 0; k < 3; ++k) d[k] = to.p[k] - from.p[k];
        for (int k = 0; k < 3; ++k) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            const Floats z = to.R[3 * k + 2] * speed;
            rate.u[k] = before.u[k] + (before.w[a] * d[b] - before.w[b] * d[a]);
            rate.w[k] = before.w[k];
            (joint.is_prismatic ? rate.u[k] : rate.w[k]) = (joint.is_prismatic ? rate.u[k] : rate.w[k]) + z;
        }
    }
}

struct Velocity {
    Floats x, y, z;
};
CSPACE_INLINE Velocity velocity_at(const Frame& frame, const Rate& rate, const Place& at) {
    const Floats d[3] = {at.x - frame.p[0], at.y - frame.p[1], at.z - frame.p[2]};
    return {rate.u[0] + (rate.w[1] * d[2] - rate.w[2] * d[1]),
            rate.u[1] + (rate.w[2] * d[0] - rate.w[0] * d[2]),
            rate.u[2] + (rate.w[0] * d[1] - rate.w[1] * d[0])};
}
// The velocity of places on one body as seen from another: that of the origin of its frame, and a turn.
struct RelativeRate {
    Floats p[3], u[3], w[3];
};
CSPACE_INLINE RelativeRate relative_rate(const Frame& seen_from, const Rate& its_rate, const Frame& frame,
                                         const Rate& rate) {
    const Velocity v = velocity_at(seen_from, its_rate, {frame.p[0], frame.p[1], frame.p[2]});
    return {{frame.p[0], frame.p[1], frame.p[2]},
            {rate.u[0] - v.x, rate.u[1] - v.y, rate.u[2] - v.z},
            {rate.w[0] - its_rate.w[0], rate.w[1] - its_rate.w[1], rate.w[2] - its_rate.w[2]}};
}
CSPACE_INLINE Velocity velocity_at(const RelativeRate& rate, const Place& at) {
    const Floats d[3] = {at.x - rate.p[0], at.y - rate.p[1], at.z - rate.p[2]};
    return {rate.u[0] + (rate.w[1] * d[2] - rate.w[2] * d[1]),
            rate.u[1] + (rate.w[2] * d[0] - rate.w[0] * d[2]),
            rate.u[2] + (rate.w[0] * d[1] - rate.w[1] * d[0])};
}
// How a body moves around a place within the intervals of all lanes: by its velocity and turn times their
// half widths, and by no more than `bend` besides.
class Way {
  public:
    CSPACE_INLINE Way(const Velocity& v, const Floats* w, Floats width, Floats bend) {
        store_floats(shift_[0], v.x * width), store_floats(shift_[1], v.y * width);
        store_floats(shift_[2], v.z * width);
        for (int k = 0; k < 3; ++k) store_floats(turn_[k], w[k] * width);
        store_floats(bend_, bend);
    }
    // Whether a place no farther than `radius` from that one may come nearer by a gap: along a unit normal
    // to something convex, or to anything for a normal of zeros.
    bool may_close(int lane, float gap, float radius, const float* n) const {
        const auto at = [&](const float (*rows)[float_lanes]) {
            return Vector{rows[0][lane], rows[1][lane], rows[2][lane]};
        };
        const Vector shift = at(shift_), turn = at(turn_), normal = {n[0], n[1], n[2]};
        const bool has_normal = n[0] != 0 || n[1] != 0 || n[2] != 0;
        const Vector across = {turn.y * n[2] - turn.z * n[1], turn.z * n[0] - turn.x * n[2],
                               turn.x * n[1] - turn.y * n[0]};
        const float along = has_normal ? std::fabs(dot(shift, normal)) : std::sqrt(dot(shift, shift));
        const Vector& lever = has_normal ? across : turn;
        return gap <= along + std::sqrt(dot(lever, lever)) * radius + bend_[lane];
    }

  private:
    struct Vector {
        float x, y, z;
    };
    static float dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

    alignas(32) float shift_[3][float_lanes], turn_[3][float_lanes], bend_[float_lanes];
};
CSPACE_INLINE Floats norm(const Velocity& v) { return sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
CSPACE_INLINE Floats speed_at(const Frame& frame, const Rate& rate, const Place& at) {
    return norm(velocity_at(frame, rate, at));
}

}  // namespace cspace::collision::inline CSPACE_ISA
