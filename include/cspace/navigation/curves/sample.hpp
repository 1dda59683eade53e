// Poses along a curve for cars.
#pragma once

#include <cstddef>
#include <vector>

#include "cspace/navigation/curves/curve.hpp"

namespace cspace::navigation {

// A curve of any number of pieces, laid from a pose.
class LaidCurve {
  public:
    LaidCurve(const CarPose& start, std::vector<Piece> pieces, double radius)
        : pieces_(std::move(pieces)), radius_(radius), pose_{start}, s_{0} {
        for (const Piece& piece : pieces_) {
            pose_.push_back(drive(pose_.back(), piece, radius));
            s_.push_back(s_.back() + std::fabs(piece.length));
        }
    }
    // The pose after a length s, in turning radii; beyond an end that of the end.
    CarPose at(double s) const {
        if (s >= s_.back()) return pose_.back();
        const auto after = std::upper_bound(s_.begin() + 1, s_.end(), s);
        const std::size_t k = std::size_t(after - s_.begin()) - 1;
        const Piece& piece = pieces_[k];
        return drive(pose_[k], {piece.turn, std::copysign(std::max(s - s_[k], 0.0), piece.length)}, radius_);
    }

  private:
    std::vector<Piece> pieces_;
    double radius_;
    std::vector<CarPose> pose_;  // where each piece begins, and the end
    std::vector<double> s_;
};

}  // namespace cspace::navigation
