// Subproblems 1 to 4: each answer is checked against the best of a dense sweep, packs against one lane.
#include "check.hpp"
#include "cspace/ik/subproblems/sp1.hpp"
#include "cspace/ik/subproblems/sp2.hpp"
#include "cspace/ik/subproblems/sp3.hpp"
#include "cspace/ik/subproblems/sp4.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::ik;
using check::Random;

namespace {

// Axes and points as users meet them: general, or parallel, orthogonal, on an axis, zero.
Vec3d some_axis(Random& random, const Vec3d& other) {
    switch (random.below(6)) {
        case 0:
            return other;
        case 1:
            return -other;
        case 2: {
            const Vec3d across = cross(other, random.axis());
            return (1.0 / norm(across)) * across;
        }
        default:
            return random.axis();
    }
}
Vec3d some_point(Random& random, const Vec3d& axis, const Vec3d& other) {
    switch (random.below(10)) {
        case 0:
            return random.uniform(-1, 1) * axis;
        case 1:
            return {0, 0, 0};
        case 2:
            return other;
        case 3:
            return rotate_about(axis, turn_by(random.uniform(-3, 3)), other);
        default:
            return random.vector();
    }
}
template <class F>
double lowest(int steps, F f) {
    double best = 1e300;
    for (int i = 0; i < steps; ++i) best = std::fmin(best, f(turn_by(2 * pi * i / steps)));
    return best;
}
void check_answer(double at_answer, double error, bool exact, double swept) {
    CHECK_NEAR(at_answer, error, 3e-14);
    CHECK(at_answer <= swept + 1e-14);
    CHECK(exact ? error <= 2e-12 : error > 0);
}

}  // namespace

TEST(subproblem_1_finds_the_smallest_error) {
    Random random{1};
    for (int i = 0; i < 2000; ++i) {
        const Vec3d k = random.axis(), p1 = some_point(random, k, k), p2 = some_point(random, k, p1);
        const auto f = [&](Turn<double> t) { return norm(rotate_about(k, t, p1) - p2); };
        const auto r = subproblem_1(k, p1, p2);
        check_answer(f(r.theta), r.error, r.exact, lowest(200, f));
        if (r.free)
            CHECK(f(turn_by(1.0)) <= r.error + 1e-13);
        else
            CHECK(f(r.theta + turn_by(0.1)) > r.error);
    }
}

TEST(subproblem_2_finds_the_smallest_error) {
    Random random{2};
    for (int i = 0; i < 500; ++i) {
        const Vec3d k1 = random.axis(), k2 = some_axis(random, k1);
        const Vec3d p1 = some_point(random, k1, k1), p2 = some_point(random, k2, p1);
        const auto f = [&](Turn<double> a, Turn<double> b) {
            return norm(rotate_about(k1, a, p1) - rotate_about(k2, b, p2));
        };
        const auto r = subproblem_2(k1, k2, p1, p2);
        const double swept =
            lowest(90, [&](Turn<double> a) { return lowest(90, [&](Turn<double> b) { return f(a, b); }); });
        check_answer(f(r.theta1[0], r.theta2[0]), r.error, r.exact, swept);
        CHECK_NEAR(f(r.theta1[1], r.theta2[1]), r.error, 3e-14);
        if (r.free1) CHECK(f(turn_by(2.0), r.theta2[0]) <= r.error + 1e-13);
        if (r.free2) CHECK(f(r.theta1[0], turn_by(2.0)) <= r.error + 1e-13);
        if (r.parallel) {
            const Turn<double> by = turn_by(0.7);
            CHECK_NEAR(f(r.theta1[0] + by, dot(k1, k2) > 0 ? by : Turn<double>{by.c, -by.s}), r.error, 1e-13);
        }
    }
}

TEST(subproblem_3_finds_the_smallest_error) {
    Random random{3};
    for (int i = 0; i < 2000; ++i) {
        const Vec3d k = random.axis(), p1 = some_point(random, k, k), p2 = some_point(random, k, p1);
        const double d = random.below(5) ? random.uniform(0, 2.5) : norm(p1 - p2);
        const auto f = [&](Turn<double> t) { return std::fabs(norm(rotate_about(k, t, p1) - p2) - d); };
        const auto r = subproblem_3(k, p1, p2, d);
        check_answer(f(r.theta[0]), r.error, r.exact, lowest(200, f));
        CHECK_NEAR(f(r.theta[1]), r.error, 3e-14);
    }
}

TEST(subproblem_3_stays_exact_at_small_distances) {
    const Vec3d k = {0, 0, 1}, p = {1, 0, 0};
    for (double d = 1e-3; d > 1e-11; d *= 0.1) {
        const auto r = subproblem_3(k, p, p, d);
        CHECK(r.two && r.exact);
        CHECK_NEAR(norm(rotate_about(k, r.theta[0], p) - p), d, 1e-15 * d + 1e-18);
    }
}

TEST(subproblem_4_finds_the_smallest_error) {
    Random random{4};
    for (int i = 0; i < 2000; ++i) {
        const Vec3d k = random.axis(), h = some_axis(random, k), p = some_point(random, k, h);
        const double d = random.uniform(-1, 1);
        const auto f = [&](Turn<double> t) { return std::fabs(dot(h, rotate_about(k, t, p)) - d); };
        const auto r = subproblem_4(h, k, p, d);
        check_answer(f(r.theta[0]), r.error, r.exact, lowest(200, f));
        CHECK_NEAR(f(r.theta[1]), r.error, 3e-14);
    }
}

TEST(all_crossings_of_zero_are_found) {
    Random random{5};
    for (int i = 0; i < 500; ++i) {
        const Vec3d k = random.axis(), h = random.axis(), p = random.vector(), q = random.vector();
        const double d = random.uniform(0, 1);
        int crossings3 = 0, crossings4 = 0;
        const auto f3 = [&](double t) { return norm(rotate_about(k, turn_by(t), p) - q) - d; };
        const auto f4 = [&](double t) { return dot(h, rotate_about(k, turn_by(t), p)) - d; };
        for (int j = 0; j < 720; ++j) {
            const double a = 2 * pi * j / 720, b = 2 * pi * (j + 1) / 720;
            crossings3 += f3(a) * f3(b) < 0;
            crossings4 += f4(a) * f4(b) < 0;
        }
        const auto r3 = subproblem_3(k, p, q, d);
        const auto r4 = subproblem_4(h, k, p, d);
        CHECK(crossings3 <= (r3.exact ? 1 + r3.two : 0));
        CHECK(crossings4 <= (r4.exact ? 1 + r4.two : 0));
    }
}

TEST(a_pack_answers_like_one_lane) {
    Random random{6};
    using V = Pack<4>;
    const auto put = [](Vec3<V>& into, int i, const Vec3d& v) {
        set_lane(into.x, i, v.x), set_lane(into.y, i, v.y), set_lane(into.z, i, v.z);
    };
    const auto same = [](const Turn<V>& t, int i, const Turn<double>& one) {
        CHECK_NEAR(get_lane(t.c, i), one.c, 1e-12);
        CHECK_NEAR(get_lane(t.s, i), one.s, 1e-12);
    };
    for (int repeat = 0; repeat < 200; ++repeat) {
        Vec3d k1[4], k2[4], p1[4], p2[4];
        double d[4];
        Vec3<V> K1, K2, P1, P2;
        V D;
        for (int i = 0; i < 4; ++i) {
            put(K1, i, k1[i] = random.axis());
            put(K2, i, k2[i] = some_axis(random, k1[i]));
            put(P1, i, p1[i] = random.below(8) ? random.vector() : k1[i]);
            put(P2, i, p2[i] = random.below(8) ? random.vector() : p1[i]);
            set_lane(D, i, d[i] = random.uniform(-0.5, 1.5));
        }
        const auto r1 = subproblem_1(K1, P1, P2);
        const auto r2 = subproblem_2(K1, K2, P1, P2);
        const auto r3 = subproblem_3(K1, P1, P2, D);
        const auto r4 = subproblem_4(K2, K1, P1, D);
        for (int i = 0; i < 4; ++i) {
            const auto s1 = subproblem_1(k1[i], p1[i], p2[i]);
            const auto s2 = subproblem_2(k1[i], k2[i], p1[i], p2[i]);
            const auto s3 = subproblem_3(k1[i], p1[i], p2[i], d[i]);
            const auto s4 = subproblem_4(k2[i], k1[i], p1[i], d[i]);
            same(r1.theta, i, s1.theta);
            CHECK(get_lane(r1.exact, i) == s1.exact && get_lane(r1.free, i) == s1.free);
            CHECK(get_lane(r2.two, i) == s2.two && get_lane(r2.parallel, i) == s2.parallel);
            CHECK(get_lane(r2.free1, i) == s2.free1 && get_lane(r2.free2, i) == s2.free2);
            CHECK(get_lane(r3.two, i) == s3.two && get_lane(r4.two, i) == s4.two);
            for (int j = 0; j < 2; ++j) {
                same(r2.theta1[j], i, s2.theta1[j]);
                same(r2.theta2[j], i, s2.theta2[j]);
                same(r3.theta[j], i, s3.theta[j]);
                same(r4.theta[j], i, s4.theta[j]);
            }
        }
    }
}
