// A grid as the sweep sees it: lines along which the robot drives, numbered across.
#pragma once

#include <cstdint>

#include "cspace/maps/bit_grid.hpp"

namespace cspace::navigation {

class SweepFrame {
  public:
    // Lines are columns of the grid, or its rows.
    SweepFrame(const maps::BitGrid& grid, bool along_rows) : grid_(grid), along_rows_(along_rows) {}
    int lines() const { return along_rows_ ? grid_.rows() : grid_.columns(); }
    int length() const { return along_rows_ ? grid_.columns() : grid_.rows(); }
    // Places of a line beyond its ends are blocked, lines beyond the last likewise.
    bool free(int line, int at) const {
        return along_rows_ ? !grid_.blocked(line, at) : !grid_.blocked(at, line);
    }
    std::int32_t number(int line, int at) const { return line * length() + at; }
    int line_of(std::int32_t number) const { return number / length(); }
    int place_of(std::int32_t number) const { return number % length(); }
    std::int32_t size() const { return lines() * length(); }
    maps::Cell cell(std::int32_t number) const {
        const int line = line_of(number), at = place_of(number);
        return along_rows_ ? maps::Cell{line, at} : maps::Cell{at, line};
    }
    std::int32_t number(maps::Cell c) const {
        return along_rows_ ? number(c.row, c.column) : number(c.column, c.row);
    }

  private:
    const maps::BitGrid& grid_;
    bool along_rows_;
};

}  // namespace cspace::navigation
