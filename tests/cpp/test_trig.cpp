// The same angle in a pack and alone, bit for bit; laws; special values. The error in ulp is
// tests/math/test_trig.py's.
#include <cstring>
#include <limits>
#include <random>

#include "check.hpp"
#include "cspace/math/trig.hpp"

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 not_a_number = std::numeric_limits<double>::quiet_NaN();

bool same(double a, double b) { return (a != a && b != b) || std::memcmp(&a, &b, sizeof a) == 0; }

// Angles of every size, with special values and huge ones among ordinary ones.
double draw(std::mt19937_64& generator) {
    constexpr double special[] = {0.0, -0.0, inf, -inf, not_a_number, 5e-324, 1e22, 1e5, -1e300, 1.0, -1.0};
    const std::uint64_t word = generator();
    if (word % 13 == 0) return special[word / 13 % (sizeof special / sizeof *special)];
    return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(generator), int(word % 64) - 40);
}

template <int N>
void check_lanes_against_one() {
    using cspace::get_lane;
    std::mt19937_64 generator(N);
    for (int round = 0; round < 20000; ++round) {
        cspace::Pack<N> x{}, y{}, s, c;
        for (int k = 0; k < N; ++k) {
            cspace::set_lane(x, k, draw(generator));
            cspace::set_lane(y, k, draw(generator));
        }
        cspace::sincos(x, s, c);
        const auto angle = cspace::atan2(y, x), arc_cosine = cspace::acos(x), arc_sine = cspace::asin(x);
        for (int k = 0; k < N; ++k) {
            double one_s, one_c;
            cspace::sincos(get_lane(x, k), one_s, one_c);
            CHECK(same(get_lane(s, k), one_s) && same(get_lane(c, k), one_c));
            CHECK(same(get_lane(angle, k), cspace::atan2(get_lane(y, k), get_lane(x, k))));
            CHECK(same(get_lane(arc_cosine, k), cspace::acos(get_lane(x, k))));
            CHECK(same(get_lane(arc_sine, k), cspace::asin(get_lane(x, k))));
        }
    }
}

}  // namespace

TEST(a_pack_agrees_with_one_bit_for_bit) {
    check_lanes_against_one<2>();
    check_lanes_against_one<4>();
    check_lanes_against_one<8>();
}

TEST(symmetries_are_exact) {
    std::mt19937_64 generator(7);
    for (int round = 0; round < 20000; ++round) {
        const double x = draw(generator), y = draw(generator);
        double s, c, minus_s, minus_c;
        cspace::sincos(x, s, c);
        cspace::sincos(-x, minus_s, minus_c);
        CHECK(same(-s, minus_s) && same(c, minus_c));
        CHECK(same(-cspace::atan2(y, x), cspace::atan2(-y, x)));
        CHECK(same(-cspace::asin(x), cspace::asin(-x)));
    }
}

TEST(the_circle_closes) {
    for (double x = -9; x < 9; x += 1.0 / 1024) {
        double s, c;
        cspace::sincos(x, s, c);
        CHECK_NEAR(s * s + c * c, 1.0, 5e-16);
        CHECK_NEAR(std::remainder(cspace::atan2(s, c) - x, 2 * cspace::pi), 0.0, 2e-15);
        CHECK_NEAR(cspace::acos(c), std::fabs(std::remainder(x, 2 * cspace::pi)), 1e-7);
        CHECK_NEAR(cspace::asin(c) + cspace::acos(c), cspace::pi / 2, 5e-16);
    }
}

TEST(special_values_are_those_of_the_c_library) {
    constexpr double edges[] = {0.0,    -0.0,    1.0,   -1.0,   inf,    -inf, not_a_number,
                                5e-324, -5e-324, 1e308, -1e308, 1e-310, 2.0};
    for (const double y : edges) {
        for (const double x : edges) {
            const double got = cspace::atan2(y, x), want = std::atan2(y, x);
            CHECK(same(got, want) ||
                  (std::fabs(got - want) < 3e-16 && std::signbit(got) == std::signbit(want)));
        }
        double s, c;
        cspace::sincos(y, s, c);
        CHECK(same(s, std::sin(y)) || std::fabs(s - std::sin(y)) < 2e-16);
        CHECK(same(c, std::cos(y)) || std::fabs(c - std::cos(y)) < 2e-16);
    }
    CHECK(cspace::acos(1.0) == 0.0 && cspace::acos(-1.0) == cspace::pi &&
          cspace::acos(0.0) == cspace::pi / 2);
    CHECK(cspace::asin(1.0) == cspace::pi / 2 && std::signbit(cspace::asin(-0.0)) &&
          !std::signbit(cspace::asin(0.0)));
    for (const double beyond : {std::nextafter(1.0, 2.0), -1.5, inf, -inf, not_a_number}) {
        CHECK(std::isnan(cspace::acos(beyond)) && std::isnan(cspace::asin(beyond)));
    }
}
