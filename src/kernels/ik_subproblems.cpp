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

Vec3<V> load_vectors(const double* rows, std::size_t first, int count) {
    V columns[3];
    load_rows(rows + 3 * first, 3, count, 3, columns);
    return {columns[0], columns[1], columns[2]};
}
Vec3d read_vector(const double* row) { return {row[0], row[1], row[2]}; }

// Answer i: theta(j, m) is angle m of solution j of at most `most`, NaN beyond count.
template <int most, int angles, class Theta>
void write_answer(const SubproblemAnswers& out, std::size_t i, int count, double residual, bool exact,
                  bool free, Theta theta) {
    for (int j = 0; j < most; ++j)
        for (int m = 0; m < angles; ++m)
            out.theta[(i * most + std::size_t(j)) * angles + std::size_t(m)] =
                j < count ? theta(j, m) : std::numeric_limits<double>::quiet_NaN();
    out.count[i] = count;
    out.residual[i] = residual;
    out.exact[i] = exact;
    out.free[i] = free;
}

// Subproblems 3 and 4 have the same shape of answer.
template <class Answer>
void write_pair(const SubproblemAnswers& out, std::size_t first, int lanes, const Answer& r) {
    const V theta[2] = {angle_of(r.theta[0]), angle_of(r.theta[1])};
    for (int k = 0; k < lanes; ++k)
        write_answer<2, 1>(out, first + k, 1 + get_lane(r.two, k), get_lane(r.error, k), get_lane(r.exact, k),
                           get_lane(r.free, k), [&](int j, int) { return get_lane(theta[j], k); });
}

}  // namespace

void subproblem_1_n(const double* k, const double* p1, const double* p2, std::size_t n,
                    SubproblemAnswers out) {
    over_packs<native_width>(n, [=](std::size_t i, int lanes) {
        const auto r =
            subproblem_1(load_vectors(k, i, lanes), load_vectors(p1, i, lanes), load_vectors(p2, i, lanes));
        const V theta = angle_of(r.theta);
        for (int l = 0; l < lanes; ++l)
            write_answer<1, 1>(out, i + l, 1, get_lane(r.error, l), get_lane(r.exact, l), get_lane(r.free, l),
                               [&](int, int) { return get_lane(theta, l); });
    });
}

void subproblem_2_n(const double* k1, const double* k2, const double* p1, const double* p2, std::size_t n,
                    SubproblemAnswers out) {
    over_packs<native_width>(n, [=](std::size_t i, int lanes) {
        const auto r = subproblem_2(load_vectors(k1, i, lanes), load_vectors(k2, i, lanes),
                                    load_vectors(p1, i, lanes), load_vectors(p2, i, lanes));
        const auto free = r.free1 || r.free2 || r.parallel;
        const V theta[2][2] = {{angle_of(r.theta1[0]), angle_of(r.theta2[0])},
                               {angle_of(r.theta1[1]), angle_of(r.theta2[1])}};
        for (int l = 0; l < lanes; ++l)
            write_answer<2, 2>(out, i + l, 1 + get_lane(r.two, l), get_lane(r.error, l), get_lane(r.exact, l),
                               get_lane(free, l), [&](int j, int m) { return get_lane(theta[j][m], l); });
    });
}

void subproblem_3_n(const double* k, const double* p1, const double* p2, const double* d, std::size_t n,
                    SubproblemAnswers out) {
    over_packs<native_width>(n, [=](std::size_t i, int lanes) {
        write_pair(out, i, lanes,
                   subproblem_3(load_vectors(k, i, lanes), load_vectors(p1, i, lanes),
                                load_vectors(p2, i, lanes), load_lanes<V>(d + i, lanes)));
    });
}

void subproblem_4_n(const double* h, const double* k, const double* p, const double* d, std::size_t n,
                    SubproblemAnswers out) {
    over_packs<native_width>(n, [=](std::size_t i, int lanes) {
        write_pair(out, i, lanes,
                   subproblem_4(load_vectors(h, i, lanes), load_vectors(k, i, lanes),
                                load_vectors(p, i, lanes), load_lanes<V>(d + i, lanes)));
    });
}

void subproblem_5_n(const double* points, const double* axes, std::size_t n, SubproblemAnswers out) {
    for (std::size_t i = 0; i < n; ++i) {
        const double *p = points + 15 * i, *k = axes + 9 * i;
        const Sp5Problem problem = {read_vector(p),     read_vector(p + 3),  read_vector(p + 6),
                                    read_vector(p + 9), read_vector(p + 12), read_vector(k),
                                    read_vector(k + 3), read_vector(k + 6)};
        const auto r = subproblem_5(problem);
        write_answer<4, 3>(out, i, r.count, r.error, r.exact, r.free,
                           [&](int j, int m) { return angle_of(r.theta[j][m]); });
    }
}

void subproblem_6_n(const double* h, const double* k, const double* p, const double* d, std::size_t n,
                    SubproblemAnswers out) {
    for (std::size_t i = 0; i < n; ++i) {
        Sp6Problem problem;
        for (int j = 0; j < 4; ++j) {
            problem.h[j] = read_vector(h + 12 * i + 3 * j);
            problem.k[j] = read_vector(k + 12 * i + 3 * j);
            problem.p[j] = read_vector(p + 12 * i + 3 * j);
        }
        problem.d[0] = d[2 * i], problem.d[1] = d[2 * i + 1];
        const auto r = subproblem_6(problem);
        write_answer<4, 2>(out, i, r.count, r.error, r.exact, r.free,
                           [&](int j, int m) { return angle_of(r.theta[j][m]); });
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
