// The spheres and solids of a robot at a configuration, in double: where they are, how they move with the
// coordinates, and what is near them.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "collision_near.hpp"
#include "collision_robot.hpp"
#include "cspace/collision/workspace.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/shapes/distance.hpp"
#include "shapes_distance.hpp"

namespace cspace::collision {

// A sphere of a link, or a convex solid that its spheres cover.
struct Part {
    int link, solid;  // solid −1: a sphere
    Vec3d center;
    double size;  // how far its places are from the centre
    shapes::Convex shape;
};

class PlacedParts {
  public:
    explicit PlacedParts(const RobotData& robot) : robot_(robot) {
        int last = -1;  // solid; its spheres come one after the other
        for (const Sphere& sphere : robot.given_spheres()) {
            if (sphere.solid < 0)
                add_part(sphere.link, -1, shapes::make_ball(sphere.center, sphere.radius));
            else if (sphere.solid != last)
                add_part(sphere.link, sphere.solid, robot.given_solids()[std::size_t(sphere.solid)]);
            last = sphere.solid;
        }
    }

    void place(const double* q) {
        place_bodies(q);
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const Posed& body = body_of(parts_[k].link);
            parts_[k].center = body * unplaced_[k].center;
            parts_[k].shape = shapes::move_solid(body, unplaced_[k].shape);
        }
    }
    // In the order of their links.
    std::span<const Part> parts() const { return parts_; }
    const Posed& body_of(int link) const { return bodies_[std::size_t(robot_.view().links[link].body)]; }

    // Adds sign times the derivative of normal · place of a place that a link carries, by the coordinates.
    void add_gradient(std::span<double> gradient, int link, const Vec3d& at, const Vec3d& normal,
                      double sign) const {
        const auto joints = robot_.given_joints();
        for (int b = robot_.view().links[link].body; b > 0; b = joints[std::size_t(b - 1)].parent + 1) {
            const model::Joint& joint = joints[std::size_t(b - 1)];
            const Posed& frame = bodies_[std::size_t(b)];
            const Vec3d z = matrix_column(frame.R, 2);
            const Vec3d rate = kinematics::joint_twist(joint.prismatic, z, frame.t, at).v;
            gradient[std::size_t(joint.coordinate)] += sign * joint.ratio * dot(normal, rate);
        }
    }

  private:
    const RobotData& robot_;
    std::vector<Posed> bodies_;
    std::vector<Part> unplaced_, parts_;

    void add_part(int link, int solid, const shapes::Convex& shape) {
        unplaced_.push_back({link, solid, shapes::find_center(shape), shapes::bound_size(shape), shape});
        parts_.push_back(unplaced_.back());
    }
    void place_bodies(const double* q) {
        bodies_.assign(1, identity_pose());
        for (const model::Joint& joint : robot_.given_joints()) {
            const double value = joint.ratio * q[joint.coordinate] + joint.offset;
            const Posed before = bodies_[std::size_t(joint.parent + 1)] * joint.T_parent_joint;
            bodies_.push_back(kinematics::move_joint(before, joint.prismatic, value));
        }
    }
};

// The pairs of a part that moves and a primitive that are nearer than a range, and those of two parts that
// are nearer than another; the margin of the checks counts, what rounding costs does not.
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
        first_.assign(std::size_t(robot.view().n_links) + 1, 0);
        for (const Part& part : placed_.parts()) ++first_[std::size_t(part.link) + 1];
        for (std::size_t l = 1; l < first_.size(); ++l) first_[l] += first_[l - 1];
        gradient_.assign(std::size_t(robot.view().n_coordinates), 0.0);
    }

    // Calls visit(contact, distance, gradient of the distance) for each at q (dof,), in the same order
    // everywhere.
    template <class Visit>
    void visit(const double* q, const Visit& visit) {
        placed_.place(q);
        InterruptPoll poll(parts_per_poll);
        const std::span<const Part> parts = placed_.parts();
        for (const Part& part : parts) {
            poll.step();
            if (robot_.view().links[part.link].body > 0) visit_primitives(part, visit);
        }
        for (const auto& [a, b] : robot_.given_pairs())
            for (std::size_t s = first_[std::size_t(a)]; s < first_[std::size_t(a) + 1]; ++s) {
                poll.step();
                for (std::size_t t = first_[std::size_t(b)]; t < first_[std::size_t(b) + 1]; ++t)
                    visit_parts(parts[s], parts[t], visit);
            }
    }

  private:
    static constexpr std::uint32_t parts_per_poll = 16;

    const RobotData& robot_;
    const Scene& scene_;
    const SceneData& data_;
    double range_, link_range_, margin_;
    PlacedParts placed_;
    std::vector<std::size_t> first_;  // part of each link
    std::vector<double> gradient_;

    std::span<double> clear_gradient() {
        gradient_.assign(gradient_.size(), 0.0);
        return gradient_;
    }
    // Of a solid that touches a mesh, the distance of its centre stands for how deep it is.
    shapes::ConvexDistance measure(const Part& part, int i, double limit) const {
        if (part.solid >= 0)
            if (const auto found = data_.distance(i, part.shape, limit)) return *found;
        const shapes::Distance d = data_.distance(i, part.center, limit + part.size);
        const double value = d.value - part.size;
        return {part.solid < 0 ? value : std::fmin(value, 0.0), d.normal, part.center, part.center};
    }
    template <class Visit>
    void visit_primitives(const Part& part, const Visit& visit) {
        const double limit = range_ + margin_;
        visit_near(
            data_, part.center, [&] { return limit + part.size; },
            [&](int i) {
                if (scene_.allowed && scene_.allowed[part.link * scene_.n + i]) return;
                const shapes::ConvexDistance d = measure(part, i, limit);
                if (!(d.value < limit)) return;
                placed_.add_gradient(clear_gradient(), part.link, d.first, d.normal, 1);
                visit(Contact{part.link, i, false, 0}, d.value - margin_, std::span<const double>(gradient_));
            });
    }
    template <class Visit>
    void visit_parts(const Part& one, const Part& other, const Visit& visit) {
        const double limit = link_range_ + margin_, reach = limit + one.size + other.size;
        const Vec3d apart = one.center - other.center;
        if (!(dot(apart, apart) < reach * reach)) return;
        const shapes::ConvexDistance d = measure_pair(one, other);
        if (!(d.value < limit)) return;
        const std::span<double> gradient = clear_gradient();
        placed_.add_gradient(gradient, one.link, d.first, d.normal, 1);
        placed_.add_gradient(gradient, other.link, d.second, d.normal, -1);
        visit(Contact{one.link, other.link, true, 0}, d.value - margin_, std::span<const double>(gradient_));
    }
    static shapes::ConvexDistance measure_pair(const Part& one, const Part& other) {
        if (one.solid >= 0 || other.solid >= 0) return shapes::measure_distance(one.shape, other.shape);
        const shapes::Distance d = shapes::from_place(one.center, other.center, 0);
        return {d.value - one.size - other.size, d.normal, one.center, other.center};
    }
};

}  // namespace cspace::collision
