// Laws of scan matching: window sums and searches equal plain loops, pooled bounds are bounds, cliques agree
// pairwise, a drive around a square room closes.
#include <cmath>
#include <stdexcept>
#include <vector>

#include "check.hpp"
#include "cspace/localization/graph/false_loops.hpp"
#include "cspace/localization/scans/laser_slam.hpp"
#include "cspace/localization/scans/line_icp.hpp"
#include "random.hpp"

namespace {

using namespace cspace::localization;
using cspace::HeaderFronts;
using cspace::Point;

struct HeaderSums {
    static int sum_windows(const std::uint8_t* scores, const std::int32_t* at, int beams, int stride,
                           int rows, int columns, std::uint16_t* sums) {
        return cspace::localization::sum_windows(scores, at, beams, stride, rows, columns, sums);
    }
};

TEST(window_sums_are_sums) {
    check::Random random(1);
    std::vector<std::uint8_t> scores(120 * 100);
    for (auto& score : scores) score = std::uint8_t(random.uniform(0, 256));
    for (int trial = 0; trial < 50; ++trial) {
        const int rows = 1 + int(random.uniform(0, 30)), columns = 1 + int(random.uniform(0, 40));
        std::vector<std::int32_t> at;
        for (int k = 0; k < most_window_beams; ++k)
            at.push_back(int(random.uniform(0, 60)) * 120 + int(random.uniform(0, 60)));
        std::vector<std::uint16_t> sums(std::size_t(rows * padded_columns(columns)));
        const int greatest =
            sum_windows(scores.data(), at.data(), int(at.size()), 120, rows, columns, sums.data());
        int expected = 0;
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                int sum = 0;
                for (const std::int32_t start : at) sum += scores[std::size_t(start + row * 120 + column)];
                CHECK(sums[std::size_t(row * padded_columns(columns) + column)] == sum);
                expected = std::max(expected, sum);
            }
        }
        CHECK(greatest == expected);
    }
}

TEST(pooled_scores_are_bounds) {
    check::Random random(2);
    cspace::maps::ByteField field;
    field.rows = 37, field.columns = 53, field.frame.resolution = 0.1, field.outside = 3;
    for (int k = 0; k < 37 * 53; ++k) field.scores.push_back(std::uint8_t(random.uniform(0, 256)));
    PaddedField padded;
    padded.copy_part(field, {2, 2}, 100, 12, 64);
    padded.pool_blocks();
    for (int trial = 0; trial < 2000; ++trial) {
        const int row = int(random.uniform(0, padded.last_row + 1));
        const int column = int(random.uniform(0, padded.last_column + 1));
        const int i = int(random.uniform(0, 3)), j = int(random.uniform(0, 16));
        const int bound =
            padded.pooled[std::size_t(padded.pooled_at(row, column) + i * padded.pooled_stride() + j)];
        for (int a = 0; a < 4; ++a) {
            for (int b = 0; b < 4; ++b) {
                const auto at = std::size_t((row + 4 * i + a) * padded.stride + column + 4 * j + b);
                CHECK(at < padded.bytes.size() && padded.bytes[at] <= bound);
            }
        }
    }
}

std::vector<Point> see_room(const PlanarSpace::Pose& pose, int beams) {
    std::vector<Point> points;
    for (int k = 0; k < beams; ++k) {
        const double angle = 2 * cspace::pi * k / beams, c = std::cos(angle), s = std::sin(angle);
        const double x = pose.c * c - pose.s * s,
                     y = pose.s * c + pose.c * s;  // of the beam, in a room 6 × 4
        const double across = x > 0 ? (3 - pose.x) / x : (-3 - pose.x) / x;
        const double up = y > 0 ? (2 - pose.y) / y : (-2 - pose.y) / y;
        const double range = std::min(std::fabs(across), std::fabs(up));
        points.push_back({range * c, range * s});
    }
    return points;
}

TEST(matches_find_the_motion) {
    check::Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const double moved[3] = {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4),
                                 random.uniform(-0.2, 0.2)};
        const auto pose = PlanarSpace::exponential(moved);
        const auto field = make_point_field(see_room({}, 360), 0.05, 0.08);
        const auto points = see_room(pose, 120);
        CorrelativeSearch<HeaderSums> search;
        const SearchPeak peak = search.find_peak(field, points, {}, {0.6, 0.3});
        CHECK(peak.is_found && !peak.is_clipped);
        const double reach = 0.5 * std::max(std::fabs(pose.x), std::fabs(pose.y));
        if (reach > 0.1) CHECK(search.find_peak(field, points, {}, {reach, 0.3}).is_clipped);
        const auto fine = refine_pose(field, points, peak.pose);
        CHECK(std::hypot(fine.x - pose.x, fine.y - pose.y) < 0.02);
        const IcpResult lines = match_lines(see_room({}, 360), points, peak.pose, 0.5);
        CHECK(lines.is_found && std::hypot(lines.pose.x - pose.x, lines.pose.y - pose.y) < 0.02);
    }
}

TEST(views_contain_what_lies_between_their_edges) {
    check::Random random(6);
    for (int trial = 0; trial < 5000; ++trial) {
        const double mount[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-4, 4)};
        const double base[3] = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-4, 4)};
        const FieldOfView view{random.uniform(-6, 6), random.uniform(0.2, 6.2),
                               PlanarSpace::read_pose(mount)};
        const auto pose = PlanarSpace::read_pose(base);
        const double share = random.uniform(-0.5, 1.5), range = random.uniform(0.3, 20);
        const double angle = view.first + share * view.span;
        const auto laser = PlanarSpace::compose(pose, view.T_base_laser);
        const Point place{laser.x + range * (laser.c * std::cos(angle) - laser.s * std::sin(angle)),
                          laser.y + range * (laser.s * std::cos(angle) + laser.c * std::sin(angle))};
        // How far inside of the nearer edge, of the directions of the place a turn apart.
        double inside = -1e9;
        for (int turn = -2; turn <= 2; ++turn) {
            const double at = share * view.span + 2 * cspace::pi * turn;
            inside = std::max(inside, std::min(at, view.span - at));
        }
        if (std::fabs(inside * range - FieldOfView::margin) < 1e-6) continue;
        CHECK(view.contains(pose, place) == (inside * range > FieldOfView::margin));
        CHECK(FieldOfView{}.contains(pose, place));
    }
}

TEST(bells_of_no_size_and_of_too_many_cells_are_refused) {
    const auto refuses = [](double resolution, double sigma) {
        try {
            (void)make_point_field(see_room({}, 36), resolution, sigma);
        } catch (const std::invalid_argument&) {
            return true;
        }
        return false;
    };
    CHECK(!refuses(0.05, 0.05 * PointStamp::widest));
    for (const double cells : {1.01 * PointStamp::widest, 1e9, 1e300, 0.0, -1.0, std::nan("")})
        CHECK(refuses(0.05, 0.05 * cells));
}

TEST(members_of_a_clique_agree) {
    check::Random random(4);
    AgreementGraph graph;
    for (int k = 0; k < 90; ++k) {
        graph.add_node();
        for (int other = 0; other < k; ++other)
            if ((k < 20 && other < 20) || random.uniform(0, 1) < 0.2) graph.join(k, other);
    }
    const auto clique = graph.find_clique();
    int count = 0;
    for (int a = 0; a < 90; ++a) {
        count += clique[std::size_t(a)];
        for (int b = 0; b < a; ++b)
            CHECK(!clique[std::size_t(a)] || !clique[std::size_t(b)] || graph.are_joined(a, b));
    }
    CHECK(count >= 20);
}

TEST(a_drive_is_mapped) {
    check::Random random(5);
    std::vector<Point> points;
    std::vector<std::int32_t> first{0};
    std::vector<PlanarSpace::Twist> steps;
    std::vector<PlanarSpace::Pose> truth;
    PlanarSpace::Pose pose{0, -1, 1, 0};
    for (int k = 0; k < 300; ++k) {
        truth.push_back(pose);
        for (const Point p : see_room(pose, 180)) points.push_back(p);
        first.push_back(std::int32_t(points.size()));
        const double twist[3] = {0.06, 0, 0.06};
        pose = PlanarSpace::move(pose, twist);
        steps.push_back({0.063 + random.uniform(-0.01, 0.01), 0, 0.057 + random.uniform(-0.01, 0.01)});
    }
    LaserSlam<HeaderSums, HeaderFronts> slam(points, first, steps, {});
    while (slam.advance(7)) CHECK(slam.done() <= slam.scans());
    CHECK(slam.done() == 300 && slam.edges().size() == 299);
    const auto start = PlanarSpace::inverse(truth[0]);
    for (std::size_t k = 0; k < truth.size(); ++k) {
        const auto there = PlanarSpace::compose(start, truth[k]);
        CHECK(std::hypot(slam.poses()[k].x - there.x, slam.poses()[k].y - there.y) < 0.05);
    }
}

}  // namespace
