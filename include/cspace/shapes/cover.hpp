// A few spheres that contain a solid, or a surface, and stick out of it by no more than a given length.
//
// Candidates are balls near the medial axis whose radius exceeds the depth of their centre by that length.
// Greedy set cover and exchange choose some that hold all pieces of the surface; what they leave inside is
// found by division into cells and covered likewise; each sphere is shrunk to what it alone holds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "cspace/shapes/cover_check.hpp"
#include "cspace/shapes/cover_items.hpp"
#include "cspace/shapes/medial_balls.hpp"
#include "cspace/shapes/set_cover.hpp"
#include "cspace/shapes/stick_out.hpp"
#include "cspace/shapes/triangle_surface.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

struct CoverGoal {
    double within;  // the largest stick-out [m]
    bool solid;     // the surface is closed: centres may lie inside it
    bool inside;    // the inside is covered too
    // Of what is in memory: pieces of the surface, cells and candidates; runs of pieces that candidates hold.
    std::size_t most_pieces, most_runs;
};

class CoverSearch {
  public:
    CoverSearch(const TriangleSurface& surface, const CoverGoal& goal, Watch& watch)
        : surface_(surface),
          goal_(goal),
          watch_(watch),
          margin_(margin_share * goal.within),
          rounding_(surface_rounding * surface.extent()) {}

    std::vector<Ball> find() {
        find_candidates();
        const CoverItems<Triangle> pieces(split_surface(piece_side), watch_);
        std::vector<Ball> balls = cover_items(pieces);
        if (goal_.solid && goal_.inside) cover_inside(balls);
        return balls;
    }
    // What CoverCheck is given: everything this near to the surface lies in the spheres that hold its pieces.
    double layer() const { return layer_share * goal_.within; }

  private:
    // Shares of the largest stick-out. A piece counts as held only if it lies this deep in a sphere; the
    // layer is thinner, so that no rounding matters.
    static constexpr double margin_share = 1.0 / 16, layer_share = 1.0 / 20;
    static constexpr double piece_side = 1.0 / 3, sample_side = 1.5, surface_sample_side = 0.5;
    static constexpr double cell_radius = 1.0 / 6;  // of the largest cells of what the spheres leave inside
    static constexpr int climb_steps = 12;

    const TriangleSurface& surface_;
    const CoverGoal& goal_;
    Watch& watch_;
    double margin_, rounding_;
    double candidate_cell_ = 0.5;  // share of the stick-out
    std::vector<Ball> candidates_;

    // Parts of the surface with sides of a share of the largest stick-out, or of the least one up to twice as
    // large that memory allows.
    std::vector<Triangle> split_surface(double share) const {
        constexpr double coarser = 1.25;
        const double most = 2 * share;
        while (true) {
            try {
                return split_triangles(surface_.triangles(), share * goal_.within, goal_.most_pieces, watch_);
            } catch (const TooFine&) {
                if ((share *= coarser) > most) throw;
            }
        }
    }

    // One candidate or two per sample of the surface. Samples are the middles of its parts, one in each cell
    // of a grid; of candidates the largest in each cell are kept.
    void find_candidates() {
        const double share = goal_.solid ? sample_side : surface_sample_side;
        const double side = share * goal_.within;
        std::vector<Triangle> parts = split_surface(share);
        thin_out(
            parts, side / 2, [](const Triangle& t) { return middle_of(t); },
            [](const Triangle&, const Triangle&) { return false; });
        for (const Triangle& part : parts) watch_.look(), add_candidates(part);
        if (goal_.solid) thin_out_candidates();
    }
    void thin_out_candidates() {
        thin_out(
            candidates_, candidate_cell_ * goal_.within, [](const Ball& b) { return b.center; },
            [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
    }
    static Vec3d middle_of(const Triangle& t) { return (1.0 / 3) * (t[0] + t[1] + t[2]); }

    // Keeps of the items in each cell of a grid the best one, the first of equal ones.
    template <class Item, class Place, class Better>
    void thin_out(std::vector<Item>& items, double grid, const Place& place, const Better& is_better) {
        struct Entry {
            double x, y, z;
            std::uint32_t item;
            bool shares_cell(const Entry& e) const { return x == e.x && y == e.y && z == e.z; }
        };
        std::vector<Entry> entries;
        entries.reserve(items.size());
        for (const Item& item : items) {
            const Vec3d at = (1 / grid) * (place(item) - surface_.bounds().low);
            entries.push_back(
                {std::floor(at.x), std::floor(at.y), std::floor(at.z), std::uint32_t(entries.size())});
            watch_.step();
        }
        sort_polled(entries, [&](const Entry& a, const Entry& b) {
            if (!a.shares_cell(b)) return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
            if (is_better(items[a.item], items[b.item])) return true;
            return !is_better(items[b.item], items[a.item]) && a.item < b.item;
        });
        std::vector<Item> kept;
        kept.reserve(entries.size());
        for (std::size_t k = 0; k < entries.size(); ++k)
            if (k == 0 || !entries[k].shares_cell(entries[k - 1]))
                kept.push_back(items[entries[k].item]), watch_.step();
        items = std::move(kept);
    }
    void add_candidates(const Triangle& part) {
        const Vec3d at = middle_of(part);
        const Vec3d n = cross(part[1] - part[0], part[2] - part[0]);
        const double length = norm(n);
        if (!goal_.solid || !(length > 0)) return add_candidate(at);
        const Ball first = touching_ball(surface_, at, (-1 / length) * n, surface_.extent());
        const bool found = add_inner(first.center);
        const Ball deepest = grow_ball(surface_, first.center, goal_.within, climb_steps);
        if (!(add_inner(deepest.center) || found)) add_candidate(at);
    }
    bool add_inner(const Vec3d& center) {
        if (surface_.winding(center) < 1) return false;
        add_candidate(center);
        return true;
    }
    void add_candidate(const Vec3d& center) {
        const double radius = goal_.within - rounding_ - signed_distance(surface_, goal_.solid, center);
        if (radius > margin_) candidates_.push_back({center, radius});
    }

    // Balls that hold all items, each with a margin.
    template <class Item>
    std::vector<Ball> cover_items(const CoverItems<Item>& items) {
        ItemSets sets = list_items(items);
        SetCover cover(sets, weigh(items), watch_);
        std::vector<Ball> balls;
        for (const std::uint32_t k : cover.choose()) balls.push_back(candidates_[k]);
        for (std::size_t k = 0; k < items.size(); ++k)
            if (cover.counts()[k] == 0) balls.push_back(own_ball(items[k]));
        sets.release(watch_);
        shrink(items, balls);
        return balls;
    }
    // What each candidate holds; where that needs too much memory, fewer candidates are kept.
    template <class Item>
    ItemSets list_items(const CoverItems<Item>& items) {
        constexpr double coarser = 1.5;
        ItemSets sets;
        while (!list_items(items, sets)) {
            if (candidates_.size() < 2) throw TooFine();
            candidate_cell_ *= coarser;
            thin_out_candidates();
        }
        return sets;
    }
    // false: there are too many runs.
    template <class Item>
    bool list_items(const CoverItems<Item>& items, ItemSets& sets) {
        sets.release(watch_);
        std::vector<Run> runs;
        for (const Ball& b : candidates_) {
            items.find_inside(b.center, b.radius - margin_, runs);
            sets.add(runs);
            watch_.look();
            if (sets.count_runs() > goal_.most_runs) return false;
        }
        return true;
    }
    // Whole numbers in proportion to the sizes of items: sums of them do not depend on their order.
    template <class Item>
    std::vector<std::uint32_t> weigh(const CoverItems<Item>& items) {
        constexpr double largest = 0x1p30;
        double total = 0;
        for (std::size_t k = 0; k < items.size(); ++k) total += size_of(items[k]), watch_.step();
        const double scale = total > 0 ? largest / total : 0;
        std::vector<std::uint32_t> weights;
        weights.reserve(items.size());
        for (std::size_t k = 0; k < items.size(); ++k) {
            weights.push_back(1 + std::uint32_t(scale * size_of(items[k])));
            watch_.step();
        }
        return weights;
    }
    static double size_of(const Triangle& t) { return area_of(t); }
    static double size_of(const Box& b) {
        const Vec3d side = b.high - b.low;
        return side.x * side.y * side.z;
    }
    Ball own_ball(const Triangle& t) const {
        const Vec3d center = middle_of(t);
        return {center, std::sqrt(farthest_square(t, center)) + 2 * margin_};
    }
    Ball own_ball(const Box& b) const {
        const Vec3d center = shapes::middle_of(b);
        return {center, std::sqrt(farthest_square(b, center)) + 2 * margin_};
    }

    // Gives each ball, the last first, the radius that what it alone holds needs.
    template <class Item>
    void shrink(const CoverItems<Item>& items, std::vector<Ball>& balls) {
        std::vector<std::uint32_t> count(items.size(), 0);
        std::vector<Run> runs;
        const auto visit_held = [&](const Ball& ball, const auto& visit) {
            items.find_inside(ball.center, ball.radius - margin_, runs);
            for (const Run& run : runs)
                for (std::size_t k = run.begin; k < run.end; ++k) visit(k);
            watch_.look();
        };
        for (const Ball& ball : balls) visit_held(ball, [&](std::size_t k) { ++count[k]; });
        for (std::size_t i = balls.size(); i-- > 0;) {
            Ball& ball = balls[i];
            double square = 0;
            visit_held(ball, [&](std::size_t k) {
                if (count[k]-- == 1) square = std::max(square, farthest_square(items[k], ball.center));
            });
            constexpr double more = 1 + 0x1p-40;  // so that what is farthest counts as held again
            ball.radius = std::min(ball.radius, std::sqrt(square) * more + margin_);
            visit_held(ball, [&](std::size_t k) { ++count[k]; });
        }
        std::erase_if(balls, [&](const Ball& ball) { return !(ball.radius > margin_); });
    }

    // Adds balls for what is left inside.
    void cover_inside(std::vector<Ball>& balls) {
        constexpr int most_rounds = 4;
        constexpr std::size_t most_cells = std::size_t(1) << 25;
        for (int round = 0; round < most_rounds; ++round) {
            CoverCheck check(surface_, balls, {layer(), layer(), most_cells}, watch_);
            std::vector<Box> open = check.find_open_cells(cell_radius * goal_.within);
            if (open.empty()) return;
            std::vector<Box> seeds = open;
            thin_out(
                seeds, candidate_cell_ * goal_.within, [](const Box& b) { return shapes::middle_of(b); },
                [](const Box& a, const Box& b) { return size_of(a) > size_of(b); });
            for (const Box& cell : seeds) {
                watch_.look();
                add_candidate(grow_ball(surface_, shapes::middle_of(cell), goal_.within, climb_steps).center);
            }
            thin_out_candidates();
            const CoverItems<Box> cells(open, watch_);
            const std::vector<Ball> more = cover_items(cells);
            balls.insert(balls.end(), more.begin(), more.end());
        }
    }
};

}  // namespace cspace::shapes
