#include "ik_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cspace/ik/goal.hpp"
#include "cspace/ik/tracking/along.hpp"
#include "cspace/ik/tracking/cheapest_chain.hpp"
#include "cspace/ik/tracking/follow.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/linear.hpp"
#include "kernels/ik.hpp"
#include "kernels/kinematics.hpp"
#include "robot_path.hpp"
#include "scratch.hpp"

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
                           given.q, given.slope, given.bend, on.find(given.locked), given.info,
                           poll_interrupts});
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t measured_at_once = 1024;  // pieces between two looks at the signals

bool are_finite(const double* q, std::size_t n) {
    return std::all_of(q, q + n, [](double value) { return std::isfinite(value); });
}

// The joints of piece k at its share t: the quintic with the values and derivatives of both nodes.
void evaluate_piece(const PieceRows& rows, std::size_t k, std::size_t dof, double* q) {
    const std::size_t a = std::size_t(rows.begin[k]), b = std::size_t(rows.end[k]);
    const double h = rows.u[b] - rows.u[a], t = rows.share[k], r = 1.0 - t;
    const double front = r * r * r, back = t * t * t, bend = 0.5 * (h * t * r) * (h * t * r);
    const double from_q = front * (1.0 + 3.0 * t + 6.0 * t * t), to_q = back * (1.0 + 3.0 * r + 6.0 * r * r);
    const double from_slope = h * front * t * (1.0 + 3.0 * t), to_slope = h * back * r * (1.0 + 3.0 * r);
    const double from_bend = bend * r, to_bend = bend * t;
    const double *qa = rows.q + a * dof, *qb = rows.q + b * dof, *sa = rows.slope + a * dof;
    const double *sb = rows.slope + b * dof, *ca = rows.bend + a * dof, *cb = rows.bend + b * dof;
    for (std::size_t j = 0; j < dof; ++j)
        q[j] = from_q * qa[j] + to_q * qb[j] + from_slope * sa[j] - to_slope * sb[j] + from_bend * ca[j] +
               to_bend * cb[j];
}

// Distance and angle between two poses (4×4); the angle by the chord of the rotations, for small ones.
void compare_poses(const double* A, const double* B, double* error) {
    double far = 0.0, turned = 0.0;
    for (int i = 0; i < 12; ++i) {
        const double apart = A[i] - B[i];
        (i % 4 == 3 ? far : turned) += apart * apart;
    }
    error[0] = std::sqrt(far);
    error[1] = std::sqrt(0.5 * turned);
}

}  // namespace

void measure_pieces(const PieceRows& given) {
    const std::size_t dof = std::size_t(given.chain.n_coordinates);
    std::vector<double> q(dof * given.count), T(16 * given.count);
    visit_range(0, given.count, [&](std::size_t k) {
        double* const middle = given.middle + k * dof;
        evaluate_piece(given, k, dof, middle);
        if (are_finite(middle, dof)) std::copy_n(middle, dof, &q[k * dof]);
    });
    kinematics::ChainRows rows{};
    rows.chain = given.chain;
    rows.count = given.count;
    rows.q = q.data();
    rows.T = T.data();
    const Scratch scratch = make_scratch(scratch_bytes(rows));
    for (std::size_t k = 0; k < given.count; k += measured_at_once) {
        poll_interrupts();
        kernels::chain_rows(rows, k, std::min(k + measured_at_once, given.count), scratch.get());
    }
    visit_range(0, given.count, [&](std::size_t k) {
        double* const error = given.error + 2 * k;
        compare_poses(&T[16 * k], given.poses + 16 * k, error);
        if (!are_finite(given.middle + k * dof, dof)) error[0] = error[1] = infinity;
    });
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
