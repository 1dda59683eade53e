// Branches along a path of poses: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#include "library/ik_tracking.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "kinematics.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

// See robot.track in the package for the meaning of each argument. q beyond the poses reached is left alone.
void track_rows(nb::handle robot, int frame, Goals poses, Matrix starts,
                Array<const double, nb::shape<3, -1>> bounds, bool whole_turns, Array<double, nb::ndim<3>> q,
                Array<double, nb::ndim<2>> last, Array<double, nb::shape<-1, ik::track_info>> info) {
    const model::Chain& chain = chain_on(robot, frame);
    const std::size_t count = poses.shape(0), branches = starts.shape(0),
                      dof = std::size_t(chain.n_coordinates);
    require_sizes(count > 0 && starts.shape(1) == dof && bounds.shape(1) == dof &&
                  has_shape(q, branches, count, dof) && has_shape(last, branches, dof) &&
                  info.shape(0) == branches);
    const nb::gil_scoped_release release;
    ik::track_branches({chain, poses.data(), count, starts.data(), branches, bounds.data(), whole_turns,
                        q.data(), last.data(), info.data()});
}

}  // namespace

void bind_ik_tracking(nb::module_& m) {
    m.def("_ik_track", track_rows, "Follows branches along poses; q, last and info take the results.");
}
