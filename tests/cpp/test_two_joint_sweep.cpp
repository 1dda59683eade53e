// Free boxes, components, boundaries and paths of the configuration space of two joints, against distances
// between segments and against a flood fill.
#include <algorithm>

#include "check.hpp"
#include "cspace/planning/two_joints/bitmap.hpp"
#include "cspace/planning/two_joints/boundaries.hpp"
#include "cspace/planning/two_joints/path.hpp"
#include "two_link_arms.hpp"

using namespace cspace;
using namespace cspace::planning::two_joints;

namespace {

constexpr double rounding = 1e-9;  // of a clearance [m] and of an angle

double draw(check::Random& random, const Joint& joint) { return random.uniform(joint.lower, joint.upper); }

// The free cells of a bitmap, each with the number of its part; −1 where blocked.
class FloodFill {
  public:
    FloodFill(const Space& space, int n) : n_(n), part_(std::size_t(n) * std::size_t(n)) {
        draw_bitmap(space, n, n, part_.data(), [](std::int32_t) { return -1; });
        wraps_1_ = space.arm().joint_1.wraps, wraps_2_ = space.arm().joint_2.wraps;
        for (int seed = 0; seed < n * n; ++seed)
            if (part_[std::size_t(seed)] == 0) fill(seed);
    }
    int at(int row, int column) const { return part_[std::size_t(row * n_ + column)]; }

  private:
    int n_, parts_ = 0;
    bool wraps_1_, wraps_2_;
    std::vector<int> part_, stack_;

    void fill(int seed) {
        mark(seed, ++parts_);
        while (!stack_.empty()) {
            const int row = stack_.back() / n_, column = stack_.back() % n_;
            stack_.pop_back();
            visit(row - 1, column), visit(row + 1, column), visit(row, column - 1), visit(row, column + 1);
        }
    }
    void mark(int cell, int part) {
        part_[std::size_t(cell)] = part;
        stack_.push_back(cell);
    }
    void visit(int row, int column) {
        const bool leaves_1 = row < 0 || row >= n_, leaves_2 = column < 0 || column >= n_;
        if ((leaves_1 && !wraps_1_) || (leaves_2 && !wraps_2_)) return;
        const int cell = (row + n_) % n_ * n_ + (column + n_) % n_;
        if (part_[std::size_t(cell)] == 0) mark(cell, parts_);
    }
};

bool is_in(const Sweep& sweep, const std::vector<Gap>& boxes, double q_2) {
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Gap& box) { return sweep.finder().contains(box, q_2); });
}

// How many regions are proved to be separate.
int count_regions(const Components& components) {
    int regions = 0;
    for (const Component& one : components.all()) regions = std::max(regions, one.region + 1);
    return regions;
}

}  // namespace

TEST(boxes_of_slabs_are_free_and_nothing_outside_of_the_possible_ones_is) {
    check::Random random{4};
    int inside = 0, outside = 0, between = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Space space(problem.arm, problem.obstacles);
        const Sweep sweep(space, {8 + random.below(100)});
        for (int k = 0; k < 300; ++k) {
            const auto s = std::size_t(random.below(int(sweep.slabs().size())));
            const double q_1 = random.uniform(sweep.rows()[s].q_1, sweep.rows()[s + 1].q_1);
            const double q_2 = draw(random, problem.arm.joint_2);
            const double clearance = check::clearance(problem.arm, problem.obstacles, q_1, q_2);
            if (is_in(sweep, sweep.slabs()[s].free, q_2)) {
                CHECK(clearance > 0);
                ++inside;
            } else if (!is_in(sweep, sweep.slabs()[s].possible, q_2)) {
                CHECK(clearance < rounding);
                ++outside;
            } else {
                ++between;
            }
        }
    }
    CHECK(inside > 20000 && outside > 20000 && between > 100);
}

TEST(boxes_lie_within_the_gaps_of_both_rows) {
    check::Random random{8};
    for (int trial = 0; trial < 200; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Space space(problem.arm, problem.obstacles);
        const Sweep sweep(space);
        const auto is_within = [&](const Gap& inner, const Gap& outer) {
            if (outer.at_low.piece == GapEnd::nothing) return true;
            const Overlap both = sweep.finder().overlap(outer, inner);
            return both.is_open() && std::abs(both.high - both.low - (inner.high - inner.low)) < rounding;
        };
        for (std::size_t s = 0; s < sweep.slabs().size(); ++s)
            for (const SweepRow* row : {&sweep.rows()[s], &sweep.rows()[s + 1]}) {
                for (const Gap& box : sweep.slabs()[s].free)
                    CHECK(std::count_if(row->gaps.begin(), row->gaps.end(),
                                        [&](const Gap& gap) { return is_within(box, gap); }) == 1);
                for (const Gap& gap : row->gaps)
                    CHECK(std::any_of(sweep.slabs()[s].possible.begin(), sweep.slabs()[s].possible.end(),
                                      [&](const Gap& box) { return is_within(gap, box); }));
            }
    }
}

TEST(components_are_those_of_a_flood_fill) {
    check::Random random{5};
    int proofs = 0, parts_of_one = 0, ones = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Space space(problem.arm, problem.obstacles);
        Sweep sweep(space);
        const Components components(sweep);
        constexpr int n = 500;
        const FloodFill fill(space, n);
        const Cells along(problem.arm.joint_1, n), across(problem.arm.joint_2, n);
        std::vector<std::pair<int, int>> seen;  // component and part of the flood fill
        for (int k = 0; k < 2000; ++k) {
            const int row = random.below(n), column = random.below(n), part = fill.at(row, column);
            const std::int32_t name = components.find_component(along.center(row), across.center(column));
            CHECK((name == Components::blocked) == (part < 0));
            CHECK(name != Components::unresolved);
            if (name >= 0) seen.push_back({name, part});
        }
        for (const Component& one : components.all()) {
            CHECK(one.is_proved && one.least_area > 0 && one.least_area <= one.greatest_area);
            CHECK(check::clearance(problem.arm, problem.obstacles, one.q_1, one.q_2) > 0);
        }
        std::sort(seen.begin(), seen.end());
        seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
        for (const auto& [name, part] : seen)
            for (const auto& [other, second] : seen) {
                if (name == other) part == second ? ++ones : ++parts_of_one;
                if (name == other) continue;
                CHECK(part != second);
                ++proofs;
            }
    }
    CHECK(proofs > 200 && ones > 100);
    CHECK(parts_of_one <= 4);  // a passage between cells
}

TEST(boundaries_touch_separate_and_are_all_that_a_row_meets) {
    check::Random random{6};
    constexpr double beside = 1e-6;
    int kinds[5] = {}, separated = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Space space(problem.arm, problem.obstacles);
        Sweep sweep(space);
        const std::vector<BoundaryCurve> curves = trace_boundaries(sweep);
        const auto clearance_at = [&](Point q) {
            return check::clearance(problem.arm, problem.obstacles, q.x, q.y);
        };
        for (const BoundaryCurve& curve : curves) {
            ++kinds[int(curve.kind)];
            CHECK(curve.points.size() >= 2);
            CHECK((curve.obstacle == no_obstacle) == (curve.kind == BoundaryKind::limit));
            for (std::size_t i = 0; i < curve.points.size(); ++i) {
                const Point q = curve.points[i];
                if (curve.kind == BoundaryKind::limit) {
                    CHECK(clearance_at(q) > -rounding);
                    continue;
                }
                CHECK_NEAR(clearance_at(q), 0, 1e-7);
                if (curve.kind == BoundaryKind::link_1) continue;
                const bool below = clearance_at(q - Point{0, beside}) > 0;
                const bool above = clearance_at(q + Point{0, beside}) > 0;
                const bool is_inner = i > 1 && i + 2 < curve.points.size() &&
                                      curve.points[i + 1].x - curve.points[i - 1].x > 1e-3;
                if (is_inner) CHECK(below != above);  // else it may be near another curve
                separated += below != above;
            }
        }
        for (int k = 0; k < 50; ++k) {
            const double q_1 = draw(random, problem.arm.joint_1);
            int met = 0, ends = 0;
            for (const BoundaryCurve& curve : curves)
                if (curve.kind != BoundaryKind::link_1)
                    for (std::size_t i = 1; i < curve.points.size(); ++i)
                        met += curve.points[i - 1].x < q_1 && q_1 < curve.points[i].x;
            const SweepRow row = sweep.make_row(q_1);
            for (const Gap& gap : row.gaps) ends += gap.at_low.piece == GapEnd::nothing ? 0 : 2;
            CHECK(met == ends);
        }
    }
    for (const int count : kinds) CHECK(count > 100);
    CHECK(separated > 10000);
}

TEST(paths_are_free_and_exist_within_components_alone) {
    check::Random random{7};
    int found = 0, none = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const check::Problem problem = check::random_problem(random, trial % 2);
        const Joint &joint_1 = problem.arm.joint_1, &joint_2 = problem.arm.joint_2;
        const Space space(problem.arm, problem.obstacles);
        Sweep sweep(space);
        const Components components(sweep);
        PathFinder finder(sweep, components);
        for (int k = 0; k < 30; ++k) {
            const Point from{draw(random, joint_1), draw(random, joint_2)};
            const Point to{draw(random, joint_1), draw(random, joint_2)};
            const std::int32_t name = components.find_component(from.x, from.y);
            const std::vector<Point> path = finder.find(from, to);
            CHECK(path.empty() == (name < 0 || name != components.find_component(to.x, to.y)));
            path.empty() ? ++none : ++found;
            if (path.empty()) continue;
            CHECK(path.front() == from);
            const Point off = path.back() - to;
            CHECK_NEAR(joint_1.wraps ? short_way(off.x) : off.x, 0, 1e-12);
            CHECK_NEAR(joint_2.wraps ? short_way(off.y) : off.y, 0, 1e-12);
            for (std::size_t i = 1; i < path.size(); ++i) {
                const int steps = 1 + int(distance(path[i], path[i - 1]) / 0.01);
                for (int t = 0; t <= steps; ++t) {
                    const Point q = path[i - 1] + double(t) / steps * (path[i] - path[i - 1]);
                    CHECK(check::clearance(problem.arm, problem.obstacles, q.x, q.y) > -rounding);
                }
            }
        }
    }
    CHECK(found > 500 && none > 500);
}

TEST(a_passage_closes_at_one_radius_and_is_proved_open_or_closed_near_it) {
    // Link 2 passes between two discs as joint 1 turns, until the links grow too thick.
    const Point left[] = {{1.35, 0.35}}, right[] = {{1.3, -0.4}};
    const Piece discs[] = {make_piece(left, 0.1, 0), make_piece(right, 0.1, 1)};
    Arm arm;
    arm.length_2 = 0.8;
    const auto regions_with = [&](double radius, bool& proved) {
        arm.radius = radius;
        const Space space(arm, discs);
        Sweep sweep(space);
        const Components components(sweep);
        proved = std::all_of(components.all().begin(), components.all().end(),
                             [](const Component& one) { return one.is_proved; });
        return count_regions(components);
    };
    bool proved = false;
    double open = 0.02, closed = 0;
    const int before = regions_with(open, proved);
    for (closed = open; regions_with(closed, proved) == before && closed < 0.5; closed += 0.01) open = closed;
    CHECK(closed < 0.5);
    while (closed - open > 1e-12) {
        const double middle = 0.5 * (open + closed);
        (regions_with(middle, proved) == before ? open : closed) = middle;
    }
    for (const double off : {1e-3, 1e-5, 1e-7}) {
        CHECK(regions_with(open - off, proved) == before && proved);
        CHECK(regions_with(closed + off, proved) != before && proved);
    }
}

TEST(an_obstacle_in_two_parts_that_share_a_side_blocks_what_the_whole_blocks) {
    check::Random random{9};
    for (int trial = 0; trial < 100; ++trial) {
        const check::Problem whole = check::random_problem(random, trial % 2);
        check::Problem cut{whole.arm, {}};
        for (const Piece& piece : whole.obstacles) {
            const auto n = std::ptrdiff_t(piece.size());
            if (n < 4) {
                cut.obstacles.push_back(piece);
                continue;
            }
            const std::ptrdiff_t k = 2 + random.below(int(n) - 3);
            const std::vector<Point> first(piece.corners.begin(), piece.corners.begin() + k + 1);
            std::vector<Point> second(piece.corners.begin() + k, piece.corners.end());
            second.push_back(piece.corners.front());
            for (const auto& part : {first, second})
                cut.obstacles.push_back(make_piece(part, piece.radius, piece.obstacle));
        }
        const Space one(whole.arm, whole.obstacles), other(cut.arm, cut.obstacles);
        Sweep sweep_one(one), sweep_other(other);
        const Components a(sweep_one), b(sweep_other);
        CHECK(a.all().size() == b.all().size());
        for (std::size_t i = 0; i < std::min(a.all().size(), b.all().size()); ++i) {
            CHECK(a.all()[i].is_proved && b.all()[i].is_proved);
            CHECK(a.all()[i].least_area <= b.all()[i].greatest_area);
            CHECK(b.all()[i].least_area <= a.all()[i].greatest_area);
        }
    }
}

TEST(squares_of_a_raster_that_touch_in_sides_and_corners_break_no_bound) {
    // Walls without thickness, which no bitmap shows, stand where squares touch in a corner.
    check::Random random{10};
    int proved = 0, open = 0, inside = 0, outside = 0;
    for (int trial = 0; trial < 80; ++trial) {
        Arm arm;
        arm.length_2 = trial % 3 ? 1 : 0.75;
        std::vector<Piece> squares;
        while (squares.size() < 6) {
            constexpr double side = 0.25;
            const double x = side * (random.below(14) - 7), y = side * (random.below(14) - 7);
            const Point corners[] = {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
            const Piece square = make_piece(corners, 0, std::int32_t(squares.size()));
            if (distance_to_corners(square, {}) > 0) squares.push_back(square);
        }
        const Space space(arm, squares);
        const Sweep sweep(space);
        const Components components(sweep);
        for (const Component& one : components.all()) one.is_proved ? ++proved : ++open;
        for (int k = 0; k < 300; ++k) {
            const auto s = std::size_t(random.below(int(sweep.slabs().size())));
            const double q_1 = random.uniform(sweep.rows()[s].q_1, sweep.rows()[s + 1].q_1);
            const double q_2 = draw(random, arm.joint_2);
            const double clearance = check::clearance(arm, squares, q_1, q_2);
            if (is_in(sweep, sweep.slabs()[s].free, q_2)) {
                CHECK(clearance > 0);
                ++inside;
            } else if (!is_in(sweep, sweep.slabs()[s].possible, q_2)) {
                CHECK(clearance < rounding);
                ++outside;
            }
        }
    }
    CHECK(inside > 5000 && outside > 3000);
    CHECK(proved > 20 * open);
}

TEST(a_corner_between_walls_is_the_tip_of_a_component) {
    // The free space in front of a corner that the tip just reaches ends in a point.
    const Point left[] = {{-3, -3}, {-1.5, -3}, {-1.5, 3}, {-3, 3}};
    const Point lower[] = {{-1.5, -1.6}, {3, -1.6}, {3, -1.2}, {-1.5, -1.2}};
    const Piece walls[] = {make_piece(left, 0, 0), make_piece(lower, 0, 1)};
    const Space space(Arm{}, walls);
    Sweep sweep(space);
    const Components components(sweep);
    CHECK(components.all().size() == 1 && components.all()[0].is_proved);
}

TEST(a_covered_base_has_no_rows_and_an_empty_scene_one_component) {
    const Point corners[] = {{-1, -1}, {1, -1}, {0, 1}};
    const Piece piece = make_piece(corners, 0, 0);
    const Space covered(Arm{}, {&piece, 1}), empty(Arm{}, {});
    Sweep nothing(covered), everything(empty);
    const Components none(nothing), all(everything);
    CHECK(nothing.rows().empty() && none.all().empty() && trace_boundaries(nothing).empty());
    CHECK(none.find_component(0, 0) == Components::blocked);
    CHECK(all.all().size() == 1 && all.all()[0].is_proved && trace_boundaries(everything).empty());
    CHECK_NEAR(all.all()[0].least_area, turn * turn, rounding);
    CHECK((PathFinder(everything, all).find({3, 3}, {-3, -3}).size()) == 2);
}
