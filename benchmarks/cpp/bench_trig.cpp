// The elementary functions: nanoseconds per element, ours on packs through the chosen kernel and the C
// library.
#include <cmath>
#include <vector>

#include "bench.hpp"
#include "cspace/math/trig.hpp"
#include "kernels/math_trig.hpp"

int main() {
    constexpr int n = 4096, repetitions = 400;
    std::vector<double> x(n), y(n), s(n), c(n);
    for (int i = 0; i < n; ++i) {
        x[i] = -3 + 6.0 * i / n;
        y[i] = 1 - 2.0 * ((i * 37) % n) / n;
    }
    using namespace cspace;
    bench::measure("sincos", n, repetitions, [&] { kernels::sincos_n(x.data(), s.data(), c.data(), n); });
    bench::measure("sincos of the C library", n, repetitions, [&] {
        for (int i = 0; i < n; ++i) {
            s[i] = std::sin(x[i]);
            c[i] = std::cos(x[i]);
        }
        bench::keep(s[0]);
    });
    bench::measure("atan2", n, repetitions, [&] { kernels::atan2_n(y.data(), x.data(), s.data(), n); });
    bench::measure("atan2 of the C library", n, repetitions, [&] {
        for (int i = 0; i < n; ++i) s[i] = std::atan2(y[i], x[i]);
        bench::keep(s[0]);
    });
    bench::measure("acos", n, repetitions, [&] { kernels::acos_n(y.data(), s.data(), n); });
    bench::measure("acos of the C library", n, repetitions, [&] {
        for (int i = 0; i < n; ++i) s[i] = std::acos(y[i]);
        bench::keep(s[0]);
    });
    bench::measure("asin", n, repetitions, [&] { kernels::asin_n(y.data(), s.data(), n); });
    // One double at a time, compiled as this file is (-DCMAKE_CXX_FLAGS="-mavx2 -mfma" for the AVX2 column).
    bench::measure("sincos of one double", n, repetitions, [&] {
        for (int i = 0; i < n; ++i) cspace::sincos(x[i], s[i], c[i]);
        bench::keep(s[0]);
    });
    bench::measure("atan2 of one double", n, repetitions, [&] {
        for (int i = 0; i < n; ++i) s[i] = cspace::atan2(y[i], x[i]);
        bench::keep(s[0]);
    });
    bench::measure("acos of one double", n, repetitions, [&] {
        for (int i = 0; i < n; ++i) s[i] = cspace::acos(y[i]);
        bench::keep(s[0]);
    });
    return 0;
}
