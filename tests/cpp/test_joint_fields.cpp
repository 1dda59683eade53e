// Laws of grids of joints, of descents on potentials in closed form and of arms, and of eigenvalues.
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "check.hpp"
#include "cspace/math/symmetric_eigen.hpp"
#include "cspace/planning/descent.hpp"
#include "cspace/planning/joint_grid.hpp"
#include "cspace/search/gains.hpp"
#include "library/planning_arm_field.hpp"
#include "library/planning_arm_grid.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::planning;
using Row = std::vector<double>;
constexpr double infinite = std::numeric_limits<double>::infinity();

// A potential given by a function for its value and slope; H is a multiple of the identity.
template <class Function>
struct Landscape {
    using Look = FieldLook;
    Function function;
    Row goal;
    Row low = Row(goal.size(), -infinite), high = Row(goal.size(), infinite);
    double stiffness = 1, clear = 1;

    std::size_t width() const { return goal.size(); }
    double lower(std::size_t k) const { return low[k]; }
    double upper(std::size_t k) const { return high[k]; }
    FieldLook look(const double* q) const {
        FieldLook seen;
        const std::size_t n = width();
        seen.slope.assign(n, 0.0), seen.stiffness.assign(n * n, 0.0);
        for (std::size_t k = 0; k < n; ++k) seen.stiffness[k * n + k] = stiffness;
        seen.value = function(q, seen.slope.data());
        return seen;
    }
    double free_share(const FieldLook&, const double* step) const {
        double square = 0;
        for (std::size_t k = 0; k < width(); ++k) square += step[k] * step[k];
        return std::min(1.0, clear / std::max(std::sqrt(square), 1e-300));
    }
    int find_goal(const double*, double* to) const { return std::copy(goal.begin(), goal.end(), to), 0; }
    bool is_free(const double*, const double*) const { return true; }
    bool has_time() const { return true; }
};
template <class Function>
Landscape(Function, Row) -> Landscape<Function>;

template <class Field>
Descent descend(Field field, const Row& start) {
    return JointDescent<Field>(field, 0.1, 100000).run(start.data());
}
double at_end(const Descent& descent, std::size_t n, std::size_t k) {
    return descent.rows[descent.rows.size() - n + k];
}

TEST(bowls_end_at_their_bottom) {
    check::Random random{1};
    for (int round = 0; round < 50; ++round) {
        const std::size_t n = std::size_t(1 + random.below(7));
        Row center(n), weight(n), start(n);
        for (std::size_t k = 0; k < n; ++k)
            center[k] = random.uniform(-2, 2), weight[k] = std::pow(10, random.uniform(-2, 2)),
            start[k] = random.uniform(-2, 2);
        const auto bowl = [&](const double* q, double* slope) {
            double sum = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const double d = q[k] - center[k];
                sum += 0.5 * weight[k] * d * d;
                slope[k] = weight[k] * d;
            }
            return sum;
        };
        Landscape field{bowl, Row(n, 10.0)};
        field.stiffness = 1e-2;
        const Descent away = descend(field, start);
        CHECK(away.rest == Rest::minimum);
        for (std::size_t k = 0; k < n; ++k) CHECK_NEAR(at_end(away, n, k), center[k], 1e-4);
        for (std::size_t i = 1; i < away.values.size(); ++i) CHECK(away.values[i] < away.values[i - 1]);
        Landscape near{bowl, center};
        const Descent home = descend(near, start);
        CHECK(home.rest == Rest::goal && home.goal == 0);
        for (std::size_t k = 0; k < n; ++k) CHECK(at_end(home, n, k) == center[k]);
    }
}

TEST(a_saddle_is_left) {
    const auto saddle = [](const double* q, double* slope) {
        slope[0] = q[0], slope[1] = -q[1] + q[1] * q[1] * q[1];
        return 0.5 * q[0] * q[0] - 0.5 * q[1] * q[1] + 0.25 * std::pow(q[1], 4);
    };
    const Descent descent = descend(Landscape{saddle, {9.0, 9.0}}, {1.5, 0.0});
    CHECK(descent.rest == Rest::minimum && descent.saddles == 1);
    CHECK_NEAR(std::fabs(at_end(descent, 2, 1)), 1, 1e-4);
}

TEST(flat_ground_is_no_minimum) {
    const auto flat = [](const double* q, double* slope) {
        slope[0] = q[0], slope[1] = 0;
        return 0.5 * q[0] * q[0];
    };
    CHECK(descend(Landscape{flat, {9.0, 9.0}}, {1.0, 0.3}).rest == Rest::saddle);
}

// The larger of two slopes that meet in a valley with a kink: |a| + ½ b² in turned axes.
TEST(a_kink_is_a_crease) {
    check::Random random{2};
    for (int round = 0; round < 30; ++round) {
        const double angle = random.uniform(-3, 3), c = std::cos(angle), s = std::sin(angle);
        const auto kink = [&](const double* q, double* slope) {
            const double a = c * q[0] + s * q[1], b = c * q[1] - s * q[0], sign = a < 0 ? -1 : 1;
            slope[0] = sign * c - b * s, slope[1] = sign * s + b * c;
            return std::fabs(a) + 0.5 * b * b;
        };
        const Descent descent =
            descend(Landscape{kink, {9.0, 9.0}}, {random.uniform(-1, 1), random.uniform(-1, 1)});
        CHECK(descent.rest == Rest::crease);
        CHECK_NEAR(at_end(descent, 2, 0), 0, 1e-3);
        CHECK_NEAR(at_end(descent, 2, 1), 0, 1e-3);
    }
}

TEST(limits_hold) {
    const auto slide = [](const double* q, double* slope) {
        slope[0] = 1, slope[1] = q[1];
        return q[0] + 0.5 * q[1] * q[1];
    };
    Landscape field{slide, {9.0, 9.0}};
    field.low = {-1, -5}, field.high = {1, 5};
    const Descent descent = descend(field, {0.5, 2.0});
    CHECK(descent.rest == Rest::minimum);
    CHECK(at_end(descent, 2, 0) == -1);
    CHECK_NEAR(at_end(descent, 2, 1), 0, 1e-4);
    CHECK(descent.force < 1e-4);
}

TEST(gains_have_their_derivatives) {
    check::Random random{3};
    for (int round = 0; round < 1000; ++round) {
        const search::Gains gains = {random.uniform(0.1, 3), random.uniform(0.1, 3), random.uniform(0.1, 2),
                                     random.uniform(0.1, 2)};
        const double rho = gains.rho_0 * random.uniform(0.05, 0.99), h = 1e-6 * rho;
        const double rate = (gains.repulsion(rho + h) - gains.repulsion(rho - h)) / (2 * h);
        CHECK_NEAR(rate / gains.repulsion_rate(rho), 1, 1e-5);
        const double bend = (gains.repulsion_rate(rho + h) - gains.repulsion_rate(rho - h)) / (2 * h);
        CHECK_NEAR(bend / gains.repulsion_stiffness(rho), 1, 1e-5);
        CHECK(gains.repulsion(1.01 * gains.rho_0) == 0 && gains.repulsion_rate(1.01 * gains.rho_0) == 0);
    }
}

TEST(eigenvectors_rebuild_their_matrix) {
    check::Random random{4};
    for (int round = 0; round < 200; ++round) {
        const std::size_t n = std::size_t(1 + random.below(9));
        Row A(n * n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j) A[i * n + j] = A[j * n + i] = random.uniform(-1, 1);
        const SymmetricEigen eigen = decompose_symmetric(A, n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                double rebuilt = 0, product = 0;
                for (std::size_t k = 0; k < n; ++k) {
                    rebuilt += eigen.values[k] * eigen.vectors[k * n + i] * eigen.vectors[k * n + j];
                    product += eigen.vectors[i * n + k] * eigen.vectors[j * n + k];
                }
                CHECK_NEAR(rebuilt, A[i * n + j], 1e-13);
                CHECK_NEAR(product, i == j ? 1.0 : 0.0, 1e-13);
            }
    }
}

TEST(grid_moves_come_back) {
    const float lower[] = {-1, float(-pi), 0}, upper[] = {2, float(pi), 0.5f};
    const unsigned char wraps[] = {0, 1, 0};
    const Box box = {3, lower, upper, wraps};
    const std::vector<std::int32_t> cells = {3, 5, 2};
    const JointGrid grid(box, cells);
    CHECK(grid.size() == 4 * 5 * 3);
    for (const int reach : {1, 2, 3}) {
        const auto moves = grid.list_moves(reach);
        CHECK(reach > 1 || moves.size() == 26);
        for (std::uint32_t node = 0; node < grid.size(); ++node)
            grid.visit_neighbours(node, moves, [&](std::uint32_t next) {
                bool is_back = false;
                grid.visit_neighbours(next, moves, [&](std::uint32_t back) { is_back |= back == node; });
                CHECK(is_back && next < grid.size());
            });
    }
    check::Random random{5};
    for (int round = 0; round < 500; ++round) {
        float q[3], corner[3];
        for (int k = 0; k < 3; ++k) q[k] = float(random.uniform(double(lower[k]), double(upper[k])));
        std::set<std::uint32_t> found;
        grid.visit_corners(q, [&](std::uint32_t node) {
            found.insert(node);
            grid.write_row(node, corner);
            for (int k = 0; k < 3; ++k) {
                const double side = (double(upper[k]) - double(lower[k])) / cells[std::size_t(k)];
                CHECK(std::fabs(double(box.difference(k, q[k], corner[k]))) <= side * (1 + 1e-6));
                CHECK(corner[k] >= lower[k] && corner[k] <= upper[k]);
            }
        });
        CHECK(found.size() == 8);
    }
    for (const std::vector<std::int32_t>& bad : {std::vector{3, 5}, {3, 0, 5}, {3000, 3000, 3000}}) {
        bool is_refused = false;
        try {
            JointGrid(box, bad);
        } catch (const std::invalid_argument&) {
            is_refused = true;
        }
        CHECK(is_refused);
    }
}

Row free_configuration(const check::RandomCell& cell, check::Random& random) {
    const auto memory = cell.checker->borrow_workspace();
    for (int i = 0; i < 200; ++i) {
        const Row q = cell.configuration(random);
        if (cell.checker->is_free(q.data(), *memory)) return q;
    }
    return {};
}
// At places along the rows.
double least_clearance(const check::RandomCell& cell, const Row& rows) {
    const std::size_t width = cell.lower.size();
    double least = infinite;
    for (std::size_t i = 0; i + width < rows.size(); i += width)
        for (int k = 0; k <= 20; ++k) {
            Row q(width);
            for (std::size_t j = 0; j < width; ++j)
                q[j] = rows[i + j] + 0.05 * k * (rows[i + width + j] - rows[i + j]);
            least = std::min(least, cell.checker->clearance(q.data()).distance);
        }
    return least;
}

TEST(descents_of_arms_are_free_and_their_gradients_are_right) {
    check::Random random{6};
    int arrived = 0, rested = 0;
    for (int arm = 0; arm < 60; ++arm) {
        const auto cell = check::random_cell(random, 2 + random.below(6));
        const std::size_t n = cell.lower.size();
        const Row start = free_configuration(cell, random), goal = free_configuration(cell, random);
        if (start.empty() || goal.empty() || cell.checker->base_contact().other >= 0) continue;
        const ArmSpace space{*cell.checker, cell.lower, cell.upper, {}};
        const FieldRule rule = {1, 1e-4, 0.1, 0.02, 0.5, 0.1, 3000};
        const FieldPlan found = plan_by_field(space, {start, goal}, {}, rule);
        const bool is_found = found.plan.status == PlanStatus::found;
        CHECK(is_found == (found.rest.kind == 0));
        ++(is_found ? arrived : rested);
        CHECK(least_clearance(cell, is_found ? found.plan.path : found.rest.rows) > 0);
        CHECK(found.rest.rows.size() == found.rest.values.size() * n);
        for (std::size_t i = 1; i + is_found < found.rest.values.size(); ++i)
            CHECK(found.rest.values[i] < found.rest.values[i - 1]);
        Row rows = start, values(2 * n + 1), gradients((2 * n + 1) * n);
        constexpr double h = 1e-7;
        for (std::size_t k = 0; k < n; ++k)
            for (const double sign : {1.0, -1.0}) {
                Row q = start;
                q[k] += sign * h;
                rows.insert(rows.end(), q.begin(), q.end());
            }
        evaluate_potential(space, goal, rule, rows, values.data(), gradients.data());
        CHECK_NEAR(values[0], found.rest.values[0], 1e-9 * values[0]);
        for (std::size_t k = 0; k < n; ++k) {
            const double slope = (values[2 * k + 1] - values[2 * k + 2]) / (2 * h);
            const double bend = (values[2 * k + 1] + values[2 * k + 2] - 2 * values[0]) / h;
            if (std::fabs(bend) < 1e-3 * (1 + std::fabs(slope)))
                CHECK_NEAR(slope, gradients[k], 1e-3 * (1 + std::fabs(slope)));
        }
    }
    std::printf("%d arrived, %d rested\n", arrived, rested);
    CHECK(arrived > 10 && rested > 5);
}

TEST(searches_over_grids_agree) {
    check::Random random{7};
    int found = 0, none = 0;
    for (int arm = 0; arm < 40; ++arm) {
        const auto cell = check::random_cell(random, 2 + random.below(2));
        const Row start = free_configuration(cell, random), goal = free_configuration(cell, random);
        if (start.empty() || goal.empty() || cell.checker->base_contact().other >= 0) continue;
        const ArmSpace space{*cell.checker, cell.lower, cell.upper, {}};
        ArmOptions options;
        options.simplify = arm % 2;
        GridRule rule;
        rule.cells.assign(cell.lower.size(), 12);
        rule.k_r = 1e-3, rule.rho_0 = 0.2, rule.cap = 5;
        double best = infinite;
        for (const int order : {1, 0, 2, 3, 4}) {
            rule.order = order % 4, rule.has_potential = order == 4, rule.weight = order == 4 ? 1.5 : 1;
            const ArmPlan plan = plan_on_grid(space, {start, goal}, options, rule);
            if (order == 1) best = plan.raw_cost;
            CHECK((plan.status == PlanStatus::found) == (best < infinite));
            if (plan.status != PlanStatus::found) {
                ++none;
                CHECK(plan.status == PlanStatus::disconnected);
                continue;
            }
            ++found;
            CHECK(plan.certified && least_clearance(cell, plan.path) > 0);
            CHECK(plan.raw_cost >= best * (1 - 1e-9));
            if (order == 0) CHECK_NEAR(plan.raw_cost, best, 1e-9 * best);
            if (order == 4) CHECK(plan.raw_cost <= 1.5 * best * (1 + 1e-9));
        }
    }
    std::printf("%d found, %d without a path\n", found, none);
    CHECK(found > 60 && none > 0);
}

}  // namespace
