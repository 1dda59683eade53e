#pragma once
#include <cstddef>
#include <cstdint>

#include "dispatch.hpp"

namespace cspace::ik {

// Where the answers of n problems go: theta (n, most, angles), NaN beyond count; one value per problem else.
struct SubproblemAnswers {
    double* theta;
    double* residual;
    std::int32_t* count;
    bool* exact;
    bool* free;
};

}  // namespace cspace::ik

// Vectors are rows of (n, 3); the six problems are those of cspace/ik/subproblems.
CSPACE_NARROW_KERNEL(cspace::ik, void, subproblem_1_n,
                     (const double* k, const double* p1, const double* p2, std::size_t n,
                      SubproblemAnswers out))
CSPACE_NARROW_KERNEL(cspace::ik, void, subproblem_2_n,
                     (const double* k1, const double* k2, const double* p1, const double* p2, std::size_t n,
                      SubproblemAnswers out))
CSPACE_NARROW_KERNEL(cspace::ik, void, subproblem_3_n,
                     (const double* k, const double* p1, const double* p2, const double* d, std::size_t n,
                      SubproblemAnswers out))
CSPACE_NARROW_KERNEL(cspace::ik, void, subproblem_4_n,
                     (const double* h, const double* k, const double* p, const double* d, std::size_t n,
                      SubproblemAnswers out))
// points (n, 5, 3), axes (n, 3, 3).
CSPACE_NARROW_KERNEL(cspace::ik, void, subproblem_5_n,
                     (const double* points, const double* axes, std::size_t n, SubproblemAnswers out))
// h, k, p (n, 4, 3), d (n, 2).
CSPACE_NARROW_KERNEL(cspace::ik, void, subproblem_6_n,
                     (const double* h, const double* k, const double* p, const double* d, std::size_t n,
                      SubproblemAnswers out))
