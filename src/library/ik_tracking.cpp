#include "ik_tracking.hpp"

#include <algorithm>

#include "cspace/ik/goal.hpp"
#include "cspace/ik/tracking/follow.hpp"
#include "cspace/math/interrupts.hpp"
#include "kernels/ik.hpp"
#include "robot_path.hpp"

namespace cspace::ik {

namespace {

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

    Tracking(const RobotPath& on, const TrackRows& given)
        : on(on),
          poses(given.count),
          ways(given.count),
          starts(on.gather_rows(given.starts, given.branches)),
          last(starts.size()),
          ends(given.branches),
          weakest(given.branches),
          reached(given.branches),
          joint(given.branches),
          fate(given.branches) {
        visit_range(0, given.count, [&](std::size_t k) { poses[k] = read_goal(given.poses + 16 * k).T; });
        visit_range(0, given.count, [&](std::size_t k) {
            ways[k] = way_between(poses[k], poses[k + (k + 1 < given.count)], on.path.length);
        });
        bool same = on.path.n == on.coordinates;
        for (int j = 0; same && j < on.path.n; ++j) same = on.number[j] == j;
        if (!same) q.resize(given.branches * given.count * std::size_t(on.path.n));
        rows = same ? given.q : q.data();
        on.gather(given.bounds, lower);
        on.gather(given.bounds + on.coordinates, upper);
        on.gather(given.bounds + 2 * on.coordinates, stride);
    }
    ik::Track track(bool whole_turns) {
        return {&on.path,       poses.data(), ways.data(),    poses.size(), lower,       upper,
                stride,         whole_turns,  starts.data(),  ends.size(),  rows,        last.data(),
                reached.data(), ends.data(),  weakest.data(), joint.data(), fate.data(), poll_interrupts};
    }
};

}  // namespace

void track_branches(const TrackRows& given) {
    const RobotPath on(given.chain);
    const std::size_t n = std::size_t(on.path.n), dof = std::size_t(on.coordinates);
    Tracking tracking(on, given);
    kernels::ik_track(tracking.track(given.whole_turns));
    for (std::size_t b = 0; b < given.branches; ++b) {
        const double* start = given.starts + dof * b;
        for (std::size_t k = 0; !tracking.q.empty() && k < std::size_t(tracking.reached[b]); ++k) {
            double* row = given.q + (b * given.count + k) * dof;
            std::copy_n(start, dof, row);
            on.scatter(tracking.q.data() + (b * given.count + k) * n, row);
        }
        std::copy_n(start, dof, given.last + dof * b);
        on.scatter(tracking.last.data() + n * b, given.last + dof * b);
        const double joint = tracking.joint[b] < 0 ? -1.0 : double(on.number[tracking.joint[b]]);
        const double values[track_info] = {double(tracking.reached[b]), tracking.ends[b],
                                           double(tracking.fate[b]), joint, tracking.weakest[b]};
        std::copy_n(values, track_info, given.info + track_info * b);
    }
}

}  // namespace cspace::ik
