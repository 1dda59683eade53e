// Pose graphs: what the bindings call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cspace/localization/graph/options.hpp"

namespace cspace::localization {

// A graph as arrays. Poses are rows x, y, θ in the plane and matrices 4 × 4 in space, the unit [m] and [rad];
// information is square, of [v; ω] in the base, or of the coordinates of a sighting.
struct GraphArrays {
    bool is_spatial;
    std::span<const double> poses, landmarks;
    std::span<const std::int32_t> edges;  // pairs: from, to
    std::span<const double> motions, information;
    std::span<const std::int32_t> sightings;  // pairs: pose, landmark
    std::span<const double> points, point_information;
    std::span<const std::uint8_t> has_bearing;  // per sighting: (range, bearing) instead of (x, y)
    std::span<const std::uint8_t> is_held, is_landmark_held, is_trusted, is_sighting_trusted;
};

struct SolveRule {
    GraphOptions options;
    GraphStart start = GraphStart::rotations;
    FalseLoops false_loops = FalseLoops::ignore;
    RobustKernel kernel = RobustKernel::none;
    double width = 1;  // of the kernel [standard deviations]
};

// Keeps the state of least cost, also where an interrupt ends a computation.
class GraphSolver {
  public:
    virtual ~GraphSolver() = default;
    virtual GraphStatus optimize(const SolveRule& rule) = 0;
    // Whether the start that was asked for could be found; else the one given was used.
    virtual bool found_start() const = 0;
    virtual const GraphStats& stats() const = 0;
    virtual void write_poses(double* to) const = 0;
    virtual void write_landmarks(double* to) const = 0;
    // The squared errors of all measurements: edges, then sightings; and whether each one counted.
    virtual std::vector<double> squares() const = 0;
    virtual std::vector<std::uint8_t> used() const = 0;
    // What the quantiles of the errors were multiplied with to reject measurements.
    virtual double limit_scale() const = 0;
    // The pose or landmark (after all poses) next to which the equations are singular; −1: none.
    virtual int singular_variable() const = 0;
    // Covariances of the variables (first, second), blocks one after the other, with [v; ω] in the base for
    // poses; false where the equations are singular.
    virtual bool write_covariances(std::span<const std::int32_t> pairs, double* to) = 0;
    // The first measurement in use whose information is not isotropic, or that has no dual; −1: none.
    virtual std::ptrdiff_t anisotropic_measurement() const = 0;
    // Tries to prove that the state of least cost is the global optimum; all information must be isotropic.
    virtual CertificateResult certify() const = 0;
};

// Throws std::invalid_argument for arrays that do not fit together.
std::unique_ptr<GraphSolver> make_graph_solver(const GraphArrays& arrays);

// The part of each pose, then of each landmark.
std::vector<int> find_graph_parts(std::size_t poses, std::size_t landmarks,
                                  std::span<const std::int32_t> edges,
                                  std::span<const std::int32_t> sightings);

}  // namespace cspace::localization
