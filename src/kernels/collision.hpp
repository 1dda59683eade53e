#pragma once
#include "cspace/collision/robot.hpp"
#include "cspace/collision/scene.hpp"
#include "cspace/collision/workspace.hpp"
#include "dispatch.hpp"

// Fills in what never changes: the frame of the base, and the order of the first tests.
CSPACE_NARROW_KERNEL(cspace::collision, void, prepare_workspace,
                     (const cspace::collision::Robot& robot, cspace::collision::Workspace& w))
// 0 free, 1 blocked, 2 undecided.
CSPACE_NARROW_KERNEL(cspace::collision, int, prove_edge,
                     (const cspace::collision::Robot& robot, const cspace::collision::Scene& scene,
                      cspace::collision::Workspace& w, const float* from, const float* to))
// 0 free, 1 blocked at one of 8 n configurations.
CSPACE_NARROW_KERNEL(cspace::collision, int, sample_edge,
                     (const cspace::collision::Robot& robot, const cspace::collision::Scene& scene,
                      cspace::collision::Workspace& w, const float* from, const float* to, int n))
// Whether one configuration touches something, and what.
CSPACE_NARROW_KERNEL(cspace::collision, bool, touches_something,
                     (const cspace::collision::Robot& robot, const cspace::collision::Scene& scene,
                      cspace::collision::Workspace& w, const float* q))
// Bit i: whether row i of up to eight configurations touches something. columns: row k has coordinate k of
// each, eight of them.
CSPACE_NARROW_KERNEL(cspace::collision, unsigned, check_rows,
                     (const cspace::collision::Robot& robot, const cspace::collision::Scene& scene,
                      cspace::collision::Workspace& w, const float* columns, int count))
// Of up to eight cells q ± half (one entry per coordinate): bit i whether the middle of cell i touches
// something, bit 8 + i whether all of the cell is so. rounding: of places [m].
CSPACE_NARROW_KERNEL(cspace::collision, unsigned, check_cells,
                     (const cspace::collision::Robot& robot, const cspace::collision::Scene& scene,
                      cspace::collision::Workspace& w, const float* columns, const float* half,
                      float rounding, int count))
// Whether a ball of the base, in its frame, touches primitive i.
CSPACE_NARROW_KERNEL(cspace::collision, bool, ball_touches,
                     (const cspace::collision::Scene& scene, int i, const cspace::collision::Ball& ball))
