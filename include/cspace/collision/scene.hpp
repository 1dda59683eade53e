// The obstacles as collision checks read them: primitives in the frame of the robot's base, their boxes, and
// which links may touch them. Plain data, rounded to float; each primitive is grown by what the rounding of
// its numbers may cost.
#pragma once

namespace cspace::collision {

struct Box {
    float center[3], axes[9], half[3], radius;  // axes: row k is the k-th axis of the box
    bool is_upright;                            // the third axis is ± z
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

// A tree of boxes in depth-first order. Where a box is of no interest, `next` is the node to go on with;
// otherwise it is the one behind. A leaf has the items first … first + count − 1, other nodes have none.
struct TreeNode {
    float low[3], high[3];
    int next, first, count;
};

// A triangle in a frame of its own: corner a is the origin, b lies at (side, 0), c at (apex[0], apex[1]),
// where apex[1] ≥ 0 is zero for one without area; ab is the longest side.
struct Triangle {
    float corner[3], axes[9], side, apex[2];  // axes: row k is the k-th axis of the frame
    float inverse_b_c, inverse_a_c;           // 1 / |bc|², 1 / |ac|²
};

// A triangle of a closed surface, for rays along z: its corners in the order of y. `turn` is 1 if that order
// agrees with the outward normal, else −1; normal: of the order of y, of any length.
template <class S>
struct Facet {
    S low[3], middle[3], high[3], normal[3], bottom, top, turn;  // bottom, top: least and greatest z
};

// A surface of triangles, in the order of its tree; facets: of the solid that it encloses, null if the
// surface alone counts.
struct Mesh {
    const TreeNode* nodes;
    const Triangle* triangles;
    const Facet<float>* facets;
    int n_nodes;
    float radius;
};

// Cells of one size around the points of a cloud. steps: of each cell, rows of x first, then those of y and
// z; least[steps]: the square of a distance that no place in such a cell is nearer to a point than. Places
// beyond the cells are no nearer than the cell beside them. ways: how many cells to go along x, y and z to
// one with a point, as near as the steps say: along z first, then along y and x, each from the cell that was
// reached. points: of a cell that has some, one of them. No cells: n[0] = 0.
struct DistanceGrid {
    const unsigned char* steps;
    const signed char* ways[3];
    const int* points;
    const float* least;
    float low[3], cells_per_metre;
    int n[3];
};

// Points in the order of their tree, each with the same radius around it; eight may be read from any of them.
struct Cloud {
    const TreeNode* nodes;
    const float *x, *y, *z;
    int n_nodes;
    float radius;
    DistanceGrid grid;
};

// The exact test of a robot's convex solids: their covers only tell where it is needed. frame: of the body
// that carries a sphere, R by rows, then p.
struct ExactTest {
    const void* owner;
    // Whether the solid that a sphere covers comes within a gap of a primitive; and how far away it is. The
    // unit normal leads from something convex to the solid; it is zero where the other one is not convex.
    bool (*reaches_primitive)(const void* owner, int sphere, const float* frame, int primitive, float gap);
    float (*measure_primitive)(const void* owner, int sphere, const float* frame, int primitive,
                               float* normal);
    // The same for two spheres, or the solids that they cover.
    bool (*reaches_sphere)(const void* owner, int sphere, const float* frame, int other,
                           const float* other_frame, float gap);
    float (*measure_sphere)(const void* owner, int sphere, const float* frame, int other,
                            const float* other_frame, float* normal);
};

struct Scene {
    const Box* boxes;
    const Capsule* capsules;
    const Cylinder* cylinders;
    const HalfSpace* half_spaces;
    const Mesh* meshes;
    const Cloud* clouds;
    int n_boxes, n_capsules, n_cylinders, n_half_spaces, n_meshes, n_clouds;
    int n;  // of all primitives, in this order
    // The boxes around the primitives: low and high of each, per coordinate, filled up to a multiple of eight
    // with boxes that nothing meets.
    const float *low[3], *high[3];
    // A tree of these boxes, and the primitives in the order of its leaves. No nodes where they are few.
    const TreeNode* nodes;
    const int* order;
    int n_nodes;
    // allowed[link · n + primitive]: they may touch. Null if no such pair is allowed.
    const unsigned char* allowed;
    float margin, pair_margin;  // added to the radii of spheres against primitives, and to pairs of spheres
    ExactTest exact;
};

}  // namespace cspace::collision
