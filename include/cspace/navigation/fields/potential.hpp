// An artificial potential (Khatib 1986): the goal attracts, with ½ k d² near it and a cone beyond, and every
// boundary loop nearer than rho_0 repels with ½ k_r (1/ρ − 1/ρ₀)².
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cspace/navigation/fields/near_walls.hpp"
#include "cspace/search/gains.hpp"

namespace cspace::navigation {

using search::Gains;

// A symmetric matrix [xx xy; xy yy] that is nowhere negative.
struct Stiffness {
    double xx = 0, xy = 0, yy = 0;

    // scale · n nᵀ
    void add(double scale, Point n) {
        xx += scale * n.x * n.x;
        xy += scale * n.x * n.y;
        yy += scale * n.y * n.y;
    }
};

// A few points.
class FewPoints {
  public:
    static constexpr std::size_t most = 6;
    void push_back(Point p) { points_[size_++] = p; }
    std::size_t size() const { return size_; }
    Point operator[](std::size_t k) const { return points_[k]; }
    operator std::span<const Point>() const { return {points_, size_}; }

  private:
    Point points_[most];
    std::size_t size_ = 0;
};

// The point nearest to zero of all that lie between points.
inline Point nearest_to_zero(std::span<const Point> points) {
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
        Stiffness stiffness;  // of the goal, and of walls along the way to their nearest places: what is
                              // positive in the second derivative
    };
    // slack: by how much farther than its nearest place a ring's places count for the slope.
    Look look(Point p, double slack) const {
        gather(p);
        Look seen{gains_.attraction(distance(p, goal_)), attraction_slope(p), gains_.rho_0, false,
                  attraction_stiffness(p)};
        pulls_.clear();
        for (std::size_t i = 0; i < places_.size();) {
            std::size_t end = i;
            double rho = places_[i].rho;
            for (; end < places_.size() && places_[end].ring == places_[i].ring; ++end)
                rho = std::min(rho, places_[end].rho);
            seen.clearance = std::min(seen.clearance, rho);
            seen.value += gains_.repulsion(rho);
            Pull& pull = pulls_.emplace_back();
            for (; i < end; ++i)
                if (places_[i].rho <= rho + slack && pull.choices.size() < FewPoints::most) {
                    pull.choices.push_back(gains_.repulsion_rate(places_[i].rho) * places_[i].away);
                    seen.stiffness.add(gains_.repulsion_stiffness(places_[i].rho), places_[i].away);
                }
            if (pull.choices.size() > 1) seen.is_crease = true;
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
        FewPoints choices;
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
    Stiffness attraction_stiffness(Point p) const {
        const double d = distance(p, goal_);
        if (d < gains_.cone) return {gains_.k, 0, gains_.k};
        Stiffness across;
        across.add(gains_.k * gains_.cone / d, (1 / d) * Point{goal_.y - p.y, p.x - goal_.x});
        return across;
    }
    void gather(Point p) const {
        places_.clear();
        const double reach = gains_.rho_0 * gains_.rho_0 * (1 + tolerance::exact);
        walls_.visit(p, [&](std::int32_t e) {
            const NearWalls::Wall& wall = walls_.wall(e);
            const Point d = p - wall.begin;
            const double reached = dot(d, wall.along);
            Point foot = wall.begin;
            if (reached > 0) {
                // The next wall begins at its end and is treated in the same way.
                if (squared_norm(wall.along) * reach < cross(wall.along, d) * cross(wall.along, d) ||
                    dot(p - wall.end, wall.along) >= 0)
                    return;
                foot = wall.begin + (reached / squared_norm(wall.along)) * wall.along;
            } else if (squared_norm(d) > reach || dot(d, wall.before) < 0) {
                return;
            }
            const double rho = distance(p, foot);
            if (rho < gains_.rho_0) put({wall.ring, rho, rho > 0 ? (1 / rho) * (p - foot) : Point{}});
        });
    }
    // In the order of rings, behind those of the same.
    void put(const Place& place) const {
        std::size_t k = places_.size();
        places_.push_back(place);
        for (; k > 0 && place.ring < places_[k - 1].ring; --k) places_[k] = places_[k - 1];
        places_[k] = place;
    }
    // Ring by ring the choice that makes the sum least, until that settles.
    Point least_slope(Point sum) const {
        for (Pull& pull : pulls_) {
            pull.chosen = pull.choices[0];
            sum = sum + pull.chosen;
        }
        if (std::none_of(pulls_.begin(), pulls_.end(), [](const Pull& p) { return p.choices.size() > 1; }))
            return sum;
        for (int round = 0; round < 8; ++round) {
            const Point before = sum;
            for (Pull& pull : pulls_) {
                if (pull.choices.size() < 2) continue;
                FewPoints sums;
                for (std::size_t k = 0; k < pull.choices.size(); ++k)
                    sums.push_back(sum - pull.chosen + pull.choices[k]);
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
