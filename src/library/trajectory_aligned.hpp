// Memory for packs, and paths as the kernels read them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cspace/trajectory/path_rows.hpp"
#include "trajectory_timing.hpp"

namespace cspace::trajectory {

// Numbers at an address that suits the widest pack.
class Aligned {
  public:
    explicit Aligned(std::size_t size) : lines_((size + joint_padding - 1) / joint_padding) {}
    double* data() { return lines_.empty() ? nullptr : lines_.front().values; }
    const double* data() const { return lines_.empty() ? nullptr : lines_.front().values; }
    double& operator[](std::size_t i) { return data()[i]; }
    double operator[](std::size_t i) const { return data()[i]; }

  private:
    struct alignas(8 * joint_padding) Line {
        double values[joint_padding] = {};
    };
    std::vector<Line> lines_;
};

inline int padded_joints(int joints) { return (joints + joint_padding - 1) / joint_padding * joint_padding; }
// The degree of q' that the kernels know.
inline int slope_degree(const TimingPath& path) { return path.degree <= 3 ? 2 : 4; }

// Bernstein coefficients of dq/ds of every piece, (pieces, degree + 1, padded).
Aligned find_slopes(const TimingPath& path, int degree, int padded);
// 1 / limit, 0 where there is none and where the joint may not move.
std::vector<double> invert_limits(std::span<const double> limits, int padded);
// Sampled limits with padded joints, and as the kernels read them.
TimingSamples pad_samples(TimingSamples samples, int joints, int padded);
SampledLimits show_samples(const TimingSamples& samples);

}  // namespace cspace::trajectory
