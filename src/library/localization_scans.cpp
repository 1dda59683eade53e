#include "localization_scans.hpp"

#include <stdexcept>

#include "cspace/localization/scans/laser_slam.hpp"
#include "cspace/localization/scans/line_icp.hpp"
#include "kernels/localization_correlation.hpp"
#include "localization_fronts.hpp"

namespace cspace::localization {

namespace {

struct CorrelationKernels {
    static int sum_windows(const std::uint8_t* scores, const std::int32_t* at, int beams, int stride,
                           int rows, int columns, std::uint16_t* sums) {
        return kernels::sum_score_windows(scores, at, beams, stride, rows, columns, sums);
    }
};

PoseRow write_pose(const PlanarSpace::Pose& pose) {
    PoseRow row;
    PlanarSpace::write_pose(pose, row.data());
    return row;
}
std::vector<PoseRow> write_poses(const std::vector<PlanarSpace::Pose>& poses) {
    std::vector<PoseRow> rows;
    for (const auto& pose : poses) rows.push_back(write_pose(pose));
    return rows;
}

maps::ByteField read_field(const ScoreArray& given) {
    maps::ByteField field;
    field.frame.resolution = given.resolution, field.frame.origin = given.origin;
    field.rows = given.rows, field.columns = given.columns;
    field.outside = std::uint8_t(given.outside);
    field.scores.assign(given.scores, given.scores + std::size_t(given.rows) * std::size_t(given.columns));
    return field;
}

class RunOfKernels : public LaserSlamRun {
  public:
    RunOfKernels(std::vector<Point> points, std::vector<std::int32_t> first, std::vector<PoseRow> steps,
                 const SlamOptions& options)
        : slam_(std::move(points), std::move(first), std::move(steps), options) {}
    bool advance(int scans) override { return slam_.advance(scans); }
    int done() const override { return slam_.done(); }
    int tried() const override { return slam_.tried(); }
    int optimizations() const override { return slam_.optimizations(); }
    std::vector<PoseRow> poses() const override { return write_poses(slam_.poses()); }
    std::vector<PoseRow> matched() const override { return write_poses(slam_.matched()); }
    std::vector<ScanRelation> edges() const override { return write_relations(slam_.edges(), {}); }
    std::vector<ScanRelation> loops() const override {
        return write_relations(slam_.loops(), slam_.verdicts());
    }

  private:
    static std::vector<ScanRelation> write_relations(const std::vector<ScanEdge>& edges,
                                                     const std::vector<LoopVerdict>& verdicts) {
        std::vector<ScanRelation> found;
        for (std::size_t k = 0; k < edges.size(); ++k) {
            const ScanEdge& edge = edges[k];
            found.push_back({edge.from, edge.to, write_pose(edge.z), edge.covariance, edge.score, edge.second,
                             verdicts.empty() ? 0 : int(verdicts[k])});
        }
        return found;
    }
    LaserSlam<CorrelationKernels, KernelFronts> slam_;
};

}  // namespace

ScanMatchResult match_points(const ScoreArray& given, std::span<const Point> points, const PoseRow& guess,
                             double reach, double turn, bool refines) {
    const maps::ByteField field = read_field(given);
    static thread_local CorrelativeSearch<CorrelationKernels> search;  // keeps its memory
    const SearchPeak peak =
        search.find_peak(field, points, PlanarSpace::read_pose(guess.data()), {reach, turn}, {}, 0, true);
    ScanMatchResult result{peak.is_found, peak.is_ambiguous, guess, peak.covariance, peak.score, peak.second};
    if (!peak.is_found) return result;
    const PlanarSpace::Pose pose = refines ? refine_pose(field, points, peak.pose) : peak.pose;
    result.pose = write_pose(pose);
    if (refines) result.score = measure_score(field, points, pose);
    return result;
}

ScanMatchResult match_point_lines(const ScoreArray& given, std::span<const Point> reference,
                                  std::span<const Point> points, const PoseRow& guess, double reach) {
    const maps::ByteField field = read_field(given);
    const IcpResult found = match_lines(reference, points, PlanarSpace::read_pose(guess.data()), reach);
    return {found.is_found,
            false,
            write_pose(found.pose),
            found.covariance,
            found.is_found ? measure_score(field, points, found.pose) : 0,
            0};
}

PointField make_field_of_points(std::span<const Point> points, double resolution, double sigma) {
    maps::ByteField field = make_point_field(points, resolution, sigma);
    return {std::move(field.scores), field.columns, field.frame.origin};
}

std::vector<Point> thin_scans(std::span<const Point> points, std::vector<std::int32_t>& first, int most) {
    std::vector<Point> all, kept;
    std::size_t begin = 0;
    for (std::size_t k = 1; k < first.size(); ++k) {
        const auto end = std::size_t(first[k]);
        if (end < begin || end > points.size())
            throw std::invalid_argument("the arrays of the scans do not fit together");
        thin_points(points.subspan(begin, end - begin), std::size_t(std::clamp(most, 1, most_beams)), kept);
        all.insert(all.end(), kept.begin(), kept.end());
        first[k] = std::int32_t(all.size()), begin = end;
        poll_interrupts();
    }
    return all;
}

std::unique_ptr<LaserSlamRun> make_laser_slam(std::span<const Point> points,
                                              std::span<const std::int32_t> first,
                                              std::span<const PoseRow> steps, const SlamRule& rule) {
    bool fits = !first.empty() && first.front() == 0 && std::size_t(first.back()) == points.size();
    for (std::size_t k = 1; k < first.size(); ++k) fits = fits && first[k] >= first[k - 1];
    if (!fits || steps.size() + 1 < first.size() - 1)
        throw std::invalid_argument("the arrays of the scans do not fit together");
    return std::make_unique<RunOfKernels>(
        std::vector<Point>(points.begin(), points.end()),
        std::vector<std::int32_t>(first.begin(), first.end()),
        std::vector<PoseRow>(steps.begin(), steps.end()),
        SlamOptions{rule.resolution,
                    rule.sigma,
                    {rule.first_angle, rule.span, PlanarSpace::read_pose(rule.T_base_laser.data())},
                    rule.finds_loops});
}

}  // namespace cspace::localization
