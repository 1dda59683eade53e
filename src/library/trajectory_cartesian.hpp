// Cartesian paths: the pose of a tip along them and its first two derivatives.
#pragma once

#include <cstdint>
#include <span>

namespace cspace::trajectory {

// The point p = Σ point_k uᵏ + (Rot(axis, rate u) − 1) arm and the rotation exp(Σ turn_k uᵏ) R of each piece,
// u from its begin: point, turn (pieces, 6, 3), R (pieces, 3, 3), axis, arm (pieces, 3), rate (pieces,).
struct CartesianPieces {
    std::span<const double> point, turn, R, axis, rate, arm;
};
struct CartesianPlaces {
    std::span<const std::int64_t> piece;
    std::span<const double> u;
};

// T (places, 4, 4).
void evaluate_poses(const CartesianPieces& path, const CartesianPlaces& places, double* T);
// The derivatives of the pose by u, [v; ω] in base axes at the tip, and theirs: (places, 6) each.
void evaluate_twists(const CartesianPieces& path, const CartesianPlaces& places, double* first,
                     double* second);

}  // namespace cspace::trajectory
