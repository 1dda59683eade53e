// The owner of a robot's numbers: the tree and the path to each of its frames.
//
// Built once, then only read; not for kernels, which take the views `tree()` and `chain(frame)`.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "cspace/model/reduce_joint.hpp"
#include "cspace/model/tree.hpp"

namespace cspace::model {

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
            if (joints_[k].parent >= 0)
                joints_[std::size_t(joints_[k].parent)].carried_mass += joints_[k].carried_mass;
        }
        for (const Frame& frame : frames_) add_chain(frame);
    }

    Tree tree() const {
        return {joints_.data(), frames_.data(), bodies_.data(), int(joints_.size()), int(frames_.size()), n_,
                mass_};
    }
    const Chain& chain(int frame) const { return chains_[std::size_t(frame)]; }
    int n_frames() const { return int(frames_.size()); }
    int n_joints() const { return int(joints_.size()); }
    int n_coordinates() const { return n_; }
    double mass() const { return mass_; }

  private:
    void add_chain(const Frame& frame) {
        std::vector<const Joint*> path;
        for (int k = frame.joint; k >= 0; k = path.back()->parent) path.push_back(&joints_[std::size_t(k)]);
        std::reverse(path.begin(), path.end());

        auto reduced = std::make_unique<ChainJoint[]>(path.size() + 1);
        Chain chain{reduced.get(),
                    int(path.size()),
                    n_,
                    int(path.size()) == n_,
                    path.empty() ? frame.T_joint_frame : path[0]->T_parent_joint,
                    1.0,
                    0.0};
        double carried = 0.0;  // the turn ψ of the link before
        for (std::size_t i = 0; i < path.size(); ++i) {
            const Joint& joint = *path[i];
            const Posed& next = i + 1 < path.size() ? path[i + 1]->T_parent_joint : frame.T_joint_frame;
            reduced[i] = reduce_joint(joint, next, carried);
            chain.ordered = chain.ordered && joint.coordinate == int(i) && joint.ratio == 1.0;
        }
        chain.cos_last = std::cos(carried);
        chain.sin_last = std::sin(carried);
        chains_.push_back(chain);
        chain_joints_.push_back(std::move(reduced));
    }
    std::vector<Joint> joints_;
    std::vector<Frame> frames_;
    std::vector<Body> bodies_;
    int n_;
    double mass_ = 0.0;
    std::vector<std::unique_ptr<ChainJoint[]>> chain_joints_;
    std::vector<Chain> chains_;
};

}  // namespace cspace::model
