// Squared distances of eight places from a primitive, 0 inside: the test of a ball against an obstacle.
#pragma once

#include "cspace/collision/boxes.hpp"
#include "cspace/collision/tree_gap.hpp"

namespace cspace::collision::inline CSPACE_ISA {

CSPACE_INLINE Floats clamp_positive(Floats x) { return max(x, fill_floats(0.0f)); }

CSPACE_INLINE Floats square_gap(const Box& box, const Place& at) {
    const Floats x = at.x - box.center[0], y = at.y - box.center[1], z = at.z - box.center[2];
    const auto beyond = [&](Floats along, int k) { return clamp_positive(abs(along) - box.half[k]); };
    const float *a = box.axes, *b = a + 3, *c = a + 6;
    if (box.is_upright)  // the same sums without their zeros
        return square(beyond(x * a[0] + y * a[1], 0)) + square(beyond(x * b[0] + y * b[1], 1)) +
               square(beyond(z, 2));
    return square(beyond(x * a[0] + (y * a[1] + z * a[2]), 0)) +
           square(beyond(x * b[0] + (y * b[1] + z * b[2]), 1)) +
           square(beyond(x * c[0] + (y * c[1] + z * c[2]), 2));
}
CSPACE_INLINE Floats square_gap(const Capsule& capsule, const Place& at) {
    const float* v = capsule.along;
    const Floats x = at.x - capsule.start[0], y = at.y - capsule.start[1], z = at.z - capsule.start[2];
    const Floats share = (x * v[0] + (y * v[1] + z * v[2])) * capsule.inverse_square;
    const Floats t = min(clamp_positive(share), fill_floats(1.0f));
    return square(x - t * v[0]) + (square(y - t * v[1]) + square(z - t * v[2]));
}
CSPACE_INLINE Floats square_gap(const Cylinder& cylinder, const Place& at) {
    const float* n = cylinder.axis;
    const Floats x = at.x - cylinder.center[0], y = at.y - cylinder.center[1], z = at.z - cylinder.center[2];
    const Floats along = x * n[0] + (y * n[1] + z * n[2]);
    const Floats across =
        sqrt(square(x - along * n[0]) + (square(y - along * n[1]) + square(z - along * n[2])));
    return square(clamp_positive(across - cylinder.rim)) + square(clamp_positive(abs(along) - cylinder.half));
}
CSPACE_INLINE Floats square_gap(const HalfSpace& half_space, const Place& at) {
    const float* n = half_space.normal;
    return square(clamp_positive(at.x * n[0] + (at.y * n[1] + at.z * n[2]) - half_space.offset));
}

// How far a ball may move: not at all.
struct NoMotion {};
CSPACE_INLINE Floats square_of(NoMotion, float r) { return fill_floats(r * r); }
CSPACE_INLINE Floats square_of(Floats growth, float r) { return square(growth + r); }

// By how much a ball is smaller, so that what still touches it touches wherever the ball moves.
struct Shrink {
    Floats by;
};
CSPACE_INLINE Floats square_of(Shrink shrink, float r) {
    return square(clamp_positive(fill_floats(r) - shrink.by));
}

// With which a ball around others is compared: that some of them shrink does not make it smaller.
CSPACE_INLINE NoMotion search_growth(NoMotion) { return {}; }
CSPACE_INLINE Floats search_growth(Floats growth) { return growth; }
CSPACE_INLINE NoMotion search_growth(Shrink) { return {}; }

// The least that is of interest: whether a ball touches where it is, or does when it is smaller.
CSPACE_INLINE NoMotion least_growth(NoMotion) { return {}; }
CSPACE_INLINE NoMotion least_growth(Floats) { return {}; }
CSPACE_INLINE Shrink least_growth(Shrink shrink) { return shrink; }

// A ball of radius r, and by how much it may move, in the lanes that are wanted.
template <class Growth>
struct Mover {
    float r;
    Growth growth;
    unsigned wanted;
    CSPACE_INLINE Floats reach(float radius) const { return square_of(growth, r + radius); }
    CSPACE_INLINE Sought seek(float radius, bool any) const {
        return {reach(radius), any ? reach(radius) : square_of(least_growth(growth), r + radius), wanted,
                any};
    }
};
template <class Growth>
Mover(float, Growth, unsigned) -> Mover<Growth>;

// Balls that do not move, one per lane.
struct Balls {
    Floats r;
    unsigned wanted;
    CSPACE_INLINE Floats reach(float radius) const { return square(r + radius); }
    CSPACE_INLINE Sought seek(float radius, bool any) const {
        return {reach(radius), reach(radius), wanted, any};
    }
};

// Meshes and clouds come last, and are not.
CSPACE_INLINE bool is_convex(const Scene& scene, int i) {
    return i < scene.n_boxes + scene.n_capsules + scene.n_cylinders + scene.n_half_spaces;
}

// Of primitive i; `radius` receives what it is grown by. In the lanes that are wanted it compares with the
// squares of r + radius and of the reach as the exact one does; if `any`, in one lane in which the ball may
// touch the primitive, where there is one.
template <class AnyBall>
CSPACE_INLINE Floats square_gap(const Scene& scene, int i, const Place& at, const AnyBall& ball,
                                float& radius, bool any = false) {
    if (i < scene.n_boxes) {
        radius = scene.boxes[i].radius;
        return square_gap(scene.boxes[i], at);
    }
    i -= scene.n_boxes;
    if (i < scene.n_capsules) {
        radius = scene.capsules[i].radius;
        return square_gap(scene.capsules[i], at);
    }
    i -= scene.n_capsules;
    if (i < scene.n_cylinders) {
        radius = scene.cylinders[i].radius;
        return square_gap(scene.cylinders[i], at);
    }
    i -= scene.n_cylinders;
    if (i < scene.n_half_spaces) {
        radius = scene.half_spaces[i].radius;
        return square_gap(scene.half_spaces[i], at);
    }
    i -= scene.n_half_spaces;
    if (i < scene.n_meshes) {
        radius = scene.meshes[i].radius;
        return square_gap(scene.meshes[i], at, ball.seek(radius, any));
    }
    i -= scene.n_meshes;
    radius = scene.clouds[i].radius;
    return square_gap(scene.clouds[i], at, ball.seek(radius, any));
}
// The lanes in which a ball may touch primitive i; if `any`, at least one of them.
template <class AnyBall>
CSPACE_INLINE unsigned find_touching(const Scene& scene, int i, const Place& at, const AnyBall& ball,
                                     bool any = true) {
    float radius;
    const Floats gap = square_gap(scene, i, at, ball, radius, any);
    return bits_of(gap < ball.reach(radius)) & ball.wanted;
}

// δ · v, where δ leads from the nearest point of a primitive to a place: how fast the squared gap grows, by
// halves.
CSPACE_INLINE Floats beyond_signed(Floats x, float half) {
    const Floats zero = fill_floats(0.0f);
    return max(x - half, zero) + min(x + half, zero);
}
CSPACE_INLINE Floats gap_rate(const Box& box, const Place& at, const Velocity& v) {
    const Floats x = at.x - box.center[0], y = at.y - box.center[1], z = at.z - box.center[2];
    Floats sum = fill_floats(0.0f);
    for (int k = 0; k < 3; ++k) {
        const float* axis = box.axes + 3 * k;
        const Floats beyond = beyond_signed(x * axis[0] + (y * axis[1] + z * axis[2]), box.half[k]);
        sum = sum + beyond * (v.x * axis[0] + (v.y * axis[1] + v.z * axis[2]));
    }
    return sum;
}
CSPACE_INLINE Floats gap_rate(const Capsule& capsule, const Place& at, const Velocity& v) {
    const float* a = capsule.along;
    const Floats x = at.x - capsule.start[0], y = at.y - capsule.start[1], z = at.z - capsule.start[2];
    const Floats share = (x * a[0] + (y * a[1] + z * a[2])) * capsule.inverse_square;
    const Floats t = min(clamp_positive(share), fill_floats(1.0f));
    return (x - t * a[0]) * v.x + ((y - t * a[1]) * v.y + (z - t * a[2]) * v.z);
}
CSPACE_INLINE Floats gap_rate(const Cylinder& cylinder, const Place& at, const Velocity& v) {
    const float* n = cylinder.axis;
    const Floats x = at.x - cylinder.center[0], y = at.y - cylinder.center[1], z = at.z - cylinder.center[2];
    const Floats along = x * n[0] + (y * n[1] + z * n[2]);
    const Floats ex = x - along * n[0], ey = y - along * n[1], ez = z - along * n[2];
    const Floats across = sqrt(square(ex) + (square(ey) + square(ez)));
    constexpr float nonzero = 1e-30f;  // on the axis nothing is outside: the quotient is zero
    const Floats share = clamp_positive(across - cylinder.rim) / max(across, fill_floats(nonzero));
    return share * (ex * v.x + (ey * v.y + ez * v.z)) +
           beyond_signed(along, cylinder.half) * (v.x * n[0] + (v.y * n[1] + v.z * n[2]));
}
CSPACE_INLINE Floats gap_rate(const HalfSpace& half_space, const Place& at, const Velocity& v) {
    const float* n = half_space.normal;
    const Floats beyond = clamp_positive(at.x * n[0] + (at.y * n[1] + at.z * n[2]) - half_space.offset);
    return beyond * (v.x * n[0] + (v.y * n[1] + v.z * n[2]));
}
CSPACE_INLINE Floats gap_rate(const Scene& scene, int i, const Place& at, const Velocity& v) {
    if (i < scene.n_boxes) return gap_rate(scene.boxes[i], at, v);
    i -= scene.n_boxes;
    if (i < scene.n_capsules) return gap_rate(scene.capsules[i], at, v);
    i -= scene.n_capsules;
    if (i < scene.n_cylinders) return gap_rate(scene.cylinders[i], at, v);
    return gap_rate(scene.half_spaces[i - scene.n_cylinders], at, v);
}

}  // namespace cspace::collision::inline CSPACE_ISA
