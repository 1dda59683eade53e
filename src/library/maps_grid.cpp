#include "maps_grid.hpp"

#include "cspace/maps/grid_inflation.hpp"
#include "cspace/maps/grid_outlines.hpp"
#include "cspace/maps/path_clearance.hpp"
#include "maps_grid_state.hpp"

namespace cspace::maps {

GridWorld::GridWorld(const std::uint8_t* blocked, int rows, int columns, double resolution, Point origin)
    : state_(new State{{blocked, rows, columns}, {resolution, origin}}) {}
GridWorld::GridWorld(const GridWorld& other, double radius, bool from_centers)
    : state_(new State{inflate_grid(other.state_->bits, radius / other.resolution(), from_centers),
                       other.state_->frame}) {}
GridWorld::GridWorld(GridWorld&&) noexcept = default;
GridWorld::~GridWorld() = default;

int GridWorld::rows() const { return state_->bits.rows(); }
int GridWorld::columns() const { return state_->bits.columns(); }
double GridWorld::resolution() const { return state_->frame.resolution; }
Point GridWorld::origin() const { return state_->frame.origin; }
std::size_t GridWorld::cells() const { return state_->bits.numbers(); }
std::size_t GridWorld::count_blocked() const { return std::size_t(state_->bits.count_blocked()); }
std::size_t GridWorld::count_corners() const { return std::size_t(maps::count_corners(state_->bits)); }
std::size_t GridWorld::bytes() const { return state_->bits.bytes() + state_->parts.bytes(); }
void GridWorld::unpack(std::uint8_t* into) const { state_->bits.unpack(into); }
GridPlace GridWorld::locate(Point p) const {
    Cell cell = {-1, -1};
    const CellState place = state_->frame.locate(state_->bits, p, cell);
    return {int(place), cell.row, cell.column};
}
double GridWorld::path_clearance(std::span<const Point> path) const {
    return maps::path_clearance(path, state_->bits, state_->frame);
}

}  // namespace cspace::maps
