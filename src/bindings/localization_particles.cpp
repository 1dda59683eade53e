// Monte Carlo localisation, for cspace.localization.
#include "library/localization_particles.hpp"

#include <nanobind/stl/tuple.h>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;
using cspace::Point;

namespace {

using Doubles = std::span<const double>;

double add_sightings(ParticleCloud& cloud, Doubles ranges, Doubles bearings,
                     std::span<const std::int32_t> rows, std::span<const Point> points, const PoseRow& mount,
                     double range_sigma, double bearing_sigma, double false_share, double exponent,
                     int threads) {
    return cloud.add_sightings(
        {ranges, bearings, rows, points, mount, range_sigma, bearing_sigma, false_share}, exponent, threads);
}

}  // namespace

void bind_localization_particles(nb::module_& m) {
    nb::class_<ScoreMap>(m, "ScoreMap", "A score per cell for the ends of beams.")
        .def(nb::init<cspace::maps::CellBytes, double, Point, int>(), "scores"_a, "resolution"_a, "origin"_a,
             "outside"_a);
    nb::class_<ParticleCloud>(m, "ParticleCloud", "Weighted poses of Monte Carlo localisation.")
        .def(nb::init<std::size_t, std::uint64_t>(), "most"_a, "seed"_a, WithoutLock())
        .def("__len__", &ParticleCloud::size)
        .def_prop_ro("most", &ParticleCloud::most)
        .def("place", &ParticleCloud::place, "poses"_a, WithoutLock(),
             "Particles at poses (k, 3), with equal weights.")
        .def("move", &ParticleCloud::move, "increment"_a, "covariance"_a, "threads"_a, WithoutLock(),
             "A step (3,) with noise of a covariance (9,).")
        .def("add_scan", &ParticleCloud::add_scan, "map"_a, "ends"_a, "exponent"_a, "threads"_a,
             WithoutLock(), "Weighs by the ends of beams (m, 2) in base; the best mean score.")
        .def("score", &ParticleCloud::score, "map"_a, "ends"_a, "threads"_a, WithoutLock(),
             "The mean score of each particle.")
        .def("add_logs", &ParticleCloud::add_logs, "logs"_a, WithoutLock(),
             "Adds to the logarithms of the weights (n,).")
        .def("add_sightings", &add_sightings, "ranges"_a, "bearings"_a, "rows"_a, "points"_a, "mount"_a,
             "range_sigma"_a, "bearing_sigma"_a, "false_share"_a, "exponent"_a, "threads"_a, WithoutLock(),
             "Weighs by readings of landmarks; how well the best particle fits.")
        .def("effective_count", &ParticleCloud::effective_count, WithoutLock())
        .def("resample", &ParticleCloud::resample, "least"_a, "error"_a, "z"_a, WithoutLock(),
             "Systematic resampling; the number of occupied bins.")
        .def("find_modes", &ParticleCloud::find_modes,
             "Poses (k, 3), covariances (k, 9) and shares (k,) of the clusters.")
        .def("poses", nb::overload_cast<>(&ParticleCloud::poses, nb::const_), "(n, 3)")
        .def("poses", nb::overload_cast<std::size_t, std::size_t>(&ParticleCloud::poses, nb::const_),
             "begin"_a, "end"_a, "Those from begin to end − 1: (k, 3).")
        .def("heaviest", &ParticleCloud::heaviest, "The pose with the most weight: (1, 3).")
        .def("weights", &ParticleCloud::weights, "(n,)")
        .def("draw_normals", &ParticleCloud::draw_normals, "count"_a, WithoutLock(),
             "Standard normal numbers (count, 3) of a step of their own.");
    m.def("_draw_counter_words", &draw_counter_words, "counter"_a, "key"_a);
    m.def("_count_particles_for_bins", &count_particles_for_bins, "bins"_a, "error"_a, "z"_a);
}
