#include <cmath>
#include <limits>

#include "collision_checker.hpp"
#include "collision_near.hpp"
#include "collision_placed.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::collision {

namespace {

class Search {
  public:
    Search(const RobotData& robot, const Scene& scene, const SceneData& data, const double* q)
        : robot_(robot), scene_(scene), data_(data), placed_(robot) {
        placed_.place(q);
        result_.distance = std::numeric_limits<double>::infinity();
        result_.gradient.assign(std::size_t(robot.view().n_coordinates), 0.0);
    }

    Clearance run() {
        for (const Part& part : placed_.parts())
            visit_near(
                data_, part.center, [&] { return limit() + part.size; },
                [&](int i) {
                    if (scene_.allowed && scene_.allowed[part.link * scene_.n + i]) return;
                    if (part.solid < 0)
                        offer_sphere(part.link, part.center, part.size, i);
                    else
                        offer_solid(part, i);
                });
        for (const auto& [a, b] : robot_.given_pairs())
            for (const Part& one : placed_.parts()) {
                if (one.link != a) continue;
                for (const Part& other : placed_.parts())
                    if (other.link == b) offer_pair(one, other);
            }
        return result_;
    }

  private:
    const RobotData& robot_;
    const Scene& scene_;
    const SceneData& data_;
    PlacedParts placed_;
    Clearance result_;

    double limit() const { return result_.distance + tolerance::same_distance; }
    void offer_sphere(int link, const Vec3d& center, double r, int i) {
        const shapes::Distance d = data_.distance(i, center, limit() + r);
        offer({link, i, false, 0}, d.value - r, d.normal, center, link, center, -1);
    }
    // Where the solid touches a mesh, its cover tells how deep.
    void offer_solid(const Part& part, int i) {
        if (const auto d = data_.distance(i, part.shape, limit()))
            return offer({part.link, i, false, 0}, d->value, d->normal, d->first, part.link, d->first, -1);
        const Posed& body = placed_.body_of(part.link);
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

    void offer(const Contact& pair, double distance, const Vec3d& normal, const Vec3d& at, int link,
               const Vec3d& other_at, int other) {
        const double band = tolerance::same_distance;
        if (distance > result_.distance + band) return;
        std::vector<double> gradient(result_.gradient.size(), 0.0);
        placed_.add_gradient(gradient, link, at, normal, 1);
        if (other >= 0) placed_.add_gradient(gradient, other, other_at, normal, -1);
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
