#include "ik_subproblems.hpp"

#include "cspace/ik/subproblems/sp1.hpp"
#include "cspace/ik/subproblems/sp2.hpp"
#include "cspace/ik/subproblems/sp3.hpp"
#include "cspace/ik/subproblems/sp4.hpp"
#include "cspace/ik/subproblems/sp5.hpp"
#include "cspace/ik/subproblems/sp6.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::ik::inline CSPACE_ISA {
namespace {

using V = Pack<native_width>;

Vec3<V> vectors(const double* rows, std::size_t first, int count) {
    V columns[3];
    load_rows(rows + 3 * first, 3, count, 3, columns);
    return {columns[0], columns[1], columns[2]};
}
Vec3d vector(const double* row) { return {row[0], row[1], row[2]}; }

// Calls f(first, count) for each pack of n problems; the last may be partial.
template <class F>
void over_packs(std::size_t n, F f) {
    for (std::size_t i = 0; i < n; i += native_width)
        f(i, n - i < native_width ? int(n - i) : int(native_width));
}

// Writes `angles` angles of answer j of problem i, or NaN where it has none.
void put_angles(const SubproblemAnswers& out, std::size_t i, int j, int most, int angles,
                const double* theta) {
    for (int m = 0; m < angles; ++m)
        out.theta[(i * most + j) * angles + m] = theta ? theta[m] : std::numeric_limits<double>::quiet_NaN();
}
void put_rest(const SubproblemAnswers& out, std::size_t i, int count, double residual, bool exact,
              bool free) {
    out.count[i] = count;
    out.residual[i] = residual;
    out.exact[i] = exact;
    out.free[i] = free;
}

// Subproblems 3 and 4 have the same shape of answer.
template <class Answer>
void put_pair(const SubproblemAnswers& out, std::size_t first, int lanes, const Answer& r) {
    const V theta[2] = {angle_of(r.theta[0]), angle_of(r.theta[1])};
    for (int k = 0; k < lanes; ++k) {
        const int count = 1 + lane(r.two, k);
        for (int j = 0; j < 2; ++j) {
            const double value = lane(theta[j], k);
            put_angles(out, first + k, j, 2, 1, j < count ? &value : nullptr);
        }
        put_rest(out, first + k, count, lane(r.error, k), lane(r.exact, k), lane(r.free, k));
    }
}

}  // namespace

void subproblem_1_n(const double* k, const double* p1, const double* p2, std::size_t n,
                    SubproblemAnswers out) {
    over_packs(n, [=](std::size_t i, int lanes) {
        const auto r = subproblem_1(vectors(k, i, lanes), vectors(p1, i, lanes), vectors(p2, i, lanes));
        const V theta = angle_of(r.theta);
        for (int j = 0; j < lanes; ++j) {
            out.theta[i + j] = lane(theta, j);
            put_rest(out, i + j, 1, lane(r.error, j), lane(r.exact, j), lane(r.free, j));
        }
    });
}

void subproblem_2_n(const double* k1, const double* k2, const double* p1, const double* p2, std::size_t n,
                    SubproblemAnswers out) {
    over_packs(n, [=](std::size_t i, int lanes) {
        const auto r = subproblem_2(vectors(k1, i, lanes), vectors(k2, i, lanes), vectors(p1, i, lanes),
                                    vectors(p2, i, lanes));
        const auto free = r.free1 || r.free2 || r.parallel;
        for (int j = 0; j < 2; ++j) {
            const V first = angle_of(r.theta1[j]), second = angle_of(r.theta2[j]);
            for (int m = 0; m < lanes; ++m) {
                const double theta[2] = {lane(first, m), lane(second, m)};
                put_angles(out, i + m, j, 2, 2, j == 0 || lane(r.two, m) ? theta : nullptr);
            }
        }
        for (int m = 0; m < lanes; ++m)
            put_rest(out, i + m, 1 + lane(r.two, m), lane(r.error, m), lane(r.exact, m), lane(free, m));
    });
}

void subproblem_3_n(const double* k, const double* p1, const double* p2, const double* d, std::size_t n,
                    SubproblemAnswers out) {
    over_packs(n, [=](std::size_t i, int lanes) {
        put_pair(out, i, lanes,
                 subproblem_3(vectors(k, i, lanes), vectors(p1, i, lanes), vectors(p2, i, lanes),
                              load<V>(d + i, lanes)));
    });
}

void subproblem_4_n(const double* h, const double* k, const double* p, const double* d, std::size_t n,
                    SubproblemAnswers out) {
    over_packs(n, [=](std::size_t i, int lanes) {
        put_pair(out, i, lanes,
                 subproblem_4(vectors(h, i, lanes), vectors(k, i, lanes), vectors(p, i, lanes),
                              load<V>(d + i, lanes)));
    });
}

namespace {

template <int angles, class Answer>
void put_answers(const SubproblemAnswers& out, std::size_t i, const Answer& r) {
    for (int j = 0; j < 4; ++j) {
        double theta[angles];
        for (int m = 0; m < angles; ++m) theta[m] = j < r.count ? angle_of(r.theta[j][m]) : 0;
        put_angles(out, i, j, 4, angles, j < r.count ? theta : nullptr);
    }
    put_rest(out, i, r.count, r.error, r.exact, r.free);
}

}  // namespace

void subproblem_5_n(const double* points, const double* axes, std::size_t n, SubproblemAnswers out) {
    for (std::size_t i = 0; i < n; ++i) {
        const double *p = points + 15 * i, *k = axes + 9 * i;
        const Sp5Problem problem = {vector(p),      vector(p + 3), vector(p + 6), vector(p + 9),
                                    vector(p + 12), vector(k),     vector(k + 3), vector(k + 6)};
        put_answers<3>(out, i, subproblem_5(problem));
    }
}

void subproblem_6_n(const double* h, const double* k, const double* p, const double* d, std::size_t n,
                    SubproblemAnswers out) {
    for (std::size_t i = 0; i < n; ++i) {
        Sp6Problem problem;
        for (int j = 0; j < 4; ++j) {
            problem.h[j] = vector(h + 12 * i + 3 * j);
            problem.k[j] = vector(k + 12 * i + 3 * j);
            problem.p[j] = vector(p + 12 * i + 3 * j);
        }
        problem.d[0] = d[2 * i], problem.d[1] = d[2 * i + 1];
        put_answers<2>(out, i, subproblem_6(problem));
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
