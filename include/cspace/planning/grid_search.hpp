// Best-first search over a grid of configurations: starts and goals are joined to the corners of their cells
// and to each other, neighbours to each other, by edges that are checked when a search comes to them.
//
// A Space offers
//   width(), distance(a, b)        of rows of floats
//   is_free(a, b)                  an edge
//   check_rows(rows, blocked)      configurations, several at a time
//   estimate(q)                    of the cost from there to a goal
//   has_time()
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "cspace/planning/joint_grid.hpp"
#include "cspace/search/best_first.hpp"
#include "cspace/search/paged_table.hpp"

namespace cspace::planning {

// The order in which open nodes are expanded: by g + h, by g, by h, or as they come.
enum class GridOrder { a_star, dijkstra, best_first, breadth_first };

template <class Space>
class GridSearch {
  public:
    using Row = std::array<float, most_grid_joints>;

    // reopens: h may fall faster than an edge costs, so a node that was expanded may be reached at less cost.
    GridSearch(Space& space, const JointGrid& grid, GridOrder order, bool reopens, int reach)
        : space_(space),
          grid_(grid),
          order_(order),
          reopens_(reopens && order == GridOrder::a_star),
          moves_(grid.list_moves(reach)) {}

    void add_start(const float* q) { starts_.push_back(row_of(q)); }
    void add_goal(const float* q) {
        const std::uint32_t goal = std::uint32_t(goals_.size());
        goals_.push_back(row_of(q));
        grid_.visit_corners(q, [&](std::uint32_t node) { entries_.push_back({node, goal}); });
        std::sort(entries_.begin(), entries_.end());
    }

    // Whether a goal was reached; at most so many edges are checked.
    bool run(std::int64_t most_edges) {
        most_edges_ = most_edges;
        notes_.begin(first_goal() + goals_.size());
        if (order_ == GridOrder::breadth_first) {
            search::Waves waves;
            return search_by(waves);
        }
        search::PriorityQueue queue;
        return search_by(queue);
    }
    // Of the last run, from a start to a goal: numbers of nodes.
    std::vector<std::uint32_t> path() const { return path_; }
    std::uint32_t start_of(std::uint32_t node) const { return node - std::uint32_t(grid_.size()); }
    std::uint32_t goal_of(std::uint32_t node) const { return node - first_goal(); }
    void write_row(std::uint32_t node, float* q) const {
        if (node < grid_.size()) return grid_.write_row(node, q);
        const Row& row = node < first_goal() ? starts_[start_of(node)] : goals_[goal_of(node)];
        std::copy_n(row.begin(), space_.width(), q);
    }
    // The edge is no longer taken.
    void ban_edge(std::uint32_t a, std::uint32_t b) { banned_.insert(key_of(a, b)); }

    bool is_out_of_edges() const { return is_out_of_edges_; }
    std::int64_t edges() const { return edges_; }
    std::int64_t blocked() const { return blocked_; }
    std::int64_t reached() const { return reached_; }
    std::uint64_t expansions() const { return effort_.settled; }
    // The node of the least estimate that was expanded; no_node before any was.
    std::uint32_t nearest() const { return nearest_; }

    // The interface of search::best_first.
    bool settle(std::uint32_t node) {
        Note& note = notes_[node];
        if (note.is_settled) return false;
        note.is_settled = true;
        if (nearest_ == search::no_node || note.estimate < notes_[nearest_].estimate) nearest_ = node;
        return true;
    }
    bool is_goal(std::uint32_t node) const { return node >= first_goal(); }
    template <class Queue>
    void expand(std::uint32_t node, Queue& queue) {
        gather(node);
        check_found();
        Row from, to;
        write_row(node, from.data());
        for (const std::uint32_t next : found_) {
            if (!space_.has_time() || edges_ >= most_edges_) {
                is_out_of_edges_ = edges_ >= most_edges_;
                queue.clear();
                return;
            }
            write_row(next, to.data());
            join(node, next, from.data(), to.data(), queue);
        }
    }

  private:
    enum class State : std::uint8_t { unknown, free, blocked };
    struct Note {
        double cost = 0;
        float estimate = 0;
        std::uint32_t before = search::no_node;
        State state = State::unknown;
        bool is_reached = false, is_settled = false;
    };

    Space& space_;
    const JointGrid& grid_;
    GridOrder order_;
    bool reopens_;
    std::vector<JointGrid::Steps> moves_;
    std::vector<Row> starts_, goals_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> entries_;  // corners of goals' cells, sorted
    std::unordered_set<std::uint64_t> banned_;
    search::PagedTable<Note> notes_;
    search::Effort effort_;
    std::vector<std::uint32_t> found_, unknown_, path_;
    std::vector<float> rows_;
    std::vector<std::uint8_t> blocked_rows_;
    std::int64_t edges_ = 0, blocked_ = 0, reached_ = 0, most_edges_ = 0;
    bool is_out_of_edges_ = false;
    std::uint32_t nearest_ = search::no_node;

    std::uint32_t first_goal() const { return std::uint32_t(grid_.size() + starts_.size()); }
    static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
    }
    Row row_of(const float* q) const {
        Row row = {};
        std::copy_n(q, space_.width(), row.begin());
        return row;
    }

    template <class Queue>
    bool search_by(Queue& queue) {
        nearest_ = search::no_node;
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            const std::uint32_t node = std::uint32_t(grid_.size() + i);
            Note& note = notes_[node];
            note.is_reached = true, note.state = State::free;
            note.estimate = float(space_.estimate(starts_[i].data()));
            queue.push(rank(note, node));
        }
        const std::uint32_t goal = search::best_first(*this, queue, effort_);
        path_.clear();
        for (std::uint32_t node = goal; node != search::no_node; node = notes_[node].before)
            path_.push_back(node);
        std::reverse(path_.begin(), path_.end());
        return goal != search::no_node;
    }
    search::Waiting rank(const Note& note, std::uint32_t node) const {
        const double h = double(note.estimate);
        switch (order_) {
            case GridOrder::a_star:
                return {note.cost + h, note.estimate, node};
            case GridOrder::dijkstra:
                return {note.cost, 0, node};
            default:
                return {h, 0, node};
        }
    }
    double length_of(const float* a, const float* b) const {
        return order_ == GridOrder::breadth_first ? 1.0 : space_.distance(a, b);
    }

    // The nodes to which an edge may lead.
    void gather(std::uint32_t node) {
        found_.clear();
        const auto add = [&](std::uint32_t next) { found_.push_back(next); };
        if (node < grid_.size()) {
            grid_.visit_neighbours(node, moves_, add);
            auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair(node, 0u));
            for (; at != entries_.end() && at->first == node; ++at) add(first_goal() + at->second);
            return;
        }
        grid_.visit_corners(starts_[start_of(node)].data(), add);
        for (std::uint32_t goal = 0; goal < goals_.size(); ++goal) add(first_goal() + goal);
    }
    // Checks the configurations of those that no search has come to, and keeps the free ones.
    void check_found() {
        unknown_.clear(), rows_.clear();
        for (const std::uint32_t next : found_)
            if (next < grid_.size() && notes_[next].state == State::unknown) unknown_.push_back(next);
        Row row;
        for (const std::uint32_t next : unknown_) {
            grid_.write_row(next, row.data());
            rows_.insert(rows_.end(), row.begin(), row.begin() + std::ptrdiff_t(space_.width()));
        }
        blocked_rows_.resize(unknown_.size());
        if (!unknown_.empty()) space_.check_rows(rows_, blocked_rows_);
        for (std::size_t i = 0; i < unknown_.size(); ++i)
            notes_[unknown_[i]].state = blocked_rows_[i] ? State::blocked : State::free;
        std::erase_if(found_, [&](std::uint32_t next) { return notes_[next].state == State::blocked; });
    }
    template <class Queue>
    void join(std::uint32_t node, std::uint32_t next, const float* from, const float* to, Queue& queue) {
        Note& note = notes_[next];
        if (note.is_settled && !reopens_) return;
        const double cost = notes_[node].cost + length_of(from, to);
        if (note.is_reached && !(cost < note.cost)) return;
        if (banned_.contains(key_of(node, next))) return;
        ++edges_;
        if (!space_.is_free(from, to)) return void(++blocked_);
        if (!note.is_reached) {
            ++reached_;
            note.is_reached = true;
            note.estimate = is_goal(next) ? 0.0f : float(space_.estimate(to));
        }
        note.cost = cost, note.before = node, note.is_settled = false;
        queue.push(rank(note, next));
    }
};

}  // namespace cspace::planning
