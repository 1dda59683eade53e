#include "trajectory_states.hpp"

#include "cspace/math/rows.hpp"

namespace cspace::trajectory::inline CSPACE_ISA {

namespace {

using V = Pack<native_width>;

AxisTaskOf<V> load_task(const AxisRows& axes, std::size_t i, int count) {
    const auto at = [&](const double* values) { return load_lanes<V>(values + i, count); };
    const AxisLimitsOf<V> limits{at(axes.v_max), at(axes.v_min), at(axes.a_max), at(axes.a_min),
                                 at(axes.jerk)};
    return make_axis_task<V>({at(axes.v0), at(axes.a0), at(axes.vf), at(axes.af), limits}, at(axes.P));
}

// body(i, count) for packs of axes; the last one may have fewer.
template <class Body>
void for_packs(const AxisRows& axes, const Body& body) {
    for (std::size_t i = 0; i < axes.count; i += native_width) {
        const std::size_t left = axes.count - i;
        body(i, left < native_width ? int(left) : native_width);
    }
}

}  // namespace

void find_shortest_times(const AxisRows& axes, double* time) {
    for_packs(axes, [&](std::size_t i, int count) {
        store_lanes(time + i, minimum_time(load_task(axes, i, count)), count);
    });
}

void attain_times(const AxisRows& axes, const double* time, double* motions, std::size_t stride,
                  bool* possible) {
    for_packs(axes, [&](std::size_t i, int count) {
        CombinationOf<V> made;
        const auto fits = attain_in(load_task(axes, i, count), load_lanes<V>(time + i, count), made);
        const unsigned bits = bits_of(fits);
        for (int k = 0; k < count; ++k) possible[i + std::size_t(k)] = bits >> k & 1;
        store_lanes(motions + i, made.theta, count);
        for (std::size_t k = 0; k < 7; ++k) {
            store_lanes(motions + (1 + k) * stride + i, made.up[k], count);
            store_lanes(motions + (8 + k) * stride + i, made.down[k], count);
        }
    });
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
