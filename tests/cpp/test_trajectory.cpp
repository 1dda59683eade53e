// Motions of one axis from state to state. Laws: reach intervals contain what a random admissible motion
// reaches; the shortest time is the first at which the goal lies in the interval, on a dense grid of times;
// the slope and the second derivative are those of differences.
#include <initializer_list>
#include <vector>

#include "check.hpp"
#include "cspace/trajectory/synchronize.hpp"
#include "library/trajectory_roots.hpp"
#include "library/trajectory_states.hpp"
#include "random.hpp"

using namespace cspace::trajectory;
using check::Random;

namespace {

AxisLimits random_limits(Random& random, bool jerk = true) {
    const auto size = [&] { return std::exp(random.uniform(-1, 1)); };
    return {size(), -size(), size(), -size(), jerk ? size() * 2 : never};
}

// A velocity and an acceleration that limits allow before and after.
AxisState random_state(Random& random, const AxisLimits& l) {
    const double a = l.has_jerk() ? random.uniform(0.9 * l.a_min, 0.9 * l.a_max) : 0;
    const double room = l.has_jerk() ? a * a / (2 * l.jerk) : 0;
    const double low = l.v_min + room, high = l.v_max - room;
    if (!(low < high)) return {random.uniform(-2, 2), 0, 0};
    return {random.uniform(-2, 2), random.uniform(low, high), a};
}

AxisState run_phases(AxisState s, const Phases& phases, const AxisLimits& l, double* worst) {
    for (int i = 0; i < phases.count; ++i) {
        const Phase& f = phases.phase[i];
        const double turn = f.j != 0 ? -f.a / f.j : -1;
        const AxisState peak = turn > 0 && turn < f.h ? advance_axis(s, {turn, f.a, f.j}) : s;
        s = advance_axis(s, f);
        for (const AxisState& at : {peak, s}) {
            *worst = std::fmax(*worst, std::fmax(at.v - l.v_max, l.v_min - at.v));
            if (l.has_jerk()) *worst = std::fmax(*worst, std::fmax(at.a - l.a_max, l.a_min - at.a));
        }
    }
    return s;
}

}  // namespace

TEST(motions_reach_their_goals_within_limits) {
    Random random{1};
    double worst = 0;
    for (int repeat = 0; repeat < 200000; ++repeat) {
        const AxisLimits l = random_limits(random, repeat % 4 != 0);
        const AxisState s = random_state(random, l), g = random_state(random, l);
        Axis axis;
        set_axis(axis, s, g, l);
        CHECK(axis.brake_time == 0);
        for (const double factor : {1.0, random.uniform(1, 3)}) {
            Axis moved = axis;
            const double T = next_duration(axis, factor * axis.shortest);
            CHECK(T < never);
            CHECK(T >= factor * axis.shortest * (1 - 1e-15));
            finish_axis(moved, T);
            CHECK_NEAR(moved.phases.duration(), T, 1e-12 * (1 + T));
            const AxisState end = run_phases({0, s.v, s.a}, moved.phases, l, &worst);
            CHECK_NEAR(end.p, g.p - s.p, 1e-9);
            CHECK_NEAR(end.v, g.v, 1e-10);
            if (l.has_jerk()) CHECK_NEAR(end.a, g.a, 1e-10);
        }
    }
    CHECK(worst < 1e-11);
}

TEST(no_shorter_time_reaches_the_goal) {
    Random random{2};
    for (int repeat = 0; repeat < 3000; ++repeat) {
        const AxisLimits l = random_limits(random);
        const AxisState s = random_state(random, l), g = random_state(random, l);
        Axis axis;
        set_axis(axis, s, g, l);
        const Domain& d = axis.task.domain;
        for (int i = 0; i < 100; ++i) {
            const double T = d.first + (axis.shortest - d.first) * i / 100.0;
            if (!is_in_domain(d, T) || T >= axis.shortest * (1 - 1e-9)) continue;
            const double up = find_farthest(axis.task.up, T).displacement;
            const double down = -find_farthest(axis.task.down, T).displacement;
            CHECK(down <= up + 1e-9);
            CHECK(axis.task.P > up || axis.task.P < down);
        }
    }
}

TEST(slopes_and_bends_are_those_of_differences) {
    Random random{3};
    int compared = 0;
    for (int repeat = 0; repeat < 20000; ++repeat) {
        const AxisLimits l = random_limits(random);
        const AxisState s = random_state(random, l), g = random_state(random, l);
        const VelocityChange q{s.v, s.a, g.v, g.a, l};
        const Domain d = find_domain(q);
        const double T = (d.has_gap ? d.gap_end : d.first) + random.uniform(0.01, 6), h = 1e-4;
        const Reach before = find_farthest(q, T - h), at = find_farthest(q, T),
                    after = find_farthest(q, T + h);
        if (before.regime != at.regime || after.regime != at.regime) continue;
        ++compared;
        CHECK_NEAR((after.displacement - before.displacement) / (2 * h), at.slope, 2e-6);
        CHECK_NEAR((after.slope - before.slope) / (2 * h), at.bend, 2e-5 * (1 + std::fabs(at.bend)));
    }
    CHECK(compared > 15000);
}

// Of jerks that are drawn at random, those that end in the state asked for are rare; so the end is what they
// reach, and the interval for it must contain their displacement.
TEST(intervals_contain_what_random_motions_reach) {
    Random random{4};
    int compared = 0;
    for (int repeat = 0; repeat < 200000; ++repeat) {
        const AxisLimits l = random_limits(random);
        const AxisState s = random_state(random, l);
        AxisState at{0, s.v, s.a};
        double T = 0, worst = 0;
        Phases one;
        for (int i = 0; i < 4; ++i) {
            one.count = 0;
            one.append({random.uniform(0, 1), at.a, random.uniform(-l.jerk, l.jerk)});
            at = run_phases(at, one, l, &worst);
            T += one.duration();
        }
        if (worst > 0) continue;
        ++compared;
        const VelocityChange q{s.v, s.a, at.v, at.a, l};
        CHECK(is_in_domain(find_domain(q), T));
        CHECK(at.p <= find_farthest(q, T).displacement + 1e-10);
        CHECK(at.p >= -find_farthest(mirror_change(q), T).displacement - 1e-10);
    }
    CHECK(compared > 1000);
}

TEST(axes_agree_on_the_first_common_duration) {
    Random random{5};
    for (int repeat = 0; repeat < 20000; ++repeat) {
        Axis axes[3];
        double least = 0;
        for (Axis& axis : axes) {
            const AxisLimits l = random_limits(random);
            set_axis(axis, random_state(random, l), random_state(random, l), l);
            least = std::fmax(least, axis.shortest);
        }
        const double T = common_duration(axes, 3, least, 0);
        for (Axis& axis : axes) CHECK(next_duration(axis, T) == T);
        for (int i = 0; i < 20; ++i) {
            const double t = least + (T - least) * i / 20;
            bool agreed = t < T * (1 - 1e-9);
            for (Axis& axis : axes) agreed = agreed && next_duration(axis, t) <= t;
            CHECK(!agreed);
        }
        const double ticks = common_duration(axes, 3, least, 0.01) / 0.01;
        CHECK_NEAR(ticks, std::round(ticks), 1e-8);
    }
}

// An axis that was brought within its limits holds an acceleration at first. In the shortest time the peak
// and the trough of its motion are the same then, up to rounding: the state of one that took three seconds
// too long.
TEST(changes_that_begin_with_a_hold_are_continuous_at_the_shortest_time) {
    const AxisLimits l{0.84246212965737044, -1.415109006900853, 0.43743038963598169, -1.7828526381723742,
                       1.5595535797711897};
    const VelocityChange q{l.v_max, l.a_min, -1.0186794066103662, -1.0565557110646093, l};
    const AxisTask task = make_axis_task(q, -0.169312889146368);
    CHECK_NEAR(find_farthest(q, task.domain.first).displacement, task.domain.displacement, 1e-12);
    CHECK(find_farthest(q, task.domain.first).bend < 0);
    CHECK_NEAR(minimum_time(task), 1.1401489959994, 1e-10);
}

// Rows of the library are solved in lanes; here each axis is solved alone.
TEST(rows_in_lanes_are_the_axes_alone) {
    Random random{6};
    constexpr std::size_t rows = 300, dof = 5;
    for (int repeat = 0; repeat < 20; ++repeat) {
        std::vector<AxisLimits> limits;
        std::vector<double> states(rows * 6 * dof), table(5 * dof), durations(rows, std::nan(""));
        for (std::size_t i = 0; i < dof; ++i) {
            const AxisLimits l = random_limits(random);
            limits.push_back(l);
            const double row[5] = {l.v_max, l.v_min, l.a_max, l.a_min, l.jerk};
            for (std::size_t k = 0; k < 5; ++k) table[k * dof + i] = row[k];
        }
        for (std::size_t row = 0; row < rows; ++row)
            for (std::size_t end = 0; end < 2; ++end)
                for (std::size_t i = 0; i < dof; ++i) {
                    AxisState s = random_state(random, limits[i]);
                    if (end == 0 && row % 3 == 0) s.v *= 3, s.a *= 2;  // beyond the limits
                    const double values[3] = {s.p, s.v, s.a};
                    for (std::size_t k = 0; k < 3; ++k)
                        states[((row * 2 + end) * 3 + k) * dof + i] = row % 7 == 0 && k > 0 ? 0 : values[k];
                }
        std::vector<std::int32_t> verdict(rows);
        std::vector<double> duration(rows), shortest(rows * dof), motions(numbers_of_motion() * rows * dof);
        solve_states({rows, dof, states.data(), table.data(), durations.data(), 0, Synchronize::time,
                      verdict.data(), duration.data(), shortest.data(), motions.data()},
                     2);
        for (std::size_t row = 0; row < rows; ++row) {
            Axis axes[dof];
            double least = 0;
            for (std::size_t i = 0; i < dof; ++i) {
                const auto state = [&](std::size_t end) {
                    const double* s = states.data() + (row * 2 + end) * 3 * dof + i;
                    return AxisState{s[0], s[dof], s[2 * dof]};
                };
                set_axis(axes[i], state(0), state(1), limits[i]);
                least = std::fmax(least, axes[i].shortest);
                CHECK_NEAR(shortest[row * dof + i], axes[i].shortest, 1e-9 * (1 + least));
            }
            CHECK_NEAR(duration[row], common_duration(axes, dof, least, 0), 1e-9 * (1 + least));
            const OneMotion alone =
                move_axes(states.data() + row * 6 * dof, table.data(), nullptr, nullptr, dof);
            CHECK(alone.duration == duration[row]);
        }
    }
}

TEST(roots_of_degenerate_polynomials_are_finite_in_number) {
    const double polynomials[3][6] = {{0, 0, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0}, {-1, 5, -10, 10, -5, 1}};
    for (const auto& c : polynomials) {
        const double begin = 0, end = 2;
        double roots[5];
        find_roots(c, &begin, &end, 1, 6, 4e-16, roots);
        for (int k = 1; k < 5; ++k) CHECK(!(roots[k] < roots[k - 1]));
    }
}
