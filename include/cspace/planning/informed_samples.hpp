// Samples of the configurations through which a path between two others may be shorter than a bound: the
// prolate hyperspheroid with the two as its foci (Gammell, Srinivasa & Barfoot 2014, "Informed RRT*").
//
// Directions are those of sums of uniform numbers, which come close to a normal distribution; radii those of
// the largest of n uniform numbers, whose distribution is that of the n-th root of one. So no function of the
// standard library takes part whose last bit depends on the machine.
#pragma once

#include <array>
#include <cmath>

#include "cspace/planning/box.hpp"
#include "cspace/search/draws.hpp"
#include "cspace/search/halton.hpp"

namespace cspace::planning {

class InformedSamples {
  public:
    using Row = std::array<float, search::most_dimensions>;

    InformedSamples(const Box& box, std::uint64_t seed) : box_(box), draws_(seed) {}

    double uniform() { return draws_.uniform(); }

    // A configuration inside the box through which a path from a to b may be shorter than `bound`; false if
    // the one drawn is not such. Points are drawn in the hyperspheroid or in the box, whichever misses less
    // often.
    bool draw(const float* a, const float* b, float bound, float* q) {
        const bool from_box = std::int64_t(hits_[1]) * tries_[0] > std::int64_t(hits_[0]) * tries_[1];
        const bool is_hit = from_box ? draw_from_box(a, b, bound, q) : draw_from_spheroid(a, b, bound, q);
        ++tries_[from_box], hits_[from_box] += is_hit;
        if (tries_[from_box] == most_tries)
            tries_[from_box] /= 2, hits_[from_box] = (hits_[from_box] + 1) / 2;
        return is_hit;
    }

  private:
    const Box& box_;
    search::Draws draws_;
    static constexpr int most_tries = 1 << 12;
    int tries_[2] = {1, 1}, hits_[2] = {1, 1};  // in the hyperspheroid, in the box

    bool draw_from_box(const float* a, const float* b, float bound, float* q) {
        Row unit;
        for (int k = 0; k < box_.width; ++k) unit[std::size_t(k)] = float(draws_.uniform());
        box_.scale(unit.data(), q);
        return box_.distance(a, q) + box_.distance(q, b) < bound;
    }
    bool draw_from_spheroid(const float* a, const float* b, float bound, float* q) {
        const int n = box_.width;
        Row axis_row, x_row;
        float *const axis = axis_row.data(), *const x = x_row.data();
        float square = 0;
        for (int k = 0; k < n; ++k) {
            axis[k] = box_.difference(k, a[k], b[k]);
            square += axis[k] * axis[k];
        }
        const float between = std::sqrt(square);
        draw_in_ball(x);
        const float along = 0.5f * bound, across = 0.5f * std::sqrt(std::max(bound * bound - square, 0.0f));
        for (int k = 0; k < n; ++k) x[k] *= k == 0 ? along : across;
        if (between > 0) reflect(axis, between, x);
        for (int k = 0; k < n; ++k) {
            q[k] = a[k] + (0.5f * axis[k] + x[k]);
            if (!put_inside(k, q[k])) return false;
        }
        return true;
    }
    void draw_in_ball(float* x) {
        constexpr int terms = 4;
        float square = 0;
        double radius = 0;
        for (int k = 0; k < box_.width; ++k) {
            double sum = -0.5 * terms;
            for (int i = 0; i < terms; ++i) sum += draws_.uniform();
            x[k] = float(sum);
            square += x[k] * x[k];
            radius = std::max(radius, draws_.uniform());
        }
        const float scale = square > 0 ? float(radius) / std::sqrt(square) : 0.0f;
        for (int k = 0; k < box_.width; ++k) x[k] *= scale;
    }
    // The Householder reflection that takes the first unit vector to axis / length.
    void reflect(const float* axis, float length, float* x) const {
        Row row;
        float* const v = row.data();
        float square = 0, product = 0;
        for (int k = 0; k < box_.width; ++k) {
            v[k] = (k == 0 ? 1.0f : 0.0f) - axis[k] / length;
            square += v[k] * v[k];
            product += v[k] * x[k];
        }
        if (square == 0) return;
        for (int k = 0; k < box_.width; ++k) x[k] -= 2 * product / square * v[k];
    }
    // A joint that wraps gets the value of its period.
    bool put_inside(int k, float& x) const {
        if (box_.is_wrapping(k)) x = wrap_once(x);
        return x >= box_.lower[k] && x <= box_.upper[k];
    }
};

}  // namespace cspace::planning
