#include "collision.hpp"

#include "cspace/collision/cells.hpp"
#include "cspace/collision/edge.hpp"
#include "cspace/collision/one.hpp"

namespace cspace::collision::inline CSPACE_ISA {

void prepare_workspace(const Robot& robot, Workspace& w) {
    set_identity(static_cast<Frame*>(w.frames)[0]);
    set_resting(static_cast<Rate*>(w.rates)[0]);
    place_base(robot, w);
    w.n_order = w.blocked_balance = 0;
    for (Touch& touch : w.touches) touch = {};
    for (int b = robot.n_bodies - 1; b > 0; --b)
        if (robot.bodies[b].count) w.order[w.n_order++] = b;
    for (int p = 0; p < robot.n_pairs; ++p) w.order[w.n_order++] = robot.n_bodies + p;
}

int prove_edge(const Robot& robot, const Scene& scene, Workspace& w, const float* from, const float* to) {
    return int(EdgeCheck(robot, scene, w, from, to).prove());
}

int sample_edge(const Robot& robot, const Scene& scene, Workspace& w, const float* from, const float* to,
                int n) {
    return EdgeCheck(robot, scene, w, from, to).sample(n) ? 0 : 1;
}

bool touches_something(const Robot& robot, const Scene& scene, Workspace& w, const float* q) {
    return OneCheck(robot, scene, w).find_contact(q);
}

CSPACE_INLINE void load_columns(const Robot& robot, const float* columns, Floats* q) {
    for (int k = 0; k < robot.n_coordinates; ++k) q[k] = load_floats(columns + float_lanes * k);
}

unsigned check_rows(const Robot& robot, const Scene& scene, Workspace& w, const float* columns, int count) {
    Floats q[most_coordinates];
    load_columns(robot, columns, q);
    Block block(robot, scene, w);
    return lanes_in_collision(block, q, (1u << count) - 1);
}

unsigned check_cells(const Robot& robot, const Scene& scene, Workspace& w, const float* columns,
                     const float* half, float rounding, int count) {
    Floats q[most_coordinates];
    load_columns(robot, columns, q);
    Block block(robot, scene, w);
    const CellVerdicts found = settle_cells(block, q, half, rounding, (1u << count) - 1);
    return found.touching | found.proved << float_lanes;
}

bool ball_touches(const Scene& scene, int i, const Ball& ball) {
    const Place at = {fill_floats(ball.x), fill_floats(ball.y), fill_floats(ball.z)};
    return find_touching(scene, i, at, Mover{ball.r + scene.margin, NoMotion{}, 1u}) != 0;
}

}  // namespace cspace::collision::inline CSPACE_ISA
