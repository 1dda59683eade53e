// Arms with random geometry of a wanted class, as screws at zero with a random base and tool.
#pragma once

#include <random>

#include "cspace/ik/chain.hpp"

namespace arms {

using namespace cspace;
using Rng = std::mt19937_64;

inline double uniform(Rng& rng, double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(rng);
}

inline Vec3d random_direction(Rng& rng) {
    for (;;) {
        const Vec3d v = {uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)};
        const double n = norm(v);
        if (n > 0.1 && n < 1) return (1 / n) * v;
    }
}
inline Posed random_pose(Rng& rng) {
    const double angle = uniform(rng, -pi, pi);
    return {spatial::rotation_about(random_direction(rng), std::cos(angle), std::sin(angle)),
            {uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)}};
}

// One row of a standard Denavit–Hartenberg table.
struct Row {
    double a, alpha, d;
};
inline double twist(Rng& rng) {
    const double angle = uniform(rng, 0.3, pi - 0.3);
    return uniform(rng, 0, 1) < 0.5 ? angle : -angle;
}
inline Row random_row(Rng& rng) { return {uniform(rng, 0.1, 0.7), twist(rng), uniform(rng, -0.5, 0.5)}; }

enum class Class {
    last_parallel,
    first_parallel,
    first_meet,
    last_meet,
    general,
    three_parallel,
    middle_parallel,
    first_three_parallel,
    count
};

// Rows 1…6 of the class, read from the base.
inline void class_rows(Class kind, Rng& rng, Row* rows) {
    for (int i = 0; i < 6; ++i) rows[i] = random_row(rng);
    if (kind == Class::three_parallel) {
        rows[1].alpha = rows[2].alpha = 0;
        rows[4].a = 0;
        return;
    }
    if (kind == Class::middle_parallel) {
        rows[1].alpha = rows[2].alpha = 0;
        return;
    }
    if (kind == Class::first_three_parallel) {
        rows[0].alpha = rows[1].alpha = 0;
        return;
    }
    rows[3].a = rows[4].a = rows[4].d = 0;
    if (kind == Class::last_parallel) rows[1].alpha = 0;
    if (kind == Class::first_parallel) rows[0].alpha = 0;
    if (kind == Class::first_meet) rows[0].a = 0;
    if (kind == Class::last_meet) rows[1].a = 0;
}

inline ik::Chain from_rows(const Row* rows, int n, const Posed& base, const Posed& tool, Rng& rng) {
    ik::Chain chain;
    chain.n = n;
    Posed T = base;
    for (int i = 0; i < n; ++i) {
        chain.axis[i] = matrix_column(T.R, 2);
        chain.point[i] = T.t + uniform(rng, -0.3, 0.3) * chain.axis[i];
        const double theta = uniform(rng, -pi, pi), c = std::cos(rows[i].alpha), s = std::sin(rows[i].alpha);
        const Posed turn = {spatial::rotation_about(Vec3d{0, 0, 1}, std::cos(theta), std::sin(theta)),
                            {0, 0, rows[i].d}};
        T = T * turn * Posed{{{{1, 0, 0}, {0, c, -s}, {0, s, c}}}, {rows[i].a, 0, 0}};
    }
    chain.tip = T * tool;
    return chain;
}

inline ik::Chain random_arm(Class kind, bool backwards, Rng& rng) {
    Row rows[6];
    class_rows(kind, rng, rows);
    const ik::Chain arm = from_rows(rows, 6, random_pose(rng), random_pose(rng), rng);
    return backwards ? reverse_chain(arm) : arm;
}

}  // namespace arms
