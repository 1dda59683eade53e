// How a pose graph is optimized, and what came of it: plain data, which the bindings share.
#pragma once

#include <cstdint>
#include <vector>

namespace cspace::localization {

// chordal: an angle θ counts as 2 sin(θ/2).
enum class ResidualKind { twist, g2o, chordal };
enum class RobustKernel { none, huber, cauchy, geman_mcclure, tukey, dcs };
// Against false loops: a kernel alone, dynamic covariance scaling, graduated non-convexity, or the better of
// both.
enum class FalseLoops { ignore, dcs, gnc, better };
enum class GraphStart { given, odometry, rotations };

enum class GraphMethod { gauss_newton, levenberg_marquardt, dog_leg };
enum class GraphStatus { converged, stopped, singular };

inline constexpr double graph_step = 1e-5;  // a hundredth of a millimetre: the next step is smaller by far
inline constexpr double graph_decrease = 1e-9;  // of the cost: thousandths of what is asked of its digits

// Converged is where the step is small and with it the decrease of the cost that it predicts.
struct GraphOptions {
    GraphMethod method = GraphMethod::gauss_newton;
    ResidualKind residual = ResidualKind::twist;
    int most_iterations = 100;
    double least_step = graph_step;          // largest entry [m or rad]
    double least_decrease = graph_decrease;  // predicted, relative to the cost
};

struct GraphStats {
    int iterations = 0, factorizations = 0, analyses = 0;
    std::vector<double> costs;  // of each linearisation
};

// Whether a global optimum of the chordal problem was found from an answer. The bound is below the χ² of all
// states; cost is that of the optimum next to the chordal one.
struct CertificateResult {
    bool is_proved = false;
    double bound = 0, cost = 0;
};

}  // namespace cspace::localization
