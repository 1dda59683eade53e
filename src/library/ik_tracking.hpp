// Branches along a path of poses: what the bindings call. Rows have one column per coordinate of the robot.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cspace/ik/tracking/layers.hpp"
#include "cspace/model/chain.hpp"

namespace cspace::ik {

inline constexpr int track_info = 5;  // poses reached, end, fate, joint, least singular value

// poses (count, 16); starts (branches, dof); bounds (3, dof): lower, upper, the longest step from pose to
// pose. q (branches, count, dof) up to the poses reached, last (branches, dof) and info (branches,
// track_info) take the results.
struct TrackRows {
    const model::Chain& chain;
    const double* poses;
    std::size_t count;
    const double* starts;
    std::size_t branches;
    const double* bounds;
    bool whole_turns;  // a branch may begin multiples of 2π away from its start
    double* q;
    double* last;
    double* info;
};
void track_branches(const TrackRows& rows);

// poses (count, 16); twists and rates (count, 6): their first two derivatives along the path, [v; ω] in base.
// q (count, dof): guesses, corrected to the poses; slope and bend (count, dof) take the derivatives of the
// joints, info (count, 2) the pose error that is left and how singular the arm is. locked: a coordinate of
// the robot that stays as it is, −1 for none.
struct JointPathRows {
    const model::Chain& chain;
    const double *poses, *twists, *rates;
    std::size_t count;
    int locked;
    double *q, *slope, *bend, *info;
};
void correct_joint_path(const JointPathRows& rows);

// Quintic pieces between nodes of joint paths, compared with the path at a place of each. q, slope, bend
// (nodes, dof) and u (nodes): the joints, their derivatives and the parameters of the nodes. Piece k lies
// between nodes begin[k] and end[k]; share[k] says where in it. poses (count, 16): of the path there. middle
// (count, dof) takes the joints, error (count, 2) the distance of the tip from the path [m, rad].
struct PieceRows {
    const model::Chain& chain;
    const double *q, *slope, *bend, *u;
    const std::int64_t *begin, *end;
    const double *share, *poses;
    std::size_t count;
    double *middle, *error;
};
void measure_pieces(const PieceRows& rows);

// As find_cheapest_chain, heeding signals.
LayerChain cheapest_chain(Layers layers);

// det(J Jᵀ) of Jacobians (rows, 6, dof), 0 where rounding leaves no more.
void square_volumes(const double* J, std::size_t rows, std::size_t dof, double* squares);

}  // namespace cspace::ik
