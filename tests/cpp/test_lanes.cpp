// Every operation on packs does in each lane what it does on a double, bit for bit.
#include <cstring>
#include <limits>

#include "check.hpp"
#include "cspace/math/rows.hpp"

using namespace cspace;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double samples[] = {
    0.0, -0.0, 1.0,          -1.0,  0.5,     -0.5,   1.5,     2.5,  -2.5,   3.7,
    inf, -inf, not_a_number, 1e300, -1e-300, 5e-324, -5e-324, 1e16, 4.6e15, -4503599627370497.5};
constexpr int n_samples = sizeof samples / sizeof *samples;

bool same(double a, double b) { return (a != a && b != b) || std::memcmp(&a, &b, sizeof a) == 0; }

// Calls f with packs of every width in which each sample meets each sample, in changing lanes.
template <int N, class F>
void over_pairs(F f) {
    for (int i = 0; i < n_samples; ++i) {
        for (int j = 0; j < n_samples; ++j) {
            Pack<N> a{}, b{};
            for (int k = 0; k < N; ++k) {
                set_lane(a, k, samples[(i + k) % n_samples]);
                set_lane(b, k, samples[(j + 3 * k) % n_samples]);
            }
            f(a, b);
        }
    }
}
template <class F>
void over_widths(F f) {
    over_pairs<2>(f);
    over_pairs<4>(f);
    over_pairs<8>(f);
}
// f on packs against f on the lanes; the result may be a number or a truth.
template <class A, class F>
void check_lanes(A a, A b, F f) {
    const auto r = f(a, b);
    for (int k = 0; k < Lanes<A>::count; ++k) CHECK(same(get_lane(r, k), f(get_lane(a, k), get_lane(b, k))));
}

}  // namespace

TEST(arithmetic) {
    over_widths([](auto a, auto b) {
        check_lanes(a, b, [](auto x, auto y) { return x + y; });
        check_lanes(a, b, [](auto x, auto y) { return x - y; });
        check_lanes(a, b, [](auto x, auto y) { return x * y; });
        check_lanes(a, b, [](auto x, auto y) { return x / y; });
        check_lanes(a, b, [](auto x, auto) { return -x; });
        check_lanes(a, b, [](auto x, auto y) { return mul_add(x, y, x); });
        check_lanes(a, b, [](auto x, auto) { return (2.0 - x) / 3.0 - 1.0 / (x + 0.5); });
        check_lanes(a, b, [](auto x, auto y) {
            x += y, x *= 3.0, x /= y, x -= 0.5, x += 0.25;
            return x;
        });
    });
}

TEST(comparison_and_logic) {
    over_widths([](auto a, auto b) {
        check_lanes(a, b, [](auto x, auto y) { return x < y; });
        check_lanes(a, b, [](auto x, auto y) { return x <= y; });
        check_lanes(a, b, [](auto x, auto y) { return x > y; });
        check_lanes(a, b, [](auto x, auto y) { return x >= y; });
        check_lanes(a, b, [](auto x, auto y) { return x == y; });
        check_lanes(a, b, [](auto x, auto y) { return x != y; });
        check_lanes(a, b, [](auto x, auto y) { return !(x < y) && (x > 0.5 || y == x); });
        check_lanes(a, b, [](auto x, auto) { return 1.0 < x || !(0.5 >= x); });
    });
}

TEST(choice) {
    over_widths([](auto a, auto b) {
        check_lanes(a, b, [](auto x, auto y) { return cspace::select_lanes(x < y, x, y); });
        check_lanes(a, b, [](auto x, auto y) { return cspace::select_lanes(!(x < y) && y > -1.0, 2.0, y); });
        check_lanes(a, b, [](auto x, auto y) { return cspace::min(x, y); });
        check_lanes(a, b, [](auto x, auto y) { return cspace::max(x, y); });
        check_lanes(a, b, [](auto x, auto y) { return keep_lanes(x < y, y); });
        unsigned bits = 0;
        for (int k = 0; k < Lanes<decltype(a)>::count; ++k)
            bits |= unsigned(get_lane(a, k) < get_lane(b, k)) << k;
        CHECK(bits_of(a < b) == bits);
        CHECK(any(a < b) == (bits != 0));
        CHECK(all(a < b) == (bits == (1u << Lanes<decltype(a)>::count) - 1));
        CHECK(all(a == a || a != a) && !any(a < a));
    });
}

TEST(signs_and_roots) {
    over_widths([](auto a, auto b) {
        for (int k = 0; k < Lanes<decltype(a)>::count; ++k) {
            const double x = get_lane(a, k), y = get_lane(b, k);
            CHECK(same(get_lane(cspace::abs(a), k), std::fabs(x)));
            CHECK(same(get_lane(cspace::copysign(a, b), k), std::copysign(x, y)));
            CHECK(same(get_lane(sign_bit(a), k), std::copysign(0.0, x)));
            CHECK(same(get_lane(cspace::sqrt(a), k), std::sqrt(x)));
            CHECK(same(get_lane(cspace::round(a), k), std::nearbyint(x)));
            CHECK(same(cspace::round(x), std::nearbyint(x)));
            CHECK(same(cspace::abs(x), std::fabs(x)));
            CHECK(same(cspace::copysign(x, y), std::copysign(x, y)));
        }
    });
}

TEST(bits) {
    over_widths([](auto a, auto b) {
        check_lanes(a, b, [](auto x, auto y) { return bit_and(x, y); });
        check_lanes(a, b, [](auto x, auto y) { return bit_or(x, y); });
        check_lanes(a, b, [](auto x, auto y) { return bit_xor(x, y); });
        check_lanes(a, b, [](auto x, auto y) { return bit_and_not(x, y); });
        check_lanes(a, b, [](auto x, auto) { return shift_bits_left<63>(x); });
        check_lanes(a, b, [](auto x, auto) { return lowest_bit(x); });
    });
}

template <int s, int N>
void check_swapped(Pack<N> a) {
    for (int k = 0; k < N; ++k) CHECK(same(get_lane(swap_lanes<s>(a), k), get_lane(a, k ^ s)));
}
template <int N, int... distances>
void check_all_swapped(Pack<N> a, std::integer_sequence<int, distances...>) {
    (check_swapped<distances>(a), ...);
}
TEST(lanes_change_places) {
    over_widths(
        []<int N>(Pack<N> a, Pack<N>) { check_all_swapped(a, std::make_integer_sequence<int, N>()); });
}

// --- memory ----------------------------------------------------------------------------------------------
template <class V>
void check_rows() {
    constexpr int lanes = Lanes<V>::count, rows = 8, stride = 9;
    double from[rows * stride], to[rows * stride];
    for (int i = 0; i < rows * stride; ++i) from[i] = i + 0.25;
    for (int width = 1; width <= stride; ++width) {
        for (int count = 1; count <= lanes; ++count) {
            V values[stride];
            load_rows(from, stride, count, width, values);
            for (int j = 0; j < width; ++j) {
                for (int k = 0; k < lanes; ++k) {
                    CHECK(get_lane(values[j], k) == from[(k < count ? k : count - 1) * stride + j]);
                }
            }
            std::memset(to, 0, sizeof to);
            store_rows(values, width, to, stride, count);
            for (int i = 0; i < rows * stride; ++i) {
                CHECK(to[i] == (i / stride < count && i % stride < width ? from[i] : 0.0));
            }
        }
    }
    for (int count = 1; count <= lanes; ++count) {
        std::memset(to, 0, sizeof to);
        store_lanes(to + 1, load_lanes<V>(from + 1, count), count);
        for (int i = 0; i < rows * stride; ++i) CHECK(to[i] == (i >= 1 && i < 1 + count ? from[i] : 0.0));
    }
}
TEST(rows_and_runs) {
    check_rows<double>();
    check_rows<Pack<2>>();
    check_rows<Pack<4>>();
    check_rows<Pack<8>>();
}
