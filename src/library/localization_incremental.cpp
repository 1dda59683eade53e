#include "localization_incremental.hpp"

#include <algorithm>
#include <stdexcept>

#include "cspace/localization/graph/incremental_graph.hpp"
#include "cspace/localization/graph/spatial_space.hpp"
#include "cspace/math/linear.hpp"
#include "localization_fronts.hpp"

namespace cspace {

template BlockGraph make_block_graph(std::vector<int>, const std::vector<BlockPair>&);
template std::vector<int> order_minimum_degree(const BlockGraph&);
template std::vector<int> order_nested_dissection(const BlockGraph&);
template SymbolicFactor analyze_pattern(const BlockGraph&, std::vector<int>, const Amalgamation&);

}  // namespace cspace

namespace cspace::localization {

namespace {

void require(bool fits) {
    if (!fits) throw std::invalid_argument("the arrays of an incremental graph do not fit together");
}

template <class Space>
class IncrementalOf : public IncrementalSolver {
  public:
    explicit IncrementalOf(const IncrementalOptions& options) : graph_(options) {}

    bool is_spatial() const override { return d == 3; }
    void hold_pose(std::int64_t id, std::span<const double> pose) override {
        require(pose.size() == numbers);
        graph_.hold_pose(id, Space::read_pose(pose.data()));
    }
    void add_edges(std::span<const std::int64_t> ids, std::span<const double> motions,
                   std::span<const double> information) override {
        const std::size_t count = ids.size() / 2;
        require(motions.size() == count * numbers && information.size() == count * n * n);
        for (std::size_t k = 0; k < count; ++k) {
            typename Space::Square W;
            std::copy_n(information.data() + k * n * n, n * n, W.begin());
            graph_.add_edge(ids[2 * k], ids[2 * k + 1], Space::read_pose(motions.data() + k * numbers), W);
        }
    }
    void add_sightings(std::span<const std::int64_t> ids, std::span<const double> points,
                       std::span<const double> information,
                       std::span<const std::uint8_t> has_bearing) override {
        const std::size_t count = ids.size() / 2;
        require(points.size() == count * d && information.size() == count * d * d);
        require(has_bearing.size() == count);
        for (std::size_t k = 0; k < count; ++k) {
            typename Space::Point z;
            typename Space::PointSquare W;
            std::copy_n(points.data() + k * d, d, z.begin());
            std::copy_n(information.data() + k * d * d, d * d, W.begin());
            require(d == 2 || !has_bearing[k]);
            graph_.add_sighting(ids[2 * k], ids[2 * k + 1],
                                has_bearing[k] ? SightingKind::range_bearing : SightingKind::point, z, W);
        }
    }
    bool step() override { return graph_.step(); }
    bool restart(std::span<const double> poses, std::span<const double> landmarks) override {
        GraphState<Space> state = graph_.state();
        require(poses.size() == state.poses.size() * numbers);
        require(landmarks.size() == state.landmarks.size() * d);
        for (std::size_t k = 0; k < state.poses.size(); ++k)
            state.poses[k] = Space::read_pose(poses.data() + k * numbers);
        for (std::size_t k = 0; k < state.landmarks.size(); ++k)
            std::copy_n(landmarks.data() + k * d, d, state.landmarks[k].begin());
        return graph_.restart(state);
    }

    const std::vector<std::int64_t>& pose_ids() const override { return graph_.pose_ids(); }
    const std::vector<std::int64_t>& landmark_ids() const override { return graph_.landmark_ids(); }
    int find_pose(std::int64_t id) const override { return graph_.find_pose(id); }
    int find_landmark(std::int64_t id) const override { return graph_.find_landmark(id); }
    void write_pose(int row, double* to) const override {
        Space::write_pose(graph_.state().poses.at(std::size_t(row)), to);
    }
    void write_state(double* poses, double* landmarks) const override {
        for (const auto& pose : graph_.state().poses) {
            Space::write_pose(pose, poses);
            poses += numbers;
        }
        for (const auto& landmark : graph_.state().landmarks)
            landmarks = std::copy(landmark.begin(), landmark.end(), landmarks);
    }
    std::size_t waiting() const override { return graph_.waiting(); }
    std::size_t eliminated() const override { return graph_.eliminated(); }
    double cost() const override { return graph_.measure_cost(); }
    IncrementalArrays arrays() const override {
        IncrementalArrays found;
        for (std::size_t k = 0; k < graph_.edges().size(); ++k) {
            if (!graph_.is_active_edge(k)) continue;
            const auto& edge = graph_.edges()[k];
            found.edges.insert(found.edges.end(), {edge.from, edge.to});
            found.motions.resize(found.motions.size() + numbers);
            Space::write_pose(edge.z, found.motions.data() + found.motions.size() - numbers);
            found.information.insert(found.information.end(), edge.W.begin(), edge.W.end());
        }
        for (std::size_t k = 0; k < graph_.sightings().size(); ++k) {
            if (!graph_.is_active_sighting(k)) continue;
            const auto& seen = graph_.sightings()[k];
            found.sightings.insert(found.sightings.end(), {seen.pose, seen.landmark});
            found.points.insert(found.points.end(), seen.z.begin(), seen.z.end());
            found.point_information.insert(found.point_information.end(), seen.W.begin(), seen.W.end());
            found.has_bearing.push_back(seen.kind == SightingKind::range_bearing);
        }
        return found;
    }
    bool write_covariance(bool is_pose, int a, int b, double* to) override {
        const int rows = int(is_pose ? graph_.pose_ids().size() : graph_.landmark_ids().size());
        require(a >= 0 && b >= 0 && a < rows && b < rows);
        if (!graph_.finish_step()) return false;
        graph_.write_covariance(is_pose, a, is_pose, b, to);
        return true;
    }

  private:
    static constexpr std::size_t n = Space::freedom, d = Space::dimension, numbers = Space::pose_numbers;
    IncrementalGraph<Space, KernelFronts> graph_;
};

bool is_clearly_positive(const double* W, int size) {
    constexpr double share = 1e-6;  // of the largest entry: far above what counts as singular
    double rows[36], largest = 0;
    for (int r = 0; r < size; ++r) {
        largest = std::max(largest, W[r * (size + 1)]);
        for (int c = 0; c < size; ++c) {
            if (!(W[r * size + c] == W[c * size + r])) return false;
            rows[r * size + c] = W[r * size + c];
        }
    }
    MatrixRows<double> A{rows, size};
    return factor_ldl(A, size, share * largest);
}

}  // namespace

std::unique_ptr<IncrementalSolver> make_incremental_solver(bool is_spatial, double relinearize,
                                                           double substitute) {
    const IncrementalOptions options{relinearize, substitute};
    if (is_spatial) return std::make_unique<IncrementalOf<SpatialSpace>>(options);
    return std::make_unique<IncrementalOf<PlanarSpace>>(options);
}

bool are_clearly_positive(std::span<const double> matrices, int size) {
    const auto numbers = std::size_t(size) * std::size_t(size);
    for (std::size_t k = 0; k + numbers <= matrices.size(); k += numbers) {
        if (!is_clearly_positive(matrices.data() + k, size)) return false;
    }
    return true;
}

}  // namespace cspace::localization
