#include "ik_tracking.hpp"

#include <algorithm>
#include <numeric>

#include "cspace/ik/goal.hpp"
#include "cspace/ik/tracking/along.hpp"
#include "cspace/ik/tracking/cheapest_chain.hpp"
#include "cspace/ik/tracking/follow.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/linear.hpp"
#include "kernels/ik.hpp"
#include "robot_path.hpp"

namespace cspace::ik {

void track_branches(const TrackRows& given) {
    const RobotPath on(given.chain);
    std::vector<Posed> poses(given.count);
    std::vector<Way> ways(given.count);
    std::vector<BranchEnd> ends(given.branches);
    visit_range(0, given.count, [&](std::size_t k) { poses[k] = read_goal(given.poses + 16 * k).T; });
    visit_range(0, given.count, [&](std::size_t k) {
        ways[k] = way_between(poses[k], poses[k + (k + 1 < given.count)], on.path.length);
    });
    Track track = {&on.path,
                   on.number,
                   std::size_t(on.coordinates),
                   poses.data(),
                   ways.data(),
                   given.count,
                   given.whole_turns,
                   given.starts,
                   given.branches,
                   given.q,
                   given.last,
                   ends.data(),
                   poll_interrupts,
                   {},
                   {},
                   {}};
    double* bounds[3] = {track.lower, track.upper, track.stride};
    for (int k = 0; k < 3; ++k) on.gather(given.bounds + k * on.coordinates, bounds[k]);
    kernels::ik_track(track);
    for (std::size_t b = 0; b < given.branches; ++b) {
        const BranchEnd& end = ends[b];
        const int joint = end.joint < 0 ? -1 : on.number[end.joint];
        const double values[track_info] = {double(end.reached), end.at, double(end.fate), double(joint),
                                           end.weakest};
        std::copy_n(values, track_info, given.info + track_info * b);
    }
}

void correct_joint_path(const JointPathRows& given) {
    const RobotPath on(given.chain);
    std::vector<Posed> poses(given.count);
    visit_range(0, given.count, [&](std::size_t k) { poses[k] = read_goal(given.poses + 16 * k).T; });
    const std::size_t dof = std::size_t(on.coordinates);
    std::fill_n(given.slope, dof * given.count, 0.0);
    std::fill_n(given.bend, dof * given.count, 0.0);
    if (given.count == 0) return;
    kernels::ik_path_rows({&on.path, on.number, dof, given.count, poses.data(), given.twists, given.rates,
                           given.q, given.slope, given.bend, given.info, poll_interrupts});
}

void square_volumes(const double* J, std::size_t rows, std::size_t dof, double* squares) {
    for (std::size_t k = 0; k < rows; ++k, J += 6 * dof) {
        double A[6][6];
        for (std::size_t r = 0; r < 6; ++r)
            for (std::size_t c = r; c < 6; ++c)
                A[r][c] = std::inner_product(J + r * dof, J + (r + 1) * dof, J + c * dof, 0.0);
        squares[k] = factor_ldl(A, 6) ? 1.0 : 0.0;
        for (int r = 0; r < 6 && squares[k] > 0.0; ++r) squares[k] /= A[r][r];
    }
}

LayerChain cheapest_chain(Layers layers) {
    layers.poll = poll_interrupts;
    return find_cheapest_chain(layers);
}

}  // namespace cspace::ik
