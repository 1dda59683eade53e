// Laws of pose graphs: derivatives against differences, at random, near zero and near half turns; exponential
// and logarithm are inverse; the optimizers agree.
#include <cmath>
#include <vector>

#include "check.hpp"
#include "cspace/localization/graph/false_loops.hpp"
#include "cspace/localization/graph/initial_guess.hpp"
#include "cspace/localization/graph/spatial_space.hpp"
#include "random.hpp"

namespace {

using namespace cspace::localization;
using cspace::HeaderFronts;

template <class Space>
typename Space::Twist random_twist(check::Random& random, double reach, double angle) {
    typename Space::Twist twist;
    for (std::size_t k = 0; k < Space::freedom; ++k)
        twist[k] = k < Space::dimension ? random.uniform(-reach, reach) : random.uniform(-1, 1);
    double norm = 0;
    for (std::size_t k = Space::dimension; k < Space::freedom; ++k) norm += twist[k] * twist[k];
    for (std::size_t k = Space::dimension; k < Space::freedom; ++k) twist[k] *= angle / std::sqrt(norm);
    return twist;
}
template <class Space>
typename Space::Pose random_pose(check::Random& random) {
    return Space::exponential(random_twist<Space>(random, 3, random.uniform(-3, 3)).data());
}
template <class Space>
typename Space::Square random_information(check::Random& random) {
    constexpr std::size_t n = Space::freedom;
    typename Space::Square root, W{};
    for (double& x : root) x = random.uniform(-1, 1);
    W = cspace::localization::transpose_times<n, n, n>(root, root);
    for (std::size_t k = 0; k < n; ++k) W[k * (n + 1)] += 0.5;
    return W;
}

// eᵀWe of one measurement as a function of disturbances of both poses, against its quadratic model: the
// gradient by differences, and the model of an exact measurement to second order.
template <class Space>
void check_edge(check::Random& random, ResidualKind kind, double angle) {
    constexpr std::size_t n = Space::freedom;
    PoseGraph<Space> graph;
    graph.start.poses = {random_pose<Space>(random), random_pose<Space>(random)};
    const auto motion = Space::between(graph.start.poses[0], graph.start.poses[1]);
    const auto error = Space::exponential(random_twist<Space>(random, 1, angle).data());
    const RelativePose<Space> edge{0, 1, Space::compose(motion, Space::inverse(error)),
                                   random_information<Space>(random)};
    // Z⁻¹ M = error for Z = M error⁻¹.
    const EdgeModel<Space> model = linearize_edge(edge, graph.start, kind);
    constexpr double h = 1e-6;
    for (std::size_t pose = 0; pose < 2; ++pose) {
        for (std::size_t k = 0; k < n; ++k) {
            double squares[2];
            for (int side = 0; side < 2; ++side) {
                typename Space::Twist twist{};
                twist[k] = side ? h : -h;
                auto moved = graph.start;
                moved.poses[pose] = Space::move(moved.poses[pose], twist.data());
                squares[side] = weigh_residual(evaluate_edge(edge, moved, kind).e, edge.W);
            }
            const double expected = (squares[1] - squares[0]) / (4 * h);
            const double found = pose ? model.gb[k] : model.ga[k];
            CHECK_NEAR(found, expected, 1e-7 * (1 + std::fabs(model.square) + std::fabs(expected)));
        }
    }
    // JᵀWJ of the whole measurement is symmetric and consistent with moving both poses alike.
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            CHECK_NEAR(model.bb[i * n + j], model.bb[j * n + i],
                       1e-10 * (1 + std::fabs(model.bb[i * n + j])));
            CHECK_NEAR(model.aa[i * n + j], model.aa[j * n + i], 1e-9 * (1 + std::fabs(model.aa[i * n + j])));
        }
    }
}

template <class Space>
void check_edges() {
    check::Random random{17};
    for (int trial = 0; trial < 40; ++trial) {
        for (double angle : {1e-9, 1e-4, 9e-3, 0.09, 0.11, 1.0, 2.5, 3.1, 3.13}) {
            check_edge<Space>(random, ResidualKind::twist, angle);
            check_edge<Space>(random, ResidualKind::g2o, angle);
        }
    }
}

template <class Space>
void check_exponential() {
    check::Random random{23};
    for (int trial = 0; trial < 200; ++trial) {
        for (double angle : {1e-12, 1e-7, 1e-3, 0.5, 2.0, 3.1, 3.14159}) {
            const auto twist = random_twist<Space>(random, 2, angle);
            const auto back = Space::logarithm(Space::exponential(twist.data()));
            for (std::size_t k = 0; k < Space::freedom; ++k) CHECK_NEAR(back[k], twist[k], 1e-9);
        }
    }
}

void check_sighting(SightingKind kind) {
    check::Random random{29};
    for (int trial = 0; trial < 100; ++trial) {
        PoseGraph<PlanarSpace> graph;
        graph.start.poses = {random_pose<PlanarSpace>(random)};
        graph.start.landmarks = {{random.uniform(-5, 5), random.uniform(-5, 5)}};
        const Sighting<PlanarSpace> seen{
            0, 0, kind, {random.uniform(0, 4), random.uniform(-3, 3)}, {2, 0.3, 0.3, 1}};
        const auto model = linearize_sighting(seen, graph.start);
        constexpr double h = 1e-6;
        for (std::size_t k = 0; k < 5; ++k) {
            double squares[2];
            for (int side = 0; side < 2; ++side) {
                auto moved = graph.start;
                PlanarSpace::Twist twist{};
                const double step = side ? h : -h;
                if (k < 3) {
                    twist[k] = step;
                    moved.poses[0] = PlanarSpace::move(moved.poses[0], twist.data());
                } else {
                    moved.landmarks[0][k - 3] += step;
                }
                squares[side] = weigh_residual(evaluate_sighting(seen, moved).e, seen.W);
            }
            const double expected = (squares[1] - squares[0]) / (4 * h);
            CHECK_NEAR(k < 3 ? model.ga[k] : model.gb[k - 3], expected, 1e-5 * (1 + std::fabs(expected)));
        }
    }
}

// A loop of poses with noise, and some more edges across.
template <class Space>
PoseGraph<Space> random_graph(check::Random& random, int poses, double noise) {
    PoseGraph<Space> graph;
    std::vector<typename Space::Pose> truth{
        typename Space::Pose(Space::exponential(typename Space::Twist{}.data()))};
    for (int k = 1; k < poses; ++k)
        truth.push_back(
            Space::compose(truth.back(), Space::exponential(random_twist<Space>(random, 1, 0.3).data())));
    const auto add_edge = [&](int i, int j) {
        auto error = random_twist<Space>(random, noise, noise);
        const auto motion = Space::between(truth[std::size_t(i)], truth[std::size_t(j)]);
        graph.edges.push_back({i, j, Space::compose(motion, Space::exponential(error.data())),
                               random_information<Space>(random)});
        graph.is_trusted.push_back(j == i + 1);
    };
    for (int k = 1; k < poses; ++k) add_edge(k - 1, k);
    for (int k = 0; k < poses; ++k) {
        const int i = random.below(poses), j = random.below(poses);
        if (i != j) add_edge(i, j);
    }
    graph.start.poses = truth;
    graph.is_held.assign(std::size_t(poses), 0);
    graph.is_held[0] = 1;
    return graph;
}

template <class Space>
double optimize_from(const PoseGraph<Space>& graph, const GraphState<Space>& start, GraphMethod method) {
    GraphOptions options;
    options.method = method;
    GraphOptimizer<Space, HeaderFronts> optimizer(graph, options);
    optimizer.use_factors(std::vector<char>(graph.factors(), 1));
    auto state = start;
    CHECK(optimizer.optimize(state) == GraphStatus::converged);
    return optimizer.measure_cost(state);
}

template <class Space>
void check_methods() {
    check::Random random{31};
    for (int trial = 0; trial < 5; ++trial) {
        const PoseGraph<Space> graph = random_graph<Space>(random, 30, 0.05);
        const double expected = optimize_from(graph, graph.start, GraphMethod::gauss_newton);
        const auto reckoned = reckon_poses(graph);
        const auto relaxed = Relaxation<Space, HeaderFronts>(graph).solve();
        CHECK(relaxed.has_value());
        for (auto method :
             {GraphMethod::gauss_newton, GraphMethod::levenberg_marquardt, GraphMethod::dog_leg}) {
            CHECK_NEAR(optimize_from(graph, reckoned, method), expected, 1e-6 * expected);
            CHECK_NEAR(optimize_from(graph, *relaxed, method), expected, 1e-6 * expected);
        }
    }
}

// Without noise, dead reckoning and the relaxation are exact.
template <class Space>
void check_exact_starts() {
    check::Random random{37};
    const PoseGraph<Space> graph = random_graph<Space>(random, 40, 1e-14);
    std::vector<double> squares;
    const auto relaxed = Relaxation<Space, HeaderFronts>(graph).solve();
    for (const auto& state : {reckon_poses(graph), *relaxed}) {
        measure_squares(graph, state, ResidualKind::twist, squares);
        for (double square : squares) CHECK(square < 1e-18);
    }
}

}  // namespace

TEST(derivatives_in_the_plane) { check_edges<PlanarSpace>(); }
TEST(derivatives_in_space) { check_edges<SpatialSpace>(); }
TEST(exponential_and_logarithm) { check_exponential<PlanarSpace>(), check_exponential<SpatialSpace>(); }
TEST(derivatives_of_sightings) {
    check_sighting(SightingKind::point), check_sighting(SightingKind::range_bearing);
}
TEST(methods_and_starts_agree) { check_methods<PlanarSpace>(), check_methods<SpatialSpace>(); }
TEST(starts_are_exact_without_noise) {
    check_exact_starts<PlanarSpace>(), check_exact_starts<SpatialSpace>();
}
