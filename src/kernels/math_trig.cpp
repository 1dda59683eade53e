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
        sincos(load_lanes<V>(x + i, count), sine, cosine);
        store_lanes(s + i, sine, count);
        store_lanes(c + i, cosine, count);
    });
}
void atan2_n(const double* y, const double* x, double* angle, std::size_t n) {
    over_packs<native_width>(n, [=](std::size_t i, int count) {
        store_lanes(angle + i, atan2(load_lanes<V>(y + i, count), load_lanes<V>(x + i, count)), count);
    });
}
void acos_n(const double* x, double* angle, std::size_t n) {
    over_packs<native_width>(n, [=](std::size_t i, int count) {
        store_lanes(angle + i, acos(load_lanes<V>(x + i, count)), count);
    });
}
void asin_n(const double* x, double* angle, std::size_t n) {
    over_packs<native_width>(n, [=](std::size_t i, int count) {
        store_lanes(angle + i, asin(load_lanes<V>(x + i, count)), count);
    });
}

}  // namespace cspace::inline CSPACE_ISA
