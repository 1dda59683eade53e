// Branches along a path of poses: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#include "library/ik_tracking.hpp"

#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>

#include "arrays.hpp"
#include "bindings.hpp"
#include "kinematics.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

using Indices = Array<const std::int64_t, nb::ndim<1>>;

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

// See cspace::ik::JointPathRows.
void joint_path_rows(nb::handle robot, int frame, Goals poses, Matrix twists, Matrix rates, int locked,
                     Array<double, nb::ndim<2>> q, Array<double, nb::ndim<2>> slope,
                     Array<double, nb::ndim<2>> bend, Array<double, nb::shape<-1, 2>> info) {
    const model::Chain& chain = chain_on(robot, frame);
    const std::size_t count = poses.shape(0), dof = std::size_t(chain.n_coordinates);
    require_sizes(has_shape(twists, count, std::size_t(6)) && has_shape(rates, count, std::size_t(6)) &&
                  has_shape(q, count, dof) && has_shape(slope, count, dof) && has_shape(bend, count, dof) &&
                  info.shape(0) == count);
    const nb::gil_scoped_release release;
    ik::correct_joint_path({chain, poses.data(), twists.data(), rates.data(), count, locked, q.data(),
                            slope.data(), bend.data(), info.data()});
}

// See cspace::ik::PieceRows.
void measure_pieces(nb::handle robot, int frame, Matrix q, Matrix slope, Matrix bend, Row u, Indices begin,
                    Indices end, Row share, Goals poses, Array<double, nb::ndim<2>> middle,
                    Array<double, nb::shape<-1, 2>> error) {
    const model::Chain& chain = chain_on(robot, frame);
    const std::size_t nodes = u.shape(0), count = poses.shape(0), dof = std::size_t(chain.n_coordinates);
    const auto is_node = [nodes](std::int64_t k) { return 0 <= k && std::size_t(k) < nodes; };
    require_sizes(has_shape(q, nodes, dof) && has_shape(slope, nodes, dof) && has_shape(bend, nodes, dof) &&
                  begin.shape(0) == count && end.shape(0) == count && share.shape(0) == count &&
                  has_shape(middle, count, dof) && error.shape(0) == count &&
                  std::all_of(begin.data(), begin.data() + count, is_node) &&
                  std::all_of(end.data(), end.data() + count, is_node));
    const nb::gil_scoped_release release;
    ik::measure_pieces({chain, q.data(), slope.data(), bend.data(), u.data(), begin.data(), end.data(),
                        share.data(), poses.data(), count, middle.data(), error.data()});
}

// See cspace::ik::Layers. Returns the states of the chain and its cost.
nb::tuple cheapest_chain(Matrix q, Row cost, Array<const std::size_t, nb::ndim<1>> begin, int values,
                         Row stride, Array<const bool, nb::ndim<1>> wraps, int reach, bool is_ring) {
    const std::size_t states = q.shape(0), dof = q.shape(1), cells = begin.shape(0) - 1;
    require_sizes(begin.shape(0) > 1 && values > 0 && cells % std::size_t(values) == 0 &&
                  cost.shape(0) == states && stride.shape(0) == dof && wraps.shape(0) == dof &&
                  begin.data()[0] == 0 && begin.data()[cells] == states &&
                  std::is_sorted(begin.data(), begin.data() + cells + 1));
    const std::size_t layers = cells / std::size_t(values);
    ik::LayerChain chain;
    {
        const nb::gil_scoped_release release;
        chain = ik::cheapest_chain({dof, q.data(), cost.data(), begin.data(), layers, values, stride.data(),
                                    wraps.data(), reach, is_ring, nullptr});
    }
    return nb::make_tuple(chain.states, chain.cost);
}

void square_volumes(Array<const double, nb::shape<-1, 6, -1>> J, Array<double, nb::ndim<1>> squares) {
    require_sizes(squares.shape(0) == J.shape(0));
    const nb::gil_scoped_release release;
    ik::square_volumes(J.data(), J.shape(0), J.shape(2), squares.data());
}

}  // namespace

void bind_ik_tracking(nb::module_& m) {
    m.def("_ik_track", track_rows, "Follows branches along poses; q, last and info take the results.");
    m.def("_ik_path_rows", joint_path_rows,
          "Corrects q to the poses of a path; slope, bend and info take the results.");
    m.def("_ik_measure_pieces", measure_pieces,
          "Compares pieces of joint paths with poses; middle and error take the results.");
    m.def("_ik_cheapest_chain", cheapest_chain, "The cheapest chain of states, one of each layer.");
    m.def("_square_volumes", square_volumes, "Writes det(J Jᵀ) of Jacobians (n, 6, dof).");
}
