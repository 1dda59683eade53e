// The navigation function of a sphere world (Koditschek & Rimon 1990; Rimon & Koditschek 1992), in
// logarithms.
//
// A sphere world is a disc without the discs in it. Its navigation function is φ = γ / (γ^κ + β)^(1/κ) with γ
// the squared distance to the goal and β the product of what is left to each disc; φ grows with V = κ log γ −
// Σ log β_i, which neither overflows nor rounds to one. Every summand of V depends on the distance to one
// point, and so has derivatives of every order that are easily bounded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::navigation {

struct Disc {
    Point center;
    double radius = 0;
};

struct SphereWorld {
    Disc room;
    std::vector<Disc> obstacles;

    // What is left to the nearest wall; negative outside free space.
    double clearance(Point p) const {
        double least = room.radius - distance(p, room.center);
        for (const Disc& disc : obstacles) least = std::min(least, distance(p, disc.center) - disc.radius);
        return least;
    }
};

struct Curvature {  // a symmetric matrix
    double xx = 0, xy = 0, yy = 0;

    double along(Point u) const { return u.x * u.x * xx + 2 * u.x * u.y * xy + u.y * u.y * yy; }
    double least() const { return 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy); }
    // The direction of the least eigenvalue, of length one.
    Point down() const {
        const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
        return {-std::sin(angle), std::cos(angle)};
    }
    Point solve(Point b) const { return solve_two({xx, xy}, {xy, yy}, b.x, b.y); }
};

// weight · log |ρ² − s²| of the distance ρ to a point: a disc of radius s, the room around, or the goal with
// s = 0.
struct LogTerm {
    Point center;
    double s = 0, weight = 0;
    bool is_room = false;

    double left(double rho) const { return (rho - s) * (rho + s); }
    double value(Point p) const { return weight * std::log(std::abs(left(distance(p, center)))); }
    Point slope(Point p) const { return (2 * weight / left(distance(p, center))) * (p - center); }
    Curvature curvature(Point p) const {
        const Point d = p - center;
        const double beta = left(norm(d)), across = 2 * weight / beta, more = -4 * weight / (beta * beta);
        return {across + more * d.x * d.x, more * d.x * d.y, across + more * d.y * d.y};
    }

    // Bounds over the disc of radius h around a point at the distance rho, where it lies in free space.
    double nearest(double rho, double h) const { return is_room ? rho + h : std::max(rho - h, 0.0); }
    double farthest(double rho, double h) const { return is_room ? std::max(rho - h, 0.0) : rho + h; }
    bool is_outside(double rho, double h) const { return is_room ? rho - h >= s : rho + h <= s; }
    bool is_regular(double rho, double h) const { return is_room ? rho + h < s : rho - h > s; }
    double least_slope(double rho, double h) const {
        const double r = farthest(rho, h);
        return std::abs(2 * weight * r / left(r));
    }
    double most_curvature(double rho, double h) const {
        const double r = nearest(rho, h), beta = left(r);
        return std::abs(weight) * 2 * (r * r + s * s) / (beta * beta);
    }
    double most_third(double rho, double h) const {
        const double r = nearest(rho, h), beta = std::abs(left(r));
        return std::abs(weight) *
               (4 * r * (r * r + 3 * s * s) / (beta * beta * beta) + 12 * r / (beta * beta));
    }
};

class SpherePotential {
  public:
    SpherePotential(const SphereWorld& world, Point goal, double kappa) : kappa_(kappa), goal_(goal) {
        terms_.push_back({goal, 0, kappa, false});
        terms_.push_back({world.room.center, world.room.radius, -1, true});
        for (const Disc& disc : world.obstacles) terms_.push_back({disc.center, disc.radius, -1, false});
        // In units of the room's radius, so that φ does not depend on the unit of length.
        shift_ = -2 * std::log(world.room.radius) * (kappa - double(terms_.size() - 1));
    }

    double kappa() const { return kappa_; }
    Point goal() const { return goal_; }
    const std::vector<LogTerm>& terms() const { return terms_; }

    double value(Point p) const {
        double sum = shift_;
        for (const LogTerm& term : terms_) sum += term.value(p);
        return sum;
    }
    // φ from V, without overflow: (e^V / (1 + e^V))^(1/κ).
    double phi(double v) const {
        const double log_share = v > 0 ? -std::log1p(std::exp(-v)) : v - std::log1p(std::exp(v));
        return std::exp(log_share / kappa_);
    }
    Point slope(Point p) const {
        Point sum;
        for (const LogTerm& term : terms_) sum = sum + term.slope(p);
        return sum;
    }
    Curvature curvature(Point p) const {
        Curvature sum;
        for (const LogTerm& term : terms_) {
            const Curvature one = term.curvature(p);
            sum = {sum.xx + one.xx, sum.xy + one.xy, sum.yy + one.yy};
        }
        return sum;
    }
    // How fast the slope can change at a point.
    double stiffness(Point p) const {
        double sum = 0;
        for (const LogTerm& term : terms_) sum += term.most_curvature(distance(p, term.center), 0);
        return sum;
    }

  private:
    double kappa_, shift_ = 0;
    Point goal_;
    std::vector<LogTerm> terms_;
};

}  // namespace cspace::navigation
