// The robot as its collision checks read it: joints, the spheres that each joint carries, pairs of links.
//
// Body 0 is the base, body k + 1 is all that joint k carries; the links of a body never move against each
// other. Balls enclose the spheres of a body, of a link and of a group of spheres. Plain data, rounded to
// float: it is shared by all instruction sets and owned by library/collision_robot.hpp.
#pragma once

namespace cspace::collision {

// The most coordinates that a robot may have here.
inline constexpr int most_coordinates = 64;

struct Ball {
    float x, y, z, r;
};

// Places body `child` in its parent: T_parent_joint, then a turn about or a slide along z by
// ratio · q[coordinate] + offset.
struct Joint {
    int parent;  // body that carries it
    int coordinate;
    float ratio, offset;
    bool is_prismatic, is_plain;  // plain: ratio 1, offset 0
    bool is_permuted;             // column c of R is sign[c] times the unit vector of row[c]
    int row[3];
    float sign[3];
    float R[9], p[3];
};
struct Group {
    int first, count;  // spheres
    Ball ball;
};
struct Link {
    int body, first, count;  // groups
    Ball ball;
};
struct Body {
    int first, count;  // links
    Ball ball;
};
struct LinkPair {
    int a, b;  // links; the body of a is before that of b
};
struct BodyPair {
    int a, b, first, count;  // bodies, link pairs
};

// Balls by columns: eight may be read from any of them.
struct BallColumns {
    const float *x, *y, *z, *r;
};
// Up to eight spheres of a body, in order; those of a body are its chunks from `first` on.
struct Chunk {
    int first, count;  // spheres
};
struct BodyChunks {
    int first, count;  // chunks
};

struct Robot {
    const Joint* joints;
    const Body* bodies;
    const Link* links;
    const Group* groups;
    const Ball* spheres;
    const BodyPair* pairs;
    const LinkPair* link_pairs;
    // For checks of one configuration, whose lanes are bodies or spheres. A body without spheres has a radius
    // far below zero. pair_numbers[a · body_stride + b]: the pair of bodies a < b; pair_lanes[(a ·
    // body_stride + b) / 8]: in which of the eight bodies from b on there is one.
    BallColumns body_balls, sphere_columns;
    const Chunk* chunks;
    const BodyChunks* body_chunks;
    const int* sphere_links;
    // Of each sphere the convex solid that it helps to cover, −1 if it counts itself; null if all do. Balls
    // around the solids, in the frames of their bodies.
    const int* sphere_solids;
    const Ball* solid_balls;
    // Of each sphere the radius of a ball around its centre that the solid holds, below zero if its centre is
    // outside.
    const float* inner_radii;
    const int* pair_numbers;
    const unsigned char* pair_lanes;
    // Bounds [m] on the distance of the sphere centres of a body from the axis of a joint, 0 if it does not
    // move the body (1 for a prismatic joint that does): row j has `body_stride` bodies.
    const float* levers;
    // The same for the motion of body b of a pair against body a: row j has `pair_stride` pairs.
    const float* pair_levers;
    int n_joints, n_bodies, n_links, n_groups, n_spheres, n_chunks, n_pairs, n_link_pairs, n_coordinates;
    int body_stride, pair_stride;  // multiples of eight
};

}  // namespace cspace::collision
