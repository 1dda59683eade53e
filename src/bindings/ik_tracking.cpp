// Branches along a path of poses: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#include "ik_tracking.hpp"

#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/ik/goal.hpp"
#include "numeric_path.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

constexpr int info_width = 5;  // poses reached, end, fate, joint, least singular value

// What the kernel reads and writes, in the coordinates of the path.
struct Tracking {
    const RobotPath& on;
    std::vector<Posed> poses;
    std::vector<ik::Way> ways;
    std::vector<double> starts, q, last, ends, weakest;
    std::vector<std::int64_t> reached;
    std::vector<std::int32_t> joint;
    std::vector<ik::Fate> fate;
    double lower[ik::max_joints], upper[ik::max_joints], stride[ik::max_joints];

    double*
        rows;  // where the configurations go: the caller's array, if its coordinates are those of the path

    Tracking(const RobotPath& on, const double* matrices, std::size_t count, const Matrix& from, double* into)
        : on(on), poses(count), ways(count) {
        for (std::size_t k = 0; k < count; ++k) poses[k] = read_goal(matrices + 16 * k).T;
        for (std::size_t k = 0; k < count; ++k)
            ways[k] = way_between(poses[k], poses[k + (k + 1 < count)], on.path.length);
        const std::size_t branches = from.shape(0), n = std::size_t(on.path.n);
        for (std::vector<double>* part : {&starts, &last}) part->resize(branches * n);
        for (std::size_t b = 0; b < branches; ++b)
            on.gather(from.data() + from.shape(1) * b, starts.data() + n * b);
        bool same = on.path.n == on.coordinates;
        for (int j = 0; same && j < on.path.n; ++j) same = on.number[j] == j;
        if (!same) q.resize(branches * count * n);
        rows = same ? into : q.data();
        ends.resize(branches);
        weakest.resize(branches);
        reached.resize(branches);
        joint.resize(branches);
        fate.resize(branches);
    }
    ik::Track track(bool whole_turns) {
        return {&on.path,       poses.data(), ways.data(),    poses.size(), lower,      upper,
                stride,         whole_turns,  starts.data(),  ends.size(),  rows,       last.data(),
                reached.data(), ends.data(),  weakest.data(), joint.data(), fate.data()};
    }
};

// See robot.track in the package for the meaning of each argument. q (branches, poses, coordinates), last
// (branches, coordinates) and info take the results; q beyond the poses reached is left alone.
void follow(nb::handle robot, int frame, Goals poses, Matrix starts,
            Array<const double, nb::shape<3, -1>> bounds, bool whole_turns, Array<double, nb::ndim<3>> q,
            Array<double, nb::ndim<2>> last, Array<double, nb::shape<-1, info_width>> info) {
    const RobotPath on = path_on(robot, frame);
    const std::size_t count = poses.shape(0), branches = starts.shape(0), n = std::size_t(on.path.n);
    const std::size_t width = std::size_t(on.coordinates);
    if (count == 0 || starts.shape(1) != width || bounds.shape(1) != width || q.shape(0) != branches ||
        q.shape(1) != count || q.shape(2) != width || last.shape(0) != branches || last.shape(1) != width ||
        info.shape(0) != branches)
        throw nb::value_error("arrays of matching sizes");
    Tracking tracking(on, poses.data(), count, starts, q.data());
    on.gather(bounds.data(), tracking.lower);
    on.gather(bounds.data() + width, tracking.upper);
    on.gather(bounds.data() + 2 * width, tracking.stride);
    nb::gil_scoped_release free;
    kernels::ik_track(tracking.track(whole_turns));
    for (std::size_t b = 0; b < branches; ++b) {
        const double* start = starts.data() + width * b;
        for (std::size_t k = 0; !tracking.q.empty() && k < std::size_t(tracking.reached[b]); ++k) {
            double* row = q.data() + (b * count + k) * width;
            std::copy_n(start, width, row);
            on.scatter(tracking.q.data() + (b * count + k) * n, row);
        }
        std::copy_n(start, width, last.data() + width * b);
        on.scatter(tracking.last.data() + n * b, last.data() + width * b);
        const double joint = tracking.joint[b] < 0 ? -1.0 : double(on.number[tracking.joint[b]]);
        const double values[info_width] = {double(tracking.reached[b]), tracking.ends[b],
                                           double(tracking.fate[b]), joint, tracking.weakest[b]};
        std::copy_n(values, info_width, info.data() + info_width * b);
    }
}

}  // namespace

void bind_ik_tracking(nb::module_& m) {
    m.def("_ik_track", follow, "robot"_a, "frame"_a, "poses"_a, "starts"_a, "bounds"_a, "whole_turns"_a,
          "q"_a, "last"_a, "info"_a, "Follows branches along poses; q, last and info take the results.");
}
