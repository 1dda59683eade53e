#include <cmath>
#include <limits>

#include "collision_checker.hpp"
#include "cspace/kinematics/jacobian.hpp"
#include "cspace/shapes/convex_distance.hpp"
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

// A sphere of a link, or a convex solid that its spheres cover.
struct Part {
    int link, solid;  // solid −1: a sphere
    Vec3d center;
    double size;  // how far its places are from the centre
    shapes::Convex shape;
};

class Search {
  public:
    Search(const RobotData& robot, const Scene& scene, const SceneData& data, const double* q)
        : robot_(robot), scene_(scene), data_(data), bodies_(place_bodies(robot.given_joints(), q)) {
        list_parts();
        result_.distance = std::numeric_limits<double>::infinity();
        result_.gradient.assign(std::size_t(robot.view().n_coordinates), 0.0);
    }

    Clearance run() {
        for (const Part& part : parts_)
            data_.visit_near(
                part.center, [&] { return limit() + part.size; },
                [&](int i) {
                    if (scene_.allowed && scene_.allowed[part.link * scene_.n + i]) return;
                    if (part.solid < 0)
                        offer_sphere(part.link, part.center, part.size, i);
                    else
                        offer_solid(part, i);
                });
        for (const auto& [a, b] : robot_.given_pairs())
            for (const Part& one : parts_) {
                if (one.link != a) continue;
                for (const Part& other : parts_)
                    if (other.link == b) offer_pair(one, other);
            }
        return result_;
    }

  private:
    const RobotData& robot_;
    const Scene& scene_;
    const SceneData& data_;
    std::vector<Posed> bodies_;
    std::vector<Part> parts_;
    Clearance result_;

    void list_parts() {
        int last = -1;  // solid; its spheres come one after the other
        for (const Sphere& sphere : robot_.given_spheres()) {
            const Posed& body = bodies_[std::size_t(body_of(sphere.link))];
            if (sphere.solid < 0) {
                const Vec3d center = body * sphere.center;
                parts_.push_back(
                    {sphere.link, -1, center, sphere.radius, shapes::make_ball(center, sphere.radius)});
            } else if (sphere.solid != last) {
                const shapes::Convex solid =
                    shapes::move_solid(body, robot_.given_solids()[std::size_t(sphere.solid)]);
                parts_.push_back({sphere.link, sphere.solid, shapes::find_center(solid),
                                  shapes::bound_size(solid), solid});
            }
            last = sphere.solid;
        }
    }

    double limit() const { return result_.distance + tolerance::same_distance; }
    void offer_sphere(int link, const Vec3d& center, double r, int i) {
        const shapes::Distance d = data_.distance(i, center, limit() + r);
        offer({link, i, false, 0}, d.value - r, d.normal, center, link, center, -1);
    }
    // Where the solid touches a mesh, its cover tells how deep.
    void offer_solid(const Part& part, int i) {
        if (const auto d = data_.distance(i, part.shape, limit()))
            return offer({part.link, i, false, 0}, d->value, d->normal, d->first, part.link, d->first, -1);
        const Posed& body = bodies_[std::size_t(body_of(part.link))];
        for (const Sphere& sphere : robot_.given_spheres())
            if (sphere.solid == part.solid) offer_sphere(part.link, body * sphere.center, sphere.radius, i);
    }
    void offer_pair(const Part& a, const Part& b) {
        const Contact pair = {a.link, b.link, true, 0};
        const shapes::Distance d = shapes::from_place(a.center, b.center, 0);
        const double least = d.value - a.size - b.size;
        if (a.solid < 0 && b.solid < 0)
            return offer(pair, least, d.normal, a.center, a.link, b.center, b.link);
        if (least > limit()) return;
        const shapes::ConvexDistance found = shapes::measure_distance(a.shape, b.shape);
        offer(pair, found.value, found.normal, found.first, a.link, found.second, b.link);
    }

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
