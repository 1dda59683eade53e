// Wrenches of the world on links, such as a push on a tool: what they take off the joints is part of the
// recursions, since a link that is pushed hands down so much less.
#pragma once

#include "cspace/dynamics/link_axes.hpp"

namespace cspace::dynamics {
// A force and a torque about the origin of a frame, in its axes.
template <class V>
struct Wrench {
    Vec3<V> f, n;
};
// A wrench at a point of a link (in its axes), in the axes of the link or of the base. path: the links from
// the base on, of which the last is pushed; none of `depth` for the base itself.
template <class V>
struct AppliedWrench {
    const int* path;
    int depth;
    bool in_link_axes;
    Vec3<V> point;
    Wrench<V> wrench;
};
template <class V>
struct AppliedWrenches {
    const AppliedWrench<V>* list = nullptr;
    int count = 0;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// In the axes of the pushed link, about its origin. links: with their turns.
template <class V, class State>
CSPACE_INLINE Wrench<V> carry_wrench(const MultibodyOf<V>& bodies, const AppliedWrench<V>& applied,
                                     const State* links) {
    Wrench<V> wrench = applied.wrench;
    for (int d = 0; d < applied.depth && !applied.in_link_axes; ++d) {
        const int k = applied.path[d];
        to_link(bodies.links[k], links[k].turn, wrench.f, wrench.n);
    }
    wrench.n = wrench.n + cross(applied.point, wrench.f);
    return wrench;
}
// Takes all that is applied off what the links feel; felt: the wrench of a state.
template <class V, class State, class Felt>
CSPACE_INLINE void apply_wrenches(const MultibodyOf<V>& bodies, const AppliedWrenches<V>& applied,
                                  State* links, const Felt& felt) {
    for (int i = 0; i < applied.count; ++i) {
        const AppliedWrench<V>& each = applied.list[i];
        if (each.depth == 0) continue;
        const Wrench<V> push = carry_wrench(bodies, each, links);
        Wrench<V>& wrench = felt(links[each.path[each.depth - 1]]);
        wrench.f = wrench.f - push.f;
        wrench.n = wrench.n - push.n;
    }
}
// Takes what is applied to the base itself off the wrench that it feels.
template <class V>
CSPACE_INLINE void apply_to_base(const AppliedWrenches<V>& applied, Wrench<V>& felt) {
    for (int i = 0; i < applied.count; ++i) {
        const AppliedWrench<V>& each = applied.list[i];
        if (each.depth > 0) continue;
        felt.f = felt.f - each.wrench.f;
        felt.n = felt.n - (each.wrench.n + cross(each.point, each.wrench.f));
    }
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
