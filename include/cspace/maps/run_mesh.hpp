// Free cells of a grid as a mesh of convex polygons that is not stored: the maximal runs of free cells in the
// rows, each a rectangle, read from the bits when a search reaches them. x and y are columns and rows, in
// cells.
//
// Two runs above each other share a door where both are free; its ends are ends of runs, so corners of
// obstacles or points of walls. Runs that meet in a point have no door there. Only points with one blocked
// cell of four are turned at, and around these free space is one piece: a point needs no copies.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/bit_scan.hpp"
#include "cspace/maps/triangulation.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::maps {

class RunMesh {
  public:
    struct Run {  // the columns begin … end − 1 of a row
        int row, begin, end;
        friend bool operator==(const Run&, const Run&) = default;
    };
    struct Door {  // part of the bottom or the top of a run, from column line `begin` to `end`
        int side;  // 2 · row, plus 1 at the top
        int begin, end;
        int row() const { return side >> 1; }
        bool is_top() const { return side & 1; }
    };
    using Edge = Door;
    using Polygon = Run;
    static constexpr bool is_vast = true;

    explicit RunMesh(const BitGrid& grid)
        : grid_(grid), shift_(int(std::bit_width(std::uint32_t(grid.columns())))) {}
    // Whether the points of a grid can be numbered.
    static bool fits(const BitGrid& grid) {
        return (std::int64_t(grid.rows()) + 1) << std::bit_width(std::uint32_t(grid.columns())) <=
               std::numeric_limits<Index>::max();
    }

    // The run of a free cell.
    Run run_at(Cell c) const { return {c.row, first_of_run(c.row, c.column), end_of_run(c.row, c.column)}; }

    Index vertex(int row, int column) const { return Index(row << shift_ | column); }
    Point point(Index v) const { return {double(v & ((1 << shift_) - 1)), double(v >> shift_)}; }
    bool may_turn(Index v) const {
        const int row = v >> shift_, column = v & ((1 << shift_) - 1);
        return grid_.blocked(row, column) + grid_.blocked(row, column - 1) + grid_.blocked(row - 1, column) +
                   grid_.blocked(row - 1, column - 1) ==
               1;
    }

    // Counterclockwise: along the bottom to the right, along the top to the left.
    Index tail(const Door& d) const { return vertex(line_of(d), d.is_top() ? d.end : d.begin); }
    Index head(const Door& d) const { return vertex(line_of(d), d.is_top() ? d.begin : d.end); }
    Door across(const Door& d) const { return {d.is_top() ? d.side + 1 : d.side - 1, d.begin, d.end}; }
    bool is_side(const Door& d, const Run& run) const {
        return d.row() == run.row && d.begin >= run.begin && d.end <= run.end;
    }
    // Distinguishes the doors with a corner on the same side.
    Index name(const Door& d) const { return d.is_top(); }
    bool leads_on(const Door& d) const {
        const int near = d.is_top() ? d.row() + 1 : d.row() - 1, far = d.is_top() ? d.row() - 1 : d.row() + 1;
        if (first_open(d.row(), far, d.begin) < d.end) return true;
        const int begin = first_of_run(d.row(), d.begin), end = end_of_run(d.row(), d.begin);
        return first_open(d.row(), far, d.end) < end || first_open(d.row(), near, d.end) < end ||
               (begin < d.begin &&
                (first_open(d.row(), far, begin) < d.begin || first_open(d.row(), near, begin) < d.begin));
    }
    template <class Visit>
    void visit_doors(const Run& run, Visit visit) const {
        visit_line(run, false, run.begin, run.end, visit);
        visit_line(run, true, run.begin, run.end, visit);
    }
    // Looks for doors only as far as a view may reach: beyond, between its lines; beside the door of entry
    // where it turns there or goes along.
    template <class View, class Visit>
    void visit_doors_beyond(const Door& entry, const View& view, Visit visit) const {
        const Run run = {entry.row(), first_of_run(entry.row(), entry.begin),
                         end_of_run(entry.row(), entry.begin)};
        const double near = line_of(entry), far = entry.is_top() ? near - 1 : near + 1;
        // Who enters by the bottom has greater columns on the right.
        const bool bounded_below = entry.is_top() ? view.is_bounded_right() : view.is_bounded_left();
        const bool bounded_above = entry.is_top() ? view.is_bounded_left() : view.is_bounded_right();
        const bool is_along = view.root().y == near;
        const int begin =
            bounded_below ? from_where(entry.is_top() ? view.right() : view.left(), far, -1, run) : run.begin;
        const int end =
            bounded_above ? from_where(entry.is_top() ? view.left() : view.right(), far, 1, run) : run.end;
        visit_line(run, !entry.is_top(), begin, end, visit);
        if (is_along || (entry.is_top() ? view.right_open : view.left_open))
            visit_line(run, entry.is_top(), run.begin, entry.begin, visit);
        if (is_along || (entry.is_top() ? view.left_open : view.right_open))
            visit_line(run, entry.is_top(), entry.end, run.end, visit);
    }

  private:
    const BitGrid& grid_;
    int shift_;

    static int line_of(const Door& d) { return d.is_top() ? d.row() + 1 : d.row(); }

    // Where a line through two points meets the row line y, a column farther on that side, inside the run.
    static int from_where(const std::pair<Point, Point>& line, double y, int farther, const Run& run) {
        const Point along = line.second - line.first;
        const double x = along.y == 0 ? std::numeric_limits<double>::infinity() * farther
                                      : line.first.x + along.x * ((y - line.first.y) / along.y);
        const double whole = farther < 0 ? std::floor(x) - 1 : std::ceil(x) + 1;
        return int(std::clamp(whole, double(run.begin), double(run.end)));
    }

    // Visits the doors of a run at its top or bottom that have a part between two columns.
    template <class Visit>
    void visit_line(const Run& run, bool is_top, int from, int to, Visit visit) const {
        const int other = is_top ? run.row + 1 : run.row - 1;
        int begin = first_open(run.row, other, from);
        if (begin == from && from > run.begin) begin = first_of_door(run.row, other, from);
        while (begin < to && begin < run.end) {
            const int end = end_of_door(run.row, other, begin);
            visit(Door{2 * run.row + is_top, begin, end});
            begin = first_open(run.row, other, end);
        }
    }

    // The words of one row, or of what two have in common, for scans.
    auto blocked_in(int row) const {
        return [line = grid_.row(row)](std::size_t k) { return line[k]; };
    }
    auto blocked_in(int row, int other) const {
        return [a = grid_.row(row), b = grid_.row(other)](std::size_t k) { return a[k] | b[k]; };
    }
    int end_of_run(int row, int column) const { return first_set(blocked_in(row), column); }
    int first_of_run(int row, int column) const { return 1 + last_set(blocked_in(row), column); }
    // Where two rows are both free: from a column on, up to the end of the row; and how far.
    int first_open(int row, int other, int column) const {
        return first_clear(blocked_in(row, other), column, grid_.columns());
    }
    int end_of_door(int row, int other, int column) const {
        return first_set(blocked_in(row, other), column);
    }
    int first_of_door(int row, int other, int column) const {
        return 1 + last_set(blocked_in(row, other), column);
    }
};

}  // namespace cspace::maps
