// A proof that the potential of a sphere world has no minimum but the goal, by subdivision.
//
// Each square is settled by one of: it lies outside free space; the slope at its centre is more than what it
// can change to its corners; one summand is stronger than all others together; there is a direction in which
// V curves down all over it. Minima would have none of these. Saddles are found on the way, by Newton's
// method.
#pragma once

#include <numbers>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/sphere_world.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

struct SingleMinimum {
    enum Verdict { proven, refuted, open } verdict = open;
    Point minimum;  // that refutes it
    std::vector<Point> saddles;
    std::int64_t squares = 0;
};

class MinimumProof {
  public:
    explicit MinimumProof(const SpherePotential& potential)
        : potential_(potential), terms_(potential.terms()) {}

    // Whether there is a minimum but the goal near a point.
    bool is_refuted_near(Point m) {
        is_minimum_near(m, 0.02 * terms_[1].s);
        return proof_.verdict == SingleMinimum::refuted;
    }
    SingleMinimum run(std::int64_t most_squares) {
        const LogTerm& room = terms_[1];
        std::vector<Square> waiting{{room.center, room.s}};
        InterruptPoll poll(16);
        while (!waiting.empty()) {
            poll.step();
            if (++proof_.squares > most_squares) return std::move(proof_);
            const Square square = waiting.back();
            waiting.pop_back();
            if (is_settled(square)) continue;
            if (proof_.verdict == SingleMinimum::refuted) return std::move(proof_);
            const double half = 0.5 * square.half;
            for (const double x : {-half, half})
                for (const double y : {-half, half}) waiting.push_back({square.middle + Point{x, y}, half});
        }
        proof_.verdict = SingleMinimum::proven;
        return std::move(proof_);
    }

  private:
    struct Square {
        Point middle;
        double half;
    };
    static constexpr double slack = 1 + tolerance::widening;  // of bounds, against rounding
    static constexpr double settled = 1e-13;                  // step of Newton's, of the room: rounding alone
    static constexpr double same_saddle = 1e-7;  // of the room: where the slope is rounding, not its zero
    const SpherePotential& potential_;
    const std::vector<LogTerm>& terms_;
    SingleMinimum proof_;

    bool is_settled(const Square& square) {
        const Point m = square.middle;
        const double h = std::numbers::sqrt2 * square.half * slack;
        std::size_t strongest = 0;
        double most = -1, changes = 0;
        bool is_regular = true;
        for (std::size_t k = 0; k < terms_.size(); ++k) {
            const double rho = distance(m, terms_[k].center);
            if (terms_[k].is_outside(rho, h)) return true;
            const double change = terms_[k].is_regular(rho, h) ? terms_[k].most_curvature(rho, h)
                                                               : std::numeric_limits<double>::infinity();
            is_regular = is_regular && std::isfinite(change);
            changes += change;
            if (change > most) most = change, strongest = k;
        }
        if (is_regular && norm(potential_.slope(m)) > h * changes * slack + noise(m)) return true;
        if (is_dominated(m, h, strongest)) return true;
        return is_regular && (curves_down(m, h) || is_minimum_near(m, square.half));
    }
    double noise(Point m) const {
        double sum = 0;
        for (const LogTerm& term : terms_) sum += norm(term.slope(m));
        return tolerance::exact * sum;
    }
    // Whether one summand pushes harder than all others together.
    bool is_dominated(Point m, double h, std::size_t strongest) const {
        Point others;
        double change = 0, noise = 0;
        for (std::size_t k = 0; k < terms_.size(); ++k) {
            if (k == strongest) continue;
            const double rho = distance(m, terms_[k].center);
            if (!terms_[k].is_regular(rho, h)) return false;
            const Point slope = terms_[k].slope(m);
            others = others + slope;
            noise += tolerance::exact * norm(slope);
            change += terms_[k].most_curvature(rho, h);
        }
        const LogTerm& one = terms_[strongest];
        return one.least_slope(distance(m, one.center), h) > (norm(others) + h * change) * slack + noise;
    }
    bool curves_down(Point m, double h) {
        const Curvature bend = potential_.curvature(m);
        const double least = bend.least();
        if (!(least < 0)) return false;
        double change = 0, noise = 0;
        for (const LogTerm& term : terms_) {
            const double rho = distance(m, term.center);
            change += term.most_third(rho, h);
            noise += tolerance::exact * term.most_curvature(rho, 0);
        }
        if (!(least + h * change * slack + noise < 0)) return false;
        note_saddle(m, h);
        return true;
    }
    // Newton's method from m, which must not go farther than a distance: where the slope is nothing.
    bool is_flat_near(Point m, double far, Point& at) const {
        at = m;
        for (int k = 0; k < 30; ++k) {
            const Point step = potential_.curvature(at).solve(potential_.slope(at));
            at = at - step;
            if (!(distance(at, m) <= far)) return false;
            if (norm(step) <= settled * terms_[1].s) return norm(potential_.slope(at)) <= 1e6 * noise(at);
        }
        return false;
    }
    bool is_free(Point p) const {
        return std::all_of(terms_.begin(), terms_.end(),
                           [&](const LogTerm& term) { return term.is_regular(distance(p, term.center), 0); });
    }
    void note_saddle(Point m, double h) {
        Point at;
        if (!is_flat_near(m, 2 * h, at)) return;
        for (const Point other : proof_.saddles)
            if (distance(other, at) <= same_saddle * terms_[1].s) return;
        if (is_free(at) && potential_.curvature(at).least() < 0) proof_.saddles.push_back(at);
    }
    bool is_minimum_near(Point m, double half) {
        Point at;
        if (potential_.curvature(m).least() > 0 && is_flat_near(m, 4 * half, at) &&
            potential_.curvature(at).least() > 0 && is_free(at) &&
            distance(at, terms_[0].center) > tolerance::widening * terms_[1].s)
            proof_.verdict = SingleMinimum::refuted, proof_.minimum = at;
        return false;
    }
};

// The least power of two for κ with which the goal is proven to be the only minimum.
struct Tuned {
    double kappa = 0;  // zero: none was
    SingleMinimum proof;
};
inline Tuned tune_kappa(const SphereWorld& world, Point goal, std::int64_t most_squares) {
    constexpr double most_kappa = 65536;
    Point refuted = world.room.center;  // where the last power had another minimum: the next may, too
    for (double kappa = 2; kappa <= most_kappa; kappa *= 2) {
        const SpherePotential potential(world, goal, kappa);
        MinimumProof attempt(potential);
        if (kappa > 2 && attempt.is_refuted_near(refuted)) continue;
        SingleMinimum proof = attempt.run(most_squares);
        if (proof.verdict == SingleMinimum::proven) return {kappa, std::move(proof)};
        refuted = proof.minimum;
    }
    return {};
}

}  // namespace cspace::navigation
