// From the joints and bodies of a robot to the links of cspace/dynamics/multibody.hpp.
#pragma once

#include <cmath>
#include <vector>

#include "cspace/dynamics/multibody.hpp"
#include "cspace/model/reduce_joint.hpp"
#include "cspace/model/tree.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

// A body turned by −angle about z, its moments taken about the origin: ∫ p pᵀ dm = ½ tr(I) 1 − I + m c cᵀ.
inline Moments<double> moments_of(const model::Body& body, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Mat3d turn = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    const Symmetric3<double> I = upper_triangle(turn * to_matrix(body.inertia) * transpose(turn));
    const Vec3d at = turn * body.center, first = body.mass * at;
    const double half = 0.5 * (I.xx + I.yy + I.zz);
    return {body.mass,
            first,
            {half - I.xx + first.x * at.x, first.x * at.y - I.xy, first.x * at.z - I.xz,
             half - I.yy + first.y * at.y, first.y * at.z - I.yz, half - I.zz + first.z * at.z}};
}

// parent_turn, own_turn: the turns about z of the frames of the parent and of the link against those of their
// joints.
inline Link make_link(const model::Joint& joint, const model::Body& body, double parent_turn,
                      double own_turn) {
    const model::TurnTiltTurn r = model::turn_tilt_turn(joint.T_parent_joint.R);
    const double phi = r.first - parent_turn, last = r.last + own_turn;
    const double c = std::cos(parent_turn), s = std::sin(parent_turn);
    const Vec3d t = joint.T_parent_joint.t;
    Link link = {};
    link.parent = joint.parent;
    link.coordinate = joint.coordinate;
    link.prismatic = joint.prismatic;
    link.turned = phi != 0.0;
    link.tilt = model::tilt_of(r.cos_alpha, r.sin_alpha);
    link.ratio = joint.ratio;
    link.turn = joint.prismatic ? 0.0 : joint.ratio;
    link.angle = joint.prismatic ? last : joint.offset + last;
    link.slide = joint.prismatic ? joint.ratio : 0.0;
    link.z = joint.prismatic ? joint.offset : 0.0;
    link.cos_phi = std::cos(phi);
    link.sin_phi = std::sin(phi);
    link.cos_alpha = r.cos_alpha;
    link.sin_alpha = r.sin_alpha;
    link.t = {c * t.x + s * t.y, c * t.y - s * t.x, t.z};
    link.d = {link.sin_phi * r.sin_alpha, -link.cos_phi * r.sin_alpha, r.cos_alpha};
    link.body = moments_of(body, own_turn);
    link.carried_mass = joint.carried_mass;
    link.armature = joint.armature;
    link.damping = joint.damping;
    link.friction = joint.friction;
    return link;
}

// The same in floats.
inline Vec3<float> to_floats(const Vec3d& a) { return {float(a.x), float(a.y), float(a.z)}; }
inline Moments<float> to_floats(const Moments<double>& m) {
    const Symmetric3<double>& S = m.second;
    return {float(m.mass),
            to_floats(m.first),
            {float(S.xx), float(S.xy), float(S.xz), float(S.yy), float(S.yz), float(S.zz)}};
}
inline BasicLink<float> to_floats(const Link& a) {
    return {a.parent,         a.coordinate,      a.prismatic,           a.turned,           a.tilt,
            float(a.ratio),   float(a.turn),     float(a.angle),        float(a.slide),     float(a.z),
            float(a.cos_phi), float(a.sin_phi),  float(a.cos_alpha),    float(a.sin_alpha), to_floats(a.t),
            to_floats(a.d),   to_floats(a.body), float(a.carried_mass), float(a.armature),  float(a.damping),
            float(a.friction)};
}

}  // namespace cspace::dynamics::inline CSPACE_ISA

namespace cspace::dynamics {

// The owner of the links of a robot; built once, then only read. Not for kernels.
class Links {
  public:
    explicit Links(const model::Tree& tree) : view_{}, turns_(std::size_t(tree.n_joints), 0.0) {
        const std::size_t n = turns_.size();
        // Each frame is turned so that the first rotation to the first link that it carries vanishes.
        std::vector<bool> carries(n, false);
        std::vector<int> movers(std::size_t(tree.n_coordinates), 0);
        for (std::size_t k = 0; k < n; ++k) {
            const model::Joint& joint = tree.joints[k];
            view_.shares = ++movers[std::size_t(joint.coordinate)] > 1 || view_.shares;
            if (joint.parent < 0 || carries[std::size_t(joint.parent)]) continue;
            carries[std::size_t(joint.parent)] = true;
            turns_[std::size_t(joint.parent)] = model::turn_tilt_turn(joint.T_parent_joint.R).first;
        }
        for (std::size_t k = 0; k < n; ++k) {
            const model::Joint& joint = tree.joints[k];
            links_.push_back(make_link(joint, tree.bodies[k + 1], turn_of(joint.parent), turns_[k]));
            float_links_.push_back(to_floats(links_.back()));
        }
        view_ = {
            links_.data(), tree.n_joints, tree.n_coordinates, view_.shares, moments_of(tree.bodies[0], 0.0),
            tree.mass};
        float_view_ = {float_links_.data(), tree.n_joints,         tree.n_coordinates,
                       view_.shares,        to_floats(view_.base), float(tree.mass)};
        find_body_frames(tree);
    }
    const Multibody& view() const { return view_; }
    const BasicMultibody<float>& float_view() const { return float_view_; }

    // A frame of the tree in the axes of its link.
    Posed place(const model::Frame& frame) const {
        const double c = std::cos(turn_of(frame.joint)), s = std::sin(turn_of(frame.joint));
        const Mat3d turn = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
        return {turn * frame.T_joint_frame.R, turn * frame.T_joint_frame.t};
    }
    // The first frame on the base and on each link in the axes of the latter, of a link without frames its
    // own as the tree has it: the frames of the parameters of bodies.
    const std::vector<Posed>& body_frames() const { return body_frames_; }

    // The links from the base to one of them.
    std::vector<int> path_to(int link) const {
        std::vector<int> path;
        for (; link >= 0; link = links_[std::size_t(link)].parent) path.insert(path.begin(), link);
        return path;
    }

  private:
    double turn_of(int joint) const { return joint < 0 ? 0.0 : turns_[std::size_t(joint)]; }
    void find_body_frames(const model::Tree& tree) {
        for (int k = -1; k < tree.n_joints; ++k) body_frames_.push_back(place({identity_pose(), k}));
        for (int i = tree.n_frames; i-- > 0;)
            body_frames_[std::size_t(tree.frames[i].joint + 1)] = place(tree.frames[i]);
    }

    std::vector<Link> links_;
    std::vector<BasicLink<float>> float_links_;
    Multibody view_;
    BasicMultibody<float> float_view_;
    std::vector<double> turns_;
    std::vector<Posed> body_frames_;
};

}  // namespace cspace::dynamics
