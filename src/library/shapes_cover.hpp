// Covers of triangle surfaces by spheres: what the bindings call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cspace/math/vec.hpp"
#include "table.hpp"

namespace cspace::shapes {

// Vertices, numbers of three of them each, and whether the surface is closed and encloses a solid. At least
// one face.
struct SurfaceData {
    std::span<const Vec3d> vertices;
    std::span<const std::array<std::int32_t, 3>> faces;
    bool solid;
};
using SphereRow = std::array<double, 4>;  // centre and radius [m]

enum class CoverOutcome { found, too_fine, out_of_time };

struct FoundCover {
    CoverOutcome outcome = CoverOutcome::found;
    Table<SphereRow> spheres;
    double stick_out = 0;        // no sphere sticks out farther [m]
    double uncovered_depth = 0;  // nothing lies farther from all spheres [m]
    std::size_t parts = 0;       // triangles and cells of the proof
};

// Spheres that hold the solid (only its surface without `inside`) and stick out by `within` at most, checked.
// seconds: of the search; infinite without a limit. Throws std::invalid_argument for faces that name no
// vertex.
FoundCover find_cover(const SurfaceData& surface, double within, bool inside, double seconds);

struct MeasuredCover {
    CoverOutcome outcome = CoverOutcome::found;
    // Each between two bounds: [m], [m], and a share of the area.
    std::array<double, 2> stick_out = {}, uncovered_depth = {}, uncovered_share = {};
};

// The same of given spheres, one at least. tolerance [m]: how far the bounds of lengths may be apart.
MeasuredCover measure_cover(const SurfaceData& surface, std::span<const SphereRow> spheres, bool inside,
                            double tolerance, double seconds);

}  // namespace cspace::shapes
