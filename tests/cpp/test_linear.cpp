// Laws of the small systems: residuals of the size of rounding, orthogonality, agreement of the lanes.
#include <algorithm>

#include "check.hpp"
#include "cspace/math/linear.hpp"
#include "random.hpp"

namespace {

template <int m, int n, class V>
struct System {
    V A[m][n], b[m];
};

// The x of least |A x − b| for m ≥ n, the least x with A x = b for m < n, by reflections. A and b are used
// up; true where A has full rank.
template <int m, int n, class V>
cspace::mask_of<V> least_squares(V (&A)[m][n], V (&b)[m], V (&x)[n]) {
    if constexpr (m >= n) {
        V diagonal[n], factor[n];
        cspace::linear::factor_qr(A, diagonal, factor);
        for (int k = 0; k < n; ++k) cspace::linear::reflect_vector(A, m, k, factor[k], b);
        for (int k = n - 1; k >= 0; --k) {
            x[k] = b[k];
            for (int j = k + 1; j < n; ++j) x[k] = cspace::mul_add(-A[k][j], x[j], x[k]);
            x[k] = x[k] * cspace::linear::safe_inverse(diagonal[k]);
        }
        return cspace::linear::full_rank(diagonal);
    } else {
        // Aᵀ = Q R: Rᵀ y = b, and x = Q y has no part outside the rows of A.
        V transposed[n][m], diagonal[m], factor[m];
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < m; ++j) transposed[i][j] = A[j][i];
        }
        cspace::linear::factor_qr(transposed, diagonal, factor);
        for (int i = 0; i < n; ++i) x[i] = cspace::fill_lanes<V>(0.0);
        for (int k = 0; k < m; ++k) {
            x[k] = b[k];
            for (int j = 0; j < k; ++j) x[k] = cspace::mul_add(-transposed[j][k], x[j], x[k]);
            x[k] = x[k] * cspace::linear::safe_inverse(diagonal[k]);
        }
        for (int k = m - 1; k >= 0; --k) cspace::linear::reflect_vector(transposed, n, k, factor[k], x);
        return cspace::linear::full_rank(diagonal);
    }
}

// Rows of very different sizes, and zeros on the diagonal, so that pivots must be chosen lane by lane.
template <int m, int n, class V>
System<m, n, V> random_system(check::Random& random) {
    System<m, n, V> s{};
    for (int k = 0; k < cspace::Lanes<V>::count; ++k) {
        for (int i = 0; i < m; ++i) {
            const double size = std::ldexp(1.0, random.below(12) - 6);
            for (int j = 0; j < n; ++j) {
                const bool zero = i == j && random.below(3) == 0;
                cspace::set_lane(s.A[i][j], k, zero ? 0.0 : size * random.uniform(-1, 1));
            }
            cspace::set_lane(s.b[i], k, size * random.uniform(-1, 1));
        }
    }
    return s;
}

// row i of A times x, less b; and the sum of the sizes that went into it
template <int m, int n, class V>
double residual(const System<m, n, V>& s, const V (&x)[n], int i, int k, double& size) {
    double r = -cspace::get_lane(s.b[i], k);
    size = std::fabs(r);
    for (int j = 0; j < n; ++j) {
        const double term = cspace::get_lane(s.A[i][j], k) * cspace::get_lane(x[j], k);
        r += term;
        size += std::fabs(term);
    }
    return r;
}
template <int m, int n, class V>
double largest_size(const System<m, n, V>& s, const V (&x)[n], int k) {
    double largest = 0, size;
    for (int i = 0; i < m; ++i) {
        residual(s, x, i, k, size);
        largest = std::max(largest, size);
    }
    return largest;
}

template <int n, class V>
void check_solve() {
    check::Random random{11 * n};
    int told_regular = 0;
    for (int round = 0; round < 300; ++round) {
        const auto s = random_system<n, n, V>(random);
        auto used = s;
        const auto regular = cspace::solve_linear(used.A, used.b);
        for (int k = 0; k < cspace::Lanes<V>::count; ++k) {
            if (!cspace::get_lane(regular, k)) continue;
            ++told_regular;
            const double largest = largest_size(s, used.b, k);
            for (int i = 0; i < n; ++i) {
                double size;
                CHECK_NEAR(residual(s, used.b, i, k, size), 0.0, 1e-13 * largest);
            }
        }
    }
    CHECK(told_regular > (n == 1 ? 150 : 250) * cspace::Lanes<V>::count);
}

// B Bᵀ + s 1 for a random B, in the lanes with s = −1 not positive definite; unknowns without a pivot are
// zero.
template <int n, class V>
void check_positive() {
    check::Random random{17 * n};
    for (int round = 0; round < 100; ++round) {
        const auto s = random_system<n, n, V>(random);
        System<n, n, V> square{};
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                square.A[i][j] = cspace::fill_lanes<V>(i == j ? 1e-3 : 0.0);
                for (int k = 0; k < n; ++k) square.A[i][j] = square.A[i][j] + s.A[i][k] * s.A[j][k];
            }
            square.b[i] = s.b[i];
        }
        const int bad = random.below(n);
        for (int k = 1; k < cspace::Lanes<V>::count; k += 2) cspace::set_lane(square.A[bad][bad], k, -1.0);
        auto used = square;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < i; ++j) used.A[i][j] = cspace::fill_lanes<V>(std::nan(""));  // is not read
        const auto definite = cspace::solve_positive(used.A, n, used.b);
        for (int k = 0; k < cspace::Lanes<V>::count; ++k) {
            CHECK(cspace::get_lane(definite, k) == (k % 2 == 0));
            const double largest = largest_size(square, used.b, k);
            double size;
            for (int i = 0; i < n && k % 2 == 0; ++i)
                CHECK_NEAR(residual(square, used.b, i, k, size), 0.0, 1e-12 * largest);
            CHECK(k % 2 == 0 || cspace::get_lane(used.b[bad], k) == 0.0);
        }
    }
}

// Whatever the shape: A x − b is orthogonal to the columns of A, and no smaller x does as well.
template <int m, int n, class V>
void check_least_squares() {
    check::Random random{13 * m + n};
    for (int round = 0; round < 100; ++round) {
        const auto s = random_system<m, n, V>(random);
        auto used = s;
        V x[n];
        const auto full = least_squares(used.A, used.b, x);
        for (int k = 0; k < cspace::Lanes<V>::count; ++k) {
            if (!cspace::get_lane(full, k)) continue;
            const double largest = largest_size(s, x, k);
            double size;
            for (int j = 0; j < n; ++j) {
                double along = 0, length = 0;
                for (int i = 0; i < m; ++i) {
                    const double a = cspace::get_lane(s.A[i][j], k);
                    along += a * residual(s, x, i, k, size);
                    length += std::fabs(a);
                }
                CHECK_NEAR(along, 0.0, 1e-13 * largest * length);
            }
        }
        if constexpr (m < n) {
            // A vector of the null space: a random one less the least vector with the same image.
            System<m, n, V> image = s;
            V w[n], same_image[n];
            for (int j = 0; j < n; ++j) w[j] = cspace::fill_lanes<V>(random.uniform(-1, 1));
            for (int i = 0; i < m; ++i) {
                image.b[i] = cspace::fill_lanes<V>(0.0);
                for (int j = 0; j < n; ++j) image.b[i] = image.b[i] + s.A[i][j] * w[j];
            }
            const auto full_too = least_squares(image.A, image.b, same_image);
            for (int k = 0; k < cspace::Lanes<V>::count; ++k) {
                if (!cspace::get_lane(full_too, k)) continue;
                double inner = 0, length = 0, x_length = 0;
                for (int j = 0; j < n; ++j) {
                    const double z = cspace::get_lane(w[j], k) - cspace::get_lane(same_image[j], k);
                    inner += z * cspace::get_lane(x[j], k);
                    length = std::max(length, std::fabs(z));
                    x_length = std::max(x_length, std::fabs(cspace::get_lane(x[j], k)));
                }
                CHECK_NEAR(inner, 0.0, 1e-10 * length * x_length);
            }
        }
    }
}

template <class V>
void check_all() {
    check_solve<1, V>();
    check_solve<3, V>();
    check_solve<6, V>();
    check_solve<8, V>();
    check_least_squares<6, 6, V>();
    check_least_squares<6, 3, V>();
    check_least_squares<8, 6, V>();
    check_least_squares<6, 7, V>();
    check_least_squares<3, 8, V>();
}

}  // namespace

TEST(systems_of_one) { check_all<double>(); }
TEST(systems_on_lanes) {
    check_all<cspace::Pack<2>>();
    check_all<cspace::Pack<4>>();
    check_all<cspace::Pack<8>>();
}

TEST(positive_definite_systems_are_solved) {
    check_positive<1, double>();
    check_positive<6, double>();
    check_positive<6, cspace::Pack<4>>();
    check_positive<9, cspace::Pack<8>>();
}

TEST(permutations_are_solved_exactly) {
    int order[] = {0, 1, 2, 3, 4};
    do {
        double A[5][5] = {}, b[5];
        for (int i = 0; i < 5; ++i) {
            A[i][order[i]] = 1 << i;
            b[i] = (order[i] + 1) * (1 << i);
        }
        CHECK(cspace::solve_linear(A, b));
        for (int i = 0; i < 5; ++i) CHECK(b[i] == i + 1);
    } while (std::next_permutation(order, order + 5));
}

TEST(a_singular_lane_is_told_and_harms_no_other) {
    check::Random random{5};
    for (int round = 0; round < 100; ++round) {
        auto s = random_system<6, 6, cspace::Pack<4>>(random);
        for (int j = 0; j < 6; ++j) cspace::set_lane(s.A[3][j], 2, 2 * cspace::get_lane(s.A[5][j], 2));
        auto eliminated = s, reflected = s;
        cspace::Pack<4> x[6];
        const auto regular = cspace::solve_linear(eliminated.A, eliminated.b);
        const auto full = least_squares(reflected.A, reflected.b, x);
        CHECK(!cspace::get_lane(regular, 2) && !cspace::get_lane(full, 2));
        for (int k : {0, 1, 3}) {
            double A[6][6], b[6];
            for (int i = 0; i < 6; ++i) {
                for (int j = 0; j < 6; ++j) A[i][j] = cspace::get_lane(s.A[i][j], k);
                b[i] = cspace::get_lane(s.b[i], k);
            }
            CHECK(cspace::solve_linear(A, b) == cspace::get_lane(regular, k));
            for (int i = 0; i < 6; ++i) {
                CHECK_NEAR(b[i], cspace::get_lane(eliminated.b[i], k), 1e-8 * (1 + std::fabs(b[i])));
                CHECK(std::isfinite(cspace::get_lane(x[i], 2)) &&
                      std::isfinite(cspace::get_lane(eliminated.b[i], 2)));
            }
        }
    }
}
