// A pose graph that grows while its robot drives: incremental smoothing on a clique tree (Kaess et al. 2012).
//
// Each step adds measurements, linearises those anew whose variables have moved far from where they were
// linearised, and eliminates again what that touches. Measurements whose variables are not connected with the
// held pose yet wait until they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cspace/localization/graph/initial_guess.hpp"
#include "cspace/localization/graph/residuals.hpp"
#include "cspace/math/sparse/clique_tree.hpp"

namespace cspace::localization {

struct IncrementalOptions {
    double relinearize = 0.1;  // largest entry of a correction [m or rad] that leaves a linearisation as it is
    double substitute = 1e-3;  // changes of corrections up to it are not passed on to the subtrees below
};

template <class Space, class Fronts>
class IncrementalGraph {
  public:
    using Pose = typename Space::Pose;
    using Point = typename Space::Point;

    explicit IncrementalGraph(const IncrementalOptions& options) : options_(options) {}

    // The pose that stays where it is, the first of all.
    void hold_pose(std::int64_t id, const Pose& pose) { create_pose(id, pose, true); }

    // Measurements for the next step: edges join the poses with the ids of their `from` and `to`.
    void add_edge(std::int64_t from, std::int64_t to, const Pose& z, const typename Space::Square& W) {
        edges_.push_back({none, none, z, W});
        edge_ids_.push_back({from, to});
        queue_.push_back({true, int(edges_.size()) - 1});
    }
    void add_sighting(std::int64_t pose, std::int64_t landmark, SightingKind kind, const Point& z,
                      const typename Space::PointSquare& W) {
        sightings_.push_back({none, none, kind, z, W});
        sighting_ids_.push_back({pose, landmark});
        queue_.push_back({false, int(sightings_.size()) - 1});
    }

    // Takes up the measurements; false where the equations are singular. A pose with one edge fits it exactly
    // and moves nothing else: its elimination is put off until another measurement touches the graph.
    bool step() {
        activate_queue();
        if (tree_.is_whole() && far_.empty() && !has_residual_) return true;
        return finish_step();
    }
    // Eliminates what was put off.
    bool finish_step() {
        activate_queue();
        move_linearizations();
        linearize_stale();
        has_residual_ = false;
        if (touched_.empty() && tree_.is_whole()) return true;
        if (!tree_.update(touched_, newest_)) return false;
        touched_.clear();
        eliminated_ += tree_.eliminated();
        tree_.substitute(options_.substitute);
        read_changes();
        return true;
    }
    // Sets the state, and makes all equations anew there.
    bool restart(const GraphState<Space>& state) {
        linear_ = state;
        estimate_ = state;
        for (int v = 0; v < tree_.variables(); ++v)
            std::fill_n(tree_.solution(v), variables_[std::size_t(v)].is_pose ? Space::freedom : Space::dimension, 0.0);
        stale_.clear();
        for (int f = 0; f < int(factors_.size()); ++f) stale_.push_back(f);
        tree_.spoil();
        return finish_step();
    }

    const GraphState<Space>& state() const { return estimate_; }
    const std::vector<std::int64_t>& pose_ids() const { return pose_ids_; }
    const std::vector<std::int64_t>& landmark_ids() const { return landmark_ids_; }
    // All measurements, also those that wait, whose poses or landmarks may be −1.
    const std::vector<RelativePose<Space>>& edges() const { return edges_; }
    const std::vector<Sighting<Space>>& sightings() const { return sightings_; }
    // Rows of a pose or landmark; −1: none of this id.
    int find_pose(std::int64_t id) const { return find_row(pose_rows_, id); }
    int find_landmark(std::int64_t id) const { return find_row(landmark_rows_, id); }
    std::size_t waiting() const { return edges_.size() + sightings_.size() - factors_.size(); }
    bool is_active_edge(std::size_t k) const { return is_edge_active_.size() > k && is_edge_active_[k]; }
    bool is_active_sighting(std::size_t k) const {
        return is_sighting_active_.size() > k && is_sighting_active_[k];
    }
    // Variables that all steps eliminated.
    std::size_t eliminated() const { return eliminated_; }

    double measure_cost() const {
        double cost = 0;
        InterruptPoll poll(1 << 8);
        for (const Measurement& at : factors_) {
            poll.step();
            const auto k = std::size_t(at.index);
            cost += at.is_edge
                        ? weigh_residual(evaluate_edge(edges_[k], estimate_, ResidualKind::twist).e, edges_[k].W)
                        : weigh_residual(evaluate_sighting(sightings_[k], estimate_).e, sightings_[k].W);
        }
        return cost;
    }
    // The covariance of two poses or landmarks at their linearisation, row by row; zero for the held pose.
    void write_covariance(bool is_pose_a, int a, bool is_pose_b, int b, double* out) const {
        const int va = variable_of(is_pose_a, a), vb = variable_of(is_pose_b, b);
        const int na = is_pose_a ? Space::freedom : Space::dimension;
        const int nb = is_pose_b ? Space::freedom : Space::dimension;
        std::fill_n(out, na * nb, 0.0);
        if (va >= 0 && vb >= 0) tree_.inverse_block(va, vb, out);
    }
    bool is_ready() const { return tree_.is_whole(); }

  private:
    static constexpr int none = -1;
    struct Measurement {
        bool is_edge;
        int index;
    };
    struct Variable {
        bool is_pose;
        int row;
    };
    using Rows = std::unordered_map<std::int64_t, int>;

    static int find_row(const Rows& rows, std::int64_t id) {
        const auto found = rows.find(id);
        return found == rows.end() ? none : found->second;
    }
    int variable_of(bool is_pose, int row) const {
        return (is_pose ? pose_variables_ : landmark_variables_)[std::size_t(row)];
    }

    void create_pose(std::int64_t id, const Pose& pose, bool is_held) {
        const int row = int(pose_ids_.size());
        pose_rows_.emplace(id, row);
        pose_ids_.push_back(id);
        linear_.poses.push_back(pose), estimate_.poses.push_back(pose);
        pose_variables_.push_back(is_held ? none : create_variable(true, row));
        if (!is_held) newest_ = pose_variables_.back();
        wake_measurements(waiting_for_pose_, id);
    }
    void create_landmark(std::int64_t id, const Point& at) {
        const int row = int(landmark_ids_.size());
        landmark_rows_.emplace(id, row);
        landmark_ids_.push_back(id);
        linear_.landmarks.push_back(at), estimate_.landmarks.push_back(at);
        landmark_variables_.push_back(create_variable(false, row));
        wake_measurements(waiting_for_landmark_, id);
    }
    int create_variable(bool is_pose, int row) {
        variables_.push_back({is_pose, row});
        is_far_.push_back(0);
        return tree_.add_variable(is_pose ? Space::freedom : Space::dimension);
    }
    using Waiting = std::unordered_map<std::int64_t, std::vector<Measurement>>;
    void wake_measurements(Waiting& waiting, std::int64_t id) {
        const auto found = waiting.find(id);
        if (found == waiting.end()) return;
        queue_.insert(queue_.end(), found->second.begin(), found->second.end());
        waiting.erase(found);
    }

    void activate_queue() {
        while (next_ < queue_.size()) {
            const Measurement at = queue_[next_++];
            at.is_edge ? activate_edge(at) : activate_sighting(at);
        }
        queue_.clear();
        next_ = 0;
    }
    void activate_edge(const Measurement& at) {
        RelativePose<Space>& edge = edges_[std::size_t(at.index)];
        const auto [from, to] = edge_ids_[std::size_t(at.index)];
        if (is_edge_active_.size() < edges_.size()) is_edge_active_.resize(edges_.size());
        if (is_edge_active_[std::size_t(at.index)]) return;  // it waited for both of its poses
        edge.from = find_pose(from), edge.to = find_pose(to);
        if (edge.from < 0 && edge.to < 0) {
            waiting_for_pose_[from].push_back(at), waiting_for_pose_[to].push_back(at);
            return;
        }
        is_edge_active_[std::size_t(at.index)] = 1;
        if (edge.to < 0) {
            edge.to = int(pose_ids_.size());
            create_pose(to, Space::compose(estimate_.poses[std::size_t(edge.from)], edge.z), false);
        } else if (edge.from < 0) {
            edge.from = int(pose_ids_.size());
            create_pose(from, Space::compose(estimate_.poses[std::size_t(edge.to)], Space::inverse(edge.z)), false);
        } else {
            has_residual_ = true;
        }
        add_factor(at, pose_variables_[std::size_t(edge.from)], pose_variables_[std::size_t(edge.to)]);
    }
    void activate_sighting(const Measurement& at) {
        Sighting<Space>& seen = sightings_[std::size_t(at.index)];
        const auto [pose, landmark] = sighting_ids_[std::size_t(at.index)];
        if (is_sighting_active_.size() < sightings_.size()) is_sighting_active_.resize(sightings_.size());
        seen.pose = find_pose(pose);
        if (seen.pose < 0) {
            waiting_for_pose_[pose].push_back(at);
            return;
        }
        seen.landmark = find_landmark(landmark);
        if (seen.landmark < 0) {
            waiting_for_landmark_[landmark].push_back(at);
            place_landmark(landmark);  // which wakes this sighting, if it can
            return;
        }
        is_sighting_active_[std::size_t(at.index)] = has_residual_ = true;
        add_factor(at, pose_variables_[std::size_t(seen.pose)], landmark_variables_[std::size_t(seen.landmark)]);
    }
    // A landmark that a sighting just began to wait for: where that has it, or where two lines of sight cross.
    void place_landmark(std::int64_t id) {
        const auto& waiting = waiting_for_landmark_[id];
        const Sighting<Space>& last = sightings_[std::size_t(waiting.back().index)];
        if (const auto point = find_seen_point(last)) {
            create_landmark(id, Space::to_map(estimate_.poses[std::size_t(last.pose)], point->z));
            return;
        }
        if constexpr (Space::dimension == 2) {
            for (const Measurement& other : waiting) {
                const auto crossing = cross_bearings(sightings_[std::size_t(other.index)], last);
                if (!crossing) continue;
                create_landmark(id, *crossing);
                return;
            }
        }
    }
    // Where two lines of sight cross, unless nearly parallel.
    std::optional<Point> cross_bearings(const Sighting<Space>& a, const Sighting<Space>& b) const {
        constexpr double least_angle = 0.1;  // [rad] its sine; a landmark of less would be hardly determined
        if (!(a.W[3] > 0) || !(b.W[3] > 0)) return std::nullopt;
        const Pose &A = estimate_.poses[std::size_t(a.pose)], &B = estimate_.poses[std::size_t(b.pose)];
        const Point u = Space::rotate(A, {std::cos(a.z[1]), std::sin(a.z[1])});
        const Point v = Space::rotate(B, {std::cos(b.z[1]), std::sin(b.z[1])});
        const double sine = u[0] * v[1] - u[1] * v[0];
        if (std::fabs(sine) < least_angle) return std::nullopt;
        const double along = ((B.x - A.x) * v[1] - (B.y - A.y) * v[0]) / sine;
        return Point{A.x + along * u[0], A.y + along * u[1]};
    }
    void add_factor(const Measurement& at, int a, int b) {
        stale_.push_back(tree_.add_factor(a, b));
        factors_.push_back(at);
    }

    // Variables far from their linearisation are linearised where they are now.
    void move_linearizations() {
        for (int v : far_) {
            const Variable& at = variables_[std::size_t(v)];
            is_far_[std::size_t(v)] = 0;
            if (!is_beyond(v)) continue;
            if (at.is_pose)
                linear_.poses[std::size_t(at.row)] = estimate_.poses[std::size_t(at.row)];
            else
                linear_.landmarks[std::size_t(at.row)] = estimate_.landmarks[std::size_t(at.row)];
            std::fill_n(tree_.solution(v), at.is_pose ? Space::freedom : Space::dimension, 0.0);
            tree_.visit_factors(v, [&](int f) { stale_.push_back(f); });
        }
        far_.clear();
        std::sort(stale_.begin(), stale_.end());
        stale_.erase(std::unique(stale_.begin(), stale_.end()), stale_.end());
    }
    bool is_beyond(int v) const {
        const double* const d = tree_.solution(v);
        const int size = variables_[std::size_t(v)].is_pose ? Space::freedom : Space::dimension;
        return std::any_of(d, d + size, [&](double x) { return std::fabs(x) > options_.relinearize; });
    }
    // An interrupt leaves the factors to come stale.
    void linearize_stale() {
        InterruptPoll poll(1 << 6);
        for (; !stale_.empty(); stale_.pop_back()) {
            poll.step();
            const int f = stale_.back();
            const Measurement& at = factors_[std::size_t(f)];
            const auto k = std::size_t(at.index);
            if (at.is_edge)
                write_model(f, linearize_edge(edges_[k], linear_, ResidualKind::twist));
            else
                write_model(f, linearize_sighting(sightings_[k], linear_));
            const auto [a, b] = tree_.factor_variables(f);
            if (a >= 0) touched_.push_back(a);
            if (b >= 0) touched_.push_back(b);
        }
    }
    // The blocks of variables that are held count nothing.
    template <std::size_t a, std::size_t b>
    void write_model(int f, const QuadraticModel<a, b>& model) {
        tree_.write_factor(f, model.aa.data(), model.ab.data(), model.bb.data(), model.ga.data(),
                           model.gb.data());
    }
    void read_changes() {
        for (int v : tree_.changed()) {
            const Variable& at = variables_[std::size_t(v)];
            const auto row = std::size_t(at.row);
            if (at.is_pose) {
                estimate_.poses[row] = Space::move(linear_.poses[row], tree_.solution(v));
            } else {
                for (std::size_t i = 0; i < Space::dimension; ++i)
                    estimate_.landmarks[row][i] = linear_.landmarks[row][i] + tree_.solution(v)[i];
            }
            if (is_far_[std::size_t(v)] || !is_beyond(v)) continue;
            is_far_[std::size_t(v)] = 1;
            far_.push_back(v);
        }
    }

    IncrementalOptions options_;
    CliqueTree<Fronts> tree_;
    GraphState<Space> linear_, estimate_;
    std::vector<std::int64_t> pose_ids_, landmark_ids_;
    Rows pose_rows_, landmark_rows_;
    std::vector<int> pose_variables_, landmark_variables_;
    std::vector<Variable> variables_;
    std::vector<RelativePose<Space>> edges_;
    std::vector<Sighting<Space>> sightings_;
    std::vector<std::pair<std::int64_t, std::int64_t>> edge_ids_, sighting_ids_;
    std::vector<char> is_edge_active_, is_sighting_active_;
    std::vector<Measurement> factors_;  // by number in the tree
    std::vector<Measurement> queue_;
    std::size_t next_ = 0;
    Waiting waiting_for_pose_, waiting_for_landmark_;
    std::vector<int> stale_, touched_;  // factors to linearise, and variables to eliminate
    std::vector<int> far_;
    std::vector<char> is_far_;
    bool has_residual_ = false;  // whether a measurement that waits for its elimination has an error
    int newest_ = none;
    std::size_t eliminated_ = 0;
};

}  // namespace cspace::localization
