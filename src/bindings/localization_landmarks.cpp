// SLAM of landmarks, for cspace.localization.
#include "library/localization_landmarks.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cspace/localization/landmarks/rejection_sum.hpp"
#include "cspace/math/trig.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;

namespace {

using Row3 = std::array<double, 3>;
constexpr double farthest = 1e15;  // tolerances.FARTHEST_POINT: squares of sums stay finite
using Row9 = std::array<double, 9>;

RangeBearingSensor read_sensor(const std::array<double, 9>& row) {
    return {row[0], row[1], row[2], row[3], {row[4], row[5], row[6]}, row[7], row[8]};
}
LandmarkRule read_rule(const std::array<double, 6>& row) {
    return {row[0], row[1], row[2], int(row[3]), int(row[4]), int(row[5])};
}

std::unique_ptr<LandmarkFilter> make_ekf(const Row9& sensor, const std::array<double, 6>& rule,
                                         int linearization, bool is_joint, long most_nodes, const Row3& start,
                                         const Row9& covariance) {
    return make_ekf_slam(
        {read_sensor(sensor), Linearization(linearization), read_rule(rule), is_joint, most_nodes}, start,
        covariance);
}
std::unique_ptr<LandmarkFilter> make_particles(const Row9& sensor, const std::array<double, 6>& rule,
                                               int version, std::size_t particles, std::uint64_t seed,
                                               double resample_below, const Row3& start,
                                               const Row9& covariance) {
    return make_fast_slam({read_sensor(sensor), read_rule(rule), version, particles, seed, resample_below},
                          start, covariance);
}

// Whether rows name, range, bearing can be used: names whole numbers from 0, or all −1; ranges not below
// zero; bearings within two turns; one of the two at least.
bool are_readings(std::span<const Row3> rows) {
    constexpr double most_bearing = 2 * cspace::pi, most_name = 9007199254740992.0;
    for (const Row3& row : rows) {
        const bool is_named = row[0] >= 0, is_name = row[0] == std::floor(row[0]) && row[0] < most_name;
        const bool is_range = std::isnan(row[1]) || (row[1] >= 0 && !std::isinf(row[1]));
        const bool is_bearing = std::isnan(row[2]) || std::fabs(row[2]) <= most_bearing;
        if (!is_name || (!is_named && row[0] != -1) || is_named != (rows[0][0] >= 0)) return false;
        if (!is_range || !is_bearing || (std::isnan(row[1]) && std::isnan(row[2]))) return false;
    }
    return true;
}
bool update(LandmarkFilter& filter, std::span<const Row3> rows) {
    if (!are_readings(rows)) return false;
    const nb::gil_scoped_release unlocked;
    filter.update(rows);
    return true;
}

template <class T, class Get>
Plain<T> collect(std::span<const ReadingOutcome> outcomes, npy_intp columns, const Get& get) {
    Plain<T> column =
        columns ? Plain<T>({npy_intp(outcomes.size()), columns}) : Plain<T>({npy_intp(outcomes.size())});
    T* to = column.data;
    for (const ReadingOutcome& outcome : outcomes) to = get(outcome, to);
    return column;
}
auto list_outcomes(const LandmarkFilter& filter) {
    const auto all = filter.outcomes();
    return std::make_tuple(
        collect<std::int64_t>(all, 0, [](const auto& o, std::int64_t* to) { return *to = o.name, to + 1; }),
        collect<std::uint8_t>(
            all, 0, [](const auto& o, std::uint8_t* to) { return *to = std::uint8_t(o.verdict), to + 1; }),
        collect<std::int64_t>(all, 0, [](const auto& o, std::int64_t* to) { return *to = o.dof, to + 1; }),
        collect<double>(all, 0, [](const auto& o, double* to) { return *to = o.nis, to + 1; }),
        collect<double>(all, 2, [](const auto& o, double* to) {
            return std::copy(o.innovation.begin(), o.innovation.end(), to);
        }));
}
auto list_landmarks(const LandmarkFilter& filter) {
    const LandmarkRows rows = filter.landmarks();
    const npy_intp count = npy_intp(rows.names.size());
    return std::make_tuple(
        Plain<std::int64_t>({count}, rows.names.data()), Plain<double>({count, 2}, rows.points.data()),
        Plain<double>({count, 2, 2}, rows.covariances.data()), Plain<std::int32_t>({count}, rows.seen.data()),
        Plain<std::uint8_t>({count}, rows.is_confirmed.data()));
}
auto list_counts(const LandmarkFilter& filter) {
    const LandmarkCounts& c = filter.counts();
    return std::make_tuple(c.updates, c.used, c.rejected, c.created, c.skipped, c.dropped, c.inflations,
                           c.capped, c.resamplings);
}

}  // namespace

void bind_localization_landmarks(nb::module_& m) {
    nb::class_<RejectionSum>(m, "RejectionSum", "When a filter is lost: a sum of rejected measurements.")
        .def(nb::init<int>(), "lost_after"_a)
        .def("accept", &RejectionSum::accept, "A measurement fits.")
        .def(
            "reject", &RejectionSum::reject,
            "A measurement does not; whether so many in a row were rejected that the covariance is inflated.")
        .def_prop_ro("is_lost", &RejectionSum::is_lost);
    nb::class_<LandmarkFilter>(m, "LandmarkFilter", "A filter on a pose and landmarks.")
        .def("predict", &LandmarkFilter::predict, "increment"_a, "noise"_a, "Moves the pose.")
        .def(
            "predict_walk",
            [](LandmarkFilter& filter, const Row3& increment, const std::array<double, 6>& walk,
               double duration) {
                if (!std::all_of(increment.begin(), increment.end(),
                                 [](double number) { return std::abs(number) <= farthest; }))
                    throw nb::type_error("the increment is too large");
                filter.predict_walk(increment, {walk[0], walk[1], walk[2], walk[3], walk[4], walk[5]},
                                    duration);
            },
            "increment"_a, "walk"_a, "duration"_a, "Moves the pose, with the noise of a random walk.")
        .def("update", &update, "readings"_a, "False, and nothing done, for rows that cannot be used.")
        .def_prop_ro("outcomes", &list_outcomes)
        .def_prop_ro("pose",
                     [](const LandmarkFilter& filter) { return Plain<double>({3}, filter.pose().data()); })
        .def_prop_ro("covariance",
                     [](const LandmarkFilter& filter) {
                         return Plain<double>({3, 3}, filter.base_covariance().data());
                     })
        .def_prop_ro("landmarks", &list_landmarks)
        .def_prop_ro("is_lost", &LandmarkFilter::is_lost)
        .def_prop_ro("counts", &list_counts)
        .def_prop_ro("joint_covariance",
                     [](const LandmarkFilter& filter) {
                         const auto dense = filter.joint_covariance();
                         const auto n = npy_intp(std::lround(std::sqrt(double(dense.size()))));
                         return Plain<double>({n, n}, dense.data());
                     })
        .def_prop_ro("particles",
                     [](const LandmarkFilter& filter) {
                         const auto rows = filter.particles();
                         return Plain<double>({npy_intp(rows.size()), 4},
                                              rows.empty() ? nullptr : rows[0].data());
                     })
        .def_prop_ro("chunks", &LandmarkFilter::chunks);
    m.def("make_ekf_slam", &make_ekf, "sensor"_a, "rule"_a, "linearization"_a, "is_joint"_a, "most_nodes"_a,
          "start"_a, "covariance"_a, "A Kalman filter on a pose and landmarks.");
    m.def("make_fast_slam", &make_particles, "sensor"_a, "rule"_a, "version"_a, "particles"_a, "seed"_a,
          "resample_below"_a, "start"_a, "covariance"_a, "Particles with maps of landmarks.");
}
