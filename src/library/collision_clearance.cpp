#include <cmath>
#include <limits>

#include "collision_checker.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/shapes/distance.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::collision {

namespace {

std::vector<Posed> place_bodies(std::span<const model::Joint> joints, const double* q) {
    std::vector<Posed> bodies = {identity_pose()};
    for (const model::Joint& joint : joints) {
        const double value = joint.ratio * q[joint.coordinate] + joint.offset;
        Posed moved = identity_pose();
        if (joint.prismatic) {
            moved.t.z = value;
        } else {
            const double s = std::sin(value), c = std::cos(value);
            moved.R = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
        }
        bodies.push_back(bodies[std::size_t(joint.parent + 1)] * (joint.T_parent_joint * moved));
    }
    return bodies;
}

class Search {
  public:
    Search(const RobotData& robot, const Scene& scene, const SceneData& data, const double* q)
        : robot_(robot), scene_(scene), data_(data), bodies_(place_bodies(robot.given_joints(), q)) {
        for (const Sphere& sphere : robot.given_spheres())
            centers_.push_back(bodies_[std::size_t(body_of(sphere.link))] * sphere.center);
        result_.distance = std::numeric_limits<double>::infinity();
        result_.gradient.assign(std::size_t(robot.view().n_coordinates), 0.0);
    }

    Clearance run() {
        const auto spheres = robot_.given_spheres();
        for (std::size_t s = 0; s < spheres.size(); ++s) {
            const int link = spheres[s].link;
            const double r = spheres[s].radius;
            const auto limit = [&] { return result_.distance + r + tolerance::same_distance; };
            data_.visit_near(centers_[s], limit, [&](int i) {
                if (scene_.allowed && scene_.allowed[link * scene_.n + i]) return;
                const shapes::Distance d = data_.distance(i, centers_[s], limit());
                offer({link, i, false, 0}, d.value - r, d.normal, centers_[s], link, centers_[s], -1);
            });
        }
        for (const auto& [a, b] : robot_.given_pairs())
            for (std::size_t s = 0; s < spheres.size(); ++s) {
                if (spheres[s].link != a) continue;
                for (std::size_t t = 0; t < spheres.size(); ++t) {
                    if (spheres[t].link != b) continue;
                    const shapes::Distance d = shapes::from_place(centers_[s], centers_[t], 0);
                    offer({a, b, true, 0}, d.value - spheres[s].radius - spheres[t].radius, d.normal,
                          centers_[s], a, centers_[t], b);
                }
            }
        return result_;
    }

  private:
    const RobotData& robot_;
    const Scene& scene_;
    const SceneData& data_;
    std::vector<Posed> bodies_;
    std::vector<Vec3d> centers_;
    Clearance result_;

    int body_of(int link) const { return robot_.view().links[link].body; }

    void add_gradient(std::vector<double>& gradient, int link, const Vec3d& at, const Vec3d& normal,
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
    void offer(const Contact& pair, double distance, const Vec3d& normal, const Vec3d& at, int link,
               const Vec3d& other_at, int other) {
        const double band = tolerance::same_distance;
        if (distance > result_.distance + band) return;
        std::vector<double> gradient(result_.gradient.size(), 0.0);
        add_gradient(gradient, link, at, normal, 1);
        if (other >= 0) add_gradient(gradient, other, other_at, normal, -1);
        double apart = 0;
        for (std::size_t k = 0; k < gradient.size(); ++k)
            apart = std::fmax(apart, std::fabs(gradient[k] - result_.gradient[k]));
        const bool is_tie = std::fabs(distance - result_.distance) <= band;
        const bool is_crease = is_tie && (result_.is_crease || apart > tolerance::same_gradient);
        if (distance < result_.distance)
            result_ = {distance, pair, std::move(gradient), is_crease};
        else
            result_.is_crease = is_crease;
    }
};

}  // namespace

Clearance Checker::clearance(const double* q) const { return Search(*robot_, scene_, *data_, q).run(); }

}  // namespace cspace::collision
