// The obstacles as collision checks read them: convex primitives in the frame of the robot's base, their
// boxes, and which links may touch them. Plain data, rounded to float; each primitive is grown by what the
// rounding of its numbers may cost.
#pragma once

namespace cspace::collision {

struct Box {
    float center[3], axes[9], half[3], radius;  // axes: row k is the k-th axis of the box
};
struct Capsule {
    float start[3], along[3], inverse_square, radius;  // inverse_square: 1 / |along|², 0 for a sphere
};
struct Cylinder {
    float center[3], axis[3], half, rim, radius;  // flat ends at ± half, rim: the radius of the solid
};
struct HalfSpace {
    float normal[3], offset, radius;  // solid where normal · x ≤ offset
};

struct Scene {
    const Box* boxes;
    const Capsule* capsules;
    const Cylinder* cylinders;
    const HalfSpace* half_spaces;
    int n_boxes, n_capsules, n_cylinders, n_half_spaces;
    int n;  // of all primitives, in this order
    // The boxes around the primitives: low and high of each, per coordinate.
    const float *low[3], *high[3];
    // allowed[link · n + primitive]: they may touch. Null if no such pair is allowed.
    const unsigned char* allowed;
    float margin, pair_margin;  // added to the radii of spheres against primitives, and to pairs of spheres
};

}  // namespace cspace::collision
