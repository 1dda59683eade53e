// Many configurations, eight at a time: which of them touch something.
#pragma once

#include "cspace/collision/block.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// Lanes are configurations of their own: one that touches something is done.
struct Apart {
    static constexpr bool is_moving = false;
    static NoMotion no_growth() { return {}; }
    CSPACE_INLINE NoMotion growth(int, const Place&) const { return {}; }
    CSPACE_INLINE NoMotion pair_growth(int, const Place&) const { return {}; }
    static bool is_done(Block& block) {
        block.wanted &= ~block.hit;
        return block.wanted == 0;
    }
};

// The lanes, among those wanted, of configurations q that touch something.
inline unsigned lanes_in_collision(Block& block, const Floats* q, unsigned wanted) {
    const Robot& robot = block.robot;
    const Apart apart;
    block.wanted = wanted;
    block.begin(q, robot.n_joints);
    for (int i = 0; i < block.scene.n; ++i) block.w.near[i] = i;
    for (int k = 0; k < block.w.n_order && block.wanted; ++k) {
        const int test = block.w.order[k];
        if (test < robot.n_bodies) {
            if (robot.bodies[test].count == 0) continue;
            const Candidates near =
                block.narrow({block.w.near, block.scene.n}, block.body_place(test),
                             robot.bodies[test].ball.r + block.scene.margin, NoMotion{}, block.w.near_body);
            if (near.count && block.test_links(test, near, apart)) break;
            continue;
        }
        const int p = test - robot.n_bodies;
        const BodyPair& pair = robot.pairs[p];
        const float r = robot.bodies[pair.a].ball.r + robot.bodies[pair.b].ball.r;
        if (!block.may_meet(block.body_place(pair.a), block.body_place(pair.b), r, NoMotion{})) continue;
        for (int i = pair.first; i < pair.first + pair.count && block.wanted; ++i) {
            const LinkPair& links = robot.link_pairs[i];
            const float sum = robot.links[links.a].ball.r + robot.links[links.b].ball.r;
            if (block.may_meet(block.link_place(links.a), block.link_place(links.b), sum, NoMotion{}))
                block.test_link_pair(p, links, apart);
        }
    }
    return block.hit & wanted;
}

}  // namespace cspace::collision::inline CSPACE_ISA
