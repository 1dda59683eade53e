// An artificial potential (Khatib 1986): the goal attracts, with ½ k d² near it and a cone beyond, and every
// ring of walls nearer than rho_0 repels with ½ k_r (1/ρ − 1/ρ₀)².
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/navigation/fields/near_walls.hpp"

namespace cspace::navigation {

struct Gains {
    double k = 1, k_r = 1;
    double rho_0 = 1;  // how far walls repel [m]
    double cone = 1;   // from how far on the goal attracts with the same force [m]

    double attraction(double d) const { return d < cone ? 0.5 * k * d * d : k * cone * (d - 0.5 * cone); }
    double repulsion(double rho) const {
        const double near = rho < rho_0 ? 1 / rho - 1 / rho_0 : 0;
        return 0.5 * k_r * near * near;
    }
    // By how much it grows with the distance: not at all, or less than nothing.
    double repulsion_rate(double rho) const {
        return rho < rho_0 ? -k_r * (1 / rho - 1 / rho_0) / (rho * rho) : 0;
    }
};

// The point nearest to zero of all that lie between points, few of them.
inline Point nearest_to_zero(const std::vector<Point>& points) {
    Point best = points[0];
    const auto offer = [&](Point p) {
        if (squared_norm(p) < squared_norm(best)) best = p;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        offer(points[i]);
        for (std::size_t j = 0; j < i; ++j) {
            const Point a = points[i], along = points[j] - a;
            const double length = squared_norm(along);
            if (length > 0) offer(a + std::clamp(-dot(a, along) / length, 0.0, 1.0) * along);
            for (std::size_t k = 0; k < j; ++k) {
                const double u = cross(points[i], points[j]), v = cross(points[j], points[k]),
                             w = cross(points[k], points[i]);
                if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) return {0, 0};
            }
        }
    }
    return best;
}

class Potential {
  public:
    Potential(const NearWalls& walls, const Gains& gains, Point goal)
        : walls_(walls), gains_(gains), goal_(goal) {}

    struct Look {
        double value = 0;
        Point slope;       // the gradient; where several places of a ring are nearest, the least of those
                           // between theirs: it leads along the crease
        double clearance;  // to the nearest wall, or rho_0 if that is nearer
        bool is_crease = false;
    };
    // slack: by how much farther than its nearest place a ring's places count for the slope.
    Look look(Point p, double slack) const {
        gather(p);
        Look seen{gains_.attraction(distance(p, goal_)), attraction_slope(p), gains_.rho_0};
        pulls_.clear();
        for (std::size_t i = 0; i < places_.size();) {
            std::size_t end = i;
            double rho = places_[i].rho;
            for (; end < places_.size() && places_[end].ring == places_[i].ring; ++end)
                rho = std::min(rho, places_[end].rho);
            seen.clearance = std::min(seen.clearance, rho);
            seen.value += gains_.repulsion(rho);
            Pull pull;
            for (; i < end; ++i)
                if (places_[i].rho <= rho + slack && pull.choices.size() < 6)
                    pull.choices.push_back(gains_.repulsion_rate(places_[i].rho) * places_[i].away);
            if (pull.choices.size() > 1) seen.is_crease = true;
            pulls_.push_back(std::move(pull));
        }
        seen.slope = least_slope(seen.slope);
        return seen;
    }
    double value(Point p) const { return look(p, 0).value; }
    const Gains& gains() const { return gains_; }
    Point goal() const { return goal_; }

  private:
    struct Place {  // of a ring, nearer than those beside it
        std::int32_t ring;
        double rho;
        Point away;  // from it to the point, of length 1
    };
    struct Pull {
        std::vector<Point> choices;
        Point chosen;
    };
    const NearWalls& walls_;
    Gains gains_;
    Point goal_;
    mutable std::vector<Place> places_;
    mutable std::vector<Pull> pulls_;

    Point attraction_slope(Point p) const {
        const Point d = p - goal_;
        return (gains_.k * std::min(1.0, gains_.cone / std::max(norm(d), gains_.cone))) * d;
    }
    void gather(Point p) const {
        const maps::Boundary& walls = walls_.walls();
        places_.clear();
        walls_.visit(p, [&](std::int32_t e) {
            const Point a = walls.begin(e), along = walls.end(e) - a;
            // Its end is the beginning of the next wall, which asks the same question.
            if (dot(p - walls.end(e), along) >= 0) return;
            const double reached = dot(p - a, along);
            Point foot = a;
            if (reached > 0)
                foot = a + (reached / squared_norm(along)) * along;
            else if (const Point before = a - walls.begin(walls_.previous(e)); dot(p - a, before) < 0)
                return;
            const double rho = distance(p, foot);
            if (rho < gains_.rho_0)
                places_.push_back(
                    {walls.ring[std::size_t(e)], rho, rho > 0 ? (1 / rho) * (p - foot) : Point{}});
        });
        std::stable_sort(places_.begin(), places_.end(),
                         [](const Place& x, const Place& y) { return x.ring < y.ring; });
    }
    // Ring by ring the choice that makes the sum least, until that settles.
    Point least_slope(Point sum) const {
        for (Pull& pull : pulls_) {
            pull.chosen = pull.choices[0];
            sum = sum + pull.chosen;
        }
        std::vector<Point> sums;
        for (int round = 0; round < 8; ++round) {
            const Point before = sum;
            for (Pull& pull : pulls_) {
                if (pull.choices.size() < 2) continue;
                sums.clear();
                for (const Point choice : pull.choices) sums.push_back(sum - pull.chosen + choice);
                const Point least = nearest_to_zero(sums);
                pull.chosen = pull.chosen + least - sum;
                sum = least;
            }
            if (sum == before) break;
        }
        return sum;
    }
};

}  // namespace cspace::navigation
