// How a pose graph is optimized, and what came of it: plain data, which the bindings share.
#pragma once

#include <cstdint>
#include <vector>

namespace cspace::localization {

enum class ResidualKind { twist, g2o };
enum class RobustKernel { none, huber, cauchy, geman_mcclure, tukey, dcs };
// Against false loops: a kernel alone, dynamic covariance scaling, graduated non-convexity, or the better of both.
enum class FalseLoops { ignore, dcs, gnc, better };
enum class GraphStart { given, odometry, rotations };

enum class GraphMethod { gauss_newton, levenberg_marquardt, dog_leg };
enum class GraphStatus { converged, stopped, singular };

// Converged is where the step is small and with it the decrease of the cost that it predicts.
struct GraphOptions {
    GraphMethod method = GraphMethod::gauss_newton;
    ResidualKind residual = ResidualKind::twist;
    int most_iterations = 100;
    double least_step = 1e-5;      // largest entry [m or rad]
    double least_decrease = 1e-9;  // predicted, relative to the cost
};

struct GraphStats {
    int iterations = 0, factorizations = 0, analyses = 0;
    std::vector<double> costs;  // of each linearisation
};

}  // namespace cspace::localization
