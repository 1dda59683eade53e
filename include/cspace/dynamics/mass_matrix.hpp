// The mass matrix M of the kinetic energy ½ q̇ᵀ M q̇, by composite bodies.
//
// All that a joint moves is one body at this instant; the wrench that accelerates it alone is handed down to
// every joint below (Walker and Orin 1982; Featherstone 2008, section 6.2). Entries of joints that do not
// carry each other are zero.
#pragma once

#include "cspace/dynamics/inverse_dynamics.hpp"

namespace cspace::dynamics {
// What the mass matrix keeps of a link: the first and second moments of all that its joint moves.
template <class V>
struct LinkComposite {
    Turn<V> turn;
    Vec3<V> t, first;
    Symmetric3<V> second;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// The moments of a body about a point from which its origin is at t.
template <class V, class M>
CSPACE_INLINE void shift_moments(const M& mass, Vec3<V>& first, Symmetric3<V>& second, const Vec3<V>& t) {
    const Vec3<V> h = first, moved = h + mass * t;
    second = second + Symmetric3<V>{t.x * h.x + moved.x * t.x, t.x * h.y + moved.x * t.y,
                                    t.x * h.z + moved.x * t.z, t.y * h.y + moved.y * t.y,
                                    t.y * h.z + moved.y * t.z, t.z * h.z + moved.z * t.z};
    first = moved;
}

// The first and second moments of all that each joint moves, in the axes of its link.
template <class V>
CSPACE_INLINE void compose_links(const MultibodyOf<V>& bodies, const V* q, LinkComposite<V>* links,
                                 Moments<V>& base) {
    turn_links(bodies, q, links);
    base = {fill_lanes<V>(bodies.mass), fill_vec3<V>(bodies.base.first),
            fill_symmetric<V>(bodies.base.second)};
    for (int k = 0; k < bodies.n_links; ++k) {
        const LinkOf<V>& link = bodies.links[k];
        links[k].t = link_origin(link, q);
        links[k].first = fill_vec3<V>(link.body.first);
        links[k].second = fill_symmetric<V>(link.body.second);
    }
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const LinkOf<V>& link = bodies.links[k];
        Vec3<V> first = links[k].first;
        Symmetric3<V> second = links[k].second;
        to_parent(link, links[k].turn, first, second);
        shift_moments(link.carried_mass, first, second, links[k].t);
        Vec3<V>& first_before = link.parent < 0 ? base.first : links[link.parent].first;
        Symmetric3<V>& second_before = link.parent < 0 ? base.second : links[link.parent].second;
        first_before = first_before + first;
        second_before = second_before + second;
    }
}

// The wrench that accelerates all that a joint moves by one along the joint.
template <class V>
CSPACE_INLINE Wrench<V> unit_wrench(const LinkOf<V>& link, const LinkComposite<V>& all) {
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V>& h = all.first;
    const Symmetric3<V>& S = all.second;
    if (link.prismatic) return {{zero, zero, fill_lanes<V>(link.carried_mass)}, {h.y, -h.x, zero}};
    return {{-h.y, h.x, zero}, {-S.xz, -S.yz, S.xx + S.yy}};
}

// Adds an entry for two joints, at their coordinates: twice where they share one.
template <class V>
CSPACE_INLINE void add_entry(V* M, int columns, int first, const LinkOf<V>& a, const LinkOf<V>& b, V value) {
    value = (a.ratio * b.ratio) * value;
    V& entry = M[(first + a.coordinate) * columns + first + b.coordinate];
    entry = entry + value;
    V& mirrored = M[(first + b.coordinate) * columns + first + a.coordinate];
    mirrored = mirrored + value;
}

// M (columns, columns), row by row; the rows and columns of the joints begin at `first`, 6 with a floating
// base and 0 otherwise. R: the axes of the base in those of the world. At a floating base M holds for its
// [v; ω] in world axes.
template <class V>
CSPACE_INLINE void mass_matrix(const MultibodyOf<V>& bodies, const V* q, const Mat3<V>& R, bool floating,
                               LinkComposite<V>* links, V* M) {
    const int first = floating ? 6 : 0, columns = first + bodies.n_coordinates;
    Moments<V> whole;
    compose_links(bodies, q, links, whole);
    for (int i = 0; i < columns * columns; ++i) M[i] = fill_lanes<V>(0.0);
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const LinkOf<V>& link = bodies.links[k];
        Wrench<V> wrench = unit_wrench(link, links[k]);
        V& own = M[(first + link.coordinate) * (columns + 1)];
        const V inertia = link.prismatic ? wrench.f.z : wrench.n.z;
        own = own + (link.ratio * link.ratio) * (inertia + link.armature);
        for (int j = k;;) {
            to_parent(bodies.links[j], links[j].turn, wrench.f, wrench.n);
            wrench.n = wrench.n + cross(links[j].t, wrench.f);
            j = bodies.links[j].parent;
            if (j < 0) break;
            const LinkOf<V>& before = bodies.links[j];
            add_entry(M, columns, first, before, link, before.prismatic ? wrench.f.z : wrench.n.z);
        }
        if (!floating) continue;
        const Vec3<V> f = link.ratio * (R * wrench.f), n = link.ratio * (R * wrench.n);
        const V rows[6] = {f.x, f.y, f.z, n.x, n.y, n.z};
        for (int i = 0; i < 6; ++i) {
            V& entry = M[i * columns + first + link.coordinate];
            entry = entry + rows[i];
            M[(first + link.coordinate) * columns + i] = entry;
        }
    }
    if (!floating) return;
    // [m 1, −[h]×; [h]×, I] in world axes.
    const Vec3<V> h = R * whole.first;
    const Mat3<V> S = R * to_matrix(whole.second) * transpose(R);
    const V zero = fill_lanes<V>(0.0), trace = S.m[0][0] + S.m[1][1] + S.m[2][2];
    const V skew[3][3] = {{zero, -h.z, h.y}, {h.z, zero, -h.x}, {-h.y, h.x, zero}};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            M[i * columns + j] = i == j ? whole.mass : zero;
            M[i * columns + 3 + j] = -skew[i][j];
            M[(3 + i) * columns + j] = skew[i][j];
            M[(3 + i) * columns + 3 + j] = i == j ? trace - S.m[i][i] : -S.m[i][j];
        }
    }
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
