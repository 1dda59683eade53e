#include <cmath>
#include <limits>

#include "collision_checker.hpp"
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
        const auto spheres = robot_.given_spheres();
        for (std::size_t s = 0; s < spheres.size(); ++s) {
            const int link = spheres[s].link;
            const double r = spheres[s].radius;
            const auto limit = [&] { return result_.distance + r + tolerance::same_distance; };
            data_.visit_near(placed_.center(s), limit, [&](int i) {
                if (scene_.allowed && scene_.allowed[link * scene_.n + i]) return;
                const shapes::Distance d = data_.distance(i, placed_.center(s), limit());
                offer({link, i, false, 0}, d.value - r, d.normal, placed_.center(s), link, placed_.center(s),
                      -1);
            });
        }
        for (const auto& [a, b] : robot_.given_pairs())
            for (std::size_t s = 0; s < spheres.size(); ++s) {
                if (spheres[s].link != a) continue;
                for (std::size_t t = 0; t < spheres.size(); ++t) {
                    if (spheres[t].link != b) continue;
                    const shapes::Distance d = shapes::from_place(placed_.center(s), placed_.center(t), 0);
                    offer({a, b, true, 0}, d.value - spheres[s].radius - spheres[t].radius, d.normal,
                          placed_.center(s), a, placed_.center(t), b);
                }
            }
        return result_;
    }

  private:
    const RobotData& robot_;
    const Scene& scene_;
    const SceneData& data_;
    PlacedSpheres placed_;
    Clearance result_;

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
