// Poses along a curve for cars.
#pragma once

#include "cspace/navigation/curves/curve.hpp"

namespace cspace::navigation {

// The pose after a length s of the curve, in turning radii; beyond an end that of the end.
inline CarPose pose_at(const CarPose& start, const Curve& curve, double s, double radius) {
    CarPose at = start;
    for (int i = 0; i < curve.count && s > 0; ++i) {
        Piece piece = curve.piece[i];
        const double length = std::fabs(piece.length);
        if (s < length) piece.length = std::copysign(s, piece.length);
        at = drive(at, piece, radius);
        s -= length;
    }
    return at;
}

}  // namespace cspace::navigation
