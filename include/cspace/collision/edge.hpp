// Edges of configuration space: proved free, blocked or undecided; or sampled at a stated resolution.
//
// An edge runs from mid − half (parameter −1) to mid + half (parameter 1). Over an interval of half width w
// around a parameter, a point with speed v there stays within v w + ½ κ w² of its place, where
//     κ = Σ_j ρ_j |h_j| (|h_j| + 2 Σ_{i before j} |h_i|)
// bounds its acceleration: h are the rates of the revolute joints that carry it, ρ_j bounds its distance from
// axis j (a prismatic joint has ρ = 1 and no square of its own). If no ball, grown by that, touches anything,
// the interval is proved free. If one touches at the middle, the edge is blocked. Other intervals are split.
// Where a ball grown so does touch something convex, only the part of its velocity along the unit vector n
// from there to its centre counts: with a distance d at the middle it keeps d − |n · v| w − ½ κ w² from the
// plane through the nearest point across n, behind which all of it lies. The idea is that of Schwarzer, Saha
// & Latombe (2005, "Adaptive dynamic collision checking for single and multiple articulated robots in complex
// environments"), who bound the length of the motion by levers alone.
#pragma once

#include "cspace/collision/block.hpp"

namespace cspace::collision {

// The narrowest interval that is split: an edge is undecided below.
inline constexpr float narrowest = 1.0f / 1024;
// Of the eight intervals that a proof begins with.
inline constexpr float first_half_width = 1.0f / 8;

}  // namespace cspace::collision

namespace cspace::collision::inline CSPACE_ISA {

class EdgeCheck {
  public:
    EdgeCheck(const Robot& robot, const Scene& scene, Workspace& w, const float* from, const float* to)
        : robot_(robot), scene_(scene), w_(w), block_(robot, scene, w) {
        for (int k = 0; k < robot.n_coordinates; ++k) {
            mid_[k] = 0.5f * (from[k] + to[k]);
            half_[k] = 0.5f * (to[k] - from[k]);
        }
    }

    Verdict prove() {
        Interval now[float_lanes];
        int count = float_lanes, left = 0;
        bool is_undecided = false;
        for (int i = 0; i < float_lanes; ++i)
            now[i] = {first_half_width * float(2 * i + 1 - float_lanes), first_half_width};
        set_intervals(now, count);
        if (begin_edge() || begin_search(first_half_width)) return Verdict::blocked;
        place_rates(robot_, half_, block_.frames, block_.rates);
        const Moving motion{*this, block_, first_half_width};
        bool is_blocked = test_first_block(motion);
        while (true) {
            if (is_blocked) return Verdict::blocked;
            const unsigned unsure = block_.unsure;
            int open = 0;
            for (unsigned m = unsure; m; m &= m - 1) ++open;
            const int parts = open + left <= 1 ? 8 : open + left <= 2 ? 4 : 2;
            for (int i = 0; i < count; ++i)
                if (unsure >> i & 1 && !split(now[i], parts, left)) is_undecided = true;
            if (is_undecided) return Verdict::undecided;
            if (left == 0) return Verdict::free;
            count = left < float_lanes ? left : float_lanes;
            for (int i = 0; i < count; ++i) now[i] = w_.stack[--left];
            for (int i = count; i < float_lanes; ++i) now[i] = now[0];
            set_intervals(now, count);
            place_next();
            place_rates(robot_, half_, block_.frames, block_.rates);
            is_blocked = test_all(motion);
        }
    }

    // Free if none of 8 n configurations at equal distances, both ends included, touches anything. Each lane
    // of the first block stands for n of them: those within whose motion nothing is near need no more.
    bool sample(int n) {
        const float step = 2.0f / float(float_lanes * n - 1);
        const int middle = n / 2;
        const float covered = step * float(middle);
        set_samples(middle, n, step);
        if (begin_edge()) return false;
        if (begin_search(covered)) return false;
        if (n == 1) return !test_first_block(Still{*this});
        set_width(fill_floats(covered));
        place_rates(robot_, half_, block_.frames, block_.rates);
        if (test_first_block(Moving{*this, block_, covered})) return false;
        return are_free(block_.unsure, n, step);
    }

  private:
    static constexpr int most_balance = 4;

    const Robot& robot_;
    const Scene& scene_;
    Workspace& w_;
    Block block_;
    alignas(32) float middle_[float_lanes] = {};
    alignas(32) float mid_[most_coordinates], half_[most_coordinates];
    Floats q_[most_coordinates], width_, width_2_;
    bool is_first_ = true;  // block of the edge

    // By how much balls move within an interval.
    struct Moving {
        const EdgeCheck& edge;
        Block& block;
        float first_half;  // of the intervals of the first block
        static constexpr bool is_moving = true, is_cell = false, is_shrinking = false;
        static Floats no_growth() { return fill_floats(0.0f); }
        CSPACE_INLINE Floats growth(int x, const Place& at) const {
            return speed_at(block.frames[x], block.rates[x], at) * edge.width_ +
                   edge.width_2_ * edge.w_.kappa[x];
        }
        // Where a ball of body x may come as near to a primitive as r.
        CSPACE_INLINE FloatMask may_reach(int x, int primitive, const Place& at, Floats gap, float r) const {
            const Velocity v = velocity_at(block.frames[x], block.rates[x], at);
            return may_approach(gap, gap_rate(edge.scene_, primitive, at, v), r, edge.w_.kappa[x]);
        }
        // Both are convex, so only the part of the velocity along the line between them counts.
        CSPACE_INLINE FloatMask may_approach(Floats gap, Floats rate, float r, float kappa) const {
            const Floats distance = sqrt(gap), left = distance - r - edge.width_2_ * kappa;
            return distance * left < abs(rate) * edge.width_;
        }
        // How body x moves around a place.
        CSPACE_INLINE Way way_of(int x, const Place& at, float) const {
            return {velocity_at(block.frames[x], block.rates[x], at), block.rates[x].w, edge.width_,
                    edge.width_2_ * edge.w_.kappa[x]};
        }
        // How body b of a pair moves against body a.
        struct Relative {
            const Moving& motion;
            RelativeRate rate;
            Floats bend;  // by the acceleration
            float kappa;
            Floats most_growth;  // at all places on body b

            CSPACE_INLINE Floats growth(const Place& at) const {
                return norm(velocity_at(rate, at)) * motion.edge.width_ + bend;
            }
            // Where a ball of body b may come as near to one of body a as r.
            CSPACE_INLINE FloatMask may_meet(const Place& at, const Place& other, Floats gap, float r) const {
                const Velocity v = velocity_at(rate, at);
                const Floats speed = (at.x - other.x) * v.x + (at.y - other.y) * v.y + (at.z - other.z) * v.z;
                return motion.may_approach(gap, speed, r, kappa);
            }
            // Sets most_growth from the growth of the ball of body b.
            CSPACE_INLINE void bound_growth(Floats growth, float radius) {
                const Floats *w = rate.w, turn = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) * radius;
                most_growth = growth + turn * motion.edge.width_;
            }
            CSPACE_INLINE Way way_of(const Place& at, float) const {
                return {velocity_at(rate, at), rate.w, motion.edge.width_, bend};
            }
        };
        CSPACE_INLINE Relative relative(int p) const {
            const BodyPair& pair = edge.robot_.pairs[p];
            const float kappa = edge.w_.pair_kappa[p];
            return {*this,
                    relative_rate(block.frames[pair.a], block.rates[pair.a], block.frames[pair.b],
                                  block.rates[pair.b]),
                    edge.width_2_ * kappa, kappa, fill_floats(0.0f)};
        }
        static bool is_done(const Block& block) { return block.hit != 0; }
    };
    // Samples do not move.
    struct Still {
        const EdgeCheck& edge;
        static constexpr bool is_moving = false, is_cell = false, is_shrinking = false;
        static constexpr float first_half = 0;
        static NoMotion no_growth() { return {}; }
        CSPACE_INLINE NoMotion growth(int, const Place&) const { return {}; }
        // As of Moving.
        struct Relative : AtRest {
            void bound_growth(NoMotion, float) {}
        };
        static Relative relative(int) { return {}; }
        static bool is_done(const Block& block) { return block.hit != 0; }
    };

    // κ/2 and Σ ρ_j |h_j| of all bodies (or pairs), eight at a time.
    void bound_motion(const float* levers, int stride, float* kappa, float* reach) {
        for (int b = 0; b < stride; b += float_lanes) {
            Floats sum = fill_floats(0.0f), before = sum, length = sum;
            for (int j = 0; j < robot_.n_joints; ++j) {
                const Joint& joint = robot_.joints[j];
                const float h = std::fabs(joint.ratio * half_[joint.coordinate]);
                const Floats lever = load_floats(levers + std::size_t(j) * std::size_t(stride) + b);
                const Floats moved = lever * h;
                length = length + moved;
                if (joint.is_prismatic) {
                    sum = sum + moved * before;
                } else {
                    sum = sum + moved * (before + 0.5f * h);
                    before = select_lanes(lever > 0.0f, before + h, before);
                }
            }
            store_floats(kappa + b, sum);
            store_floats(reach + b, length);
        }
    }

    static CSPACE_INLINE float sample_place(int k, int n, float step) {
        return 0.5f * step * float(2 * k - (float_lanes * n - 1));
    }
    CSPACE_INLINE void set_samples(int row, int n, float step) {
        for (int i = 0; i < float_lanes; ++i) middle_[i] = sample_place(i * n + row, n, step);
        set_coordinates();
    }
    // The samples of some lanes of the first block but for those that it has tested.
    bool are_free(unsigned lanes, int n, float step) {
        int filled = 0;
        for (; lanes; lanes &= lanes - 1)
            for (int row = 0; row < n; ++row) {
                if (row == n / 2) continue;
                middle_[filled++] = sample_place(lowest_lane(lanes) * n + row, n, step);
                if (filled == float_lanes && touches_samples(filled)) return false;
            }
        return filled == 0 || !touches_samples(filled);
    }
    bool touches_samples(int& filled) {
        for (int i = filled; i < float_lanes; ++i) middle_[i] = middle_[0];
        filled = 0;
        set_coordinates();
        place_next();
        return test_all(Still{*this});
    }
    CSPACE_INLINE void set_width(Floats width) {
        width_ = width;
        width_2_ = width * width;
    }
    CSPACE_INLINE void set_intervals(const Interval* now, int count) {
        alignas(32) float width[float_lanes];
        for (int i = 0; i < float_lanes; ++i) {
            middle_[i] = now[i].middle;
            width[i] = now[i].half;
        }
        set_width(load_floats(width));
        block_.wanted = (1u << count) - 1;
        set_coordinates();
    }
    CSPACE_INLINE void set_coordinates() {
        const Floats s = load_floats(middle_);
        for (int k = 0; k < robot_.n_coordinates; ++k) q_[k] = s * half_[k] + mid_[k];
    }
    CSPACE_INLINE void place_next() { block_.begin(q_, robot_.n_joints); }
    bool split(const Interval& interval, int parts, int& left) {
        if (interval.half < narrowest || left + parts > w_.stack_size) return false;
        const float half = interval.half / float(parts);
        for (int k = 0; k < parts; ++k)
            w_.stack[left++] = {interval.middle - interval.half + half * float(2 * k + 1), half};
        return true;
    }

    // Begins the first block with what found a contact last, for which the last bodies need no place; true
    // if something touches.
    bool begin_edge() {
        if (w_.n_order == 0) return place_next(), false;
        const int test = w_.order[0];
        block_.begin(q_, test < robot_.n_bodies ? test : robot_.pairs[test - robot_.n_bodies].b);
        const bool is_blocked = block_.test_touches() || test_likely(test);
        if (is_blocked)
            w_.contact.at = middle_[lowest_lane(block_.hit)];
        else
            block_.place_rest(q_);
        return is_blocked;
    }
    // Chooses candidates. Where most edges that came so far were blocked, tests the block as it is first:
    // that costs less than with motions. True if something touches.
    bool begin_search(float covered) {
        bound_motion(robot_.levers, robot_.body_stride, w_.kappa, w_.reach);
        bound_motion(robot_.pair_levers, robot_.pair_stride, w_.pair_kappa, w_.pair_reach);
        find_near(covered);
        if (w_.blocked_balance <= 0) return false;
        const Still motion{*this};
        const bool is_blocked = test_each([&](int test) {
            return test < robot_.n_bodies ? touches_near(test, motion)
                                          : touches_pair(test - robot_.n_bodies, motion);
        });
        if (is_blocked) note_blocked(true);
        return is_blocked;
    }
    bool touches_near(int x, const Still& motion) {
        if (w_.near_counts[x] == 0) return false;
        const Candidates near = {w_.near + x * w_.near_stride, w_.near_counts[x]};
        const float r = robot_.bodies[x].ball.r + scene_.margin;
        const Candidates touched = block_.narrow(near, block_.body_place(x), r, NoMotion{}, w_.near_body);
        return touched.count && block_.test_links(x, touched, motion);
    }
    bool touches_pair(int p, const Still& motion) {
        const BodyPair& pair = robot_.pairs[p];
        const float r = robot_.bodies[pair.a].ball.r + robot_.bodies[pair.b].ball.r;
        return block_.may_meet(block_.body_place(pair.a), block_.body_place(pair.b), r, NoMotion{}) &&
               test_likely_pair(p, motion);
    }
    void note_blocked(bool is_blocked) {
        int& balance = w_.blocked_balance;
        if (is_blocked)
            balance += balance < most_balance;
        else
            balance -= balance > -most_balance;
    }
    template <class Motion>
    bool test_first_block(const Motion& motion) {
        is_first_ = true;
        const bool is_blocked = test_all(motion);
        is_first_ = false;
        note_blocked(is_blocked);
        return is_blocked;
    }

    // All tests of a block; true if something touches.
    template <class Motion>
    bool test_all(const Motion& motion) {
        return test_each([&](int test) {
            return test < robot_.n_bodies ? test_body(test, motion)
                                          : test_pair(test - robot_.n_bodies, motion);
        });
    }
    // The test that finds a contact comes first from then on.
    template <class Touches>
    bool test_each(const Touches& touches) {
        for (int k = 0; k < w_.n_order; ++k) {
            const int test = w_.order[k];
            if (!touches(test)) continue;
            for (int i = k; i > 0; --i) w_.order[i] = w_.order[i - 1];
            w_.order[0] = test;
            w_.contact.at = middle_[lowest_lane(block_.hit)];
            return true;
        }
        return false;
    }

    // The test that found a contact last, before candidates are chosen: it settles most blocked edges.
    bool test_likely(int test) {
        const Still motion{*this};
        if (test >= robot_.n_bodies) return test_likely_pair(test - robot_.n_bodies, motion);
        if (scene_.n_nodes) return false;
        const Place& at = block_.body_place(test);
        const float r = robot_.bodies[test].ball.r + scene_.margin;
        float low[3], high[3];
        bound_places(at, r, low, high);
        const int count = list_boxes(scene_, low, high, w_.near_body);
        const Candidates near = block_.narrow({w_.near_body, count}, at, r, NoMotion{}, w_.near_body);
        return near.count && block_.test_links(test, near, motion);
    }
    // The box around the places of a ball in all lanes.
    static void bound_places(const Place& at, float r, float (&low)[3], float (&high)[3]) {
        const Floats rows[float_lanes] = {at.x, at.y, at.z, at.x, at.x, at.x, at.x, at.x};
        Floats least, greatest;
        bound_rows(rows, least, greatest);
        alignas(32) float all_low[float_lanes], all_high[float_lanes];
        store_floats(all_low, least - r);
        store_floats(all_high, greatest + r);
        for (int k = 0; k < 3; ++k) low[k] = all_low[k], high[k] = all_high[k];
    }

    bool test_likely_pair(int p, const Still& motion) {
        const BodyPair& pair = robot_.pairs[p];
        for (int k = pair.first; k < pair.first + pair.count; ++k) {
            const LinkPair& links = robot_.link_pairs[k];
            const float sum = robot_.links[links.a].ball.r + robot_.links[links.b].ball.r;
            if (block_.may_meet(block_.link_place(links.a), block_.link_place(links.b), sum, NoMotion{}) &&
                block_.test_link_pair(links, motion, AtRest{}, NoMotion{}))
                return true;
        }
        return false;
    }

    // The primitives whose boxes meet the box around all places of a body's ball along the edge.
    void find_near(float covered) {
        for (int first = 1; first < robot_.n_bodies; first += float_lanes) {
            const int count = robot_.n_bodies - first < float_lanes ? robot_.n_bodies - first : float_lanes;
            Floats x[float_lanes], y[float_lanes], z[float_lanes];
            alignas(32) float radius[float_lanes];
            for (int i = 0; i < float_lanes; ++i) {
                const int b = first + (i < count ? i : 0);
                const bool is_empty = i >= count || robot_.bodies[b].count == 0;
                const Place& at = block_.body_place(b);
                x[i] = at.x, y[i] = at.y, z[i] = at.z;
                radius[i] =
                    is_empty ? -3e38f : robot_.bodies[b].ball.r + scene_.margin + w_.reach[b] * covered;
            }
            Floats low[3], high[3];
            bound_rows(x, low[0], high[0]);
            bound_rows(y, low[1], high[1]);
            bound_rows(z, low[2], high[2]);
            const Floats r = load_floats(radius);
            for (int k = 0; k < 3; ++k) low[k] = low[k] - r, high[k] = high[k] + r;
            for (int i = 0; i < count; ++i) w_.near_counts[first + i] = 0;
            const auto meets = [&](const float* box_low, const float* box_high) {
                FloatMask all = (low[0] < box_high[0]) & (high[0] > box_low[0]);
                for (int k = 1; k < 3; ++k) all = all & (low[k] < box_high[k]) & (high[k] > box_low[k]);
                return bits_of(all);
            };
            visit_boxes(scene_, meets, [&](int p, unsigned bits) {
                for (; bits; bits &= bits - 1) {
                    const int b = first + lowest_lane(bits);
                    w_.near[b * w_.near_stride + w_.near_counts[b]++] = p;
                }
            });
        }
    }

    // A body against the primitives near it. The first block drops those that no block can reach.
    template <class Motion>
    bool test_body(int x, const Motion& motion) {
        int* const near = w_.near + x * w_.near_stride;
        int& count = w_.near_counts[x];
        if (count == 0) return false;
        const Place& at = block_.body_place(x);
        const float r = robot_.bodies[x].ball.r + scene_.margin;
        const auto growth = motion.growth(x, at);
        const Candidates touched =
            block_.narrow({near, count}, at, r, growth, is_first_ ? near : w_.near_body);
        if (is_first_) count = touched.count;
        return touched.count && block_.test_links(x, touched, motion);
    }

    // A pair of bodies. The first block keeps the pairs of links that any block can bring together.
    template <class Motion>
    bool test_pair(int p, const Motion& motion) {
        if (!is_first_ && !w_.kept_pairs[p]) return false;
        const BodyPair& pair = robot_.pairs[p];
        const Place &at_a = block_.body_place(pair.a), &at_b = block_.body_place(pair.b);
        const float r = robot_.bodies[pair.a].ball.r + robot_.bodies[pair.b].ball.r;
        if (is_first_) {
            const float reach = w_.pair_reach[p] * motion.first_half;
            w_.kept_pairs[p] = block_.may_meet(at_a, at_b, r + reach, NoMotion{});
            if (!w_.kept_pairs[p]) return false;
        } else if (!Motion::is_moving && !block_.may_meet(at_a, at_b, r, NoMotion{})) {
            return false;
        }
        auto relative = motion.relative(p);
        const auto growth = relative.growth(at_b);
        if (Motion::is_moving && !block_.may_meet(at_a, at_b, r, growth)) {
            if (is_first_) w_.kept_pairs[p] = 0;
            return false;
        }
        relative.bound_growth(growth, robot_.bodies[pair.b].ball.r);
        return test_link_pairs(p, motion, relative, growth);
    }
    template <class Motion, class Growth>
    bool test_link_pairs(int p, const Motion& motion, const typename Motion::Relative& relative,
                         Growth body_growth) {
        const BodyPair& pair = robot_.pairs[p];
        const bool is_whole = robot_.bodies[pair.b].count == 1;  // the link of b
        int kept = 0;
        for (int k = pair.first; k < pair.first + pair.count; ++k) {
            if (!is_first_ && !w_.kept_links[k]) continue;
            const LinkPair& links = robot_.link_pairs[k];
            const Place &a = block_.link_place(links.a), &b = block_.link_place(links.b);
            const float sum = robot_.links[links.a].ball.r + robot_.links[links.b].ball.r;
            if (is_first_) {
                w_.kept_links[k] = block_.may_meet(a, b, sum, relative.most_growth);
                if (!w_.kept_links[k]) continue;
                ++kept;
            }
            const Growth growth = is_whole ? body_growth : relative.growth(b);
            if (block_.may_meet(a, b, sum, growth) && block_.test_link_pair(links, motion, relative, growth))
                return true;
        }
        if (is_first_ && kept == 0) w_.kept_pairs[p] = 0;
        return false;
    }
};

}  // namespace cspace::collision::inline CSPACE_ISA
