#include "trig.hpp"

#include "cspace/math/trig.hpp"

namespace cspace::inline CSPACE_ISA {
namespace {

constexpr int width = 4;
using V = Pack<width>;

// Calls f on packs of the arrays; the last, partial pack is padded with ones.
template <class F>
void over_packs(std::size_t n, F f) {
    for (std::size_t i = 0; i < n; i += width) f(i, n - i < width ? int(n - i) : width);
}
V load(const double* x, int count) {
    V v = fill<V>(1.0);
    for (int k = 0; k < count; ++k) set_lane(v, k, x[k]);
    return v;
}
void store(double* x, V v, int count) {
    for (int k = 0; k < count; ++k) x[k] = lane(v, k);
}

}  // namespace

void sincos_n(const double* x, double* s, double* c, std::size_t n) {
    over_packs(n, [=](std::size_t i, int count) {
        V sv, cv;
        sincos(load(x + i, count), sv, cv);
        store(s + i, sv, count);
        store(c + i, cv, count);
    });
}
void atan2_n(const double* y, const double* x, double* angle, std::size_t n) {
    over_packs(n, [=](std::size_t i, int count) {
        store(angle + i, atan2(load(y + i, count), load(x + i, count)), count);
    });
}
void acos_n(const double* x, double* angle, std::size_t n) {
    over_packs(n, [=](std::size_t i, int count) { store(angle + i, acos(load(x + i, count)), count); });
}

}  // namespace cspace::inline CSPACE_ISA
