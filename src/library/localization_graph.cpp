#include "localization_graph.hpp"

#include <algorithm>
#include <stdexcept>

#include "cspace/localization/graph/certificate.hpp"
#include "cspace/localization/graph/false_loops.hpp"
#include "cspace/localization/graph/information_scale.hpp"
#include "cspace/localization/graph/initial_guess.hpp"
#include "cspace/localization/graph/spatial_space.hpp"
#include "localization_fronts.hpp"

namespace cspace::localization {

namespace {

void require(bool fits) {
    if (!fits) throw std::invalid_argument("the arrays of a pose graph do not fit together");
}
void require_indices(std::span<const std::int32_t> pairs, std::size_t first, std::size_t second) {
    for (std::size_t k = 0; k < pairs.size(); ++k)
        require(pairs[k] >= 0 && std::size_t(pairs[k]) < (k % 2 ? second : first));
}
std::vector<char> read_flags(std::span<const std::uint8_t> flags) { return {flags.begin(), flags.end()}; }

template <class Space>
PoseGraph<Space> read_graph(const GraphArrays& arrays) {
    constexpr std::size_t n = Space::freedom, d = Space::dimension, numbers = Space::pose_numbers;
    const std::size_t poses = arrays.is_held.size(), landmarks = arrays.is_landmark_held.size();
    const std::size_t edges = arrays.is_trusted.size(), sightings = arrays.is_sighting_trusted.size();
    require(arrays.poses.size() == poses * numbers && arrays.landmarks.size() == landmarks * d);
    require(arrays.edges.size() == 2 * edges && arrays.motions.size() == edges * numbers);
    require(arrays.information.size() == edges * n * n && arrays.sightings.size() == 2 * sightings);
    require(arrays.points.size() == sightings * d && arrays.point_information.size() == sightings * d * d);
    require(arrays.has_bearing.size() == sightings);
    require_indices(arrays.edges, poses, poses);
    require_indices(arrays.sightings, poses, landmarks);
    PoseGraph<Space> graph;
    for (std::size_t k = 0; k < poses; ++k)
        graph.start.poses.push_back(Space::read_pose(arrays.poses.data() + k * numbers));
    graph.start.landmarks.resize(landmarks);
    for (std::size_t k = 0; k < landmarks; ++k)
        std::copy_n(arrays.landmarks.data() + k * d, d, graph.start.landmarks[k].begin());
    graph.edges.resize(edges);
    for (std::size_t k = 0; k < edges; ++k) {
        RelativePose<Space>& edge = graph.edges[k];
        edge.from = arrays.edges[2 * k], edge.to = arrays.edges[2 * k + 1];
        edge.z = Space::read_pose(arrays.motions.data() + k * numbers);
        std::copy_n(arrays.information.data() + k * n * n, n * n, edge.W.begin());
    }
    graph.sightings.resize(sightings);
    for (std::size_t k = 0; k < sightings; ++k) {
        Sighting<Space>& seen = graph.sightings[k];
        seen.pose = arrays.sightings[2 * k], seen.landmark = arrays.sightings[2 * k + 1];
        seen.kind = arrays.has_bearing[k] ? SightingKind::range_bearing : SightingKind::point;
        require(d == 2 || seen.kind == SightingKind::point);
        std::copy_n(arrays.points.data() + k * d, d, seen.z.begin());
        std::copy_n(arrays.point_information.data() + k * d * d, d * d, seen.W.begin());
    }
    graph.is_held = read_flags(arrays.is_held);
    graph.is_landmark_held = read_flags(arrays.is_landmark_held);
    graph.is_trusted = read_flags(arrays.is_trusted);
    graph.is_sighting_trusted = read_flags(arrays.is_sighting_trusted);
    return graph;
}

// Dynamic covariance scaling is tried with these shares of its width: the information of files may be a
// hundredth of the true one, and an honest one lets loops start out far.
constexpr double scaling_widths[] = {1.0, 0.3, 3.0};

template <class Space>
class SolverOf : public GraphSolver {
  public:
    explicit SolverOf(const GraphArrays& arrays)
        : graph_(read_graph<Space>(arrays)), state_(graph_.start), is_used_(graph_.factors(), 1) {}

    GraphStatus optimize(const SolveRule& rule) override {
        residual_ = rule.options.residual;
        stats_ = {};
        factorized_.reset(), solved_block_ = -1;
        is_used_.assign(graph_.factors(), 1);
        state_ = graph_.start;
        find_start(rule.start);
        if (rule.false_loops != FalseLoops::ignore) return reject_loops(rule);
        GraphOptimizer<Space, KernelFronts> optimizer(graph_, rule.options);
        optimizer.use_factors(is_used_);
        optimizer.weights().kernel = rule.kernel;
        optimizer.weights().width = rule.width;
        const GraphStatus status = optimizer.optimize(state_);
        stats_ = optimizer.stats();
        singular_ = status == GraphStatus::singular ? variable_of(optimizer.failed_block()) : -1;
        weights_ = optimizer.weights();
        return status;
    }
    bool found_start() const override { return found_start_; }
    const GraphStats& stats() const override { return stats_; }
    void write_poses(double* to) const override {
        for (const auto& pose : state_.poses) {
            Space::write_pose(pose, to);
            to += Space::pose_numbers;
        }
    }
    void write_landmarks(double* to) const override {
        for (const auto& landmark : state_.landmarks) to = std::copy(landmark.begin(), landmark.end(), to);
    }
    std::vector<double> squares() const override {
        std::vector<double> found;
        measure_squares(graph_, state_, residual_, found);
        return found;
    }
    std::vector<std::uint8_t> used() const override { return {is_used_.begin(), is_used_.end()}; }
    double limit_scale() const override { return limit_scale_; }
    int singular_variable() const override { return singular_; }

    bool write_covariances(std::span<const std::int32_t> pairs, double* to) override {
        const std::size_t variables = state_.poses.size() + state_.landmarks.size();
        require_indices(pairs, variables, variables);
        if (!factorized_ && !factorize()) return false;
        for (std::size_t k = 0; k + 1 < pairs.size(); k += 2) {
            poll_interrupts();
            const int a = pairs[k], b = pairs[k + 1];
            write_covariance(block_of(a), block_of(b), size_of(a), size_of(b), to);
            to += size_of(a) * size_of(b);
        }
        return true;
    }

    std::ptrdiff_t anisotropic_measurement() const override { return find_anisotropic(graph_, is_used_); }
    CertificateResult certify() const override {
        return DualCertificate<Space, KernelFronts>(graph_, is_used_).certify(state_);
    }

  private:
    using Equations = NormalEquations<Space, KernelFronts>;

    void find_start(GraphStart start) {
        found_start_ = true;
        if (start == GraphStart::odometry) state_ = reckon_poses(graph_);
        if (start != GraphStart::rotations) return;
        auto found = Relaxation<Space, KernelFronts>(graph_).solve();
        found_start_ = found.has_value();
        if (found) state_ = std::move(*found);
    }
    // What a robust method found, with the information divided by a scale.
    struct ScaledAnswer {
        RobustAnswer<Space> answer;  // its squares are those of the graph
        double scale = 1, cost = 0;
        GraphStats stats;
        int failed_block = -1;
    };
    GraphStatus reject_loops(const SolveRule& rule) {
        const GraphState<Space> start = state_;
        const LoopEvidence<Space> evidence(graph_);
        ScaledAnswer best = find_loops(rule, start, 1, evidence);
        take_answer(best);
        if (may_be_larger(evidence, best)) try_scales(rule, start, evidence, best);
        return best.answer.status;
    }
    // Whether what is kept fits badly, or hardly anything is kept.
    static bool may_be_larger(const LoopEvidence<Space>& evidence, const ScaledAnswer& found) {
        const double fit = evidence.measure_fit(found.answer.squares, found.answer.is_used) / found.scale;
        return fit > information_scale::most_fit ||
               evidence.measure_share(found.answer.is_used) < information_scale::few_kept;
    }
    // Takes the answers of larger scales while they explain more.
    void try_scales(const SolveRule& rule, const GraphState<Space>& start,
                    const LoopEvidence<Space>& evidence, ScaledAnswer& best) {
        double scale = 1;
        for (int step = 1; step <= information_scale::most_steps; ++step) {
            scale *= information_scale::factor;
            ScaledAnswer next = find_loops(rule, start, scale, evidence);
            const bool is_better =
                next.cost + information_scale::odds < best.cost &&
                evidence.measure_share(next.answer.is_used) >= information_scale::least_kept;
            if (is_better) best = std::move(next), take_answer(best);
            if (is_better ? !may_be_larger(evidence, best) : step >= information_scale::least_steps) return;
        }
    }
    void take_answer(const ScaledAnswer& found) {
        state_ = found.answer.state, is_used_ = found.answer.is_used;
        limit_scale_ = found.answer.scale * found.scale;
        stats_ = found.stats;
        singular_ = found.answer.status == GraphStatus::singular ? variable_of(found.failed_block) : -1;
        weights_ = {};
    }
    ScaledAnswer find_loops(const SolveRule& rule, const GraphState<Space>& start, double scale,
                            const LoopEvidence<Space>& evidence) {
        const PoseGraph<Space> scaled = divide_information(graph_, scale);
        FalseLoopSolver<Space, KernelFronts> solver(scaled, rule.options);
        std::vector<RobustAnswer<Space>> answers;
        const auto keep_answer = [&](RobustAnswer<Space> answer) {
            answers.push_back(std::move(answer));
            if (scale == 1) state_ = answers[0].state, is_used_ = answers[0].is_used;
        };
        if (rule.false_loops != FalseLoops::gnc) {
            for (double share : scaling_widths)
                keep_answer(solver.scale_covariances(start, share * rule.width));
            if (!is_clear(solver, answers)) keep_answer(solver.scale_in_time(start, rule.width));
        }
        if (rule.false_loops != FalseLoops::dcs) keep_answer(solver.graduate(start));
        // One scale for all, of the answer that knows most.
        const double limits =
            std::max_element(answers.begin(), answers.end(), [&](const auto& a, const auto& b) {
                return solver.count_kept(a) < solver.count_kept(b);
            })->scale;
        ScaledAnswer found;
        found.answer = solver.select_loops(
            *std::min_element(answers.begin(), answers.end(), [&](const auto& a, const auto& b) {
                return solver.truncated_cost(a, limits) < solver.truncated_cost(b, limits);
            }));
        found.scale = scale;
        found.stats = solver.optimizer().stats();
        found.failed_block = solver.optimizer().failed_block();
        for (double& square : found.answer.squares) square *= scale;
        for (double& cost : found.stats.costs) cost *= scale;
        found.cost = evidence.measure_cost(found.answer.squares, found.answer.is_used, scale);
        return found;
    }
    // Whether two answers agree, and keep more than a few of the doubted measurements; where loops start out
    // far they do not.
    static bool is_clear(const FalseLoopSolver<Space, KernelFronts>& solver,
                         const std::vector<RobustAnswer<Space>>& answers) {
        constexpr double least_kept = 0.1, most_different = 0.01;  // as shares of the doubted ones
        const double doubted = double(solver.count_doubted());
        for (std::size_t a = 0; a < answers.size(); ++a) {
            if (double(solver.count_kept(answers[a])) < least_kept * doubted) continue;
            for (std::size_t b = 0; b < a; ++b) {
                if (double(solver.count_differences(answers[a], answers[b])) <= most_different * doubted)
                    return true;
            }
        }
        return false;
    }
    int variable_of(int block) const {
        const BlockNumbers numbers = number_blocks(graph_, 1, 1);
        const auto pose = std::find(numbers.pose.begin(), numbers.pose.end(), block);
        if (block < 0) return -1;
        if (pose != numbers.pose.end()) return int(pose - numbers.pose.begin());
        return int(numbers.pose.size()) +
               int(std::find(numbers.landmark.begin(), numbers.landmark.end(), block) -
                   numbers.landmark.begin());
    }

    // The equations at the answer, factored, with the inverse on their pattern.
    bool factorize() {
        auto equations = std::make_unique<Equations>(graph_, is_used_);
        std::vector<double> squares;
        equations->linearize(state_, residual_, weights_, squares);
        auto& solver = equations->solver();
        if (!solver.factor_matrix(equations->values())) {
            singular_ = variable_of(solver.failed_block());
            return false;
        }
        solver.invert_pattern();
        factorized_ = std::move(equations);
        return true;
    }
    bool is_pose(int variable) const { return std::size_t(variable) < state_.poses.size(); }
    int size_of(int variable) const { return is_pose(variable) ? Space::freedom : Space::dimension; }
    int block_of(int variable) const {
        const BlockNumbers& numbers = factorized_->numbers();
        return is_pose(variable) ? numbers.pose[std::size_t(variable)]
                                 : numbers.landmark[std::size_t(variable) - state_.poses.size()];
    }
    void write_covariance(int a, int b, int rows, int columns, double* to) {
        std::fill_n(to, rows * columns, 0.0);
        if (a < 0 || b < 0) return;
        auto& solver = factorized_->solver();
        if (solver.inverse_block(a, b, to)) return;
        if (solved_block_ != b || solved_for_ != factorized_.get()) solve_columns(b, columns);
        for (int c = 0; c < columns; ++c) {
            const double* const x = columns_.data() + std::size_t(c) * std::size_t(solver.rows());
            for (int r = 0; r < rows; ++r) to[r * columns + c] = x[solver.row_of(a) + r];
        }
    }
    // Columns of the inverse for a block; kept, for many pairs share one.
    void solve_columns(int block, int columns) {
        auto& solver = factorized_->solver();
        const auto rows = std::size_t(solver.rows());
        columns_.assign(std::size_t(columns) * rows, 0.0);
        for (int c = 0; c < columns; ++c) {
            double* const x = columns_.data() + std::size_t(c) * rows;
            x[solver.row_of(block) + c] = 1;
            solver.solve(x);
        }
        solved_block_ = block, solved_for_ = factorized_.get();
    }

    PoseGraph<Space> graph_;
    GraphState<Space> state_;
    std::vector<char> is_used_;
    ResidualKind residual_ = ResidualKind::twist;
    FactorWeights weights_;
    GraphStats stats_;
    bool found_start_ = true;
    double limit_scale_ = 1;
    int singular_ = -1;
    std::unique_ptr<Equations> factorized_;
    int solved_block_ = -1;
    const Equations* solved_for_ = nullptr;
    std::vector<double> columns_;
};

}  // namespace

std::unique_ptr<GraphSolver> make_graph_solver(const GraphArrays& arrays) {
    if (arrays.is_spatial) return std::make_unique<SolverOf<SpatialSpace>>(arrays);
    return std::make_unique<SolverOf<PlanarSpace>>(arrays);
}

std::vector<int> find_graph_parts(std::size_t poses, std::size_t landmarks,
                                  std::span<const std::int32_t> edges,
                                  std::span<const std::int32_t> sightings) {
    require_indices(edges, poses, poses);
    require_indices(sightings, poses, landmarks);
    PoseGraph<PlanarSpace> graph;
    graph.start.poses.resize(poses), graph.start.landmarks.resize(landmarks);
    for (std::size_t k = 0; k + 1 < edges.size(); k += 2)
        graph.edges.push_back({edges[k], edges[k + 1], {}, {}});
    for (std::size_t k = 0; k + 1 < sightings.size(); k += 2)
        graph.sightings.push_back({sightings[k], sightings[k + 1], SightingKind::point, {}, {}});
    return find_parts(graph);
}

}  // namespace cspace::localization
