// The owner of a robot's numbers: the tree and the path to each of its frames.
//
// Built once, then only read; not for kernels, which take the views `tree()` and `chain(frame)`.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "cspace/model/chain.hpp"
#include "cspace/model/tree.hpp"
#include "cspace/tolerances.hpp"

namespace cspace {

// R = Rz(first) Rx(α) Rz(last), with cos α and sin α read from R, so that right angles stay exact. The last
// angle is read from Rz(-first) R, not from R itself: where α is almost zero only the sum of both is well
// defined.
struct TurnTiltTurn {
    double first, cos_alpha, sin_alpha, last;
};
inline TurnTiltTurn turn_tilt_turn(const Mat3d& R) {
    const double sine = std::hypot(R.m[0][2], R.m[1][2]);
    const double first = sine == 0.0 ? 0.0 : std::atan2(R.m[0][2], -R.m[1][2]);
    const double c = std::cos(first), s = std::sin(first);
    const double last = std::atan2(-(c * R.m[0][1] + s * R.m[1][1]), c * R.m[0][0] + s * R.m[1][0]);
    return {first, R.m[2][2], sine, last};
}

// Whether the tilt is one of those that only permute axes, up to the rounding of the rotation it was read
// from.
inline Tilt tilt_of(double cos_alpha, double sin_alpha) {
    if (std::fabs(sin_alpha) <= tolerance::right_angle) return cos_alpha > 0.0 ? Tilt::none : Tilt::half;
    return std::fabs(cos_alpha) <= tolerance::right_angle ? Tilt::quarter : Tilt::any;
}

class RobotModel {
  public:
    RobotModel(std::vector<Joint> joints, std::vector<Frame> frames, std::vector<Body> bodies,
               int n_coordinates)
        : joints_(std::move(joints)),
          frames_(std::move(frames)),
          bodies_(std::move(bodies)),
          n_(n_coordinates) {
        for (const Body& body : bodies_) mass_ += body.mass;
        for (std::size_t k = 0; k < joints_.size(); ++k) joints_[k].carried_mass = bodies_[k + 1].mass;
        for (std::size_t k = joints_.size(); k-- > 0;) {
            if (joints_[k].parent >= 0) joints_[joints_[k].parent].carried_mass += joints_[k].carried_mass;
        }
        for (const Frame& frame : frames_) add_chain(frame);
    }

    Tree tree() const {
        return {joints_.data(), frames_.data(), bodies_.data(), int(joints_.size()), int(frames_.size()), n_,
                mass_};
    }
    const Chain& chain(int frame) const { return chains_[frame]; }
    int n_frames() const { return int(frames_.size()); }
    int n_joints() const { return int(joints_.size()); }
    int n_coordinates() const { return n_; }
    double mass() const { return mass_; }

  private:
    void add_chain(const Frame& frame) {
        std::vector<int> path;
        for (int k = frame.joint; k >= 0; k = joints_[k].parent) path.push_back(k);
        std::reverse(path.begin(), path.end());

        auto reduced = std::make_unique<ChainJoint[]>(path.size() + 1);
        Chain chain{reduced.get(),
                    int(path.size()),
                    n_,
                    int(path.size()) == n_,
                    path.empty() ? frame.T_joint_frame : joints_[path[0]].T_parent_joint,
                    1.0,
                    0.0};
        double carried = 0.0;  // the turn ψ of the link before
        for (int i = 0; i < chain.n; ++i) {
            const Joint& joint = joints_[path[i]];
            const Posed& next = i + 1 < chain.n ? joints_[path[i + 1]].T_parent_joint : frame.T_joint_frame;
            reduced[i] = reduce(joint, next, carried);
            chain.ordered = chain.ordered && joint.coordinate == i && joint.ratio == 1.0;
        }
        chain.cos_last = std::cos(carried);
        chain.sin_last = std::sin(carried);
        chains_.push_back(chain);
        chain_joints_.push_back(std::move(reduced));
    }
    static ChainJoint reduce(const Joint& joint, const Posed& next, double& carried) {
        const TurnTiltTurn r = turn_tilt_turn(next.R);
        const double c = std::cos(r.first), s = std::sin(r.first);
        const double fixed = carried + r.first;
        carried = r.last;
        return {joint.prismatic ? 0.0 : joint.ratio,
                joint.prismatic ? fixed : joint.offset + fixed,
                joint.prismatic ? joint.ratio : 0.0,
                c * next.t.x + s * next.t.y,
                c * next.t.y - s * next.t.x,
                next.t.z + (joint.prismatic ? joint.offset : 0.0),
                r.cos_alpha,
                r.sin_alpha,
                joint.ratio,
                joint.coordinate,
                joint.prismatic,
                tilt_of(r.cos_alpha, r.sin_alpha)};
    }

    std::vector<Joint> joints_;
    std::vector<Frame> frames_;
    std::vector<Body> bodies_;
    int n_;
    double mass_ = 0.0;
    std::vector<std::unique_ptr<ChainJoint[]>> chain_joints_;
    std::vector<Chain> chains_;
};

}  // namespace cspace
