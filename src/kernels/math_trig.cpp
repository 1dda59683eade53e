#include "math_trig.hpp"

#include "cspace/math/rows.hpp"
#include "cspace/math/trig.hpp"

namespace cspace::inline CSPACE_ISA {
namespace {

using V = Pack<native_width>;

}  // namespace

void sincos_n(const double* x, double* s, double* c, std::size_t n) {
    over_packs<native_width>(n, [=](std::size_t i, int count) {
        V sine, cosine;
        sincos(load<V>(x + i, count), sine, cosine);
        store(s + i, sine, count);
        store(c + i, cosine, count);
    });
}
void atan2_n(const double* y, const double* x, double* angle, std::size_t n) {
    over_packs<native_width>(n, [=](std::size_t i, int count) {
        store(angle + i, atan2(load<V>(y + i, count), load<V>(x + i, count)), count);
    });
}
void acos_n(const double* x, double* angle, std::size_t n) {
    over_packs<native_width>(
        n, [=](std::size_t i, int count) { store(angle + i, acos(load<V>(x + i, count)), count); });
}
void asin_n(const double* x, double* angle, std::size_t n) {
    over_packs<native_width>(
        n, [=](std::size_t i, int count) { store(angle + i, asin(load<V>(x + i, count)), count); });
}

}  // namespace cspace::inline CSPACE_ISA
