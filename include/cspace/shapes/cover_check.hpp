// Checks a cover by spheres: bounds on how far a solid reaches out of them, proved by division into triangles
// and cells. It shares with the search for covers the distance from the surface and the halving of triangles.
//
// A place x is g(x) = min (‖x − c‖ − r) away from the nearest sphere. On a convex part the distance from one
// centre is largest at a corner, so the least of these maxima bounds g from above; g at any place of the part
// bounds it from below. Parts are divided until the bounds meet, or the upper one is not positive.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "cspace/shapes/box_tree.hpp"
#include "cspace/shapes/cover_items.hpp"
#include "cspace/shapes/triangle_surface.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

struct Bounds {
    double lower, upper;
};

// Spheres in lists that get shorter as parts are divided: only those that may be nearest to some place of it.
class NearSpheres {
  public:
    struct List {
        std::size_t begin, end;
    };
    explicit NearSpheres(std::span<const Ball> balls) : balls_(balls), numbers_(balls.size()) {
        std::iota(numbers_.begin(), numbers_.end(), 0u);
    }
    List all() const { return {0, balls_.size()}; }

    // An upper bound of g on a convex part.
    template <class Part>
    double bound(const Part& part, List list) const {
        double least = infinite;
        for (std::size_t k = list.begin; k < list.end; ++k) {
            const Ball& b = ball(k);
            least = std::min(least, std::sqrt(farthest_square(part, b.center)) - b.radius);
        }
        return least;
    }
    double gap(const Vec3d& p, List list) const { return bound(Box{p, p}, list); }
    // How far a box is outside of all spheres, at least.
    double least_gap(const Box& box, List list) const {
        double least = infinite;
        for (std::size_t k = list.begin; k < list.end; ++k)
            least = std::min(least, std::sqrt(nearest_square(box, ball(k).center)) - ball(k).radius);
        return least;
    }
    // The spheres of a list that come within `bound` of a box. drop() takes them back, the last first.
    List narrow(const Box& box, double bound, List list) {
        const std::size_t begin = numbers_.size();
        for (std::size_t k = list.begin; k < list.end; ++k) {
            const double reach = bound + ball(k).radius;
            if (reach >= 0 && nearest_square(box, ball(k).center) <= reach * reach)
                numbers_.push_back(numbers_[k]);
        }
        return {begin, numbers_.size()};
    }
    void drop(List list) { numbers_.resize(list.begin); }

  private:
    std::span<const Ball> balls_;
    std::vector<std::uint32_t> numbers_;
    const Ball& ball(std::size_t k) const { return balls_[numbers_[k]]; }
};

class CoverCheck {
  public:
    // tolerance: how far the bounds of a positive depth may be apart. layer: what is that near to the surface
    // is not divided further, and counts as covered where the surface is by as much more; tolerance and layer
    // are positive. most: parts that are examined.
    struct Settings {
        double layer, tolerance;
        std::size_t most;
    };
    CoverCheck(const TriangleSurface& surface, std::span<const Ball> balls, Settings settings, Watch& watch)
        : surface_(surface),
          spheres_(balls),
          settings_(settings),
          watch_(watch),
          rounding_(relative_rounding * reach_of(surface, balls)) {}

    // The largest distance of a place of the surface from the nearest sphere, and of places within `around`
    // of the surface.
    Bounds check_surface(double around) {
        reset(around);
        check_node(surface_.tree().nodes()[0], spheres_.all());
        return found_;
    }
    // The same of places inside the surface that are farther than the layer from it.
    Bounds check_inside() {
        reset(0);
        check_cell(root_cell(), false, spheres_.all());
        return found_;
    }
    // Cells inside the surface that no sphere holds whole, and that cover what no sphere holds: those of at
    // most this radius whose centre no sphere holds, and smaller ones.
    std::vector<Box> find_open_cells(double radius) {
        open_radius_ = radius;
        check_inside();
        open_radius_ = 0;
        return std::move(open_);
    }
    // The area of the surface outside of all spheres, over its own: parts are divided until 1 % is open.
    Bounds check_share() {
        constexpr double open_share = 0.01;
        double whole = 0;
        for (const Triangle& t : surface_.triangles()) whole += area_of(t);
        if (!(whole > 0)) return {0, 0};
        Bounds share = {0, 1};
        for (double side = surface_.extent() / 32; share.upper - share.lower > open_share; side /= 2) {
            reset(0);
            outside_area_ = open_area_ = 0, part_side_ = side;
            sum_node(surface_.tree().nodes()[0], spheres_.all());
            share = {outside_area_ / whole, std::min(1.0, (outside_area_ + open_area_) / whole)};
            if (parts_ >= settings_.most) break;
        }
        return share;
    }
    std::size_t parts() const { return all_parts_ + parts_; }  // examined so far

  private:
    // Of a distance, over the extent of what is measured: some twenty roundings.
    static constexpr double relative_rounding = 0x1p-48;
    const TriangleSurface& surface_;
    NearSpheres spheres_;
    Settings settings_;
    Watch& watch_;
    double rounding_;
    double around_ = 0, open_radius_ = 0, part_side_ = 0, outside_area_ = 0, open_area_ = 0;
    Bounds found_ = {0, 0};
    std::vector<Box> open_;
    std::size_t parts_ = 0, all_parts_ = 0;
    using List = NearSpheres::List;

    static double reach_of(const TriangleSurface& surface, std::span<const Ball> balls) {
        double reach = surface.extent();
        const Vec3d middle = middle_of(surface.bounds());
        for (const Ball& b : balls) reach = std::max(reach, norm(b.center - middle) + b.radius);
        return reach;
    }
    void reset(double around) {
        around_ = around + rounding_, found_ = {0, 0};
        all_parts_ += parts_, parts_ = 0;
    }
    void count_part() { watch_.step(), ++parts_; }
    // Whether a part with this upper bound needs no division.
    bool is_settled(double bound) {
        const double beyond = found_.lower > 0 && open_radius_ == 0 ? found_.lower + settings_.tolerance : 0;
        if (bound > beyond && parts_ < settings_.most) return false;
        found_.upper = std::max(found_.upper, bound);
        return true;
    }
    void raise_lower(double gap) { found_.lower = std::max(found_.lower, gap - rounding_); }

    void check_node(const BoxTree::Node& node, List list) {
        count_part();
        const double bound = spheres_.bound(node.box, list) + around_;
        if (is_settled(bound)) return;
        const List near = spheres_.narrow(node.box, bound, list);
        if (node.second) {
            check_node(surface_.tree().first_child(node), near);
            check_node(surface_.tree().second_child(node), near);
        } else {
            for (std::uint32_t k = node.begin; k < node.end; ++k)
                check_triangle(surface_.triangles()[k], near);
        }
        spheres_.drop(near);
    }
    void check_triangle(const Triangle& t, List list) {
        count_part();
        for (const Vec3d& corner : t) raise_lower(spheres_.gap(corner, list));
        const double bound = spheres_.bound(t, list) + around_;
        if (is_settled(bound)) return;
        const LongSide longest = find_long_side(t);
        if (std::sqrt(longest.square) < settings_.tolerance / 4) {
            found_.upper = std::max(found_.upper, bound);
            return;
        }
        const List near = spheres_.narrow(box_of(t), bound, list);
        for (const Triangle& part : halve_triangle(longest)) check_triangle(part, near);
        spheres_.drop(near);
    }

    Box root_cell() const {
        const Box& b = surface_.bounds();
        const Vec3d middle = middle_of(b), size = b.high - b.low;
        const double half = std::max({size.x, size.y, size.z}) / 2;
        return {middle - Vec3d{half, half, half}, middle + Vec3d{half, half, half}};
    }
    // inside: whether the cell is known to be.
    void check_cell(const Box& cell, bool inside, List list) {
        count_part();
        const double bound = spheres_.bound(cell, list) + around_;
        if (is_settled(bound)) return;
        const Vec3d middle = middle_of(cell);
        const double radius = norm(cell.high - middle);
        if (!inside) {
            const double distance = surface_.distance(middle), unsure = surface_rounding * surface_.extent();
            if (distance + radius + unsure <= settings_.layer) return;
            if (distance > radius + unsure) {
                if (surface_.winding(middle) < 1) return;
                inside = true;
            }
        }
        const double gap = inside ? spheres_.gap(middle, list) : 0;
        raise_lower(gap);
        if (radius <= (gap > 0 ? open_radius_ : 0) || radius <= settings_.layer / 2) {
            found_.upper = std::max(found_.upper, bound);
            if (open_radius_ > 0) open_.push_back(cell);
            return;
        }
        const List near = spheres_.narrow(cell, bound, list);
        for (int k = 0; k < 8; ++k) check_cell(octant_of(cell, middle, k), inside, near);
        spheres_.drop(near);
    }

    void sum_node(const BoxTree::Node& node, List list) {
        count_part();
        if (spheres_.bound(node.box, list) <= 0) return;
        const List near = spheres_.narrow(node.box, 0, list);
        if (node.second) {
            sum_node(surface_.tree().first_child(node), near);
            sum_node(surface_.tree().second_child(node), near);
        } else {
            for (std::uint32_t k = node.begin; k < node.end; ++k) sum_triangle(surface_.triangles()[k], near);
        }
        spheres_.drop(near);
    }
    void sum_triangle(const Triangle& t, List list) {
        count_part();
        if (spheres_.bound(t, list) <= 0) return;
        const Box box = box_of(t);
        const List near = spheres_.narrow(box, 0, list);
        if (near.begin == near.end) {
            outside_area_ += area_of(t);
        } else if (norm(box.high - box.low) < part_side_ || parts_ >= settings_.most) {
            open_area_ += area_of(t);
        } else {
            for (const Triangle& part : halve_triangle(find_long_side(t))) sum_triangle(part, near);
        }
        spheres_.drop(near);
    }
};

}  // namespace cspace::shapes
