// Scan matching and laser SLAM, for cspace.localization.
#include "library/localization_scans.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>

#include <tuple>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;
using cspace::Point;

namespace {

ScoreArray read_field(const cspace::maps::CellBytes& scores, double resolution, const Point& origin,
                      int outside) {
    return {scores.data, scores.rows, scores.columns, resolution, origin, outside};
}
// Found, ambiguous, pose, covariance, score, second.
using MatchParts = std::tuple<bool, bool, cspace::Table<PoseRow>, cspace::Table<SquareRow>, double, double>;
MatchParts write_match(const ScanMatchResult& found) {
    return {found.is_found,       found.is_ambiguous, {{found.pose}},
            {{found.covariance}}, found.score,        found.second};
}
using RelationParts =
    std::tuple<cspace::Table<std::int32_t>, cspace::Table<PoseRow>, cspace::Table<SquareRow>,
               cspace::Table<double>, cspace::Table<std::int32_t>>;
RelationParts write_relations(const std::vector<ScanRelation>& relations) {
    cspace::Table<std::int32_t> ends{{}, 2};
    cspace::Table<PoseRow> poses;
    cspace::Table<SquareRow> covariances;
    cspace::Table<double> scores{{}, 2};
    cspace::Table<std::int32_t> verdicts;
    for (const ScanRelation& relation : relations) {
        ends.values.insert(ends.values.end(), {relation.from, relation.to});
        poses.values.push_back(relation.pose);
        covariances.values.push_back(relation.covariance);
        scores.values.insert(scores.values.end(), {relation.score, relation.second});
        verdicts.values.push_back(relation.verdict);
    }
    return {std::move(ends), std::move(poses), std::move(covariances), std::move(scores),
            std::move(verdicts)};
}

}  // namespace

void bind_localization_scans(nb::module_& m) {
    m.def(
        "match_points",
        [](const cspace::maps::CellBytes& scores, double resolution, const Point& origin, int outside,
           std::span<const Point> points, const PoseRow& guess, double reach, double turn, bool refines) {
            ScanMatchResult found;
            {
                const nb::gil_scoped_release released;
                found = match_points(read_field(scores, resolution, origin, outside), points, guess, reach,
                                     turn, refines);
            }
            return write_match(found);
        },
        "scores"_a, "resolution"_a, "origin"_a, "outside"_a, "points"_a, "guess"_a, "reach"_a, "turn"_a,
        "refines"_a, "Found, ambiguous, pose, covariance, score and second score of a correlative match.");
    m.def(
        "match_point_lines",
        [](const cspace::maps::CellBytes& scores, double resolution, const Point& origin, int outside,
           std::span<const Point> reference, std::span<const Point> points, const PoseRow& guess,
           double reach) {
            ScanMatchResult found;
            {
                const nb::gil_scoped_release released;
                found = match_point_lines(read_field(scores, resolution, origin, outside), reference, points,
                                          guess, reach);
            }
            return write_match(found);
        },
        "scores"_a, "resolution"_a, "origin"_a, "outside"_a, "reference"_a, "points"_a, "guess"_a, "reach"_a,
        "The same by point-to-line ICP.");
    m.def(
        "make_field_of_points",
        [](std::span<const Point> points, double resolution, double sigma) {
            PointField field = make_field_of_points(points, resolution, sigma);
            return std::make_tuple(
                cspace::Table<std::uint8_t>{std::move(field.scores), std::size_t(field.columns)},
                field.origin.x, field.origin.y);
        },
        "points"_a, "resolution"_a, "sigma"_a, "The scores and the origin of a field of bells about points.");
    m.def(
        "thin_scans",
        [](std::span<const Point> points, std::span<const std::int32_t> first, int most) {
            std::vector<std::int32_t> begins(first.begin(), first.end());
            std::vector<Point> kept;
            {
                const nb::gil_scoped_release released;
                kept = thin_scans(points, begins, most);
            }
            return std::make_tuple(cspace::Table<Point>{std::move(kept)},
                                   cspace::Table<std::int32_t>{std::move(begins)});
        },
        "points"_a, "first"_a, "most"_a, "At most so many points of each scan, and where each scan begins.");
    nb::class_<LaserSlamRun>(m, "LaserSlamRun", "Laser SLAM on a pose graph, as far as it is done.")
        .def(nb::new_([](std::span<const Point> points, std::span<const std::int32_t> first,
                         std::span<const PoseRow> steps, double first_angle, double span,
                         const PoseRow& T_base_laser, double resolution, double sigma, bool finds_loops) {
                 return make_laser_slam(points, first, steps,
                                        {first_angle, span, T_base_laser, resolution, sigma, finds_loops});
             }),
             "points"_a, "first"_a, "steps"_a, "first_angle"_a, "span"_a, "T_base_laser"_a, "resolution"_a,
             "sigma"_a, "finds_loops"_a)
        .def("advance", &LaserSlamRun::advance, "scans"_a, WithoutLock(),
             "Works on so many scans more; False when all are done.")
        .def_prop_ro("done", &LaserSlamRun::done)
        .def_prop_ro("tried", &LaserSlamRun::tried)
        .def_prop_ro("optimizations", &LaserSlamRun::optimizations)
        .def_prop_ro("poses", [](const LaserSlamRun& run) { return cspace::Table<PoseRow>{run.poses()}; })
        .def_prop_ro("matched", [](const LaserSlamRun& run) { return cspace::Table<PoseRow>{run.matched()}; })
        .def_prop_ro(
            "edges", [](const LaserSlamRun& run) { return write_relations(run.edges()); },
            "Ends, poses, covariances, scores with second scores, and verdicts.")
        .def_prop_ro(
            "loops", [](const LaserSlamRun& run) { return write_relations(run.loops()); },
            "The same of all loops that were found.");
}
