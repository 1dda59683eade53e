// Coverage to and fro: a robot carries a bar across the lines along which it drives and leaves no place
// unswept that it can reach by moves along and across the lines.
//
// Regions are taken nearest first, by the way that the robot has to drive; within one, every line that is a
// bar's width from the last. Where walls end the bar, what is left behind them is swept last.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::navigation {

// Free space cut into regions that a robot can sweep to and fro (Choset & Pignon 1997): a new region begins
// wherever the free part of a line splits, joins, appears or ends.

// A grid as the sweep sees it: lines along which the robot drives, numbered across.

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

// A part of a line without obstacles, both ends included.
struct FreeRun {
    int line, first, last;
    int region;
};

using SweepRegion = std::vector<FreeRun>;  // one on each of its lines, in order

struct Decomposition {
    std::vector<SweepRegion> regions;
    std::vector<std::int32_t> region_of;  // of each place, −1 where it is not to be swept
};

// reach: which places are to be swept.
inline std::vector<FreeRun> free_runs(const SweepFrame& frame, const std::vector<char>& reach, int line) {
    std::vector<FreeRun> runs;
    for (int at = 0; at < frame.length(); ++at) {
        if (!reach[std::size_t(frame.number(line, at))]) continue;
        const int first = at;
        while (at + 1 < frame.length() && reach[std::size_t(frame.number(line, at + 1))]) ++at;
        runs.push_back({line, first, at, -1});
    }
    return runs;
}

inline Decomposition decompose_frame(const SweepFrame& frame, const std::vector<char>& reach) {
    Decomposition made;
    made.region_of = filled_vector<std::int32_t>(std::size_t(frame.size()), -1);
    std::vector<FreeRun> before;
    InterruptPoll poll(4);
    for (int line = 0; line < frame.lines(); ++line) {
        poll.step();
        std::vector<FreeRun> runs = free_runs(frame, reach, line);
        std::vector<int> ahead(before.size()), back(runs.size()), behind(runs.size(), -1);
        std::size_t from = 0;
        for (std::size_t k = 0; k < runs.size(); ++k) {
            while (from < before.size() && before[from].last < runs[k].first) ++from;
            for (std::size_t b = from; b < before.size() && before[b].first <= runs[k].last; ++b)
                ++ahead[b], ++back[k], behind[k] = int(b);
        }
        for (std::size_t k = 0; k < runs.size(); ++k) {
            const bool goes_on = back[k] == 1 && ahead[std::size_t(behind[k])] == 1;
            runs[k].region = goes_on ? before[std::size_t(behind[k])].region : int(made.regions.size());
            if (!goes_on) made.regions.emplace_back();
            made.regions[std::size_t(runs[k].region)].push_back(runs[k]);
            for (int at = runs[k].first; at <= runs[k].last; ++at)
                made.region_of[std::size_t(frame.number(line, at))] = runs[k].region;
        }
        before = std::move(runs);
    }
    return made;
}

struct Coverage {
    std::vector<maps::Cell> path;          // cell by cell
    std::vector<std::int32_t> region;      // of each cell of the grid, row by row; −1 not reached
    std::vector<std::int32_t> order;       // in which the regions are entered
    std::vector<std::uint32_t> passes;     // how often the bar came over each cell, row by row
    std::int64_t reached = 0, free = 0;    // cells
    std::int64_t lanes = 0, leftover = 0;  // lines driven, and places that needed a separate path
};

class Coverer {
  public:
    // half: how many cells the bar reaches to either side of the robot's own.
    Coverer(const SweepFrame& frame, int half)
        : frame_(frame), half_(half), size_(std::size_t(frame.size())) {}

    Coverage cover(maps::Cell start) {
        here_ = frame_.number(start);
        reach_ = filled_vector<char>(size_);
        passes_ = filled_vector<std::uint32_t>(size_);
        stamp_ = filled_vector<std::uint32_t>(size_);
        from_ = filled_vector<std::int32_t>(size_, -1);
        visit_range(0, size_, [&](std::size_t k) {
            out_.free += frame_.free(frame_.line_of(std::int32_t(k)), frame_.place_of(std::int32_t(k)));
        });
        search([](std::int32_t) { return false; });
        for (const std::int32_t place : queue_) reach_[std::size_t(place)] = 1;
        out_.reached = std::int64_t(queue_.size());
        const Decomposition cut = decompose_frame(frame_, reach_);
        step_to(here_, true);
        sweep_regions(cut);
        sweep_leftovers();
        tell(cut);
        return std::move(out_);
    }

  private:
    // The lines of a region that are driven: a bar's width apart, the first and last within it.
    std::vector<FreeRun> lanes_of(const SweepRegion& region) const {
        std::vector<FreeRun> lanes;
        const int count = int(region.size());
        for (int first = 0; first < count; first += 2 * half_ + 1) {
            const bool whole = first + 2 * half_ < count;
            lanes.push_back(region[std::size_t(whole ? first + half_ : (first + count - 1) / 2)]);
        }
        return lanes;
    }

    void sweep_regions(const Decomposition& cut) {
        std::vector<std::vector<FreeRun>> lanes;
        for (const SweepRegion& region : cut.regions) lanes.push_back(lanes_of(region));
        // The places at which a region can be begun: both ends of its first lane and of its last.
        auto door = filled_vector<std::int32_t>(size_, -1);
        const auto doors = [&](std::size_t k, auto&& use) {
            for (const FreeRun& lane : {lanes[k].front(), lanes[k].back()})
                for (const int at : {lane.first, lane.last}) use(frame_.number(lane.line, at));
        };
        for (std::size_t k = 0; k < lanes.size(); ++k)
            doors(k, [&](std::int32_t place) { door[std::size_t(place)] = std::int32_t(k); });
        for (std::size_t done = 0; done < lanes.size(); ++done) {
            go(search([&](std::int32_t place) { return door[std::size_t(place)] >= 0; }));
            const std::size_t k = std::size_t(door[std::size_t(here_)]);
            doors(k, [&](std::int32_t place) { door[std::size_t(place)] = -1; });
            out_.order.push_back(std::int32_t(k));
            if (frame_.line_of(here_) != lanes[k].front().line)
                std::reverse(lanes[k].begin(), lanes[k].end());
            for (const FreeRun& lane : lanes[k]) drive(lane);
        }
    }

    // To the nearer end of a line, and along it to the other.
    void drive(const FreeRun& lane) {
        const std::int32_t first = frame_.number(lane.line, lane.first),
                           last = frame_.number(lane.line, lane.last);
        go(search([&](std::int32_t place) { return place == first || place == last; }));
        const int step = here_ == first ? 1 : -1;
        while (here_ != (step > 0 ? last : first)) step_to(here_ + step);
        ++out_.lanes;
    }

    void sweep_leftovers() {
        const auto unswept = [&](std::int32_t place) {
            return reach_[std::size_t(place)] && passes_[std::size_t(place)] == 0;
        };
        visit_range(0, size_, [&](std::size_t k) { out_.leftover += unswept(std::int32_t(k)); });
        for (std::int32_t next; (next = search(unswept)) >= 0;) go(next);
    }

    // The nearest place that is wanted, −1 if there is none; from_ leads back to the robot.
    template <class Wanted>
    std::int32_t search(const Wanted& wanted) {
        ++now_;
        queue_.assign(1, here_);
        stamp_[std::size_t(here_)] = now_;
        if (wanted(here_)) return here_;
        for (std::size_t k = 0; k < queue_.size(); ++k) {
            poll_.step();
            const int line = frame_.line_of(queue_[k]), at = frame_.place_of(queue_[k]);
            for (const auto& [dl, da] :
                 {std::pair{0, 1}, std::pair{0, -1}, std::pair{1, 0}, std::pair{-1, 0}}) {
                if (!frame_.free(line + dl, at + da)) continue;
                const std::int32_t next = frame_.number(line + dl, at + da);
                if (stamp_[std::size_t(next)] == now_) continue;
                stamp_[std::size_t(next)] = now_;
                from_[std::size_t(next)] = queue_[k];
                if (wanted(next)) return next;
                queue_.push_back(next);
            }
        }
        return -1;
    }

    // Drives the way of the last search.
    void go(std::int32_t to) {
        std::vector<std::int32_t> way;
        for (std::int32_t at = to; at != here_; at = from_[std::size_t(at)]) way.push_back(at);
        for (auto place = way.rbegin(); place != way.rend(); ++place) step_to(*place);
    }

    // One step; the bar comes over what it did not lie on before.
    void step_to(std::int32_t next, bool first = false) {
        poll_.step();
        const int at = frame_.place_of(next), line = frame_.line_of(next);
        int low = line, high = line;
        while (low > line - half_ && frame_.free(low - 1, at)) --low;
        while (high < line + half_ && frame_.free(high + 1, at)) ++high;
        const bool beside = !first && frame_.place_of(here_) == at;
        for (int k = low; k <= high; ++k)
            if (!beside || k < low_ || k > high_) ++passes_[std::size_t(frame_.number(k, at))];
        low_ = low, high_ = high;
        here_ = next;
        out_.path.push_back(frame_.cell(next));
    }

    void tell(const Decomposition& cut) {
        out_.region = filled_vector<std::int32_t>(size_, -1);
        out_.passes = filled_vector<std::uint32_t>(size_);
        const int columns = frame_.cell(frame_.size() - 1).column + 1;
        visit_range(0, size_, [&](std::size_t k) {
            const maps::Cell cell = frame_.cell(std::int32_t(k));
            const std::size_t to = std::size_t(cell.row) * std::size_t(columns) + std::size_t(cell.column);
            out_.region[to] = cut.region_of[k];
            out_.passes[to] = passes_[k];
        });
    }

    SweepFrame frame_;
    int half_;
    std::size_t size_;
    std::int32_t here_ = 0;
    int low_ = 0, high_ = -1;  // where the bar lies
    std::vector<char> reach_;
    std::vector<std::uint32_t> passes_, stamp_;
    std::uint32_t now_ = 0;
    InterruptPoll poll_{1024};
    std::vector<std::int32_t> queue_, from_;
    Coverage out_;
};

// along: the lines are the grid's rows (true) or its columns.
inline Coverage cover_cells(const maps::BitGrid& grid, maps::Cell start, int half, bool along_rows) {
    return Coverer(SweepFrame(grid, along_rows), half).cover(start);
}

}  // namespace cspace::navigation
