// One motion of seven joints from state to state, in the shortest time; beside Ruckig where CMake finds it.
#include <array>
#include <limits>
#include <random>
#include <vector>

#include "bench.hpp"
#include "library/trajectory_states.hpp"
#ifdef CSPACE_BENCH_RUCKIG
#include <ruckig/ruckig.hpp>
#endif

namespace {

constexpr std::size_t dof = 7;
constexpr int problems = 2000, repetitions = 25;
constexpr double velocity = 2.0, acceleration = 8.0, jerk = 80.0;

// Positions, velocities and accelerations at the start, then at the goal.
using States = std::array<std::array<double, dof>, 6>;

std::vector<States> make_problems(bool moving) {
    std::mt19937_64 random(7);
    const auto draw = [&](double most) {
        return std::uniform_real_distribution<double>(-most, most)(random);
    };
    std::vector<States> all(problems);
    for (States& each : all)
        for (std::size_t j = 0; j < dof; ++j)
            for (const int k : {0, 1, 2, 3, 4, 5})
                each[std::size_t(k)][j] = k % 3 == 0   ? draw(2.0)
                                          : !moving    ? 0.0
                                          : k % 3 == 1 ? draw(1.0)
                                          : k == 2     ? draw(4.0)
                                                       : 0.0;
    return all;
}

void measure_ours(const char* solved, const char* made, const std::vector<States>& all) {
    using namespace cspace::trajectory;
    std::array<std::array<double, dof>, 5> limits;
    const double values[] = {velocity, -velocity, acceleration, -acceleration, jerk};
    for (std::size_t k = 0; k < 5; ++k) limits[k].fill(values[k]);
    std::vector<double> motions(numbers_of_motion() * dof);
    bench::measure(solved, problems, repetitions, [&] {
        const double free = std::numeric_limits<double>::quiet_NaN();
        for (const States& each : all) {
            double duration, shortest[dof];
            std::int32_t verdict;
            solve_states({1, dof, each[0].data(), limits[0].data(), &free, 0.0, Synchronize::time, &verdict,
                          &duration, shortest, motions.data()},
                         1);
            bench::keep(duration);
        }
    });
    bench::measure(made, problems, repetitions, [&] {
        for (const States& each : all)
            bench::keep(move_axes(each[0].data(), limits[0].data(), nullptr, nullptr, dof).duration);
    });
}

#ifdef CSPACE_BENCH_RUCKIG
void measure_ruckig(const char* name, const std::vector<States>& all) {
    ruckig::Ruckig<dof> solver;
    ruckig::InputParameter<dof> task;
    task.max_velocity.fill(velocity), task.max_acceleration.fill(acceleration), task.max_jerk.fill(jerk);
    ruckig::Trajectory<dof> motion;
    bench::measure(name, problems, repetitions, [&] {
        for (const States& each : all) {
            task.current_position = each[0], task.current_velocity = each[1],
            task.current_acceleration = each[2];
            task.target_position = each[3], task.target_velocity = each[4],
            task.target_acceleration = each[5];
            solver.calculate(task, motion);
            bench::keep(motion.get_duration());
        }
    });
}
#endif

}  // namespace

int main() {
    for (const bool moving : {false, true}) {
        const std::vector<States> all = make_problems(moving);
        measure_ours(moving ? "states, moving" : "states, at rest",
                     moving ? "states with pieces, moving" : "states with pieces, at rest", all);
#ifdef CSPACE_BENCH_RUCKIG
        measure_ruckig(moving ? "ruckig, moving" : "ruckig, at rest", all);
#endif
    }
}
