// Descents on the pose error against closed forms, finite differences and themselves.
#include <algorithm>
#include <vector>

#include "check.hpp"
#include "cspace/ik/arm.hpp"
#include "cspace/ik/numeric/descent.hpp"
#include "cspace/model/reduce_joint.hpp"
#include "random_arms.hpp"

using namespace cspace;
using namespace cspace::ik;

namespace {

// A random arm of n joints; those whose bit is set slide.
ik::Chain random_chain(int n, unsigned slides, arms::Rng& rng) {
    arms::Row rows[ik::max_joints] = {};
    for (int i = 0; i < n; ++i) rows[i] = arms::random_row(rng);
    ik::Chain chain = arms::from_rows(rows, n, arms::random_pose(rng), arms::random_pose(rng), rng);
    for (int i = 0; i < n; ++i) chain.prismatic[i] = slides >> i & 1u;
    return chain;
}
// The path of an arm given by its joint axes; joint i is coordinate i.
ik::Path path_of(const ik::Chain& chain) {
    ik::Path path;
    path.joints = path.n = chain.n;
    Posed frame[ik::max_joints + 1];  // of each joint at zero, its axis along z
    for (int i = 0; i < chain.n; ++i) frame[i] = {frame_along(chain.axis[i]), chain.point[i]};
    frame[chain.n] = chain.tip;
    path.T_base_first = frame[0];
    double carried = 0;
    for (int i = 0; i < chain.n; ++i) {
        const model::Joint joint = {frame[i], i - 1, i, 1.0, 0.0, chain.prismatic[i], 0.0};
        path.joint[i] = model::reduce_joint(joint, inverse(frame[i]) * frame[i + 1], carried);
        path.slides[i] = chain.prismatic[i];
    }
    path.cos_last = std::cos(carried);
    path.sin_last = std::sin(carried);
    path.length = length_of(path);
    return path;
}
std::vector<double> random_q(int count, arms::Rng& rng, double reach = pi) {
    std::vector<double> q(count);
    for (double& x : q) x = arms::uniform(rng, -reach, reach);
    return q;
}
double largest_difference(const Posed& A, const Posed& B) {
    double worst = norm(A.t - B.t);
    for (int i = 0; i < 3; ++i) worst = std::fmax(worst, norm(matrix_column(A.R, i) - matrix_column(B.R, i)));
    return worst;
}

// The results of one descent per start.
struct Runs {
    std::vector<double> q;
    std::vector<ik::DescentEnd> ends;
};
template <class V = Pack<native_width>>
Runs run(const ik::Path& path, const ik::Task& task, const Posed& goal, const std::vector<double>& starts,
         bool first_only = false) {
    const std::size_t n = starts.size() / std::size_t(path.n);
    Runs out{std::vector<double>(starts.size()), std::vector<ik::DescentEnd>(n)};
    double T[16];
    kinematics::write_matrix(goal, T);
    run_descents<V>({&path, &task, T, 0, starts.data(), std::size_t(path.n), nullptr, n, first_only,
                     out.q.data(), out.ends.data()});
    return out;
}
double apart(const ik::Chain& chain, const double* a, const double* b) {
    double worst = 0;
    for (int i = 0; i < chain.n; ++i)
        worst = std::fmax(worst,
                          std::fabs(chain.prismatic[i] ? a[i] - b[i] : std::remainder(a[i] - b[i], 2 * pi)));
    return worst;
}

}  // namespace

TEST(a_path_leads_where_its_chain_leads) {
    arms::Rng rng(1);
    for (int n = 1; n <= ik::max_joints; ++n) {
        const ik::Chain chain = random_chain(n, unsigned(rng()), rng);
        const ik::Path path = path_of(chain);
        const auto q = random_q(n, rng);
        double s[ik::max_path + 3], c[ik::max_path + 3];
        kinematics::chain_sines(view_of(path), q.data(), s, c);
        const Posed T = kinematics::follow_chain(view_of(path), path.T_base_first, q.data(), s, c,
                                                 [](int, auto&&, auto&&) {});
        CHECK(largest_difference(T, forward_kinematics(chain, q.data())) < 1e-13);
    }
}

TEST(the_derivative_of_the_error_is_that_of_differences) {
    arms::Rng rng(2);
    for (int trial = 0; trial < 200; ++trial) {
        const int n = 1 + trial % 9;
        const ik::Path path = path_of(random_chain(n, unsigned(rng()), rng));
        ik::Task task;
        for (double& w : task.weight) w = trial % 3 ? double(rng() % 3) : arms::uniform(rng, 0.5, 2);
        const Rows rows = rows_of(task);
        const Posed first = inverse(arms::random_pose(rng)) * path.T_base_first;
        auto q = random_q(n, rng);
        Gap<double> at, up, down;
        measure_gap(path, rows, first, q.data(), at);
        for (int j = 0; j < n; ++j) {
            const double unit = path.slides[j] ? path.length : 1.0, h = 1e-6, kept = q[j];
            q[j] = kept + h * unit;
            measure_gap(path, rows, first, q.data(), up);
            q[j] = kept - h * unit;
            measure_gap(path, rows, first, q.data(), down);
            q[j] = kept;
            if (at.rotation > 3.1) continue;  // the logarithm jumps at a half turn
            double gradient = 0, expected = 0;
            for (int r = 0; r < rows.m; ++r) {
                const double slope = -(up.e[r] - down.e[r]) / (2 * h);
                if (!rows.even) CHECK_NEAR(at.J[r][j], slope, 2e-6 * (1 + std::fabs(slope)));
                gradient += at.J[r][j] * at.e[r];
                expected += slope * at.e[r];
            }
            CHECK_NEAR(gradient, expected, 1e-5 * (1 + std::fabs(expected)));
        }
    }
}

TEST(what_descents_reach_is_among_the_solutions_of_the_closed_form) {
    arms::Rng rng(3);
    long reached = 0, starts = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const ik::Chain chain =
            arms::random_arm(arms::Class(trial % int(arms::Class::count)), trial & 1, rng);
        const ik::Arm arm = make_arm(chain);
        const auto truth = random_q(6, rng);
        const Posed goal = forward_kinematics(chain, truth.data());
        const ik::Solutions all = solve_pose(arm, goal, nullptr);
        const Runs runs = run(path_of(chain), {}, goal, random_q(6 * 32, rng));
        const std::vector<double>& q = runs.q;
        for (int k = 0; k < 32; ++k) {
            ++starts;
            if (!(std::fmax(runs.ends[k].position, runs.ends[k].rotation) < 1e-9)) continue;
            ++reached;
            CHECK(largest_difference(forward_kinematics(chain, &q[6 * k]), goal) < 2e-9);
            double nearest = 10;
            for (int s = 0; s < all.count; ++s)
                nearest = std::fmin(nearest, apart(chain, &q[6 * k], all.q[s]));
            CHECK(nearest < 1e-6);
        }
    }
    CHECK(reached > starts / 2);
}

TEST(any_kinds_of_joints_reach_what_they_can) {
    arms::Rng rng(4);
    for (int n = 1; n <= ik::max_joints; ++n) {
        int reached = 0;
        for (int trial = 0; trial < 10; ++trial) {
            const ik::Chain chain = random_chain(n, unsigned(rng() & rng()), rng);
            const auto truth = random_q(n, rng);
            const Posed goal = forward_kinematics(chain, truth.data());
            const Runs runs = run(path_of(chain), {}, goal, random_q(32 * n, rng));
            bool some = false;
            for (std::size_t k = 0; k < 32; ++k) {
                if (runs.ends[k].ending != ik::Ending::reached) continue;
                some = true;
                CHECK(largest_difference(forward_kinematics(chain, &runs.q[k * std::size_t(n)]), goal) <
                      2e-9);
            }
            reached += some;
        }
        CHECK(reached == 10);
    }
}

TEST(a_start_ends_alike_in_any_company) {
    arms::Rng rng(5);
    for (int n : {2, 6, 7, 12}) {
        const ik::Chain chain = random_chain(n, n == 7 ? 4u : 0u, rng);
        const ik::Path path = path_of(chain);
        const Posed goal = forward_kinematics(chain, random_q(n, rng).data());
        const auto starts = random_q(23 * n, rng);
        const Runs together = run(path, {}, goal, starts);
        std::size_t first = 23;
        for (std::size_t k = 23; k-- > 0;) {
            const std::size_t row = k * std::size_t(n);
            const Runs alone =
                run(path, {}, goal, {starts.begin() + long(row), starts.begin() + long(row) + n});
            CHECK(std::equal(alone.q.begin(), alone.q.end(), together.q.begin() + long(row)));
            CHECK(alone.ends[0].steps == together.ends[k].steps &&
                  alone.ends[0].ending == together.ends[k].ending);
            if (alone.ends[0].ending == ik::Ending::reached) first = k;
        }
        const Runs until_first = run(path, {}, goal, starts, true);
        if (first < 23) CHECK(until_first.ends[first].ending == ik::Ending::reached);
        for (std::size_t k = 0; k < first && k < 23; ++k)
            CHECK(until_first.ends[k].ending == together.ends[k].ending);
    }
}

TEST(limits_hold_and_goals_within_them_are_found) {
    arms::Rng rng(6);
    int found = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const int n = 5 + trial % 4;
        const ik::Chain chain = random_chain(n, trial & 4 ? 2u : 0u, rng);
        ik::Task task;
        task.limited = true;
        std::vector<double> truth(n);
        for (int j = 0; j < n; ++j) {
            task.lower[j] = arms::uniform(rng, -2, -0.5);
            task.upper[j] = arms::uniform(rng, 0.5, 2);
            // Some goals have joints at their limits.
            truth[j] = rng() % 4 ? arms::uniform(rng, task.lower[j], task.upper[j]) : task.upper[j];
        }
        const Runs runs =
            run(path_of(chain), task, forward_kinematics(chain, truth.data()), random_q(64 * n, rng));
        bool reached = false;
        for (std::size_t k = 0; k < 64; ++k) {
            reached = reached || runs.ends[k].ending == ik::Ending::reached;
            for (int j = 0; j < n; ++j) {
                const double q = runs.q[k * std::size_t(n) + std::size_t(j)];
                CHECK(task.lower[j] <= q && q <= task.upper[j]);
            }
        }
        found += reached;
    }
    CHECK(found >= 38);
}

TEST(what_is_out_of_reach_is_never_reached) {
    arms::Rng rng(7);
    for (int trial = 0; trial < 30; ++trial) {
        const int n = 1 + trial % 8;
        const ik::Chain chain = random_chain(n, 0, rng);
        Posed goal = forward_kinematics(chain, random_q(n, rng).data());
        goal.t = goal.t + Vec3d{0, 0, trial & 1 ? 30.0 : 1e6};
        for (const auto method : {ik::Method::levenberg_marquardt, ik::Method::newton}) {
            ik::Task task;
            task.method = method;
            const Runs runs = run(path_of(chain), task, goal, random_q(16 * n, rng));
            for (std::size_t k = 0; k < 16; ++k) {
                CHECK(runs.ends[k].ending != ik::Ending::reached);
                CHECK(runs.ends[k].position > 10);
                CHECK(runs.ends[k].steps <= task.most_steps);
            }
        }
    }
}

TEST(rows_without_weight_are_free) {
    arms::Rng rng(8);
    for (int trial = 0; trial < 30; ++trial) {
        const ik::Chain chain = random_chain(6, 0, rng);
        const Posed goal = forward_kinematics(chain, random_q(6, rng).data());
        ik::Task task;
        // The tip's z axis and its place, or a line along z: what is left free is a turn or a slide.
        const int free_row = trial & 1 ? 5 : 2;
        task.weight[free_row] = 0;
        const Runs runs = run(path_of(chain), task, goal, random_q(6 * 32, rng));
        int reached = 0;
        for (std::size_t k = 0; k < 32; ++k) {
            if (runs.ends[k].ending != ik::Ending::reached) continue;
            ++reached;
            const Posed miss = inverse(goal) * forward_kinematics(chain, &runs.q[6 * k]);
            if (free_row == 5) {
                CHECK(norm(miss.t) < 2e-9);
                CHECK(norm(matrix_column(miss.R, 2) - Vec3d{0, 0, 1}) < 2e-9);
            } else {
                CHECK(std::hypot(miss.t.x, miss.t.y) < 2e-9);
                CHECK(norm(matrix_column(miss.R, 0) - Vec3d{1, 0, 0}) < 2e-9);
            }
        }
        CHECK(reached > 4);
    }
}

TEST(half_turns_and_singular_starts_are_left_again) {
    // A straight arm at zero, asked for a pose turned by exactly a half turn.
    ik::Chain chain;
    chain.n = 6;
    for (int i = 0; i < 6; ++i) {
        chain.axis[i] = i == 0 || i == 3 || i == 5 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
        chain.point[i] = {0, 0, 0.3 * i};
    }
    chain.tip = {identity_pose().R, {0, 0, 2}};
    const double truth[6] = {0.4, 1.1, -0.7, 0.3, 0.9, -0.2};
    Posed goal = forward_kinematics(chain, truth);
    const std::vector<double> zero(6, 0.0);
    CHECK(run(path_of(chain), {}, goal, zero).ends[0].ending == ik::Ending::reached);
    const Posed turned = {{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}, chain.tip.t};
    const Runs runs = run(path_of(chain), {}, turned, zero);
    CHECK(runs.ends[0].ending == ik::Ending::reached);
    CHECK(largest_difference(forward_kinematics(chain, runs.q.data()), turned) < 2e-9);
}
