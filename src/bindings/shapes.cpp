// Covers of meshes by spheres, for cspace.shapes.mesh_cover.
#include <nanobind/stl/tuple.h>

#include <tuple>

#include "library/shapes_cover.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::shapes;

using Vertices = std::span<const cspace::Vec3d>;
using Faces = std::span<const std::array<std::int32_t, 3>>;

static const char* name_of(CoverOutcome outcome) {
    static constexpr const char* names[] = {"found", "too_fine", "out_of_time"};
    return names[int(outcome)];
}

void bind_shapes(nb::module_& m) {
    m.def(
        "find_cover",
        [](Vertices vertices, Faces faces, bool solid, double within, bool inside, double seconds) {
            FoundCover found = find_cover({vertices, faces, solid}, within, inside, seconds);
            return std::make_tuple(name_of(found.outcome), std::move(found.spheres), found.stick_out,
                                   found.uncovered_depth, found.parts);
        },
        "vertices"_a, "faces"_a, "solid"_a, "within"_a, "inside"_a, "seconds"_a, WithoutLock(),
        "Outcome, spheres (n, 4), bounds of the stick-out and of the uncovered depth, parts of the proof.");
    m.def(
        "measure_cover",
        [](Vertices vertices, Faces faces, bool solid, std::span<const SphereRow> spheres, bool inside,
           double tolerance, double seconds) {
            const MeasuredCover found =
                measure_cover({vertices, faces, solid}, spheres, inside, tolerance, seconds);
            const auto pair_of = [](const std::array<double, 2>& bounds) {
                return std::make_tuple(bounds[0], bounds[1]);
            };
            return std::make_tuple(name_of(found.outcome), pair_of(found.stick_out),
                                   pair_of(found.uncovered_depth), pair_of(found.uncovered_share));
        },
        "vertices"_a, "faces"_a, "solid"_a, "spheres"_a, "inside"_a, "tolerance"_a, "seconds"_a,
        WithoutLock(), "Outcome, and two bounds each of stick-out, uncovered depth and uncovered share.");
}
