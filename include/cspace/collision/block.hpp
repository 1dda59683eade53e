// Eight configurations at once: which of them touch something, and which might within a given motion.
//
// A test descends from the ball of a body over those of its links and groups to its spheres. `Motion` says by
// how much a ball may move within what a lane stands for (edge.hpp, rows.hpp): nothing for a configuration,
// v w + κ w² for an interval of half width w. A sphere that covers a solid stands for it: where it touches
// something, the solid is tested exactly.
#pragma once

#include "cspace/collision/exact.hpp"
#include "cspace/collision/gap.hpp"
#include "cspace/collision/workspace.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// A set of primitives, by number.
struct Candidates {
    const int* begin;
    int count;
};

// How a body of a pair moves against the other if neither moves.
struct AtRest {
    NoMotion most_growth;
    CSPACE_INLINE NoMotion growth(const Place&) const { return {}; }
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
            if (Motion::is_shrinking && is_hollow(group.first + s)) continue;
            const float r = radius_of<Motion>(group.first + s) + scene.margin;
            Marks<Motion> marks(motion.growth(x, at));
            for (int k = 0; k < near.count; ++k) {
                compare_primitive(x, group.first + s, at, near.begin[k], r, motion, marks);
            }
            if (settle(marks) && motion.is_done(*this)) return record_primitive(l, group.first + s, at, near);
        }
        return false;
    }

    // Tests two links of a pair of bodies against each other: the spheres of each that the other's ball may
    // meet. `relative` is how the body of b moves against that of a, `growth` by how much the ball of b does.
    template <class Motion, class Relative, class Growth>
    CSPACE_INLINE bool test_link_pair(const LinkPair& links, const Motion& motion, const Relative& relative,
                                      Growth growth) {
        const Link &a = robot.links[links.a], &b = robot.links[links.b];
        const Place at_a = link_place(links.a), at_b = link_place(links.b);
        const int count = list_spheres(a, at_b, b.ball.r, growth);
        if (count == 0) return false;
        for (int g = b.first; g < b.first + b.count; ++g) {
            const Group& group = robot.groups[g];
            if (b.count > 1) {
                const Place at = place_ball(frames[b.body], group.ball);
                if (!may_meet(at, at_a, group.ball.r + a.ball.r, relative.growth(at))) continue;
            }
            const Place* places = sphere_places(g, b.body);
            for (int s = 0; s < group.count; ++s) {
                const Place& at = places[s];
                const float r = robot.spheres[group.first + s].r + scene.pair_margin;
                const Floats from_a = square_distance(at, at_a);
                if constexpr (!Motion::is_cell)
                    if (!(bits_of(from_a < square_of(relative.most_growth, r + a.ball.r)) & wanted)) continue;
                Marks<Motion> marks(relative.growth(at));
                if constexpr (Motion::is_moving || Motion::is_cell) {
                    const Floats reach = square_of(search_growth(marks.growth), r + a.ball.r);
                    if (!(bits_of(from_a < reach) & wanted)) continue;
                }
                const Place* all = static_cast<Place*>(w.sphere_places);
                if (Motion::is_shrinking && is_hollow(group.first + s)) continue;
                const float own = radius_of<Motion>(group.first + s) + scene.pair_margin;
                for (int k = 0; k < count; ++k) {
                    const int other = w.near_spheres[k];
                    compare_balls(links, group.first + s, at, own, other, all[other], relative, marks);
                }
                if (settle(marks) && motion.is_done(*this))
                    return record_pair(links, group.first + s, at, count);
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
        if (touch.other_body < 0)
            hit = lanes_touching(touch.body, touch.sphere, at, touch.other);
        else
            hit = lanes_meeting(touch.body, touch.sphere, at, touch.other_body, touch.other,
                                place_ball(frames[touch.other_body], robot.spheres[touch.other]));
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
    // Numbers of other spheres and solids among what solids are refined against, behind primitives.
    static constexpr int first_pair = 1 << 30;

    const bool has_covers_ = robot.sphere_solids != nullptr;
    int placed_ = 0;  // bodies 0 … placed_ have their frames
    LastRefined refined_;

    // Of several tests: the lanes in which something touches, or may within its motion.
    template <class Motion>
    struct Marks {
        decltype(Motion::no_growth()) growth;
        FloatMask touching = fill_floats(0.0f) < fill_floats(0.0f), near = touching;
        unsigned exact_touching = 0, exact_near = 0;  // of solids

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
    CSPACE_INLINE void compare_primitive(int x, int s, const Place& at, int i, float r, const Motion& motion,
                                         Marks<Motion>& marks) {
        float radius;
        const Floats gap = square_gap(scene, i, at, Mover{r, marks.growth, wanted}, radius);
        const float sum = r + radius;
        if (!Motion::is_cell && has_covers_ && is_cover(s)) {
            const unsigned near = bits_of(gap < square_of(marks.growth, sum)) & wanted;
            if (!near) return;
            // The gaps of others are exact only as far as they compare with this radius.
            const float inner = is_convex(scene, i) ? robot.inner_radii[s] : -1.0f;
            const float excess = robot.spheres[s].r - robot.inner_radii[s];
            unsigned suspects = settle_inner(gap, near, sum - excess, inner, marks);
            if constexpr (Motion::is_moving) {
                const unsigned far = lanes_moving_far(gap, sum, excess, marks.growth) & suspects;
                if (far && is_convex(scene, i))
                    suspects &= ~far | bits_of(motion.may_reach(x, i, at, gap, sum));
                marks.exact_near |= far & suspects;
                suspects &= ~far;
            }
            if (suspects) refine_primitive(x, s, i, suspects, motion, marks);
            return;
        }
        FloatMask touching = gap < touching_square(marks, sum);
        if constexpr (Motion::is_cell) {
            if (is_convex(scene, i)) touching = motion.refine_primitive(touching, x, i, at, gap, sum);
            const unsigned suspects = bits_of(touching) & wanted;
            if (!Motion::is_shrinking && has_covers_ && is_cover(s)) {
                if (suspects) refine_primitive(x, s, i, suspects, motion, marks);
                return;
            }
        }
        marks.touching = marks.touching | touching;
        if constexpr (Motion::is_moving) {
            const FloatMask near = gap < square_of(marks.growth, sum);
            if (bits_of(near) & wanted)
                marks.near =
                    marks.near | (is_convex(scene, i) ? near & motion.may_reach(x, i, at, gap, sum) : near);
        }
    }
    // The same for a sphere of body b of a pair against one of body a.
    template <class Motion, class Relative>
    CSPACE_INLINE void compare_balls(const LinkPair& links, int s, const Place& at, float own, int other,
                                     const Place& other_at, const Relative& relative, Marks<Motion>& marks) {
        const float r = own + radius_of<Motion>(other);
        if (Motion::is_shrinking && is_hollow(other)) return;
        const Floats gap = square_distance(at, other_at);
        if (!Motion::is_cell && has_covers_ && (is_cover(s) || is_cover(other))) {
            const unsigned near = bits_of(gap < square_of(marks.growth, r)) & wanted;
            if (!near) return;
            const float inner = robot.inner_radii[s], other_inner = robot.inner_radii[other];
            const float excess = robot.spheres[s].r - inner + robot.spheres[other].r - other_inner;
            unsigned suspects =
                settle_inner(gap, near, r - excess, inner < other_inner ? inner : other_inner, marks);
            if constexpr (Motion::is_moving) {
                const unsigned far = lanes_moving_far(gap, r, excess, marks.growth) & suspects;
                if (far) suspects &= ~far | bits_of(relative.may_meet(at, other_at, gap, r));
                marks.exact_near |= far & suspects;
                suspects &= ~far;
            }
            if (suspects) refine_pair(links, s, other, suspects, relative, marks);
            return;
        }
        FloatMask touching = gap < touching_square(marks, r);
        if constexpr (Motion::is_cell) {
            touching = relative.refine(touching, at, other_at, gap, r);
            const unsigned suspects = bits_of(touching) & wanted;
            if (!Motion::is_shrinking && has_covers_ && (is_cover(s) || is_cover(other))) {
                if (suspects) refine_pair(links, s, other, suspects, relative, marks);
                return;
            }
        }
        marks.touching = marks.touching | touching;
        if constexpr (Motion::is_moving) {
            const FloatMask near = gap < square_of(marks.growth, r);
            if (bits_of(near) & wanted)
                marks.near = marks.near | (near & relative.may_meet(at, other_at, gap, r));
        }
    }

    // The radius with which a sphere counts: what is proved blocked touches the ball inside a solid.
    template <class Motion>
    CSPACE_INLINE float radius_of(int s) const {
        return Motion::is_shrinking ? robot.inner_radii[s] : robot.spheres[s].r;
    }
    // Whether a sphere covers a solid that holds no ball around its centre.
    CSPACE_INLINE bool is_hollow(int s) const { return robot.inner_radii[s] < 0; }
    // Whether a sphere only covers a solid.
    CSPACE_INLINE bool is_cover(int s) const { return robot.sphere_solids && robot.sphere_solids[s] >= 0; }
    CSPACE_INLINE const Ball& ball_around(int s) const {
        return is_cover(s) ? robot.solid_balls[robot.sphere_solids[s]] : robot.spheres[s];
    }
    // Of near lanes, those left once the balls inside the solids have told where these touch for sure.
    template <class Motion>
    CSPACE_INLINE unsigned settle_inner(Floats gap, unsigned near, float sum, float inner,
                                        Marks<Motion>& marks) {
        const unsigned sure = inner > 0 ? bits_of(gap < fill_floats(sum * sum)) & near : 0u;
        marks.exact_touching |= sure;
        return near & ~sure;
    }
    // Lanes in which covers do not touch, and move so far that the solids would tell no more.
    CSPACE_INLINE static unsigned lanes_moving_far(Floats gap, float sum, float excess, Floats growth) {
        constexpr float share = 2;
        return bits_of((gap > fill_floats(sum * sum)) & (growth > fill_floats(share * excess)));
    }
    template <class Motion, class Test, class AnyWay>
    void refine(int one, int other, unsigned suspects, const Test& test, const AnyWay* way, float radius,
                Marks<Motion>& marks) {
        constexpr int kind = Motion::is_moving ? 1 : Motion::is_cell ? 2 : 0;
        const RefinedLanes found = refined_.refine({w.stamp, kind, one, other}, suspects, test, way, radius);
        marks.exact_touching |= found.touching, marks.exact_near |= found.near;
    }
    template <class Motion>
    CSPACE_COLD void refine_primitive(int x, int s, int i, unsigned suspects, const Motion& motion,
                                      Marks<Motion>& marks) {
        const int solid = robot.sphere_solids[s];
        const Ball& ball = robot.solid_balls[solid];
        const PrimitiveTest test = {scene, frames[x], s, i};
        if constexpr (Motion::is_moving || Motion::is_cell) {
            const auto way = motion.way_of(x, place_ball(frames[x], ball), ball.r);
            refine(solid, i, suspects, test, &way, ball.r, marks);
        } else {
            refine(solid, i, suspects, test, static_cast<const Way*>(nullptr), 0, marks);
        }
    }
    // Sphere s is of link b of the pair, the other one of link a. Numbers below zero stand for spheres.
    template <class Motion, class Relative>
    CSPACE_COLD void refine_pair(const LinkPair& links, int s, int other, unsigned suspects,
                                 const Relative& relative, Marks<Motion>& marks) {
        const int x = robot.links[links.b].body, other_x = robot.links[links.a].body;
        const auto number = [&](int sphere) {
            return is_cover(sphere) ? robot.sphere_solids[sphere] : -1 - sphere;
        };
        const int one = number(s), two = first_pair + number(other) + robot.n_spheres;
        const PairTest test = {scene, frames[x], frames[other_x], s, other};
        if constexpr (Motion::is_moving || Motion::is_cell) {
            const Ball& ball = ball_around(s);
            const auto way = relative.way_of(place_ball(frames[x], ball), ball.r);
            refine(one, two, suspects, test, &way, ball.r, marks);
        } else {
            refine(one, two, suspects, test, static_cast<const Way*>(nullptr), 0, marks);
        }
    }
    // The lanes in which a sphere, or the solid that it covers, touches a primitive.
    CSPACE_INLINE unsigned lanes_touching(int x, int s, const Place& at, int i) const {
        const float r = robot.spheres[s].r + scene.margin;
        float radius;
        const Floats gap = square_gap(scene, i, at, Mover{r, NoMotion{}, wanted}, radius);
        unsigned lanes = touching_lanes(gap, r + radius);
        if (is_cover(s))
            for (unsigned bits = lanes; bits; bits &= bits - 1)
                if (!PrimitiveTest{scene, frames[x], s, i}.touches(lowest_lane(bits)))
                    lanes &= ~(1u << lowest_lane(bits));
        return lanes;
    }
    CSPACE_INLINE unsigned lanes_meeting(int x, int s, const Place& at, int other_x, int other,
                                         const Place& other_at) const {
        const float r = robot.spheres[s].r + robot.spheres[other].r + scene.pair_margin;
        unsigned lanes = touching_lanes(square_distance(at, other_at), r);
        if (is_cover(s) || is_cover(other))
            for (unsigned bits = lanes; bits; bits &= bits - 1)
                if (!PairTest{scene, frames[x], frames[other_x], s, other}.touches(lowest_lane(bits)))
                    lanes &= ~(1u << lowest_lane(bits));
        return lanes;
    }
    template <class Motion>
    CSPACE_INLINE bool settle(const Marks<Motion>& marks) {
        if constexpr (Motion::is_moving) unsure |= (bits_of(marks.near) & wanted) | marks.exact_near;
        unsigned touching = (bits_of(marks.touching) & wanted) | marks.exact_touching;
        if constexpr (Motion::is_cell) touching |= marks.exact_near;
        hit |= touching;
        return touching != 0;
    }
    // Which of the primitives a sphere touches.
    CSPACE_COLD bool record_primitive(int l, int s, const Place& at, Candidates near) {
        for (int k = 0; k < near.count; ++k) {
            if (!lanes_touching(robot.links[l].body, s, at, near.begin[k])) continue;
            const Contact contact = {l, near.begin[k], false, 0};
            return record_touch({robot.links[l].body, s, -1, near.begin[k], contact});
        }
        return true;
    }
    // Which of the listed spheres another sphere touches.
    CSPACE_COLD bool record_pair(const LinkPair& links, int s, const Place& at, int count) {
        const Place* all = static_cast<Place*>(w.sphere_places);
        const Contact contact = {links.a, links.b, true, 0};
        for (int k = 0; k < count; ++k) {
            const int other = w.near_spheres[k];
            const int x = robot.links[links.b].body, other_x = robot.links[links.a].body;
            if (!lanes_meeting(x, s, at, other_x, other, all[other])) continue;
            return record_touch({x, s, other_x, other, contact});
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
    CSPACE_INLINE unsigned touching_lanes(Floats gap, float r) const {
        return bits_of(gap < fill_floats(r * r)) & wanted;
    }
};

}  // namespace cspace::collision::inline CSPACE_ISA
