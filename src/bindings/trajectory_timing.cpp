// The fastest motion along a path, for cspace.trajectory.time_parametrize.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "arrays_in_place.hpp"
#include "bindings.hpp"
#include "library/trajectory_jerk.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::trajectory;

namespace {

using Integers = Plain<const std::int32_t>;
using Flags = Plain<const std::int8_t>;
using GridArrays = std::tuple<Plain<std::int32_t>, Doubles, Doubles>;
// along, across, offset, margin and limit of sampled limits, and the inverse of the squared speed.
using SampleArrays =
    std::tuple<std::optional<ConstDoubles>, std::optional<ConstDoubles>, std::optional<ConstDoubles>,
               std::optional<ConstDoubles>, std::optional<ConstDoubles>, std::optional<ConstDoubles>>;

void require_size(bool fits) {
    if (!fits) throw nb::value_error("arrays of matching sizes are needed");
}

TimingPath read_pieces(const ConstDoubles& controls, const ConstDoubles& lengths) {
    require_size(controls.ndim() == 3 && controls.shape(0) == lengths.size && 2 <= controls.shape(1) &&
                 controls.shape(1) <= 6 && lengths.size > 0);
    return {int(controls.shape(1)) - 1,
            int(controls.shape(2)),
            {controls.data, std::size_t(controls.size)},
            {lengths.data, std::size_t(lengths.size)},
            {}};
}
TimingPath read_path(const ConstDoubles& controls, const ConstDoubles& lengths, const Flags& stops) {
    TimingPath path = read_pieces(controls, lengths);
    require_size(stops.size == lengths.size + 1);
    path.stops = {reinterpret_cast<const signed char*>(stops.data), std::size_t(stops.size)};
    return path;
}
TimingLimits read_limits(const TimingPath& path, const ConstDoubles& velocity,
                         const ConstDoubles& acceleration) {
    require_size(velocity.size == path.joints && acceleration.size == path.joints);
    return {{velocity.data, std::size_t(velocity.size)}, {acceleration.data, std::size_t(acceleration.size)}};
}

GridArrays show_grid(const TimingGrid& grid) {
    const npy_intp count = npy_intp(grid.size());
    return {Plain<std::int32_t>({count}, grid.piece.data()), Doubles({count}, grid.from.data()),
            Doubles({count}, grid.to.data())};
}
TimingGrid read_grid(const TimingPath& path, const Integers& piece, const ConstDoubles& from,
                     const ConstDoubles& to) {
    require_size(piece.size == from.size && piece.size == to.size && piece.size > 0);
    for (npy_intp i = 0; i < piece.size; ++i)
        require_size(0 <= piece.data[i] && std::size_t(piece.data[i]) < path.lengths.size());
    const auto all = [](const auto& array) { return std::vector(array.data, array.data + array.size); };
    return {all(piece), all(from), all(to)};
}

std::vector<double> read_samples(const std::optional<ConstDoubles>& given, std::size_t size) {
    if (!given) return {};
    require_size(std::size_t(given->size) == size);
    return {given->data, given->data + given->size};
}

TimingSamples read_all_samples(const SampleArrays& given, std::size_t count, std::size_t width) {
    const std::size_t rows = std::get<0>(given) ? 3 * count * width : 0;
    require_size(!rows || (std::get<1>(given) && std::get<2>(given) && std::get<4>(given)));
    TimingSamples samples;
    samples.along = read_samples(std::get<0>(given), rows);
    samples.across = read_samples(std::get<1>(given), rows);
    samples.offset = read_samples(std::get<2>(given), rows);
    samples.margin = read_samples(std::get<3>(given), count * width);
    samples.limit = read_samples(std::get<4>(given), width);
    samples.inverse_square = read_samples(std::get<5>(given), 3 * count);
    return samples;
}

// sample(piece, from, to) in Python, with the lock of the interpreter.
Sampler make_sampler(const nb::object& sample, int joints) {
    if (sample.is_none()) return {};
    return [&sample, joints](const TimingGrid& grid) {
        const nb::gil_scoped_acquire acquire;
        const GridArrays arrays = show_grid(grid);
        const auto given =
            nb::cast<SampleArrays>(sample(std::get<0>(arrays), std::get<1>(arrays), std::get<2>(arrays)));
        return read_all_samples(given, grid.size(), std::size_t(joints));
    };
}

const char* name_of(TimingOutcome outcome) {
    static constexpr const char* names[] = {"timed", "blocked", "stands", "start", "end"};
    return names[int(outcome)];
}
using Answer =
    std::tuple<const char*, std::size_t, double, double, std::optional<GridArrays>, Doubles, Doubles, bool>;
// The numbers as an array; their own memory is given back.
template <class T>
Plain<T> hand_over(std::vector<T>& numbers) {
    const std::vector<T> given = std::move(numbers);
    numbers = {};
    return Plain<T>({npy_intp(given.size())}, given.data());
}
Answer show(Timing timing) {
    Doubles squared_speed = hand_over(timing.squared_speed);
    std::optional<GridArrays> own;
    if (TimingGrid& grid = timing.grid; grid.size() > 0) {
        auto piece = hand_over(grid.piece);
        Doubles from = hand_over(grid.from);
        own.emplace(std::move(piece), std::move(from), hand_over(grid.to));
    }
    return {name_of(timing.outcome), timing.where,    timing.least, timing.most, own, squared_speed,
            hand_over(timing.rises), timing.converged};
}

}  // namespace

void bind_trajectory_timing(nb::module_& m) {
    m.def(
        "divide_path",
        [](const ConstDoubles& controls, const ConstDoubles& lengths, const Flags& stops,
           std::size_t intervals) {
            return show_grid(divide_evenly(read_path(controls, lengths, stops), intervals));
        },
        "controls"_a, "lengths"_a, "stops"_a, "intervals"_a,
        "Pieces, from and to (k,) of about so many intervals of a path, two or more in each piece.");
    m.def(
        "time_path",
        [](const ConstDoubles& controls, const ConstDoubles& lengths, const Flags& stops,
           const ConstDoubles& velocity, const ConstDoubles& acceleration, double start, double end,
           double tolerance, const std::optional<std::tuple<Integers, ConstDoubles, ConstDoubles>>& grid,
           const nb::object& sample, const std::optional<ConstDoubles>& rises) {
            const TimingPath path = read_path(controls, lengths, stops);
            const TimingLimits limits = read_limits(path, velocity, acceleration);
            const Sampler sampler = make_sampler(sample, path.joints);
            const TimingOptions options = {start, end, tolerance};
            TimingGrid given;
            if (grid) given = read_grid(path, std::get<0>(*grid), std::get<1>(*grid), std::get<2>(*grid));
            std::vector<double> bends = read_samples(rises, given.size());
            Timing timing;
            {
                const nb::gil_scoped_release release;
                timing = grid ? time_on_grid(path, limits, options, given, sampler, std::move(bends))
                              : time_path(path, limits, options, sampler);
            }
            return show(std::move(timing));
        },
        "controls"_a, "lengths"_a, "stops"_a, "velocity"_a, "acceleration"_a, "start"_a, "end"_a,
        "tolerance"_a, "grid"_a.none(), "sample"_a.none(), "rises"_a.none(),
        "Outcome, the interval that is at fault, speeds that are possible, grid unless given, squared "
        "speeds, their rises, whether converged.");
    m.def(
        "sum_times",
        [](const ConstDoubles& lengths, const ConstDoubles& squared_speed, const ConstDoubles& rises) {
            require_size(squared_speed.size == lengths.size + 1 && rises.size == lengths.size);
            Doubles times({squared_speed.size});
            sum_times({lengths.data, std::size_t(lengths.size)},
                      {squared_speed.data, std::size_t(squared_speed.size)},
                      {rises.data, std::size_t(rises.size)}, times.data);
            return times;
        },
        "lengths"_a, "squared_speed"_a, "rises"_a,
        "Seconds (k + 1,) to the places of a grid with intervals of lengths (k,), squared speeds (k + 1,), "
        "rises (k,).");
    m.def(
        "examine_path",
        [](const ConstDoubles& controls, const ConstDoubles& lengths, double gap, double jump, double slope) {
            const TimingPath path = read_pieces(controls, lengths);
            const PathShape shape = examine_path(path, {gap, jump, slope});
            return std::make_tuple(shape.gap, shape.width,
                                   Plain<std::int8_t>({lengths.size + 1}, shape.events.data()),
                                   Plain<std::int8_t>({lengths.size, path.joints}, shape.moving.data()));
        },
        "controls"_a, "lengths"_a, "gap"_a, "jump"_a, "slope"_a,
        "The first break with a gap (0: none) and its width; flags (k + 1,) of breaks: bit 0 where slopes "
        "vanish, bit k where derivative k jumps; which joints move (k, dof).");
    m.def(
        "evaluate_path",
        [](const ConstDoubles& controls, const ConstDoubles& lengths, const Flags& stops,
           const Integers& piece, const ConstDoubles& local) {
            const TimingPath path = read_path(controls, lengths, stops);
            require_size(piece.size == local.size);
            for (npy_intp i = 0; i < piece.size; ++i)
                require_size(0 <= piece.data[i] && std::size_t(piece.data[i]) < path.lengths.size());
            const npy_intp n = path.joints;
            Doubles q({local.size, n}), slope({local.size, n}), bend({local.size, n});
            const std::size_t count = std::size_t(local.size);
            evaluate_path(path, {{piece.data, count}, {local.data, count}, q.data, slope.data, bend.data});
            return std::make_tuple(q, slope, bend);
        },
        "controls"_a, "lengths"_a, "stops"_a, "piece"_a, "local"_a,
        "Configurations (m, dof) and their first two derivatives at places (m,) within pieces (m,).");
    m.def(
        "time_path_with_jerk",
        [](const ConstDoubles& controls, const ConstDoubles& lengths, const Flags& stops,
           const ConstDoubles& velocity, const ConstDoubles& acceleration, const ConstDoubles& jerk,
           const std::tuple<Integers, ConstDoubles, ConstDoubles>& grid, const std::array<double, 2>& start,
           const std::array<double, 2>& end, double duration, double tolerance,
           const std::optional<SampleArrays>& sampled) {
            const TimingPath path = read_path(controls, lengths, stops);
            const TimingLimits limits = read_limits(path, velocity, acceleration);
            require_size(jerk.size == path.joints);
            const TimingGrid given = read_grid(path, std::get<0>(grid), std::get<1>(grid), std::get<2>(grid));
            TimingSamples samples;
            if (sampled) samples = read_all_samples(*sampled, given.size(), std::size_t(path.joints));
            const JerkOptions options = {{start[0], start[1]}, {end[0], end[1]}, duration, tolerance};
            JerkTiming timing;
            {
                const nb::gil_scoped_release release;
                timing = time_path_with_jerk(path, limits, {jerk.data, std::size_t(jerk.size)}, given,
                                             options, samples);
            }
            return std::make_tuple(timing.found,
                                   Doubles({npy_intp(timing.squares.size() / 3), 3}, timing.squares.data()),
                                   timing.start_jerk, timing.end_jerk);
        },
        "controls"_a, "lengths"_a, "stops"_a, "velocity"_a, "acceleration"_a, "jerk"_a, "grid"_a, "start"_a,
        "end"_a, "duration"_a, "tolerance"_a, "sampled"_a.none(),
        "Whether found, Bernstein coefficients (k, 3) of the squared speed, path jerks of both launches.");
}
