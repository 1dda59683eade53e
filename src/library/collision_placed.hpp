// The spheres of a robot at a configuration, in double: where they are, how they move with the coordinates,
// and what is near them.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "collision_robot.hpp"
#include "collision_scene.hpp"
#include "cspace/collision/workspace.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/shapes/distance.hpp"

namespace cspace::collision {

class PlacedSpheres {
  public:
    explicit PlacedSpheres(const RobotData& robot) : robot_(robot) {}

    void place(const double* q) {
        place_bodies(q);
        centers_.clear();
        for (const Sphere& sphere : robot_.given_spheres())
            centers_.push_back(bodies_[std::size_t(body_of(sphere.link))] * sphere.center);
    }
    const Vec3d& center(std::size_t sphere) const { return centers_[sphere]; }

    // Adds sign times the derivative of normal · place of a place that a link carries, by the coordinates.
    void add_gradient(std::span<double> gradient, int link, const Vec3d& at, const Vec3d& normal,
                      double sign) const {
        const auto joints = robot_.given_joints();
        for (int b = body_of(link); b > 0; b = joints[std::size_t(b - 1)].parent + 1) {
            const model::Joint& joint = joints[std::size_t(b - 1)];
            const Posed& frame = bodies_[std::size_t(b)];
            const Vec3d z = column(frame.R, 2);
            const Vec3d rate = kinematics::joint_twist(joint.prismatic, z, frame.t, at).v;
            gradient[std::size_t(joint.coordinate)] += sign * joint.ratio * dot(normal, rate);
        }
    }

  private:
    const RobotData& robot_;
    std::vector<Posed> bodies_;
    std::vector<Vec3d> centers_;

    int body_of(int link) const { return robot_.view().links[link].body; }

    void place_bodies(const double* q) {
        bodies_.assign(1, identity_pose());
        for (const model::Joint& joint : robot_.given_joints()) {
            const double value = joint.ratio * q[joint.coordinate] + joint.offset;
            Posed moved = identity_pose();
            if (joint.prismatic) {
                moved.t.z = value;
            } else {
                const double s = std::sin(value), c = std::cos(value);
                moved.R = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
            }
            bodies_.push_back(bodies_[std::size_t(joint.parent + 1)] * (joint.T_parent_joint * moved));
        }
    }
};

// The pairs of a sphere that moves and a primitive that are nearer than a range, and those of two spheres
// that are nearer than another; the margin of the checks counts, what rounding costs does not.
class NearPairs {
  public:
    NearPairs(const RobotData& robot, const Scene& scene, const SceneData& data, double range,
              double link_range)
        : robot_(robot),
          scene_(scene),
          data_(data),
          range_(range),
          link_range_(link_range),
          margin_(double(scene.margin - robot.slack())),
          placed_(robot) {
        const auto spheres = robot.given_spheres();
        first_.assign(std::size_t(robot.view().n_links) + 1, 0);
        for (const Sphere& sphere : spheres) ++first_[std::size_t(sphere.link) + 1];
        for (std::size_t l = 1; l < first_.size(); ++l) first_[l] += first_[l - 1];
        gradient_.assign(std::size_t(robot.view().n_coordinates), 0.0);
    }

    // Calls visit(contact, distance, gradient of the distance) for each at q (dof,), in the same order
    // everywhere.
    template <class Visit>
    void visit(const double* q, const Visit& visit) {
        placed_.place(q);
        InterruptPoll poll(spheres_per_poll);
        const auto spheres = robot_.given_spheres();
        for (std::size_t s = 0; s < spheres.size(); ++s) {
            poll.step();
            if (robot_.view().links[spheres[s].link].body > 0) visit_primitives(s, visit);
        }
        for (const auto& [a, b] : robot_.given_pairs())
            for (std::size_t s = first_[std::size_t(a)]; s < first_[std::size_t(a) + 1]; ++s) {
                poll.step();
                for (std::size_t t = first_[std::size_t(b)]; t < first_[std::size_t(b) + 1]; ++t)
                    visit_spheres(s, t, visit);
            }
    }

  private:
    static constexpr std::uint32_t spheres_per_poll = 16;

    const RobotData& robot_;
    const Scene& scene_;
    const SceneData& data_;
    double range_, link_range_, margin_;
    PlacedSpheres placed_;
    std::vector<std::size_t> first_;  // sphere of each link
    std::vector<double> gradient_;

    std::span<double> clear_gradient() {
        gradient_.assign(gradient_.size(), 0.0);
        return gradient_;
    }
    template <class Visit>
    void visit_primitives(std::size_t s, const Visit& visit) {
        const Sphere& sphere = robot_.given_spheres()[s];
        const Vec3d& at = placed_.center(s);
        const double grown = sphere.radius + margin_, limit = range_ + grown;
        data_.visit_near(
            at, [&] { return limit; },
            [&](int i) {
                if (scene_.allowed && scene_.allowed[sphere.link * scene_.n + i]) return;
                const shapes::Distance d = data_.distance(i, at, limit);
                if (!(d.value < limit)) return;
                placed_.add_gradient(clear_gradient(), sphere.link, at, d.normal, 1);
                visit(Contact{sphere.link, i, false, 0}, d.value - grown, std::span<const double>(gradient_));
            });
    }
    template <class Visit>
    void visit_spheres(std::size_t s, std::size_t t, const Visit& visit) {
        const Sphere &one = robot_.given_spheres()[s], &other = robot_.given_spheres()[t];
        const Vec3d &a = placed_.center(s), &b = placed_.center(t);
        const double grown = one.radius + other.radius + margin_;
        const Vec3d apart = a - b;
        if (!(dot(apart, apart) < (link_range_ + grown) * (link_range_ + grown))) return;
        const shapes::Distance d = shapes::from_place(a, b, 0);
        const std::span<double> gradient = clear_gradient();
        placed_.add_gradient(gradient, one.link, a, d.normal, 1);
        placed_.add_gradient(gradient, other.link, b, d.normal, -1);
        visit(Contact{one.link, other.link, true, 0}, d.value - grown, std::span<const double>(gradient_));
    }
};

}  // namespace cspace::collision
