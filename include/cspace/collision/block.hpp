// Eight configurations at once: which of them touch something, and which might within a given motion.
//
// A test descends from the ball of a body over those of its links and groups to its spheres. `Motion` says by
// how much a ball may move within what a lane stands for (edge.hpp, rows.hpp): nothing for a configuration,
// v w + κ w² for an interval of half width w.
#pragma once

#include "cspace/collision/gap.hpp"
#include "cspace/collision/workspace.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// A set of primitives, by number.
struct Candidates {
    const int* begin;
    int count;
};

class Block {
  public:
    Block(const Robot& robot, const Scene& scene, Workspace& w)
        : robot(robot),
          scene(scene),
          w(w),
          frames(static_cast<Frame*>(w.frames)),
          rates(static_cast<Rate*>(w.rates)) {}

    const Robot& robot;
    const Scene& scene;
    Workspace& w;
    Frame* const frames;
    Rate* const rates;
    unsigned wanted = all_lanes;  // lanes that count
    unsigned hit = 0;             // that touch something
    unsigned unsure = 0;          // that might within their motion

    // Begins a block: the bodies up to one are placed at the configurations q, one entry per coordinate.
    CSPACE_INLINE void begin(const Floats* q, int body) {
        place_frames(robot, q, 0, body, frames);
        placed_ = body;
        ++w.stamp;
        ++w.blocks;
        hit = unsure = 0;
    }
    // Places the other bodies too.
    CSPACE_INLINE void place_rest(const Floats* q) {
        place_frames(robot, q, placed_, robot.n_joints, frames);
        placed_ = robot.n_joints;
    }

    CSPACE_INLINE const Place& body_place(int x) {
        Place& at = static_cast<Place*>(w.body_places)[x];
        if (w.body_stamps[x] != w.stamp) {
            w.body_stamps[x] = w.stamp;
            at = place_ball(frames[x], robot.bodies[x].ball);
        }
        return at;
    }
    CSPACE_INLINE const Place& link_place(int l) {
        const Link& link = robot.links[l];
        if (robot.bodies[link.body].count == 1) return body_place(link.body);
        Place& at = static_cast<Place*>(w.link_places)[l];
        if (w.link_stamps[l] != w.stamp) {
            w.link_stamps[l] = w.stamp;
            at = place_ball(frames[link.body], link.ball);
        }
        return at;
    }
    // The places of the spheres of a group, from its first on.
    CSPACE_INLINE const Place* sphere_places(int g, int body) {
        const Group& group = robot.groups[g];
        Place* places = static_cast<Place*>(w.sphere_places) + group.first;
        if (w.group_stamps[g] != w.stamp) {
            w.group_stamps[g] = w.stamp;
            const Frame& frame = frames[body];
            for (int s = 0; s < group.count; ++s)
                places[s] = place_ball(frame, robot.spheres[group.first + s]);
        }
        return places;
    }

    // Those primitives of a set that a ball may touch.
    template <class Growth>
    CSPACE_INLINE Candidates narrow(Candidates from, const Place& at, float r, Growth growth, int* into) {
        int n = 0;
        for (int k = 0; k < from.count; ++k) {
            const int i = from.begin[k];
            if (find_touching(scene, i, at, Mover{r, search_growth(growth), wanted})) into[n++] = i;
        }
        return {into, n};
    }

    // Tests the links of a body against the primitives near its ball. True as soon as `is_done` says so.
    template <class Motion>
    CSPACE_INLINE bool test_links(int x, Candidates near, const Motion& motion) {
        const Body& body = robot.bodies[x];
        for (int l = body.first; l < body.first + body.count; ++l) {
            const Link& link = robot.links[l];
            Candidates here = near;
            if (body.count > 1 || scene.allowed) here = narrow_link(l, near, motion);
            if (here.count == 0) continue;
            for (int g = link.first; g < link.first + link.count; ++g) {
                Candidates last = here;
                if (link.count > 1) {
                    const Ball& ball = robot.groups[g].ball;
                    const Place at = place_ball(frames[x], ball);
                    last = narrow(here, at, ball.r + scene.margin, motion.growth(x, at), w.near_group);
                    if (last.count == 0) continue;
                }
                if (test_spheres(l, g, last, motion)) return true;
            }
        }
        return false;
    }

    template <class Motion>
    CSPACE_INLINE Candidates narrow_link(int l, Candidates near, const Motion& motion) {
        const Link& link = robot.links[l];
        const Place& at = link_place(l);
        const auto growth = motion.growth(link.body, at);
        if (!scene.allowed) return narrow(near, at, link.ball.r + scene.margin, growth, w.near_link);
        int n = 0;
        for (int k = 0; k < near.count; ++k)
            if (!scene.allowed[l * scene.n + near.begin[k]]) w.near_link[n++] = near.begin[k];
        return narrow({w.near_link, n}, at, link.ball.r + scene.margin, growth, w.near_link);
    }

    template <class Motion>
    CSPACE_INLINE bool test_spheres(int l, int g, Candidates near, const Motion& motion) {
        const Group& group = robot.groups[g];
        const int x = robot.links[l].body;
        const Place* places = sphere_places(g, x);
        for (int s = 0; s < group.count; ++s) {
            const Place& at = places[s];
            const float r = robot.spheres[group.first + s].r + scene.margin;
            Marks<Motion> marks(motion.growth(x, at));
            for (int k = 0; k < near.count; ++k) {
                compare_primitive(x, at, near.begin[k], r, motion, marks);
            }
            if (settle(marks) && motion.is_done(*this))
                return record_primitive(l, group.first + s, at, r, near);
        }
        return false;
    }

    // Tests two links of a pair of bodies against each other: the spheres of each that the other's ball may
    // meet. Growth counts the motion of body b against body a.
    template <class Motion>
    CSPACE_INLINE bool test_link_pair(int p, const LinkPair& links, const Motion& motion) {
        const BodyPair& pair = robot.pairs[p];
        const Link &a = robot.links[links.a], &b = robot.links[links.b];
        const Place at_a = link_place(links.a), at_b = link_place(links.b);
        const int count = list_spheres(a, at_b, b.ball.r, motion.pair_growth(p, at_b));
        if (count == 0) return false;
        for (int g = b.first; g < b.first + b.count; ++g) {
            const Group& group = robot.groups[g];
            if (b.count > 1) {
                const Place at = place_ball(frames[pair.b], group.ball);
                if (!may_meet(at, at_a, group.ball.r + a.ball.r, motion.pair_growth(p, at))) continue;
            }
            const Place* places = sphere_places(g, pair.b);
            for (int s = 0; s < group.count; ++s) {
                const Place& at = places[s];
                const float r = robot.spheres[group.first + s].r + scene.pair_margin;
                Marks<Motion> marks(motion.pair_growth(p, at));
                const Floats reach = square_of(search_growth(marks.growth), r + a.ball.r);
                if (!(bits_of(square_distance(at, at_a) < reach) & wanted)) continue;
                const Place* all = static_cast<Place*>(w.sphere_places);
                for (int k = 0; k < count; ++k) {
                    const int other = w.near_spheres[k];
                    compare_balls(p, at, all[other], r + robot.spheres[other].r, motion, marks);
                }
                if (settle(marks) && motion.is_done(*this))
                    return record_pair(links, group.first + s, at, r, count);
            }
        }
        return false;
    }
    // Whether something that touched lately touches again, as far as bodies have their frames.
    CSPACE_INLINE bool test_touches() {
        for (int i = 0; i < recent_touches && w.touches[i].body >= 0; ++i) {
            const Touch touch = w.touches[i];
            if (touch.body > placed_ || !test_touch(touch)) continue;
            w.touches[i] = w.touches[0];
            w.touches[0] = touch;
            w.contact = touch.contact;
            return true;
        }
        return false;
    }
    CSPACE_INLINE bool test_touch(const Touch& touch) {
        const Ball& ball = robot.spheres[touch.sphere];
        const Place at = place_ball(frames[touch.body], ball);
        float radius;
        Floats gap;
        if (touch.other_body < 0) {
            gap =
                square_gap(scene, touch.other, at, Mover{ball.r + scene.margin, NoMotion{}, wanted}, radius);
            radius += ball.r + scene.margin;
        } else {
            const Ball& other = robot.spheres[touch.other];
            gap = square_distance(at, place_ball(frames[touch.other_body], other));
            radius = ball.r + other.r + scene.pair_margin;
        }
        hit = bits_of(gap < fill_floats(radius * radius)) & wanted;
        return hit != 0;
    }

    // The spheres of a link that a ball may meet, to w.near_spheres; how many.
    template <class Growth>
    CSPACE_INLINE int list_spheres(const Link& link, const Place& ball, float r, Growth growth) {
        int n = 0;
        for (int g = link.first; g < link.first + link.count; ++g) {
            const Group& group = robot.groups[g];
            if (link.count > 1) {
                const Place at = place_ball(frames[link.body], group.ball);
                if (!may_meet(at, ball, group.ball.r + r, growth)) continue;
            }
            const Place* places = sphere_places(g, link.body);
            for (int s = group.first; s < group.first + group.count; ++s)
                if (may_meet(places[s - group.first], ball, robot.spheres[s].r + r, growth))
                    w.near_spheres[n++] = s;
        }
        return n;
    }
    template <class Growth>
    CSPACE_INLINE bool may_meet(const Place& one, const Place& other, float r, Growth growth) {
        const Floats reach = square_of(search_growth(growth), r + scene.pair_margin);
        return bits_of(square_distance(one, other) < reach) & wanted;
    }

  private:
    int placed_ = 0;  // bodies 0 … placed_ have their frames

    // Of several tests: the lanes in which something touches, or may within its motion.
    template <class Motion>
    struct Marks {
        decltype(Motion::no_growth()) growth;
        FloatMask touching = fill_floats(0.0f) < fill_floats(0.0f), near = touching;

        CSPACE_INLINE explicit Marks(decltype(Motion::no_growth()) growth) : growth(growth) {}
    };
    // Below this square two balls touch. A cell has no middle of its own: its growth counts.
    template <class Motion>
    static CSPACE_INLINE Floats touching_square(const Marks<Motion>& marks, float r) {
        if constexpr (Motion::is_moving)
            return fill_floats(r * r);
        else
            return square_of(marks.growth, r);
    }
    // A sphere against a primitive. The growth bounds the motion first; where it does not suffice, the part
    // of the motion that brings them nearer.
    template <class Motion>
    CSPACE_INLINE void compare_primitive(int x, const Place& at, int i, float r, const Motion& motion,
                                         Marks<Motion>& marks) {
        float radius;
        const Floats gap = square_gap(scene, i, at, Mover{r, marks.growth, wanted}, radius);
        const float sum = r + radius;
        FloatMask touching = gap < touching_square(marks, sum);
        if constexpr (Motion::is_cell)
            if (is_convex(scene, i)) touching = motion.refine_primitive(touching, x, i, at, gap, sum);
        marks.touching = marks.touching | touching;
        if constexpr (Motion::is_moving) {
            const FloatMask near = gap < square_of(marks.growth, sum);
            if (bits_of(near) & wanted)
                marks.near =
                    marks.near | (is_convex(scene, i) ? near & motion.may_reach(x, i, at, gap, sum) : near);
        }
    }
    // The same for a sphere of body b of a pair against one of body a.
    template <class Motion>
    CSPACE_INLINE void compare_balls(int p, const Place& at, const Place& other, float r,
                                     const Motion& motion, Marks<Motion>& marks) {
        const Floats gap = square_distance(at, other);
        FloatMask touching = gap < touching_square(marks, r);
        if constexpr (Motion::is_cell) touching = motion.refine_pair(touching, p, at, other, gap, r);
        marks.touching = marks.touching | touching;
        if constexpr (Motion::is_moving) {
            const FloatMask near = gap < square_of(marks.growth, r);
            if (bits_of(near) & wanted)
                marks.near = marks.near | (near & motion.may_meet(p, at, other, gap, r));
        }
    }
    template <class Motion>
    CSPACE_INLINE bool settle(const Marks<Motion>& marks) {
        if constexpr (Motion::is_moving) unsure |= bits_of(marks.near) & wanted;
        const unsigned touching = bits_of(marks.touching) & wanted;
        hit |= touching;
        return touching != 0;
    }
    // Which of the primitives a sphere touches.
    CSPACE_COLD bool record_primitive(int l, int s, const Place& at, float r, Candidates near) {
        for (int k = 0; k < near.count; ++k) {
            float radius;
            const Floats gap = square_gap(scene, near.begin[k], at, Mover{r, NoMotion{}, wanted}, radius);
            if (!touches(gap, r + radius)) continue;
            const Contact contact = {l, near.begin[k], false, 0};
            return record_touch({robot.links[l].body, s, -1, near.begin[k], contact});
        }
        return true;
    }
    // Which of the listed spheres another sphere touches.
    CSPACE_COLD bool record_pair(const LinkPair& links, int s, const Place& at, float r, int count) {
        const Place* all = static_cast<Place*>(w.sphere_places);
        const Contact contact = {links.a, links.b, true, 0};
        for (int k = 0; k < count; ++k) {
            const int other = w.near_spheres[k];
            if (!touches(square_distance(at, all[other]), r + robot.spheres[other].r)) continue;
            return record_touch({robot.links[links.b].body, s, robot.links[links.a].body, other, contact});
        }
        w.contact = contact;
        return true;
    }
    bool record_touch(const Touch& touch) {
        for (int i = recent_touches - 1; i > 0; --i) w.touches[i] = w.touches[i - 1];
        w.touches[0] = touch;
        w.contact = touch.contact;
        return true;
    }
    CSPACE_INLINE bool touches(Floats gap, float r) const {
        return bits_of(gap < fill_floats(r * r)) & wanted;
    }
};

}  // namespace cspace::collision::inline CSPACE_ISA
