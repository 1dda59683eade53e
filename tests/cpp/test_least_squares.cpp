// Laws of least squares: residuals of the normal equations, steps without a part in the null space, descents
// that end where the gradient vanishes.
#include <algorithm>
#include <cmath>

#include "check.hpp"
#include "cspace/math/least_squares.hpp"
#include "cspace/math/small_svd.hpp"
#include "random.hpp"

using namespace cspace;
using check::Random;

namespace {

constexpr int rows = 6, columns = 9;

// m rows, n columns; of rank one less where `deficient`.
template <class V>
void fill_random(Random& random, int m, int n, bool deficient, V (&J)[rows][columns], V (&e)[rows]) {
    for (int r = 0; r < m; ++r) {
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < Lanes<V>::count; ++k) set_lane(J[r][j], k, random.uniform(-1, 1));
        for (int k = 0; k < Lanes<V>::count; ++k) set_lane(e[r], k, random.uniform(-1, 1));
    }
    for (int r = 0; r < m && deficient && n > 1; ++r) J[r][n - 1] = 2.0 * J[r][0];
    for (int j = 0; j < n && deficient && m > 1; ++j) J[m - 1][j] = -1.0 * J[0][j];
}

template <class V>
void check_damped_steps() {
    Random random{3};
    for (int round = 0; round < 300; ++round) {
        const int m = 1 + random.below(rows), n = 1 + random.below(columns);
        V J[rows][columns] = {}, e[rows] = {}, loose[columns], dx[columns];
        fill_random(random, m, n, round % 3 == 0, J, e);
        for (int j = 0; j < n; ++j) loose[j] = fill_lanes<V>(random.below(4) > 0);
        const double damping = std::ldexp(1.0, -random.below(12));
        damped_step(m, n, J, e, loose, fill_lanes<V>(damping), dx);
        for (int k = 0; k < Lanes<V>::count; ++k) {
            double left[rows];
            for (int r = 0; r < m; ++r) {
                left[r] = get_lane(e[r], k);
                for (int j = 0; j < n; ++j) left[r] -= get_lane(J[r][j], k) * get_lane(dx[j], k);
            }
            for (int j = 0; j < n; ++j) {
                if (get_lane(loose[j], k) == 0) {
                    CHECK(get_lane(dx[j], k) == 0);
                    continue;
                }
                double gradient = -damping * get_lane(dx[j], k);  // of ½ |e − J dx|² + ½ λ |dx|²
                for (int r = 0; r < m; ++r) gradient += get_lane(J[r][j], k) * left[r];
                CHECK_NEAR(gradient, 0.0, 1e-13 * (1 + 1 / damping));
            }
        }
    }
}

// f_k(x) = Σ a_kj (x_j − z_j) + bent_k ((x_0 − z_0)² …): zero at z. Of rank one less where `deficient`.
struct Bent {
    static constexpr int size = 3;
    int n = 3;
    double a[4][3], z[3], bent, offset;

    struct Place {
        double value[4], slope[4][3];
    };
    double evaluate(const double* x, Place& at) const {
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
            at.value[k] = k == 3 ? offset : 0;
            for (int j = 0; j < 3; ++j) {
                const double d = x[j] - z[j];
                at.value[k] += a[k][j] * (d + bent * d * d);
                at.slope[k][j] = a[k][j] * (1 + 2 * bent * d);
            }
            sum += at.value[k] * at.value[k];
        }
        return std::sqrt(sum);
    }
    bool model(const double*, const Place& at, double (*A)[3], double* down) const {
        for (int i = 0; i < 3; ++i) {
            down[i] = 0;
            for (int k = 0; k < 4; ++k) down[i] -= at.slope[k][i] * at.value[k];
            for (int j = i; j < 3; ++j) {
                A[i][j] = 0;
                for (int k = 0; k < 4; ++k) A[i][j] += at.slope[k][i] * at.slope[k][j];
            }
            // The exact Hessian of half the squared error where it stays large.
            for (int k = 0; k < 4 && offset != 0; ++k) A[i][i] += 2 * bent * a[k][i] * at.value[k];
        }
        return true;
    }
    double add_step(double x, double step) const { return x + step; }
};

Bent random_bent(Random& random, bool deficient, double offset) {
    Bent out{};
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 3; ++j) out.a[k][j] = random.uniform(-1, 1);
    for (int k = 0; k < 4 && deficient; ++k) out.a[k][2] = out.a[k][0];
    for (double& z : out.z) z = random.uniform(-1, 1);
    out.bent = 0.05;
    out.offset = offset;
    return out;
}

}  // namespace

TEST(a_damped_step_solves_the_normal_equations) {
    check_damped_steps<double>();
    check_damped_steps<Pack<4>>();
}

TEST(a_step_is_shortened_to_its_stride_alone) {
    const double step[3] = {0.5, -2, 1};
    CHECK_NEAR(largest_of(step, 3), 2.0, 0.0);
    CHECK_NEAR(shortening_factor(largest_of(step, 3), 0.5), 0.25, 0.0);
    CHECK_NEAR(shortening_factor(largest_of(step, 3), 3.0), 1.0, 0.0);
}

TEST(a_descent_reaches_a_zero_whatever_the_rank) {
    Random random{5};
    for (int round = 0; round < 300; ++round) {
        const Bent problem = random_bent(random, round % 2, 0);
        double x[3];
        for (int j = 0; j < 3; ++j) x[j] = problem.z[j] + random.uniform(-0.5, 0.5);
        Bent::Place at;
        const double left = descend_damped(problem, x, at, GaussNewtonDamping{1e-15, 1e-12, 1e-24}, 60);
        CHECK(left < 1e-12);
        CHECK_NEAR(problem.evaluate(x, at), left, 0.0);
    }
}

TEST(a_descent_never_raises_the_error) {
    Random random{6};
    for (int round = 0; round < 200; ++round) {
        Bent problem = random_bent(random, round % 2, 0);
        problem.bent = 2;  // far beyond what the model sees
        double x[3], before = 1e300;
        for (int j = 0; j < 3; ++j) x[j] = problem.z[j] + random.uniform(-3, 3);
        Bent::Place at;
        for (int steps = 0; steps < 10; ++steps) {
            double copy[3] = {x[0], x[1], x[2]};
            const double left = descend_damped(problem, copy, at, GaussNewtonDamping{0, 0, 1e-24}, steps);
            CHECK(left <= before);
            before = left;
        }
    }
}

TEST(newtons_method_ends_where_the_gradient_vanishes) {
    Random random{7};
    for (int round = 0; round < 200; ++round) {
        const Bent problem = random_bent(random, false, 1);
        double x[3] = {problem.z[0], problem.z[1], problem.z[2]};
        Bent::Place at;
        const double first = problem.evaluate(x, at);
        const double left = descend_damped(problem, x, at, NewtonDamping{0, 1e-12, 0.5, 1e-6, 1e-13}, 100);
        CHECK(left <= first);
        double A[3][3], down[3];
        problem.model(x, at, A, down);
        CHECK(largest_of(down, 3) < 1e-7);
    }
}

// Matrices of every size up to 6 × 16, of full rank or not, with columns of very different lengths.
TEST(a_decomposition_is_orthogonal_and_gives_the_matrix_back) {
    constexpr int most_columns = 16;
    Random random{9};
    for (int round = 0; round < 3000; ++round) {
        const int m = 1 + random.below(rows), n = 1 + random.below(most_columns);
        SmallSvd<rows, most_columns> svd{m, n, {}, {}, {}};
        double A[most_columns][rows], largest = 0;
        for (int j = 0; j < n; ++j) {
            const double size = random.below(4) ? 1 : std::pow(10, -random.below(12));
            const int copied = random.below(4) || j == 0 ? -1 : random.below(j);
            for (int r = 0; r < m; ++r) {
                A[j][r] = svd.us[j][r] = copied < 0 ? random.uniform(-size, size) : -2 * A[copied][r];
                largest = std::fmax(largest, std::fabs(A[j][r]));
            }
        }
        decompose_matrix(svd);
        for (int j = 0; j < n; ++j) {
            CHECK_NEAR(std::sqrt(dot_n(svd.us[j], svd.us[j], m)), svd.sigma[j], 1e-14 * largest);
            for (int i = 0; i <= j; ++i) {
                CHECK_NEAR(dot_n(svd.v[i], svd.v[j], n), double(i == j), 1e-13);
                if (i < j) CHECK_NEAR(dot_n(svd.us[i], svd.us[j], m), 0.0, 1e-13 * largest * largest);
            }
            for (int r = 0; r < m; ++r) {
                double sum = 0;
                for (int k = 0; k < n; ++k) sum += svd.us[k][r] * svd.v[k][j];
                CHECK_NEAR(sum, A[j][r], 2e-14 * largest);
            }
        }
    }
}

TEST(a_least_norm_step_stays_in_the_row_space) {
    Random random{8};
    for (int round = 0; round < 200; ++round) {
        const int n = 1 + random.below(columns);
        double J[rows][columns] = {}, e[rows], x[columns];
        fill_random(random, rows, n, true, J, e);
        SmallSvd<rows, columns> svd{rows, n, {}, {}, {}};
        for (int j = 0; j < n; ++j)
            for (int r = 0; r < rows; ++r) svd.us[j][r] = J[r][j];
        decompose_matrix(svd);
        least_norm_step(svd, e, 0, 1e-10, -1, x);
        double left[rows];
        for (int r = 0; r < rows; ++r) left[r] = e[r] - dot_n(J[r], x, n);
        for (int j = 0; j < n; ++j) {
            double gradient = 0;
            for (int r = 0; r < rows; ++r) gradient += J[r][j] * left[r];
            CHECK_NEAR(gradient, 0.0, 1e-9);
            if (svd.sigma[j] <= 1e-10) CHECK_NEAR(dot_n(svd.v[j], x, n), 0.0, 1e-10 * (1 + largest_of(x, n)));
        }
        const int weak = weakest_direction(svd);
        least_norm_step(svd, e, 0, 1e-10, weak, x);
        CHECK_NEAR(dot_n(svd.v[weak], x, n), 0.0, 1e-10 * (1 + largest_of(x, n)));
    }
}
