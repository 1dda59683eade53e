// The histogram filter, for cspace.localization.
#include "library/localization_histogram.hpp"

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::localization;
using cspace::Point;

namespace {

using Doubles = std::span<const double>;

bool move(Doubles belief, int sectors, int rows, int columns, std::span<const std::array<double, 4>> steps,
          double turn, double turn_sigma, int threads, std::span<double> moved) {
    return move_belief(belief, {sectors, rows, columns}, steps, turn, turn_sigma, threads, moved);
}

std::int32_t weigh(Doubles belief, int sectors, int rows, int columns, std::span<const std::int32_t> sums,
                   std::span<const std::uint8_t> free, double unit, double share, int threads,
                   std::span<double> weighed) {
    return weigh_belief(belief, {sectors, rows, columns}, sums, free, unit, share, threads, weighed);
}

}  // namespace

void bind_localization_histogram(nb::module_& m) {
    nb::class_<LatticeScores>(m, "LatticeScores", "The scores of all cells of x, y and θ.")
        .def(nb::init<cspace::maps::CellBytes, int, int, Point, int, int, std::span<const Point>>(),
             "scores"_a, "outside"_a, "step"_a, "first"_a, "rows"_a, "columns"_a, "headings"_a)
        .def("sum", &LatticeScores::sum, "ends"_a, "threads"_a, "sums"_a, WithoutLock(),
             "Writes the sums of the bytes at the ends of beams (m, 2) in base [cells], flat.");
    m.def("move_belief", &move, "belief"_a, "sectors"_a, "rows"_a, "columns"_a, "steps"_a, "turn"_a,
          "turn_sigma"_a, "threads"_a, "moved"_a, WithoutLock(),
          "Writes the belief moved and blurred, flat; returns whether any is left.");
    m.def("weigh_belief", &weigh, "belief"_a, "sectors"_a, "rows"_a, "columns"_a, "sums"_a, "free"_a,
          "unit"_a, "share"_a, "threads"_a, "weighed"_a, WithoutLock(),
          "Writes the belief times the likelihoods, flat; returns the largest sum of a free cell.");
}
