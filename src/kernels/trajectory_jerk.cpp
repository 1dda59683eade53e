#include "trajectory_jerk.hpp"

namespace cspace::trajectory::inline CSPACE_ISA {
namespace {

// visit(degree as a type, interval, its rows).
template <class Visit>
CSPACE_INLINE void over_intervals(const JerkPath& path, std::size_t begin, std::size_t end, double* rows,
                                  const Visit& visit) {
    for (std::size_t i = begin; i < end; ++i) visit(i, rows + i * path.row_size());
}

}  // namespace

void build_all_jerk_rows(const JerkPath& path, std::size_t begin, std::size_t end, double* rows,
                         double* largest) {
    over_intervals(path, begin, end, rows, [&](std::size_t i, double* own) {
        largest[i] = path.degree == 2 ? build_jerk_rows<2>(path, i, own) : build_jerk_rows<4>(path, i, own);
    });
}

void sum_all_barriers(const JerkPath& path, std::size_t begin, std::size_t end, const double* rows,
                      const Squares* x, const Tangent* tangents, BarrierTerms* terms) {
    over_intervals(path, begin, end, const_cast<double*>(rows), [&](std::size_t i, const double* own) {
        terms[i] = path.degree == 2 ? sum_barriers<2>(path, own, x[i], tangents[i])
                                    : sum_barriers<4>(path, own, x[i], tangents[i]);
    });
}

double bound_all_steps(const JerkPath& path, std::size_t begin, std::size_t end, const double* rows,
                       const Squares* x, const Squares* change, const Tangent* tangents) {
    double least = no_end;
    over_intervals(path, begin, end, const_cast<double*>(rows), [&](std::size_t i, const double* own) {
        const double step = path.degree == 2 ? bound_step<2>(path, own, x[i], change[i], tangents[i])
                                             : bound_step<4>(path, own, x[i], change[i], tangents[i]);
        least = min(least, step);
    });
    return least;
}

void bound_all_jerks(const JerkPath& path, std::size_t begin, std::size_t end, const double* rows,
                     const Squares* x, double* most) {
    over_intervals(path, begin, end, const_cast<double*>(rows), [&](std::size_t i, const double* own) {
        double* out = most + i * std::size_t(path.degree + 1);
        path.degree == 2 ? bound_jerks<2>(path, own, x[i], out) : bound_jerks<4>(path, own, x[i], out);
    });
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
