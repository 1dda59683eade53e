// Subproblems 5 and 6: the angles a problem was made from come back, every answer holds, and where none
// exists no sweep finds a better one.
#include "check.hpp"
#include "cspace/ik/subproblems/sp5.hpp"
#include "cspace/ik/subproblems/sp6.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::ik;
using check::Random;

namespace {

Vec3d some_axis(Random& random, const Vec3d& other, int wildness) {
    switch (random.below(wildness)) {
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
Vec3d some_point(Random& random, const Vec3d& axis, int wildness) {
    switch (random.below(wildness)) {
        case 0:
            return random.uniform(-1, 1) * axis;
        case 1:
            return {0, 0, 0};
        case 2:
            return axis;
        default:
            return random.vector();
    }
}
double chord_between(const Turn<double>& a, const Turn<double>& b) {
    return std::hypot(a.c - b.c, a.s - b.s);
}

Sp5Problem random_sp5(Random& random, int wildness) {
    Sp5Problem s;
    s.k1 = random.axis();
    s.k2 = some_axis(random, s.k1, wildness);
    s.k3 = some_axis(random, s.k2, wildness);
    s.p0 = some_point(random, s.k2, wildness);
    s.p1 = some_point(random, s.k1, wildness);
    s.p2 = some_point(random, s.k2, wildness);
    s.p3 = some_point(random, s.k3, wildness);
    s.p4 = some_point(random, s.k3, wildness);
    return s;
}
double left(const Sp5Problem& s, const Turn<double> t[3]) {
    return norm(s.p0 + rotate_about(s.k1, t[0], s.p1) - s.p2 -
                rotate_about(s.k2, t[1], s.p3 + rotate_about(s.k3, t[2], s.p4)));
}
Sp6Problem random_sp6(Random& random, int wildness) {
    Sp6Problem s;
    s.k[0] = random.axis();
    for (int i = 1; i < 4; ++i) s.k[i] = some_axis(random, s.k[i - 1], wildness);
    for (int i = 0; i < 4; ++i) {
        s.h[i] = some_axis(random, s.k[i], wildness);
        s.p[i] = some_point(random, s.k[i], wildness);
    }
    return s;
}
double side(const Sp6Problem& s, int i, const Turn<double>& t1, const Turn<double>& t2) {
    return dot(s.h[2 * i], rotate_about(s.k[2 * i], t1, s.p[2 * i])) +
           dot(s.h[2 * i + 1], rotate_about(s.k[2 * i + 1], t2, s.p[2 * i + 1]));
}
double left(const Sp6Problem& s, const Turn<double> t[2]) {
    return std::hypot(side(s, 0, t[0], t[1]) - s.d[0], side(s, 1, t[0], t[1]) - s.d[1]);
}

}  // namespace

TEST(subproblem_5_returns_the_angles_it_was_made_from) {
    Random random{1};
    int most = 0, lost = 0;
    for (int repeat = 0; repeat < 20000; ++repeat) {
        Sp5Problem s = random_sp5(random, repeat % 2 ? 1000 : 6);
        Turn<double> made[3];
        for (auto& t : made) t = turn_by(random.uniform(-3.1, 3.1));
        s.p0 = s.p2 + rotate_about(s.k2, made[1], s.p3 + rotate_about(s.k3, made[2], s.p4)) -
               rotate_about(s.k1, made[0], s.p1);
        const Sp5 r = subproblem_5(s);
        CHECK(r.exact && r.count >= 1 && r.count <= 4);
        double nearest = 9;
        for (int i = 0; i < r.count; ++i) {
            CHECK_NEAR(left(s, r.theta[i]), 0, 4e-12);
            double far = 0;
            for (int j = 0; j < 3; ++j) far = std::fmax(far, chord_between(r.theta[i][j], made[j]));
            nearest = std::fmin(nearest, far);
        }
        most = r.count > most ? r.count : most;
        lost += !r.free && nearest > 1e-6;
    }
    CHECK(most == 4);
    CHECK(lost == 0);
}

TEST(subproblem_5_without_answer_is_the_best_of_a_sweep) {
    Random random{2};
    for (int repeat = 0, seen = 0; repeat < 400 && seen < 25; ++repeat) {
        const Sp5Problem s = random_sp5(random, 12);
        const Sp5 r = subproblem_5(s);
        if (r.exact) continue;
        ++seen;
        CHECK(r.count == 1);
        CHECK_NEAR(left(s, r.theta[0]), r.error, 1e-14);
        double best = 1e300;
        for (int i = 0; i < 48; ++i)
            for (int j = 0; j < 48; ++j)
                for (int k = 0; k < 48; ++k) {
                    const Turn<double> t[3] = {turn_by(i * pi / 24), turn_by(j * pi / 24),
                                               turn_by(k * pi / 24)};
                    best = std::fmin(best, left(s, t));
                }
        CHECK(r.error <= best + 1e-12);
    }
}

TEST(subproblem_6_returns_the_angles_it_was_made_from) {
    Random random{3};
    int most = 0, lost = 0;
    for (int repeat = 0; repeat < 20000; ++repeat) {
        Sp6Problem s = random_sp6(random, repeat % 2 ? 1000 : 6);
        const Turn<double> made[2] = {turn_by(random.uniform(-3.1, 3.1)), turn_by(random.uniform(-3.1, 3.1))};
        for (int i = 0; i < 2; ++i) s.d[i] = side(s, i, made[0], made[1]);
        const Sp6 r = subproblem_6(s);
        CHECK(r.exact && r.count >= 1 && r.count <= 4);
        double nearest = 9;
        for (int i = 0; i < r.count; ++i) {
            CHECK_NEAR(left(s, r.theta[i]), 0, 4e-12);
            nearest = std::fmin(
                nearest, chord_between(r.theta[i][0], made[0]) + chord_between(r.theta[i][1], made[1]));
        }
        most = r.count > most ? r.count : most;
        lost += !r.free && nearest > 1e-6;
    }
    CHECK(most == 4);
    CHECK(lost == 0);
}

TEST(subproblem_6_without_answer_is_the_best_of_a_sweep) {
    Random random{4};
    for (int repeat = 0, seen = 0; repeat < 2000 && seen < 200; ++repeat) {
        Sp6Problem s = random_sp6(random, 12);
        s.d[0] = random.uniform(-2, 2);
        s.d[1] = random.uniform(-2, 2);
        const Sp6 r = subproblem_6(s);
        if (r.exact) continue;
        ++seen;
        CHECK_NEAR(left(s, r.theta[0]), r.error, 1e-14);
        double best = 1e300;
        for (int i = 0; i < 120; ++i)
            for (int j = 0; j < 120; ++j) {
                const Turn<double> t[2] = {turn_by(i * pi / 60), turn_by(j * pi / 60)};
                best = std::fmin(best, left(s, t));
            }
        CHECK(r.error <= best + 1e-12);
    }
}
