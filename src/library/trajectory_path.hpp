// Paths of polynomials in each joint: their configurations and where their derivatives jump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cspace::trajectory {

// Pieces of polynomials of one degree, 1 to 5: controls (pieces, degree + 1, joints), their Bernstein
// coefficients. stops (pieces + 1,): 1 where the motion has to stand.
struct TimingPath {
    int degree, joints;
    std::span<const double> controls, lengths;
    std::span<const signed char> stops;
};

// The configurations of a path and their first two derivatives by the parameter, (places, joints) each, at
// places within pieces.
struct PathPlaces {
    std::span<const std::int32_t> piece;
    std::span<const double> local;  // in [0, 1]
    double *q, *slope, *bend;
};
void evaluate_path(const TimingPath& path, const PathPlaces& places);

// How large relative numbers are that count: a gap between pieces, a jump of a derivative, a slope.
struct ShapeTolerances {
    double gap, jump, slope;
};

// What a path does at its breaks and on its pieces. gap: the first break where the pieces do not meet, or 0.
struct PathShape {
    std::size_t gap;
    double width;  // of that gap
    // (pieces + 1,): bit 0 where the slopes of both pieces vanish, bit k where derivative k = 1, 2, 3 jumps.
    std::vector<std::int8_t> events;
    std::vector<std::int8_t> moving;  // (pieces, joints): 1 for joints that move on a piece
};
PathShape examine_path(const TimingPath& path, const ShapeTolerances& tolerances);

}  // namespace cspace::trajectory
