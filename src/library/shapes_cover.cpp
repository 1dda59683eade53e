#include "shapes_cover.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "cspace/shapes/cover.hpp"
#include "cspace/shapes/cover_check.hpp"
#include "cspace/shapes/stick_out.hpp"

namespace cspace::shapes {

namespace {

constexpr std::size_t most_pieces = std::size_t(1) << 20;  // about 350 megabytes
constexpr std::size_t most_runs = std::size_t(1) << 25;    // 270 megabytes
constexpr std::size_t most_parts = std::size_t(1) << 25;   // of a check: half a minute

TriangleSurface make_surface(const SurfaceData& data, Watch& watch) {
    const auto count = std::int64_t(data.vertices.size());
    for (const auto& face : data.faces)
        for (const std::int32_t v : face)
            if (v < 0 || v >= count) throw std::invalid_argument("a face names no vertex");
    if (data.faces.empty()) throw std::invalid_argument("a surface needs a face");
    return TriangleSurface(data.vertices, data.faces, watch);
}

Bounds join_bounds(const Bounds& a, const Bounds& b) {
    return {std::max(a.lower, b.lower), std::max(a.upper, b.upper)};
}
Bounds check_depth(CoverCheck& check, bool inside, double layer) {
    const Bounds surface = check.check_surface(inside ? layer : 0);
    return inside ? join_bounds(surface, check.check_inside()) : surface;
}

// What `work` returns, or the reason why it could not.
template <class Result, class Work>
Result finish(const Work& work) {
    Result result;
    try {
        work(result);
    } catch (const OutOfTime&) {
        result.outcome = CoverOutcome::out_of_time;
    } catch (const TooFine&) {
        result.outcome = CoverOutcome::too_fine;
    }
    return result;
}

}  // namespace

FoundCover find_cover(const SurfaceData& data, double within, bool inside, double seconds) {
    return finish<FoundCover>([&](FoundCover& found) {
        Watch watch(seconds);
        const TriangleSurface surface = make_surface(data, watch);
        const bool whole = data.solid && inside;
        const CoverGoal goal = {within, data.solid, whole, most_pieces, most_runs};
        CoverSearch search(surface, goal, watch);
        const std::vector<Ball> balls = search.find();
        const double layer = search.layer();
        CoverCheck check(surface, balls, {layer, layer, most_parts}, watch);
        found.uncovered_depth = check_depth(check, whole, layer).upper;
        found.parts = check.parts();
        for (const Ball& b : balls) {
            found.spheres.values.push_back({b.center.x, b.center.y, b.center.z, b.radius});
            found.stick_out = std::max(found.stick_out, bound_stick_out(surface, data.solid, b));
        }
    });
}

MeasuredCover measure_cover(const SurfaceData& data, std::span<const SphereRow> spheres, bool inside,
                            double tolerance, double seconds) {
    return finish<MeasuredCover>([&](MeasuredCover& found) {
        Watch watch(seconds);
        const TriangleSurface surface = make_surface(data, watch);
        std::vector<Ball> balls;
        for (const SphereRow& s : spheres) balls.push_back({{s[0], s[1], s[2]}, s[3]});
        const double layer = tolerance / 2;
        CoverCheck check(surface, balls, {layer, tolerance, most_parts}, watch);
        const auto pair_of = [](const Bounds& b) { return std::array{b.lower, b.upper}; };
        found.uncovered_depth = pair_of(check_depth(check, data.solid && inside, layer));
        found.uncovered_share = pair_of(check.check_share());
        StickOut stick_out(surface, data.solid, tolerance, most_parts, watch);
        found.stick_out = pair_of(stick_out.measure(balls));
    });
}

}  // namespace cspace::shapes
