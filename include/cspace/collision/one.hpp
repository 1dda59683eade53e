// One configuration: whether it touches something, and what. Its lanes are bodies, then spheres: eight balls
// of bodies against a primitive or another ball, and eight spheres of a body where its ball touches.
//
// Every sphere is placed and compared by the operations that blocks use (block.hpp), so verdicts are equal.
#pragma once

#include "cspace/collision/block.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// The base, which does not move.
inline void place_base(const Robot& robot, Workspace& w) {
    FrameOf<float>& base = static_cast<FrameOf<float>*>(w.one_frames)[0];
    for (int k = 0; k < 12; ++k) {
        const float x = k % 4 == 0 && k < 9 ? 1.0f : 0.0f;
        (k < 9 ? base.R[k] : base.p[k - 9]) = w.frame_columns[k * robot.body_stride] = x;
    }
}

class OneCheck {
  public:
    OneCheck(const Robot& robot, const Scene& scene, Workspace& w)
        : robot_(robot),
          scene_(scene),
          w_(w),
          stride_(robot.body_stride),
          frames_(static_cast<FrameOf<float>*>(w.one_frames)) {}

    // q: one entry per coordinate. Writes w.contact if something touches.
    bool find_contact(const float* q) {
        ++w_.stamp;
        ++w_.blocks;
        place_bodies(q);
        place_balls();
        return touches_primitive() || touches_itself();
    }

  private:
    struct Point {
        float x, y, z;
    };

    const Robot& robot_;
    const Scene& scene_;
    Workspace& w_;
    const int stride_;
    FrameOf<float>* const frames_;

    // The sines and cosines of all joints come first, eight at a time.
    CSPACE_INLINE void place_bodies(const float* q) {
        float *const values = w_.joint_columns, *const sines = values + stride_,
                     *const cosines = sines + stride_;
        for (int j = 0; j < robot_.n_joints; ++j) {
            const Joint& joint = robot_.joints[j];
            values[j] = q[joint.coordinate];
            if (!joint.is_plain) values[j] = values[j] * joint.ratio + joint.offset;
        }
        for (int j = 0; j < robot_.n_joints; j += float_lanes) {
            Floats s, c;
            sin_cos(load_floats(values + j), s, c);
            store_floats(sines + j, s);
            store_floats(cosines + j, c);
        }
        for (int j = 0; j < robot_.n_joints; ++j) {
            const Joint& joint = robot_.joints[j];
            FrameOf<float>& frame = frames_[j + 1];
            place_joint(joint, frames_[joint.parent], frame);
            if (joint.is_prismatic)
                slide_along_z(frame, values[j]);
            else
                turn_about_z(frame, sines[j], cosines[j]);
            for (int k = 0; k < 9; ++k) w_.frame_columns[k * stride_ + j + 1] = frame.R[k];
            for (int k = 0; k < 3; ++k) w_.frame_columns[(9 + k) * stride_ + j + 1] = frame.p[k];
        }
    }
    CSPACE_INLINE void place_balls() {
        for (int b = 0; b < stride_; b += float_lanes) {
            const auto column = [&](int k) { return load_floats(w_.frame_columns + k * stride_ + b); };
            const Floats x = load_floats(robot_.body_balls.x + b), y = load_floats(robot_.body_balls.y + b),
                         z = load_floats(robot_.body_balls.z + b);
            for (int r = 0; r < 3; ++r)
                store_floats(
                    w_.ball_columns + r * stride_ + b,
                    column(3 * r) * x + (column(3 * r + 1) * y + (column(3 * r + 2) * z + column(9 + r))));
        }
    }
    CSPACE_INLINE Place balls_from(int b) const {
        return {load_floats(w_.ball_columns + b), load_floats(w_.ball_columns + stride_ + b),
                load_floats(w_.ball_columns + 2 * stride_ + b)};
    }
    CSPACE_INLINE Point ball_center(int b) const {
        return {w_.ball_columns[b], w_.ball_columns[stride_ + b], w_.ball_columns[2 * stride_ + b]};
    }

    // The spheres of a chunk and of others of its body, placed when first asked for.
    CSPACE_INLINE void place_spheres(int body) {
        if (w_.body_stamps[body] == w_.stamp) return;
        w_.body_stamps[body] = w_.stamp;
        const FrameOf<float>& f = frames_[body];
        const BodyChunks& own = robot_.body_chunks[body];
        for (int c = own.first; c < own.first + own.count; ++c) {
            const int s = robot_.chunks[c].first;
            const Floats x = load_floats(robot_.sphere_columns.x + s),
                         y = load_floats(robot_.sphere_columns.y + s),
                         z = load_floats(robot_.sphere_columns.z + s);
            for (int r = 0; r < 3; ++r)
                store_floats(w_.sphere_columns + float_lanes * (3 * c + r),
                             f.R[3 * r] * x + (f.R[3 * r + 1] * y + (f.R[3 * r + 2] * z + f.p[r])));
        }
    }
    CSPACE_INLINE Place chunk_place(int c) const {
        const float* columns = w_.sphere_columns + 3 * float_lanes * c;
        return {load_floats(columns), load_floats(columns + float_lanes),
                load_floats(columns + 2 * float_lanes)};
    }
    CSPACE_INLINE Floats chunk_radii(int c) const {
        return load_floats(robot_.sphere_columns.r + robot_.chunks[c].first);
    }

    bool touches_primitive() {
        bool found = false;
        for (int first = 0; first < robot_.n_bodies && !found; first += float_lanes) {
            const unsigned moving = first == 0 ? all_lanes - 1 : all_lanes;  // the base is checked elsewhere
            const Place at = balls_from(first);
            const Floats r = load_floats(robot_.body_balls.r + first) + scene_.margin;
            const Floats low[3] = {at.x - r, at.y - r, at.z - r}, high[3] = {at.x + r, at.y + r, at.z + r};
            const auto meets = [&](const float* box_low, const float* box_high) {
                FloatMask all = (low[0] < box_high[0]) & (high[0] > box_low[0]);
                for (int k = 1; k < 3; ++k) all = all & (low[k] < box_high[k]) & (high[k] > box_low[k]);
                return found ? 0u : bits_of(all) & moving;
            };
            visit_boxes(scene_, meets, [&](int p, unsigned bits) {
                for (bits = find_touching(scene_, p, at, Balls{r, bits}, false); bits && !found;
                     bits &= bits - 1)
                    found = body_touches(first + lowest_lane(bits), p);
            });
        }
        return found;
    }
    bool body_touches(int body, int primitive) {
        place_spheres(body);
        const BodyChunks& own = robot_.body_chunks[body];
        for (int c = own.first; c < own.first + own.count; ++c) {
            const unsigned wanted = lanes_that_count(c, primitive);
            const Balls balls = {chunk_radii(c) + scene_.margin, wanted};
            if (!wanted) continue;
            const bool has_covers = robot_.sphere_solids != nullptr;
            unsigned touching = find_touching(scene_, primitive, chunk_place(c), balls, !has_covers);
            if (has_covers && touching) touching = find_reaching(body, c, primitive, touching);
            if (!touching) continue;
            const int sphere = robot_.chunks[c].first + lowest_lane(touching);
            w_.contact = {robot_.sphere_links[sphere], primitive, false, 0};
            return true;
        }
        return false;
    }
    // Of the spheres of a chunk that touch a primitive, one that counts itself or whose solid touches it too.
    unsigned find_reaching(int body, int c, int primitive, unsigned touching) const {
        const int first = robot_.chunks[c].first;
        const Floats inner = load_floats(robot_.inner_radii + first);
        const unsigned inside = touching & bits_of(inner > 0.0f);
        const Balls balls = {inner + scene_.margin, inside};
        const unsigned sure = inside ? find_touching(scene_, primitive, chunk_place(c), balls, false) : 0u;
        int last = -1;  // solid that does not touch
        for (; touching; touching &= touching - 1) {
            const int lane = lowest_lane(touching), s = first + lane;
            if (!is_cover(s) || sure >> lane & 1) return 1u << lane;
            if (robot_.sphere_solids[s] == last) continue;
            if (reaches(body, s, primitive)) return 1u << lane;
            last = robot_.sphere_solids[s];
        }
        return 0;
    }
    // Whether a sphere only covers a solid; whether the solid touches a primitive, and two of them each
    // other.
    CSPACE_INLINE bool is_cover(int s) const { return robot_.sphere_solids && robot_.sphere_solids[s] >= 0; }
    bool reaches(int body, int s, int primitive) const {
        float frame[12];
        copy_frame(frames_[body], frame);
        return scene_.exact.reaches_primitive(scene_.exact.owner, s, frame, primitive, scene_.margin);
    }
    bool meets(int s, int other) const {
        if (!is_cover(s) && !is_cover(other)) return true;
        float frame[12], other_frame[12];
        copy_frame(frames_[robot_.links[robot_.sphere_links[s]].body], frame);
        copy_frame(frames_[robot_.links[robot_.sphere_links[other]].body], other_frame);
        return scene_.exact.reaches_sphere(scene_.exact.owner, s, frame, other, other_frame,
                                           scene_.pair_margin);
    }
    // Those of the spheres of a chunk that may not touch a primitive.
    CSPACE_INLINE unsigned lanes_that_count(int c, int primitive) const {
        const Chunk& chunk = robot_.chunks[c];
        unsigned lanes = (1u << chunk.count) - 1;
        if (!scene_.allowed) return lanes;
        for (int i = 0; i < chunk.count; ++i)
            if (scene_.allowed[robot_.sphere_links[chunk.first + i] * scene_.n + primitive])
                lanes &= ~(1u << i);
        return lanes;
    }

    bool touches_itself() {
        if (robot_.n_pairs == 0) return false;
        for (int a = 0; a < robot_.n_bodies; ++a)
            for (int first = a / float_lanes * float_lanes; first < stride_; first += float_lanes) {
                const unsigned wanted = robot_.pair_lanes[(a * stride_ + first) / float_lanes];
                if (!wanted) continue;
                const float r = robot_.bodies[a].ball.r + scene_.pair_margin;
                const Floats reach = load_floats(robot_.body_balls.r + first) + r;
                const Floats gap = square_distance(balls_from(first), fill_place(ball_center(a)));
                for (unsigned bits = bits_of(gap < square(reach)) & wanted; bits; bits &= bits - 1)
                    if (pair_touches(robot_.pair_numbers[a * stride_ + first + lowest_lane(bits)]))
                        return true;
            }
        return false;
    }
    CSPACE_INLINE static Place fill_place(const Point& p) {
        return {fill_floats(p.x), fill_floats(p.y), fill_floats(p.z)};
    }
    bool pair_touches(int p) {
        const BodyPair& pair = robot_.pairs[p];
        for (int k = pair.first; k < pair.first + pair.count; ++k) {
            const LinkPair& links = robot_.link_pairs[k];
            const Point a = link_center(links.a), b = link_center(links.b);
            const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
            const float r = robot_.links[links.a].ball.r + robot_.links[links.b].ball.r + scene_.pair_margin;
            if (x * x + y * y + z * z < r * r && link_pair_touches(links, a, b)) return true;
        }
        return false;
    }
    CSPACE_INLINE Point link_center(int l) const {
        const Link& link = robot_.links[l];
        if (robot_.bodies[link.body].count == 1) return ball_center(link.body);
        const FrameOf<float>& f = frames_[link.body];
        const Ball& ball = link.ball;
        return {f.R[0] * ball.x + (f.R[1] * ball.y + (f.R[2] * ball.z + f.p[0])),
                f.R[3] * ball.x + (f.R[4] * ball.y + (f.R[5] * ball.z + f.p[1])),
                f.R[6] * ball.x + (f.R[7] * ball.y + (f.R[8] * ball.z + f.p[2]))};
    }
    // The spheres of b that the ball of a may meet, each against those of a that the ball of b may meet.
    bool link_pair_touches(const LinkPair& links, const Point& center_a, const Point& center_b) {
        const Link &a = robot_.links[links.a], &b = robot_.links[links.b];
        place_spheres(a.body);
        place_spheres(b.body);
        int n = 0;
        any_chunk(a, [&](int c, unsigned wanted) {
            wanted &= lanes_near(c, center_b, b.ball.r);
            w_.near_chunks[n] = c, w_.near_lanes[n] = wanted;
            n += wanted != 0;
            return false;
        });
        if (n == 0) return false;
        return any_chunk(b, [&](int c, unsigned wanted) {
            for (unsigned bits = lanes_near(c, center_a, a.ball.r) & wanted; bits; bits &= bits - 1)
                if (sphere_touches(c, lowest_lane(bits), n)) {
                    w_.contact = {links.a, links.b, true, 0};
                    return true;
                }
            return false;
        });
    }
    // The spheres of a chunk that a ball may meet.
    CSPACE_INLINE unsigned lanes_near(int c, const Point& center, float r) const {
        const Floats reach = chunk_radii(c) + scene_.pair_margin + r;
        return bits_of(square_distance(chunk_place(c), fill_place(center)) < square(reach));
    }
    // Whether sphere i of a chunk touches one of those listed.
    CSPACE_INLINE bool sphere_touches(int chunk, int i, int listed) const {
        const float* columns = w_.sphere_columns + 3 * float_lanes * chunk + i;
        const Place at = fill_place({columns[0], columns[float_lanes], columns[2 * float_lanes]});
        const int s = robot_.chunks[chunk].first + i;
        const float r = robot_.sphere_columns.r[s] + scene_.pair_margin;
        for (int k = 0; k < listed; ++k) {
            const int c = w_.near_chunks[k];
            const Floats gap = square_distance(at, chunk_place(c));
            unsigned bits = bits_of(gap < square(r + chunk_radii(c))) & w_.near_lanes[k];
            if (!bits) continue;
            if (!robot_.sphere_solids) return true;
            const float inner = robot_.inner_radii[s] + scene_.pair_margin;
            const Floats others = load_floats(robot_.inner_radii + robot_.chunks[c].first);
            const FloatMask is_sure = (others > 0.0f) & (gap < square(inner + others));
            if (robot_.inner_radii[s] > 0 && (bits_of(is_sure) & bits)) return true;
            for (; bits; bits &= bits - 1)
                if (meets(s, robot_.chunks[c].first + lowest_lane(bits))) return true;
        }
        return false;
    }
    // Whether test(chunk, lanes) holds for one of the chunks with spheres of a link, in the lanes that have
    // them.
    template <class Test>
    CSPACE_INLINE bool any_chunk(const Link& link, const Test& test) const {
        if (link.count == 0) return false;
        const Group& last = robot_.groups[link.first + link.count - 1];
        const int begin = robot_.groups[link.first].first, end = last.first + last.count;
        const BodyChunks& own = robot_.body_chunks[link.body];
        const int before = begin - robot_.chunks[own.first].first;
        for (int c = own.first + before / float_lanes; c < own.first + own.count; ++c) {
            const Chunk& chunk = robot_.chunks[c];
            if (chunk.first >= end) break;
            unsigned wanted = (1u << chunk.count) - 1;
            if (chunk.first < begin) wanted &= all_lanes << (begin - chunk.first);
            if (chunk.first + chunk.count > end) wanted &= (1u << (end - chunk.first)) - 1;
            if (test(c, wanted)) return true;
        }
        return false;
    }
};

}  // namespace cspace::collision::inline CSPACE_ISA
