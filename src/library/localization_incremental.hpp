// Pose graphs that grow: what the bindings call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cspace/localization/graph/options.hpp"

namespace cspace::localization {

// The measurements of an incremental graph, those that do not wait: rows of poses and landmarks, and numbers
// as in GraphArrays.
struct IncrementalArrays {
    std::vector<std::int32_t> edges, sightings;
    std::vector<double> motions, information, points, point_information;
    std::vector<std::uint8_t> has_bearing;
};

// Poses are rows x, y, θ in the plane and matrices 4 × 4 in space. Rows of poses and landmarks are in the order
// in which they were connected with the held pose.
class IncrementalSolver {
  public:
    virtual ~IncrementalSolver() = default;
    virtual bool is_spatial() const = 0;
    virtual void hold_pose(std::int64_t id, std::span<const double> pose) = 0;
    // Pairs of ids, with their numbers one after the other.
    virtual void add_edges(std::span<const std::int64_t> ids, std::span<const double> motions,
                           std::span<const double> information) = 0;
    virtual void add_sightings(std::span<const std::int64_t> ids, std::span<const double> points,
                               std::span<const double> information,
                               std::span<const std::uint8_t> has_bearing) = 0;
    // Brings the estimate up to date; false where the equations are singular.
    virtual bool step() = 0;
    // Goes on from a state, with all measurements linearised there.
    virtual bool restart(std::span<const double> poses, std::span<const double> landmarks) = 0;

    virtual const std::vector<std::int64_t>& pose_ids() const = 0;
    virtual const std::vector<std::int64_t>& landmark_ids() const = 0;
    virtual int find_pose(std::int64_t id) const = 0;  // its row; −1: none of this id
    virtual int find_landmark(std::int64_t id) const = 0;
    virtual void write_pose(int row, double* to) const = 0;
    virtual void write_state(double* poses, double* landmarks) const = 0;
    virtual std::size_t waiting() const = 0;
    virtual std::size_t eliminated() const = 0;
    virtual double cost() const = 0;
    virtual IncrementalArrays arrays() const = 0;
    // The covariance of two poses, or of two landmarks; false where the equations are singular.
    virtual bool write_covariance(bool is_pose, int a, int b, double* to) = 0;
};

std::unique_ptr<IncrementalSolver> make_incremental_solver(bool is_spatial, double relinearize,
                                                           double substitute);

// Whether matrices of this size are symmetric to the last digit and positive definite by far; those for which it
// is false need a closer look.
bool are_clearly_positive(std::span<const double> matrices, int size);

}  // namespace cspace::localization
