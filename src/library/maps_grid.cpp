#include "maps_grid.hpp"

#include "cspace/maps/grid_inflation.hpp"
#include "cspace/maps/grid_outlines.hpp"
#include "cspace/maps/path_clearance.hpp"
#include "maps_grid_state.hpp"

namespace cspace::maps {

GridWorld::GridWorld(std::shared_ptr<State> state)
    : rows(state->bits.rows()),
      columns(state->bits.columns()),
      resolution(state->frame.resolution),
      x(state->frame.origin.x),
      y(state->frame.origin.y),
      state_(std::move(state)) {}
GridWorld::GridWorld(CellBytes blocked, double side, Point origin)
    : GridWorld(
          std::shared_ptr<State>(new State{{blocked.data, blocked.rows, blocked.columns}, {side, origin}})) {}
GridWorld::GridWorld(const GridWorld& other, double radius, bool from_centers)
    : GridWorld(std::shared_ptr<State>(new State{
          inflate_grid(other.state_->bits, radius / other.resolution, from_centers), other.state_->frame})) {}

std::size_t GridWorld::cells() const { return state_->bits.numbers(); }
std::size_t GridWorld::count_blocked() const { return std::size_t(state_->bits.count_blocked()); }
std::size_t GridWorld::count_corners() const { return std::size_t(maps::count_corners(state_->bits)); }
std::size_t GridWorld::bytes() const { return state_->bits.bytes() + state_->parts.bytes(); }
Table<std::uint8_t> GridWorld::unpack() const { return unpack_bits(state_->bits); }
std::tuple<int, int, int> GridWorld::locate(Point p) const {
    Cell cell = {-1, -1};
    const CellState place = state_->frame.locate(state_->bits, p, cell);
    return {int(place), cell.row, cell.column};
}
Table<std::uint8_t> GridWorld::find_free(std::span<const Point> points) const {
    Table<std::uint8_t> made;
    Cell cell;
    for (const Point p : points) made.values.push_back(state_->find_cell(p, cell));
    return made;
}
double GridWorld::path_clearance(std::span<const Point> path) const {
    return maps::path_clearance(path, state_->bits, state_->frame);
}

}  // namespace cspace::maps
