// Residuals of the measurements of a pose graph, and their exact derivatives.
//
// A relative pose has the residual e = log(Z⁻¹ Xᵢ⁻¹ Xⱼ), a twist, with the derivatives Jr⁻¹(e) and
// −Jr⁻¹(e) Ad(Xⱼ⁻¹ Xᵢ) for disturbances on the right; or that of g2o, whose rotational part in space is the
// vector of the quaternion (Kümmerle et al. 2011).
#pragma once

#include <cmath>
#include <cstddef>

#include "cspace/localization/graph/options.hpp"
#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/localization/graph/pose_graph.hpp"

namespace cspace::localization {

// Aᵀ B of row-major matrices: rows × a and rows × b.
template <std::size_t rows, std::size_t a, std::size_t b>
std::array<double, a * b> transpose_times(const std::array<double, rows * a>& A,
                                          const std::array<double, rows * b>& B) {
    std::array<double, a * b> C{};
    for (std::size_t k = 0; k < rows; ++k) {
        for (std::size_t i = 0; i < a; ++i) {
            for (std::size_t j = 0; j < b; ++j) C[i * b + j] += A[k * a + i] * B[k * b + j];
        }
    }
    return C;
}
// A B of row-major matrices: rows × inner and inner × b.
template <std::size_t rows, std::size_t inner, std::size_t b>
std::array<double, rows * b> multiply(const std::array<double, rows * inner>& A,
                                      const std::array<double, inner * b>& B) {
    std::array<double, rows * b> C{};
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t k = 0; k < inner; ++k) {
            for (std::size_t j = 0; j < b; ++j) C[i * b + j] += A[i * inner + k] * B[k * b + j];
        }
    }
    return C;
}
// eᵀ W e.
template <std::size_t n, std::size_t square>
double weigh_residual(const std::array<double, n>& e, const std::array<double, square>& W) {
    static_assert(square == n * n);
    const std::array<double, n> We = multiply<n, n, 1>(W, e);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += e[k] * We[k];
    return sum;
}

template <class Space>
struct EdgeError {
    typename Space::Pose motion;  // Xᵢ⁻¹ Xⱼ
    typename Space::Pose error;   // Z⁻¹ Xᵢ⁻¹ Xⱼ
    typename Space::Twist e;
};

template <class Space>
EdgeError<Space> evaluate_edge(const RelativePose<Space>& edge, const GraphState<Space>& state,
                               ResidualKind kind) {
    EdgeError<Space> found;
    found.motion = Space::between(state.poses[std::size_t(edge.from)], state.poses[std::size_t(edge.to)]);
    found.error = Space::between(edge.z, found.motion);
    found.e = kind == ResidualKind::twist ? Space::logarithm(found.error)
              : kind == ResidualKind::g2o ? Space::g2o_residual(found.error)
                                          : Space::chordal_residual(found.error);
    return found;
}

// The quadratic model of a measurement: blocks of JᵀWJ for its variables a and b, and of JᵀWe.
template <std::size_t a, std::size_t b>
struct QuadraticModel {
    double square;  // eᵀWe
    std::array<double, a * a> aa;
    std::array<double, a * b> ab;
    std::array<double, b * b> bb;
    std::array<double, a> ga;
    std::array<double, b> gb;
};

template <class Space>
using EdgeModel = QuadraticModel<Space::freedom, Space::freedom>;
template <class Space>
using SightingModel = QuadraticModel<Space::freedom, Space::dimension>;

template <class Space>
EdgeModel<Space> linearize_edge(const RelativePose<Space>& edge, const GraphState<Space>& state,
                                ResidualKind kind) {
    constexpr std::size_t n = Space::freedom;
    const EdgeError<Space> found = evaluate_edge(edge, state, kind);
    const typename Space::Square J =
        kind == ResidualKind::twist ? Space::log_jacobian(found.e)
        : kind == ResidualKind::g2o ? Space::g2o_jacobian(found.error)
                                    : Space::chordal_jacobian(found.error);
    typename Space::Square A = Space::adjoint(Space::inverse(found.motion));
    for (double& x : A) x = -x;  // dξⱼ = −Ad(Xⱼ⁻¹ Xᵢ) dξᵢ
    const typename Space::Square WJ = multiply<n, n, n>(edge.W, J);
    EdgeModel<Space> model;
    model.square = weigh_residual(found.e, edge.W);
    model.bb = transpose_times<n, n, n>(J, WJ);
    model.gb = transpose_times<n, n, 1>(WJ, found.e);
    model.ab = transpose_times<n, n, n>(A, model.bb);
    model.aa = multiply<n, n, n>(model.ab, A);
    model.ga = transpose_times<n, n, 1>(A, model.gb);
    return model;
}

template <class Space>
struct SightingError {
    typename Space::Point h;  // the landmark in the base
    typename Space::Point e;
};

template <class Space>
SightingError<Space> evaluate_sighting(const Sighting<Space>& sighting, const GraphState<Space>& state) {
    SightingError<Space> found;
    found.h = Space::to_base(state.poses[std::size_t(sighting.pose)],
                             state.landmarks[std::size_t(sighting.landmark)]);
    if (sighting.kind == SightingKind::point) {
        for (std::size_t k = 0; k < found.e.size(); ++k) found.e[k] = found.h[k] - sighting.z[k];
    } else {
        found.e = {};
        found.e[0] = std::hypot(found.h[0], found.h[1]) - sighting.z[0];
        found.e[1] = wrap_angle(std::atan2(found.h[1], found.h[0]) - sighting.z[1]);
    }
    return found;
}

// d (range, bearing) / dh in the plane; a landmark in the base has no bearing, and moves neither.
inline std::array<double, 4> range_bearing_jacobian(const std::array<double, 2>& h) {
    constexpr double least = 1e-12;  // [m], square: nearer landmarks have no bearing
    const double square = h[0] * h[0] + h[1] * h[1], range = std::sqrt(square);
    if (square < least * least) return {};
    return {h[0] / range, h[1] / range, -h[1] / square, h[0] / square};
}

template <class Space>
SightingModel<Space> linearize_sighting(const Sighting<Space>& sighting, const GraphState<Space>& state) {
    constexpr std::size_t n = Space::freedom, p = Space::dimension;
    const SightingError<Space> found = evaluate_sighting(sighting, state);
    typename Space::PointByPose A = Space::point_by_pose(found.h);
    typename Space::PointSquare B = Space::point_by_point(state.poses[std::size_t(sighting.pose)]);
    if constexpr (p == 2) {
        if (sighting.kind == SightingKind::range_bearing) {
            const auto G = range_bearing_jacobian(found.h);
            A = multiply<p, p, n>(G, A), B = multiply<p, p, p>(G, B);
        }
    }
    const auto WA = multiply<p, p, n>(sighting.W, A);
    const auto WB = multiply<p, p, p>(sighting.W, B);
    SightingModel<Space> model;
    model.square = weigh_residual(found.e, sighting.W);
    model.aa = transpose_times<p, n, n>(A, WA);
    model.ab = transpose_times<p, n, p>(A, WB);
    model.bb = transpose_times<p, p, p>(B, WB);
    model.ga = transpose_times<p, n, 1>(WA, found.e);
    model.gb = transpose_times<p, p, 1>(WB, found.e);
    return model;
}

// The squared errors of all measurements: the edges, then the sightings.
template <class Space>
void measure_squares(const PoseGraph<Space>& graph, const GraphState<Space>& state, ResidualKind kind,
                     std::vector<double>& squares) {
    squares.resize(graph.factors());
    for (std::size_t k = 0; k < graph.edges.size(); ++k)
        squares[k] = weigh_residual(evaluate_edge(graph.edges[k], state, kind).e, graph.edges[k].W);
    for (std::size_t k = 0; k < graph.sightings.size(); ++k)
        squares[graph.edges.size() + k] =
            weigh_residual(evaluate_sighting(graph.sightings[k], state).e, graph.sightings[k].W);
}

}  // namespace cspace::localization
