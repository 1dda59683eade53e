#include "localization_landmarks.hpp"

#include <stdexcept>

#include "cspace/localization/landmarks/fast_slam.hpp"
#include "cspace/mobile/random_walk.hpp"
#include "kernels/localization_landmarks.hpp"

namespace cspace::localization {

namespace {

struct KernelPanels {
    static void add(double* panels, int first, int last, const double* X, const double* Y,
                    std::ptrdiff_t stride, int rank) {
        kernels::add_panel_products(panels, first, last, X, Y, stride, rank);
    }
    static void add_weighted(double* const* to, int count, const WeightedVectors& from) {
        kernels::add_weighted_vectors(to, count, from);
    }
};

std::array<double, 3> write_pose(const PlanarSpace::Pose& pose) {
    std::array<double, 3> row;
    PlanarSpace::write_pose(pose, row.data());
    return row;
}
void append_landmark(LandmarkRows& rows, const MappedLandmark& landmark, bool is_confirmed,
                     const Matrix2& P) {
    rows.names.push_back(landmark.name);
    rows.points.insert(rows.points.end(), landmark.point.begin(), landmark.point.end());
    rows.covariances.insert(rows.covariances.end(), P.begin(), P.end());
    rows.seen.push_back(landmark.seen);
    rows.is_confirmed.push_back(is_confirmed);
}

// Both filters: readings are read, outcomes kept.
template <class Filter>
class FilterOf : public LandmarkFilter {
  public:
    template <class Rule>
    FilterOf(const Rule& rule, const std::array<double, 3>& start, const std::array<double, 9>& covariance)
        : filter_(rule, start, covariance) {}

    void predict(const std::array<double, 3>& increment, const std::array<double, 9>& noise) override {
        filter_.predict(PlanarSpace::read_pose(increment.data()), noise);
    }
    void update(std::span<const std::array<double, 3>> readings) override {
        if (is_broken_) throw std::logic_error("its last update was interrupted");
        readings_.clear();
        for (const auto& row : readings) readings_.push_back({std::int64_t(row[0]), row[1], row[2]});
        outcomes_ = {};
        is_broken_ = !Filter::is_resumable;
        outcomes_ = filter_.update(readings_);
        is_broken_ = false;
    }
    std::span<const ReadingOutcome> outcomes() const override { return outcomes_; }
    std::array<double, 3> pose() const override { return write_pose(filter_.pose()); }
    std::array<double, 9> base_covariance() const override { return filter_.base_covariance(); }
    bool is_lost() const override { return filter_.is_lost(); }
    const LandmarkCounts& counts() const override { return filter_.counts(); }

  protected:
    Filter filter_;

  private:
    std::vector<LandmarkReading> readings_;
    std::span<const ReadingOutcome> outcomes_;
    bool is_broken_ = false;
};

class EkfFilter final : public FilterOf<EkfSlam<KernelPanels>> {
  public:
    using FilterOf::FilterOf;
    LandmarkRows landmarks() const override {
        LandmarkRows rows;
        for (int j = 0; j < int(filter_.landmarks().size()); ++j) {
            const MappedLandmark& landmark = filter_.landmarks()[std::size_t(j)];
            append_landmark(rows, landmark, filter_.is_confirmed(landmark), filter_.covariance().block(j, j));
        }
        return rows;
    }
    std::vector<double> joint_covariance() const override {
        const auto& P = filter_.covariance();
        const std::size_t m = std::size_t(P.landmarks()), n = 3 + 2 * m;
        std::vector<double> dense(n * n);
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) dense[n * i + j] = P.pose()[3 * i + j];
            for (std::size_t c = 0; c < 2 * m; ++c)
                dense[n * i + 3 + c] = dense[n * (3 + c) + i] = P.cross(i)[c];
        }
        for (std::size_t i = 0; i < m; ++i) {
            for (std::size_t j = 0; j < m; ++j) {
                const Matrix2 block = P.block(int(i), int(j));
                for (std::size_t k = 0; k < 4; ++k)
                    dense[n * (3 + 2 * i + k / 2) + 3 + 2 * j + k % 2] = block[k];
            }
        }
        return dense;
    }
};

class ParticleFilterOfLandmarks final : public FilterOf<FastSlam> {
  public:
    using FilterOf::FilterOf;
    LandmarkRows landmarks() const override {
        LandmarkRows rows;
        std::vector<Symmetric2> covariances;
        const auto found = filter_.landmarks(covariances);
        for (std::size_t j = 0; j < found.size(); ++j) {
            const Symmetric2& P = covariances[j];
            append_landmark(rows, found[j], filter_.is_confirmed(found[j]), {P[0], P[1], P[1], P[2]});
        }
        return rows;
    }
    std::vector<std::array<double, 4>> particles() const override {
        std::vector<std::array<double, 4>> rows;
        for (std::size_t k = 0; k < filter_.particles(); ++k) {
            const auto pose = write_pose(filter_.particle(k));
            rows.push_back({pose[0], pose[1], pose[2], filter_.shares()[k]});
        }
        return rows;
    }
    std::size_t chunks() const override { return filter_.chunks(); }
};

}  // namespace

void LandmarkFilter::predict_walk(const std::array<double, 3>& increment, const mobile::RandomWalk& walk,
                                  double duration) {
    const auto xi = PlanarSpace::logarithm(PlanarSpace::read_pose(increment.data()));
    predict(increment, mobile::walk_covariance(walk, xi.data(), duration));
}

std::unique_ptr<LandmarkFilter> make_ekf_slam(const EkfSlamRule& rule, const std::array<double, 3>& start,
                                              const std::array<double, 9>& covariance) {
    return std::make_unique<EkfFilter>(rule, start, covariance);
}
std::unique_ptr<LandmarkFilter> make_fast_slam(const FastSlamRule& rule, const std::array<double, 3>& start,
                                               const std::array<double, 9>& covariance) {
    return std::make_unique<ParticleFilterOfLandmarks>(rule, start, covariance);
}

}  // namespace cspace::localization
