// Many configurations, eight at a time: which of them touch something.
#pragma once

#include "cspace/collision/block.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// Lanes are configurations of their own: one that touches something is done.
struct Apart {
    static constexpr bool is_moving = false, is_cell = false, is_shrinking = false;
    static NoMotion no_growth() { return {}; }
    CSPACE_INLINE NoMotion growth(int, const Place&) const { return {}; }
    static AtRest relative(int) { return {}; }
    static bool is_done(Block& block) {
        block.wanted &= ~block.hit;
        return block.wanted == 0;
    }
};

// What rounding may cost the squared gap of a box [m].
inline constexpr float box_slack = 1e-6f;

// The primitives that the ball of a body touches in some lane.
template <class Motion>
Candidates find_candidates(Block& block, int body, const Motion& motion) {
    const Place& at = block.body_place(body);
    const float r = block.robot.bodies[body].ball.r + block.scene.margin;
    const auto growth = motion.growth(body, at);
    const Floats reach = square_of(search_growth(growth), r + box_slack);
    int n = 0;
    if (block.scene.n_nodes == 0)
        while (n < block.scene.n) block.w.near[n] = n, ++n;
    else
        visit_boxes(
            block.scene,
            [&](const float* low, const float* high) {
                return bits_of(square_gap(low, high, at) < reach) & block.wanted;
            },
            [&](int p, unsigned) { block.w.near[n++] = p; });
    return block.narrow({block.w.near, n}, at, r, growth, block.w.near_body);
}

// All tests of a block whose bodies are placed, until the motion is done.
template <class Motion>
void test_lanes(Block& block, const Motion& motion) {
    const Robot& robot = block.robot;
    for (int k = 0; k < block.w.n_order && block.wanted; ++k) {
        const int test = block.w.order[k];
        if (test < robot.n_bodies) {
            if (robot.bodies[test].count == 0) continue;
            const Candidates near = find_candidates(block, test, motion);
            if (near.count && block.test_links(test, near, motion)) break;
            continue;
        }
        const int p = test - robot.n_bodies;
        const BodyPair& pair = robot.pairs[p];
        const float r = robot.bodies[pair.a].ball.r + robot.bodies[pair.b].ball.r;
        const Place &a = block.body_place(pair.a), &b = block.body_place(pair.b);
        const auto relative = motion.relative(p);
        if (!block.may_meet(a, b, r, relative.growth(b))) continue;
        for (int i = pair.first; i < pair.first + pair.count && block.wanted; ++i) {
            const LinkPair& links = robot.link_pairs[i];
            const float sum = robot.links[links.a].ball.r + robot.links[links.b].ball.r;
            const Place& at = block.link_place(links.b);
            const auto growth = relative.growth(at);
            if (block.may_meet(block.link_place(links.a), at, sum, growth))
                block.test_link_pair(links, motion, relative, growth);
        }
    }
}

// The lanes, among those wanted, of configurations q that touch something.
inline unsigned lanes_in_collision(Block& block, const Floats* q, unsigned wanted) {
    block.wanted = wanted;
    block.begin(q, block.robot.n_joints);
    test_lanes(block, Apart{});
    return block.hit & wanted;
}

}  // namespace cspace::collision::inline CSPACE_ISA
