// Starts of a pose graph: dead reckoning along trusted edges, and the linear relaxation that finds the
// rotations first (Carlone, Tron, Daniilidis & Dellaert 2015, "Initialization techniques for 3D SLAM").
//
// The relaxation lets the entries of rotations be any numbers, so that all measurements become linear; the
// nearest rotations are taken, and the positions solved again with them. Without landmarks the rotations are
// a problem of their own. With landmarks they are found together with the positions, for landmarks may be all
// that closes loops.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "cspace/localization/graph/normal_equations.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::localization {

// A linear least-squares problem of blocks: each equation is x_j − A x_i − c with a weight per row. Right
// sides are solved with one matrix.
template <class Fronts>
class LinearGraph {
  public:
    LinearGraph(std::vector<int> sizes, const std::vector<BlockPair>& pairs, int right_sides)
        : sizes_(sizes),
          solver_(make_block_graph(std::move(sizes), pairs)),
          values_(solver_.value_count()),
          sides_(std::size_t(right_sides), std::vector<double>(std::size_t(solver_.rows()))) {}

    // A: rows × columns of x_i, row by row; weights: one per row. known_i, known_j: the values of a block
    // that is −1, for all right sides one after the other. c: rows per right side, or null.
    void add_equation(int i, int j, const double* A, int rows, int columns, const double* weights,
                      const double* known_i, const double* known_j, const double* c) {
        if (j >= 0) add_identity(j, rows, weights);
        if (i >= 0) add_square(i, A, rows, columns, weights);
        if (i >= 0 && j >= 0) add_product(i, j, A, rows, columns, weights);
        for (std::size_t side = 0; side < sides_.size(); ++side) {
            for (int r = 0; r < rows; ++r) {
                // What x_j − A x_i must be, as far as it is known.
                double value = c ? c[side * std::size_t(rows) + std::size_t(r)] : 0.0;
                if (i < 0) {
                    for (int k = 0; k < columns; ++k)
                        value += A[r * columns + k] * known_i[side * std::size_t(columns) + std::size_t(k)];
                }
                if (j < 0) value -= known_j[side * std::size_t(rows) + std::size_t(r)];
                const double weighted = weights[r] * value;
                if (j >= 0) right(side, j, r) += weighted;
                if (i < 0) continue;
                for (int k = 0; k < columns; ++k) right(side, i, k) -= A[r * columns + k] * weighted;
            }
        }
    }
    bool solve() {
        std::vector<double*> sides;
        for (auto& side : sides_) sides.push_back(side.data());
        return solver_.solve_matrix(values_.data(), nullptr, sides);
    }
    SparseCholesky<Fronts>& solver() { return solver_; }
    std::vector<double>& values() { return values_; }
    const double* solution(int side, int block) const {
        return sides_[std::size_t(side)].data() + solver_.row_of(block);
    }

  private:
    double& right(std::size_t side, int block, int row) {
        return sides_[side][std::size_t(solver_.row_of(block) + row)];
    }
    void add_identity(int j, int rows, const double* weights) {
        const BlockSlot slot = solver_.slot_of(j, j);
        for (int r = 0; r < rows; ++r) values_[slot.at + std::size_t(r * (slot.rows + 1))] += weights[r];
    }
    void add_square(int i, const double* A, int rows, int columns, const double* weights) {
        double* const to = values_.data() + solver_.slot_of(i, i).at;
        for (int r = 0; r < rows; ++r) {
            for (int a = 0; a < columns; ++a) {
                for (int b = 0; b < columns; ++b)
                    to[b * columns + a] += weights[r] * A[r * columns + a] * A[r * columns + b];
            }
        }
    }
    void add_product(int i, int j, const double* A, int rows, int columns, const double* weights) {
        const BlockSlot slot = solver_.slot_of(i, j);
        double* const to = values_.data() + slot.at;
        for (int r = 0; r < rows; ++r) {
            for (int k = 0; k < columns; ++k)
                to[slot.is_transposed ? k * rows + r : r * columns + k] -= weights[r] * A[r * columns + k];
        }
    }

    std::vector<int> sizes_;
    SparseCholesky<Fronts> solver_;
    std::vector<double> values_;
    std::vector<std::vector<double>> sides_;
};

// The mean information of the coordinates, and of the rotation as a part of a matrix.
template <class Space>
struct MeanInformation {
    double position, rotation;
};
template <class Space>
MeanInformation<Space> average_information(const typename Space::Square& W) {
    constexpr std::size_t n = Space::freedom, d = Space::dimension;
    double position = 0, rotation = 0;
    for (std::size_t k = 0; k < n; ++k) (k < d ? position : rotation) += W[k * (n + 1)];
    // The squared distance of two rotation matrices counts each angle twice.
    return {position / double(d), rotation / double(n - d) / (d == 2 ? 1.0 : 2.0)};
}

// A sighting as a point of the base with one information; none where its range or bearing is missing.
template <class Space>
struct SeenPoint {
    typename Space::Point z;
    double information;
};
template <class Space>
std::optional<SeenPoint<Space>> find_seen_point(const Sighting<Space>& sighting) {
    constexpr std::size_t d = Space::dimension;
    SeenPoint<Space> found{sighting.z, 0};
    for (std::size_t k = 0; k < d; ++k) found.information += sighting.W[k * (d + 1)] / double(d);
    if (sighting.kind == SightingKind::range_bearing) {
        constexpr double least_range = 1e-3;  // [m], for landmarks next to the base
        const double range = sighting.z[0], across = std::max(range, least_range);
        if (!(sighting.W[0] > 0) || !(sighting.W[3] > 0)) return std::nullopt;
        found.z[0] = range * std::cos(sighting.z[1]), found.z[1] = range * std::sin(sighting.z[1]);
        found.information = 0.5 * (sighting.W[0] + sighting.W[3] / (across * across));
    }
    return found;
}

// Landmarks that no complete sighting places: the point nearest to the lines of sight, or what is given.
template <class Space>
void place_by_bearings(const PoseGraph<Space>& graph, GraphState<Space>& state,
                       std::vector<char>& is_placed) {
    if constexpr (Space::dimension == 2) {
        constexpr double least_turn =
            1e-6;  // of the determinant: lines of sight that are parallel cross nowhere
        struct Lines {
            double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
        };
        std::vector<Lines> lines(is_placed.size());
        for (const Sighting<Space>& seen : graph.sightings) {
            if (is_placed[std::size_t(seen.landmark)] || seen.kind == SightingKind::point || !(seen.W[3] > 0))
                continue;
            const auto& pose = state.poses[std::size_t(seen.pose)];
            const auto across = Space::rotate(pose, {-std::sin(seen.z[1]), std::cos(seen.z[1])});
            const double offset = across[0] * pose.x + across[1] * pose.y;
            Lines& sum = lines[std::size_t(seen.landmark)];
            sum.xx += across[0] * across[0], sum.xy += across[0] * across[1], sum.yy += across[1] * across[1];
            sum.x += across[0] * offset, sum.y += across[1] * offset;
        }
        for (std::size_t k = 0; k < lines.size(); ++k) {
            const Lines& sum = lines[k];
            const double determinant = sum.xx * sum.yy - sum.xy * sum.xy, trace = sum.xx + sum.yy;
            if (is_placed[k] || !(determinant > least_turn * trace * trace)) continue;
            const Point at = solve_two({sum.xx, sum.xy}, {sum.xy, sum.yy}, sum.x, sum.y);
            state.landmarks[k] = {at.x, at.y};
        }
    }
}

// Landmarks at the median of where their first complete sightings have them: one of these may be false, and
// dead reckoning drifts.
template <class Space>
void place_landmarks(const PoseGraph<Space>& graph, GraphState<Space>& state) {
    constexpr std::size_t most_sightings = 5;
    std::vector<char> is_placed = graph.is_landmark_held;
    std::vector<std::vector<typename Space::Point>> places(is_placed.size());
    for (const Sighting<Space>& seen : graph.sightings) {
        auto& own = places[std::size_t(seen.landmark)];
        if (is_placed[std::size_t(seen.landmark)] || own.size() == most_sightings) continue;
        const auto point = find_seen_point(seen);
        if (point) own.push_back(Space::to_map(state.poses[std::size_t(seen.pose)], point->z));
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (places[k].empty()) continue;
        const auto middle = places[k].begin() + std::ptrdiff_t((places[k].size() - 1) / 2);
        for (std::size_t axis = 0; axis < Space::dimension; ++axis) {
            std::nth_element(places[k].begin(), middle, places[k].end(),
                             [&](const auto& p, const auto& q) { return p[axis] < q[axis]; });
            state.landmarks[k][axis] = (*middle)[axis];
        }
        is_placed[k] = 1;
    }
    place_by_bearings(graph, state, is_placed);
}

// Dead reckoning from known poses of a state: along trusted edges as far as they reach, then along the
// others.
template <class Space>
void reckon_from(const PoseGraph<Space>& graph, std::vector<char> is_known, GraphState<Space>& state) {
    const std::size_t n = state.poses.size();
    std::vector<std::vector<std::size_t>> touching(n);
    for (std::size_t k = 0; k < graph.edges.size(); ++k) {
        touching[std::size_t(graph.edges[k].from)].push_back(k);
        touching[std::size_t(graph.edges[k].to)].push_back(k);
    }
    std::deque<std::size_t> trusted, others;
    const auto leave_pose = [&](std::size_t pose) {
        for (std::size_t k : touching[pose]) (graph.is_trusted[k] ? trusted : others).push_back(k);
    };
    for (std::size_t pose = 0; pose < n; ++pose) {
        if (is_known[pose]) leave_pose(pose);
    }
    while (!trusted.empty() || !others.empty()) {
        auto& queue = trusted.empty() ? others : trusted;
        const RelativePose<Space>& edge = graph.edges[queue.front()];
        queue.pop_front();
        const auto from = std::size_t(edge.from), to = std::size_t(edge.to);
        if (is_known[from] == is_known[to]) continue;
        const std::size_t found = is_known[from] ? to : from;
        state.poses[found] = is_known[from] ? Space::compose(state.poses[from], edge.z)
                                            : Space::compose(state.poses[to], Space::inverse(edge.z));
        is_known[found] = 1;
        leave_pose(found);
    }
}

// Dead reckoning from the held poses, and landmarks where their first sightings have them.
template <class Space>
GraphState<Space> reckon_poses(const PoseGraph<Space>& graph) {
    GraphState<Space> state = graph.start;
    reckon_from(graph, graph.is_held, state);
    place_landmarks(graph, state);
    return state;
}

// The linear relaxation, in three steps.
template <class Space, class Fronts>
class Relaxation {
  public:
    explicit Relaxation(const PoseGraph<Space>& graph)
        : graph_(graph), is_free_(graph.is_landmark_held.size(), 0) {
        for (const auto& seen : graph.sightings) {
            seen_.push_back(find_seen_point(seen));
            if (seen_.back() && !graph.is_landmark_held[std::size_t(seen.landmark)])
                is_free_[std::size_t(seen.landmark)] = 1;
        }
    }

    // The state; none where the measurements do not determine it.
    std::optional<GraphState<Space>> solve() {
        GraphState<Space> state = graph_.start;
        const bool has_points = !graph_.sightings.empty();
        if (!(has_points ? solve_everything(state) : solve_rotations(state))) return std::nullopt;
        if (!solve_positions(state)) return std::nullopt;
        place_landmarks_left(state);
        return state;
    }

  private:
    static constexpr std::size_t n = Space::relaxed, p = Space::relaxed_point, r = Space::rotation_part;
    static constexpr std::size_t sides = Space::right_sides, d = Space::dimension;

    BlockNumbers number(int pose_size, int landmark_size) const {
        BlockNumbers numbers = number_blocks(graph_, pose_size, landmark_size);
        numbers.sizes.resize(
            numbers.sizes.size() -
            std::size_t(std::count(graph_.is_landmark_held.begin(), graph_.is_landmark_held.end(), 0)));
        for (std::size_t k = 0; k < is_free_.size(); ++k) {
            numbers.landmark[k] = is_free_[k] ? int(numbers.sizes.size()) : -1;
            if (is_free_[k]) numbers.sizes.push_back(landmark_size);
        }
        return numbers;
    }
    // Whether a sighting places a point that is free or held.
    bool counts(std::size_t k) const {
        const auto landmark = std::size_t(graph_.sightings[k].landmark);
        return seen_[k] && (is_free_[landmark] || graph_.is_landmark_held[landmark]);
    }
    std::vector<BlockPair> pair_blocks(const BlockNumbers& numbers, bool with_landmarks) const {
        std::vector<BlockPair> pairs;
        const auto add_pair = [&](int a, int b) {
            if (a >= 0 && b >= 0) pairs.push_back({a, b});
        };
        for (const auto& edge : graph_.edges)
            add_pair(numbers.pose[std::size_t(edge.from)], numbers.pose[std::size_t(edge.to)]);
        for (std::size_t k = 0; with_landmarks && k < graph_.sightings.size(); ++k) {
            if (counts(k))
                add_pair(numbers.pose[std::size_t(graph_.sightings[k].pose)],
                         numbers.landmark[std::size_t(graph_.sightings[k].landmark)]);
        }
        return pairs;
    }

    bool solve_rotations(GraphState<Space>& state) const {
        const BlockNumbers numbers = number_blocks(graph_, int(r), 1);
        LinearGraph<Fronts> system(
            std::vector<int>(numbers.sizes.begin(), numbers.sizes.begin() + free_poses()),
            pair_blocks(numbers, false), int(sides));
        for (const auto& edge : graph_.edges) {
            const auto motion = Space::relaxed_motion(edge.z);
            std::array<double, r * r> A;
            for (std::size_t i = 0; i < r; ++i) {
                for (std::size_t j = 0; j < r; ++j) A[i * r + j] = motion[i * n + j];
            }
            std::array<double, r> weights;
            weights.fill(average_information<Space>(edge.W).rotation);
            const auto known_i = known_rotation(edge.from), known_j = known_rotation(edge.to);
            system.add_equation(numbers.pose[std::size_t(edge.from)], numbers.pose[std::size_t(edge.to)],
                                A.data(), int(r), int(r), weights.data(), known_i.data(), known_j.data(),
                                nullptr);
        }
        if (!system.solve()) return false;
        for (std::size_t k = 0; k < state.poses.size(); ++k) {
            if (numbers.pose[k] < 0) continue;
            std::array<double, n * sides> relaxed{};
            for (std::size_t side = 0; side < sides; ++side)
                std::copy_n(system.solution(int(side), numbers.pose[k]), r, relaxed.data() + side * n);
            state.poses[k] = Space::read_relaxed(relaxed.data());
        }
        return true;
    }
    std::ptrdiff_t free_poses() const { return std::count(graph_.is_held.begin(), graph_.is_held.end(), 0); }
    std::array<double, r * sides> known_rotation(int pose) const {
        std::array<double, n * sides> relaxed;
        Space::write_relaxed(graph_.start.poses[std::size_t(pose)], relaxed.data());
        std::array<double, r * sides> found;
        for (std::size_t side = 0; side < sides; ++side)
            std::copy_n(relaxed.data() + side * n, r, found.data() + side * r);
        return found;
    }

    bool solve_everything(GraphState<Space>& state) const {
        const BlockNumbers numbers = number(int(n), int(p));
        LinearGraph<Fronts> system(numbers.sizes, pair_blocks(numbers, true), int(sides));
        const auto known_pose = [&](int pose) {
            std::array<double, n * sides> known;
            Space::write_relaxed(graph_.start.poses[std::size_t(pose)], known.data());
            return known;
        };
        for (const auto& edge : graph_.edges) {
            const auto A = Space::relaxed_motion(edge.z);
            const auto mean = average_information<Space>(edge.W);
            std::array<double, n> weights;
            for (std::size_t k = 0; k < n; ++k) weights[k] = k < r ? mean.rotation : mean.position;
            const auto known_i = known_pose(edge.from), known_j = known_pose(edge.to);
            system.add_equation(numbers.pose[std::size_t(edge.from)], numbers.pose[std::size_t(edge.to)],
                                A.data(), int(n), int(n), weights.data(), known_i.data(), known_j.data(),
                                nullptr);
        }
        for (std::size_t k = 0; k < graph_.sightings.size(); ++k) {
            if (counts(k)) add_sighting(system, numbers, k, known_pose(graph_.sightings[k].pose));
        }
        if (!system.solve()) return false;
        for (std::size_t k = 0; k < state.poses.size(); ++k) {
            if (numbers.pose[k] < 0) continue;
            std::array<double, n * sides> relaxed;
            for (std::size_t side = 0; side < sides; ++side)
                std::copy_n(system.solution(int(side), numbers.pose[k]), n, relaxed.data() + side * n);
            state.poses[k] = Space::read_relaxed(relaxed.data());
        }
        return true;
    }
    // The landmark is the rotated point after the position: the last rows of a motion by that point.
    void add_sighting(LinearGraph<Fronts>& system, const BlockNumbers& numbers, std::size_t k,
                      const std::array<double, n * sides>& known_pose) const {
        const auto& seen = graph_.sightings[k];
        const auto motion = Space::relaxed_motion(Space::with_position(typename Space::Pose{}, seen_[k]->z));
        std::array<double, p> weights;
        weights.fill(seen_[k]->information);
        system.add_equation(numbers.pose[std::size_t(seen.pose)],
                            numbers.landmark[std::size_t(seen.landmark)], motion.data() + (n - p) * n, int(p),
                            int(n), weights.data(), known_pose.data(),
                            graph_.start.landmarks[std::size_t(seen.landmark)].data(), nullptr);
    }

    // Positions for the rotations of a state: each coordinate is a right side of one matrix of numbers.
    bool solve_positions(GraphState<Space>& state) const {
        const BlockNumbers numbers = number(1, 1);
        LinearGraph<Fronts> system(numbers.sizes, pair_blocks(numbers, true), int(d));
        const double one = 1;
        for (const auto& edge : graph_.edges) {
            const auto &from = state.poses[std::size_t(edge.from)], &to = state.poses[std::size_t(edge.to)];
            const auto known_i = Space::position(from), known_j = Space::position(to);
            const auto c = Space::rotate(from, Space::position(edge.z));
            const double weight = average_information<Space>(edge.W).position;
            system.add_equation(numbers.pose[std::size_t(edge.from)], numbers.pose[std::size_t(edge.to)],
                                &one, 1, 1, &weight, known_i.data(), known_j.data(), c.data());
        }
        for (std::size_t k = 0; k < graph_.sightings.size(); ++k) {
            if (!counts(k)) continue;
            const auto& seen = graph_.sightings[k];
            const auto& from = state.poses[std::size_t(seen.pose)];
            const auto known = Space::position(from), c = Space::rotate(from, seen_[k]->z);
            system.add_equation(numbers.pose[std::size_t(seen.pose)],
                                numbers.landmark[std::size_t(seen.landmark)], &one, 1, 1,
                                &seen_[k]->information, known.data(),
                                graph_.start.landmarks[std::size_t(seen.landmark)].data(), c.data());
        }
        if (!system.solve()) return false;
        const auto read = [&](int block) {
            typename Space::Point at;
            for (std::size_t side = 0; side < d; ++side) at[side] = system.solution(int(side), block)[0];
            return at;
        };
        for (std::size_t k = 0; k < state.poses.size(); ++k) {
            if (numbers.pose[k] >= 0)
                state.poses[k] = Space::with_position(state.poses[k], read(numbers.pose[k]));
        }
        for (std::size_t k = 0; k < state.landmarks.size(); ++k) {
            if (numbers.landmark[k] >= 0) state.landmarks[k] = read(numbers.landmark[k]);
        }
        return true;
    }
    void place_landmarks_left(GraphState<Space>& state) const {
        std::vector<char> is_placed = graph_.is_landmark_held;
        for (std::size_t k = 0; k < is_placed.size(); ++k) is_placed[k] = is_placed[k] || is_free_[k];
        place_by_bearings(graph_, state, is_placed);
    }

    const PoseGraph<Space>& graph_;
    std::vector<std::optional<SeenPoint<Space>>> seen_;
    std::vector<char> is_free_;  // landmarks that the relaxation finds
};

}  // namespace cspace::localization
