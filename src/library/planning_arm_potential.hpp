// The artificial potential of an arm (Khatib 1986) over its coordinates.
//
// The goal attracts by the distance of the joints (L2 norm), joints that wrap the short way. Every sphere that
// a joint moves is a control point: each obstacle, and each sphere of a link that it is checked against,
// repels it while nearer than rho_0. A force at a sphere acts on the joints by the transpose of its Jacobian,
// which is the gradient of the distance.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "collision_checker.hpp"
#include "collision_placed.hpp"
#include "cspace/math/wrapping.hpp"
#include "cspace/planning/descent.hpp"
#include "cspace/search/gains.hpp"
#include "planning_arm.hpp"

namespace cspace::planning {

// The goals of a potential: rows (g, dof).
class GoalRows {
  public:
    GoalRows(const ArmSpace& space, std::vector<double> rows)
        : width_(std::size_t(space.checker.dof())), wraps_(space.wraps), rows_(std::move(rows)) {}

    std::size_t width() const { return width_; }
    std::size_t size() const { return rows_.size() / width_; }
    bool is_wrapping(std::size_t k) const { return !wraps_.empty() && wraps_[k]; }
    // From q to a goal in one coordinate, the short way.
    double difference(std::size_t goal, std::size_t k, double q) const {
        const double d = rows_[goal * width_ + k] - q;
        return is_wrapping(k) ? short_way(d) : d;
    }
    template <class S>
    double distance(std::size_t goal, const S* q) const {
        double sum = 0;
        for (std::size_t k = 0; k < width_; ++k) {
            const double d = difference(goal, k, double(q[k]));
            sum += d * d;
        }
        return std::sqrt(sum);
    }
    // The nearest goal and its distance; of equally near ones the first.
    template <class S>
    std::pair<std::size_t, double> find_nearest(const S* q) const {
        std::pair<std::size_t, double> best = {0, std::numeric_limits<double>::infinity()};
        for (std::size_t i = 0; i < size(); ++i)
            if (const double d = distance(i, q); d < best.second) best = {i, d};
        return best;
    }

  private:
    std::size_t width_;
    std::span<const unsigned char> wraps_;
    std::vector<double> rows_;
};

class ArmPotential {
  public:
    // Bodies that are near to each other, or to an obstacle (other < 0), and how near at least.
    struct Near {
        int body, other;
        double rho;
    };
    struct Look : FieldLook {
        std::vector<Near> near;
    };

    ArmPotential(const collision::Checker& checker, const GoalRows& goals, const search::Gains& gains)
        : robot_(checker.robot()),
          goals_(goals),
          gains_(gains),
          pairs_(checker.robot_data(), checker.scene(), checker.scene_data(), gains.rho_0) {}

    const search::Gains& gains() const { return gains_; }

    // Calls visit(contact, ρ, gradient of ρ) for everything that repels at q.
    template <class Visit>
    void visit_near(const double* q, const Visit& visit) {
        pairs_.visit(q, [&](const collision::Contact& contact, double rho, std::span<const double> slope) {
            visit(contact, std::max(rho, least_rho * gains_.rho_0), slope);
        });
    }
    Look look(const double* q) {
        const std::size_t n = goals_.width();
        Look seen;
        seen.slope.assign(n, 0.0), seen.stiffness.assign(n * n, 0.0);
        attract(q, seen);
        visit_near(q, [&](const collision::Contact& contact, double rho, std::span<const double> slope) {
            const double rate = gains_.repulsion_rate(rho), stiffness = gains_.repulsion_stiffness(rho);
            seen.value += gains_.repulsion(rho);
            for (std::size_t i = 0; i < n; ++i) {
                seen.slope[i] += rate * slope[i];
                for (std::size_t j = 0; j < n; ++j) seen.stiffness[i * n + j] += stiffness * slope[i] * slope[j];
            }
            note_near(contact, rho, seen.near);
        });
        return seen;
    }
    // See JointDescent. What is not near is rho_0 away.
    double free_share(const Look& look, const double* step) const {
        constexpr double half = 0.5;
        double share = 1;
        const auto allow = [&](double rho, double moved) {
            if (moved * share > half * rho) share = half * rho / moved;
        };
        double most = 0;
        for (int b = 1; b < robot_.n_bodies; ++b) most = std::max(most, reach_of(b, step));
        allow(gains_.rho_0, 2 * most);  // two links may approach each other
        for (const Near& near : look.near)
            allow(near.rho, reach_of(near.body, step) + (near.other < 0 ? 0 : reach_of(near.other, step)));
        return share;
    }

  private:
    static constexpr double least_rho = 1e-9;  // of rho_0: closer is contact, where the potential is infinite

    const collision::Robot& robot_;
    const GoalRows& goals_;
    search::Gains gains_;
    collision::NearPairs pairs_;

    void attract(const double* q, FieldLook& seen) const {
        const std::size_t n = goals_.width();
        const auto [goal, d] = goals_.find_nearest(q);
        seen.value = gains_.attraction(d);
        const double pull = gains_.k * std::min(1.0, gains_.cone / std::max(d, gains_.cone));
        for (std::size_t i = 0; i < n; ++i) {
            const double along = goals_.difference(goal, i, q[i]);
            seen.slope[i] = -pull * along;
            seen.stiffness[i * n + i] = pull;
            if (d < gains_.cone) continue;
            for (std::size_t j = 0; j < n; ++j)
                seen.stiffness[i * n + j] -= pull * (along / d) * (goals_.difference(goal, j, q[j]) / d);
        }
    }
    void note_near(const collision::Contact& contact, double rho, std::vector<Near>& near) const {
        const int body = robot_.links[contact.link].body;
        const int other = contact.is_pair ? robot_.links[contact.other].body : -1;
        for (Near& each : near)
            if (each.body == body && each.other == other) return void(each.rho = std::min(each.rho, rho));
        near.push_back({body, other, rho});
    }
    // By how much a step moves any sphere of a body at most.
    double reach_of(int body, const double* step) const {
        double sum = 0;
        for (int j = 0; j < robot_.n_joints; ++j) {
            const collision::Joint& joint = robot_.joints[j];
            sum += double(robot_.levers[j * robot_.body_stride + body]) *
                   std::fabs(double(joint.ratio) * step[joint.coordinate]);
        }
        return sum;
    }
};

}  // namespace cspace::planning
