// The moves from a cell to its neighbours, under each rule for corners, as tables over the cells around it.
#pragma once

#include <array>
#include <cstdint>

namespace cspace::navigation {

// When a diagonal step is allowed: if both adjacent cells are free, if one is, always; four: no diagonal
// steps.
enum class Corners : std::uint8_t { never, one, always, four };
inline constexpr int corner_rules = 4;

// The directions, each an eighth of a turn from the one before, as steps in row and column: the even ones lie
// along rows and columns, the odd ones between them.
inline constexpr int row_step[8] = {0, 1, 1, 1, 0, -1, -1, -1};
inline constexpr int column_step[8] = {1, 1, 0, -1, -1, -1, 0, 1};
// What to add to the number of a cell to come to that of its neighbours, where rows are `stride` apart.
class NeighbourOffsets {
  public:
    explicit NeighbourOffsets(std::uint32_t stride) {
        for (int d = 0; d < 8; ++d)
            offset_[d] = std::uint32_t(row_step[d]) * stride + std::uint32_t(column_step[d]);
    }
    std::uint32_t operator[](int direction) const { return offset_[direction]; }

  private:
    std::uint32_t offset_[8];
};
constexpr bool is_diagonal(int direction) { return direction & 1; }
constexpr unsigned bit_of(int direction) { return 1u << (direction & 7); }
// The direction that leads a step of these signs.
inline constexpr std::int8_t direction_of[3][3] = {
    {5, 6, 7}, {4, -1, 0}, {3, 2, 1}};  // [row + 1][column + 1]

namespace moves {

// Whether the neighbour in a direction is blocked, by the pattern BitGrid::around gives.
constexpr bool is_neighbour_blocked(unsigned around, int direction) {
    direction &= 7;
    return around >> (3 * (1 + row_step[direction]) + 1 + column_step[direction]) & 1;
}

constexpr bool is_move_allowed(Corners rule, unsigned around, int direction) {
    if (is_neighbour_blocked(around, direction)) return false;
    if (!is_diagonal(direction)) return true;
    const int beside =
        is_neighbour_blocked(around, direction - 1) + is_neighbour_blocked(around, direction + 1);
    return rule == Corners::always || (rule == Corners::never && beside == 0) ||
           (rule == Corners::one && beside < 2);
}

constexpr std::array<std::uint8_t, 512> allowed_table(Corners rule) {
    std::array<std::uint8_t, 512> table{};
    for (unsigned around = 0; around < 512; ++around)
        for (int d = 0; d < 8; ++d)
            if (is_move_allowed(rule, around, d)) table[around] = std::uint8_t(table[around] | bit_of(d));
    return table;
}

}  // namespace moves

// The allowed directions, a bit each, by rule and pattern of the cells around.
inline constexpr std::array<std::array<std::uint8_t, 512>, corner_rules> allowed_moves = {
    moves::allowed_table(Corners::never), moves::allowed_table(Corners::one),
    moves::allowed_table(Corners::always), moves::allowed_table(Corners::four)};

}  // namespace cspace::navigation
