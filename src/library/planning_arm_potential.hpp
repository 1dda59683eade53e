// The artificial potential of an arm (Khatib 1986) over its coordinates.
//
// The goal attracts by the distance of the joints (L2 norm), joints that wrap the short way. Every sphere
// that a joint moves is a control point: each obstacle repels it while nearer than rho_0, and so does each
// sphere of a link that it is checked against while nearer than rho_links. Some links are always close to
// each other, so this is shorter. A force at a sphere acts on the joints by the transpose of its Jacobian,
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
    // The least distance of a body from an obstacle, or of two bodies and the gradient of that distance.
    struct Near {
        int body, other;  // other < 0: an obstacle
        double rho;
        std::vector<double> slope;
    };
    struct Look : FieldLook {
        std::vector<Near> near;
    };

    // Between links the repulsion k_r is less by the cube of rho_links / rho_0: it balances the same
    // attraction at half of the distance.
    ArmPotential(const collision::Checker& checker, const GoalRows& goals, const search::Gains& gains,
                 double rho_links)
        : robot_(checker.robot()),
          goals_(goals),
          gains_(gains),
          link_gains_(gains),
          pairs_(checker.robot_data(), checker.scene(), checker.scene_data(), gains.rho_0, rho_links) {
        const double ratio = rho_links / gains.rho_0;
        link_gains_.rho_0 = rho_links, link_gains_.k_r *= ratio * ratio * ratio;
    }

    const search::Gains& gains_for(const collision::Contact& contact) const {
        return contact.is_pair ? link_gains_ : gains_;
    }

    // Calls visit(contact, ρ, gradient of ρ) for everything that repels at q.
    template <class Visit>
    void visit_near(const double* q, const Visit& visit) {
        pairs_.visit(q, [&](const collision::Contact& contact, double rho, std::span<const double> slope) {
            visit(contact, std::max(rho, least_rho * gains_for(contact).rho_0), slope);
        });
    }
    Look look(const double* q) {
        const std::size_t n = goals_.width();
        Look seen;
        seen.slope.assign(n, 0.0), seen.stiffness.assign(n * n, 0.0);
        attract(q, seen);
        visit_near(q, [&](const collision::Contact& contact, double rho, std::span<const double> slope) {
            const search::Gains& gains = gains_for(contact);
            const double rate = gains.repulsion_rate(rho), stiffness = gains.repulsion_stiffness(rho);
            seen.value += gains.repulsion(rho);
            for (std::size_t i = 0; i < n; ++i) {
                seen.slope[i] += rate * slope[i];
                for (std::size_t j = 0; j < n; ++j)
                    seen.stiffness[i * n + j] += stiffness * slope[i] * slope[j];
            }
            note_near(contact, rho, slope, seen.near);
        });
        return seen;
    }
    // See JointDescent: bounds for obstacles, of which those that are not near are rho_0 away, and the rates
    // of approach of links.
    double free_share(const Look& look, const double* step) const {
        constexpr double half = 0.5;
        double share = 1, most = 0;
        const auto allow = [&](double rho, double moved) {
            if (moved * share > half * rho) share = half * rho / moved;
        };
        for (int b = 1; b < robot_.n_bodies; ++b) most = std::max(most, reach_of(b, step));
        allow(gains_.rho_0, most);
        for (const Near& near : look.near) allow(near.rho, motion_of(near, step));
        return share;
    }

  private:
    static constexpr double least_rho = 1e-9;  // of rho_0: closer is contact, where the potential is infinite

    const collision::Robot& robot_;
    const GoalRows& goals_;
    search::Gains gains_, link_gains_;
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
    void note_near(const collision::Contact& contact, double rho, std::span<const double> slope,
                   std::vector<Near>& near) const {
        const int body = robot_.links[contact.link].body;
        const int other = contact.is_pair ? robot_.links[contact.other].body : -1;
        const auto is_same = [&](const Near& each) { return each.body == body && each.other == other; };
        auto found = std::find_if(near.begin(), near.end(), is_same);
        if (found == near.end()) found = near.insert(near.end(), {body, other, rho, {}});
        if (rho <= found->rho) {
            found->rho = rho;
            if (contact.is_pair) found->slope.assign(slope.begin(), slope.end());
        }
    }
    double motion_of(const Near& near, const double* step) const {
        if (near.other < 0) return reach_of(near.body, step);
        double rate = 0;
        for (std::size_t k = 0; k < near.slope.size(); ++k) rate += near.slope[k] * step[k];
        return std::fabs(rate);
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
