// A Cartesian path for cspace.trajectory.CartesianPath: its pieces and places on them.
#include "library/trajectory_cartesian.hpp"

#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <tuple>

#include "arrays_in_place.hpp"
#include "bindings.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::trajectory;

namespace {

using Integers = Plain<const std::int64_t>;
// point, turn, R, axis, rate and arm of the pieces.
using PieceArrays =
    std::tuple<ConstDoubles, ConstDoubles, ConstDoubles, ConstDoubles, ConstDoubles, ConstDoubles>;

std::span<const double> read_rows(const ConstDoubles& array, std::size_t count, std::size_t width) {
    if (std::size_t(array.size) != count * width)
        throw nb::value_error("arrays of matching sizes are needed");
    return {array.data, count * width};
}
CartesianPieces read_pieces(const PieceArrays& arrays) {
    const std::size_t n = std::size_t(std::get<4>(arrays).size);
    return {read_rows(std::get<0>(arrays), n, 18), read_rows(std::get<1>(arrays), n, 18),
            read_rows(std::get<2>(arrays), n, 9),  read_rows(std::get<3>(arrays), n, 3),
            read_rows(std::get<4>(arrays), n, 1),  read_rows(std::get<5>(arrays), n, 3)};
}
CartesianPlaces read_places(const CartesianPieces& path, const Integers& piece, const ConstDoubles& u) {
    const std::size_t count = std::size_t(piece.size);
    for (std::size_t i = 0; i < count; ++i)
        if (piece.data[i] < 0 || std::size_t(piece.data[i]) >= path.rate.size())
            throw nb::value_error("a piece is not on the path");
    return {{piece.data, count}, read_rows(u, count, 1)};
}

}  // namespace

void bind_trajectory_cartesian(nb::module_& m) {
    m.def(
        "cartesian_poses",
        [](const PieceArrays& arrays, const Integers& piece, const ConstDoubles& u) {
            const CartesianPieces path = read_pieces(arrays);
            Doubles T({u.size, 4, 4});
            evaluate_poses(path, read_places(path, piece, u), T.data);
            return T;
        },
        "pieces"_a, "piece"_a, "u"_a, "Poses (n, 4, 4) of a Cartesian path at places u (n,) of pieces (n,).");
    m.def(
        "cartesian_twists",
        [](const PieceArrays& arrays, const Integers& piece, const ConstDoubles& u) {
            const CartesianPieces path = read_pieces(arrays);
            Doubles first({u.size, 6}), second({u.size, 6});
            evaluate_twists(path, read_places(path, piece, u), first.data, second.data);
            return std::make_tuple(first, second);
        },
        "pieces"_a, "piece"_a, "u"_a, "The first two derivatives (n, 6) of the pose there.");
}
