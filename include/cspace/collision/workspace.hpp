// The memory of one thread's checks, and what the last of them found. The library owns it
// (library/collision_workspace.hpp); kernels fill it.
#pragma once

namespace cspace::collision {

enum class Verdict { free, blocked, undecided };

// A part of an edge: middle ± half of its parameter, which runs from −1 to 1.
struct Interval {
    float middle, half;
};

// What touches: a link, and a primitive or another link. `at`: the parameter of the edge, −1 … 1, or the
// lane.
struct Contact {
    int link = -1, other = -1;
    bool is_pair = false;
    float at = 0;
};

// So many of the last contacts are tested first: most blocked edges of a search touch one of them.
inline constexpr int recent_touches = 8;

// A sphere and a primitive or another sphere that touched.
struct Touch {
    int body = -1, sphere = -1, other_body = -1, other = -1;  // other_body < 0: a primitive
    Contact contact;
};

struct Workspace {
    // Frame, Rate per body and Place per body, link and sphere, with lanes of eight floats.
    void *frames, *rates, *body_places, *link_places, *sphere_places;
    // Of one configuration (one.hpp): a FrameOf<float> per body; by columns the value, sine and cosine of
    // each joint, the numbers of these frames, and the centres of the balls of bodies and of all spheres.
    void* one_frames;
    float *joint_columns, *frame_columns, *ball_columns, *sphere_columns;
    int* near_chunks;  // a list for one descent, and the lanes of each
    unsigned* near_lanes;
    // The number of the block in which each was placed last.
    unsigned *body_stamps, *link_stamps, *group_stamps, stamp;
    // Per body a list of the primitives that it may touch, of `near_stride` entries, and its length.
    int *near, *near_counts, near_stride;
    int *near_body, *near_link, *near_group, *near_spheres;  // lists for one descent
    int *kept_pairs, *kept_links;                            // whether a body pair, a link pair may touch
    // Bodies (x) and body pairs (n_bodies + pair); the one that found a contact last comes first.
    int *order, n_order;
    int blocked_balance;  // of edges that these did not settle: above zero where more were blocked lately
    float *kappa, *pair_kappa, *reach, *pair_reach;  // bounds along the edge, see edge.hpp
    Interval* stack;
    int stack_size;
    long long blocks;  // placed so far
    Contact contact;
    Touch touches[recent_touches];  // the last of them first; body < 0: none
};

}  // namespace cspace::collision
