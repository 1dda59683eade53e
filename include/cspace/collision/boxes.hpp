// A search among the boxes of all primitives of a scene.
#pragma once

#include "cspace/collision/scene.hpp"
#include "cspace/math/float_lanes.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// Calls visit(primitive, meets(low, high)) for each primitive whose box is of interest, by what
// meets(low, high) says of a box: whether it is, or in which lanes.
template <class Meets, class Visit>
CSPACE_INLINE void visit_boxes(const Scene& scene, const Meets& meets, const Visit& visit) {
    const auto try_primitive = [&](int p) {
        const float low[3] = {scene.low[0][p], scene.low[1][p], scene.low[2][p]};
        const float high[3] = {scene.high[0][p], scene.high[1][p], scene.high[2][p]};
        if (const auto lanes = meets(low, high)) visit(p, lanes);
    };
    if (scene.n_nodes == 0)
        for (int p = 0; p < scene.n; ++p) try_primitive(p);
    for (int i = 0; i < scene.n_nodes;) {
        const TreeNode& node = scene.nodes[i];
        if (!meets(node.low, node.high)) {
            i = node.next;
            continue;
        }
        for (int k = node.first; k < node.first + node.count; ++k) try_primitive(scene.order[k]);
        ++i;
    }
}

// Lists the primitives of a scene without a tree whose boxes meet a box; how many.
CSPACE_INLINE int list_boxes(const Scene& scene, const float (&low)[3], const float (&high)[3], int* into) {
    int n = 0;
    for (int first = 0; first < scene.n; first += float_lanes) {
        const auto meets = [&](int k) {
            return (load_floats(scene.low[k] + first) < high[k]) &
                   (load_floats(scene.high[k] + first) > low[k]);
        };
        for (unsigned bits = bits_of(meets(0) & meets(1) & meets(2)); bits; bits &= bits - 1)
            into[n++] = first + lowest_lane(bits);
    }
    return n;
}

}  // namespace cspace::collision::inline CSPACE_ISA
