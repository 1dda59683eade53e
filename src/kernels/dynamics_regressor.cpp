#include <cstring>

#include "cspace/dynamics/regressor.hpp"
#include "dynamics_arguments.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {
namespace {

// Writes into the regressors of a pack of rows.
template <class V>
struct RegressorWriter {
    double* result;
    int dof, columns, count;

    std::size_t row_size() const { return std::size_t(dof) * std::size_t(columns); }
    CSPACE_INLINE void write(int row, int column, const V* values, int width) const {
        double* to = result + std::size_t(row) * std::size_t(columns) + std::size_t(column);
        if constexpr (Lanes<V>::count == 1)
            std::memcpy(to, values, sizeof(double) * std::size_t(width));
        else
            store_rows(values, width, to, row_size(), count);
    }
};

// The columns of a body: of the twist of a floating base, and of every joint from link k to the base.
template <class V>
CSPACE_INLINE void write_body(const Multibody& bodies, const MovingBody<V>& body, int k, int column,
                              int first, const MovingFrame<V>* links, const RegressorWriter<V>& to) {
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0);
    const Vec3<V> none = {zero, zero, zero},
                  unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    for (int i = 0; i < first; ++i) {
        V powers[body_parameters] = {};
        const Vec3<V>& e = unit[i % 3];
        if (i < 3)
            add_powers(body, e, none, powers);
        else
            add_powers(body, cross(e, body.origin), e, powers);
        to.write(i, column, powers, body_parameters);
    }
    for (int j = k; j >= 0; j = bodies.links[j].parent) {
        const int coordinate = bodies.links[j].coordinate;
        bool written = false;  // with a joint before that shares the coordinate
        for (int i = k; bodies.shares && i != j; i = bodies.links[i].parent)
            written = written || bodies.links[i].coordinate == coordinate;
        if (written) continue;
        V powers[body_parameters] = {};
        add_joint_powers(body, bodies.links[j], links[j].frame, powers);
        for (int i = bodies.links[j].parent; bodies.shares && i >= 0; i = bodies.links[i].parent) {
            if (bodies.links[i].coordinate == coordinate)
                add_joint_powers(body, bodies.links[i], links[i].frame, powers);
        }
        to.write(first + coordinate, column, powers, body_parameters);
    }
}

// The columns of armature, damping and dry friction of all joints.
template <class V>
CSPACE_INLINE void write_resistances(const Multibody& bodies, bool rubs, const V* qd, const V* qdd,
                                     int column, int first, const RegressorWriter<V>& to) {
    const int n = bodies.n_links;
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0);
    for (int k = 0; k < n; ++k) {
        const Link& link = bodies.links[k];
        const int row = first + link.coordinate;
        const V inertial = link.ratio * link.ratio * qdd[link.coordinate];
        to.write(row, column + k, &inertial, 1);
        if (!rubs) continue;
        const V rate = link.ratio * qd[link.coordinate], viscous = link.ratio * rate;
        const V dry = link.ratio * select_lanes(rate > zero, one, select_lanes(rate < zero, -one, zero));
        to.write(row, column + n + k, &viscous, 1);
        to.write(row, column + 2 * n + k, &dry, 1);
    }
}

template <class V>
bool regressor_pack(const RegressorRows& task, void* memory, std::size_t i, int count) {
    const Rows& rows = task.rows;
    const Multibody& bodies = rows.bodies;
    Scratch scratch{static_cast<char*>(memory)};
    Arguments<V> given;
    if (!read_arguments(rows, scratch, i, count, 0, given)) return false;
    const std::size_t size = std::size_t(given.dof) * std::size_t(task.columns);
    const RegressorWriter<V> writer = {rows.result + i * size, given.dof, task.columns, count};
    std::memset(writer.result, 0, sizeof(double) * size * std::size_t(count));
    auto* links = take_array<MovingFrame<V>>(scratch, bodies.n_links);
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> none = {zero, zero, zero};
    MovingFrame<V> root = {
        {},
        {matrix_column(given.R, 0), matrix_column(given.R, 1), matrix_column(given.R, 2), none},
        {none, none, -fill_vec3<V>(rows.gravity)}};
    if (given.first) {
        root.motion.w = vector_at(given.qd + 3);
        root.motion.wd = vector_at(given.force + 3);
        root.motion.a = root.motion.a + vector_at(given.force);
    }
    const V *qd = given.qd + given.first, *qdd = given.force + given.first;
    move_frames(bodies, root, given.q, qd, qdd, links);
    int place = 0;
    if (given.first) {
        write_body(bodies, move_body(root, task.frames[0]), -1, 0, given.first, links, writer);
        place = 1;
    }
    for (int k = 0; k < bodies.n_links; ++k, ++place)
        write_body(bodies, move_body(links[k], task.frames[place]), k, body_parameters * place, given.first,
                   links, writer);
    write_resistances(bodies, rows.rubs, qd, qdd, body_parameters * place, given.first, writer);
    return true;
}

}  // namespace

bool regressor_rows(const RegressorRows& task, std::size_t begin, std::size_t end, void* memory) {
    return over_rows(
        begin, end, native_width, [&](std::size_t i) { return regressor_pack<double>(task, memory, i, 1); },
        [&](std::size_t i, int count) { return regressor_pack<Wide>(task, memory, i, count); });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
