// A path through the free leaves of a quadtree, which is refined where only mixed leaves would connect
// (Latombe 1991, section 5.3).
#pragma once

#include "cspace/navigation/cells/quadtree.hpp"
#include "cspace/navigation/sampling/sight.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

struct CellOptions {
    int depth = 6;           // mixed leaves are split down to this level first,
    int most_depth = 12;     // and, if the result is then undetermined, to this one
    bool refine = true;      // false: the result stays undetermined
    bool uniform = false;    // free leaves are split as well
    bool manhattan = false;  // the metric of the search
    std::size_t most_cells = std::size_t(1) << 22;
};

class ApproximateCells {
  public:
    // kept: what other questions have split already; a record of the search is of one that splits anew.
    ApproximateCells(const maps::PolygonWorld& world, const CellOptions& options, Trace* trace = nullptr,
                     CellStages* kept = nullptr)
        : world_(world), options_(options), trace_(trace) {
        const auto make = [&] { return first_stage(); };
        stage_ = kept && !trace
                     ? kept->of({options_.depth, options_.most_depth, options_.uniform, options_.most_cells},
                                make, search::most_kept_bytes)
                     : make();
        options_.most_depth = std::min(options_.most_depth, tree().deepest());
    }

    const Quadtree& tree() const { return stage_->tree; }

    CellRoute solve(Point start, Point goal) {
        CellRoute answer;
        if (start == goal) {
            answer.route.status = Status::found;
            answer.route.path = {start, goal};
            answer.route.length = 0;
        }
        while (answer.route.status != Status::found) {
            answer.route.stats.edges += std::int64_t(doors().size());
            tree().leaves_at(start, at_start_);
            tree().leaves_at(goal, at_goal_);
            if (search(start, goal, answer.route)) break;
            answer.route.status = Status::unreachable;
            if (!join()) break;
            answer.route.status = Status::undetermined;
            if (!options_.refine || !refine()) break;
        }
        answer.leaves = stage_->leaves, answer.depth = stage_->depth;
        return answer;
    }

  private:
    enum : std::int8_t { expand_word = 2 };
    const maps::PolygonWorld& world_;
    CellOptions options_;
    Trace* trace_;
    std::shared_ptr<const CellStage> stage_;
    std::vector<maps::Index> at_start_, at_goal_, part_;
    std::vector<std::uint8_t> connecting_;  // of each root: whether its leaves contain start and goal

    const std::vector<CellDoor>& doors() const { return stage_->doors; }

    std::size_t root(maps::Index c) {
        while (part_[std::size_t(c)] != c)
            c = part_[std::size_t(c)] = part_[std::size_t(part_[std::size_t(c)])];
        return std::size_t(c);
    }

    std::shared_ptr<const CellStage> first_stage() const {
        Quadtree tree(world_, trace_);
        const int last = std::min({options_.depth, options_.most_depth, tree.deepest()});
        for (int level = 0; level < last; ++level)
            for (const maps::Index c : to_split(tree, [](maps::Index) { return true; }, level + 1))
                tree.split(c);
        return std::make_shared<const CellStage>(std::move(tree));
    }

    // The leaves above a level that may hide a path; none if they are too many.
    template <class Wanted>
    std::vector<maps::Index> to_split(const Quadtree& tree, Wanted wanted, int level) const {
        std::vector<maps::Index> chosen;
        for (maps::Index c = 0; c < maps::Index(tree.cells().size()); ++c) {
            const QuadCell& cell = tree[c];
            const bool can_be =
                cell.kind == QuadCell::mixed || (options_.uniform && cell.kind == QuadCell::free);
            if (tree.is_leaf(c) && can_be && cell.level < level && wanted(c)) chosen.push_back(c);
        }
        if (tree.cells().size() + 4 * chosen.size() > options_.most_cells) chosen.clear();
        return chosen;
    }

    // Splits the leaves that may hide the way, once each; false where there are none, or too many.
    bool refine() {
        const auto connects = [&](maps::Index c) { return options_.uniform || connecting_[root(c)]; };
        const std::vector<maps::Index> chosen = to_split(tree(), connects, options_.most_depth);
        if (chosen.empty()) return false;
        stage_ = stage_->next.of(
            chosen,
            [&] {
                Quadtree tree = stage_->tree;
                for (const maps::Index c : chosen) tree.split(c);
                return std::make_shared<const CellStage>(std::move(tree));
            },
            search::most_kept_bytes);
        return true;
    }

    // Joins leaves that doors connect, mixed ones too; whether start and goal then hang together.
    bool join() {
        part_.resize(tree().cells().size());
        std::iota(part_.begin(), part_.end(), 0);
        for (const CellDoor& d : doors()) part_[root(d.one)] = maps::Index(root(d.other));
        std::vector<std::uint8_t> from(part_.size(), 0);
        connecting_.assign(part_.size(), 0);
        const auto is_full = [&](maps::Index c) { return tree()[c].kind == QuadCell::full; };
        for (const maps::Index c : at_start_) from[root(c)] = !is_full(c);
        bool joined = false;
        for (const maps::Index c : at_goal_)
            if (!is_full(c) && from[root(c)]) connecting_[root(c)] = 1, joined = true;
        return joined;
    }

    double metric(Point a, Point b) const {
        return options_.manhattan ? std::abs(b.x - a.x) + std::abs(b.y - a.y) : distance(a, b);
    }

    // A* over the doors of free leaves.
    struct Space {
        const ApproximateCells& cells;
        Point start, goal;
        Trace* trace;
        search::Ways ways;                     // to each door, and to the goal
        std::vector<std::uint8_t> holds_goal;  // each leaf

        std::uint32_t last() const { return std::uint32_t(cells.doors().size()); }
        Point at(std::uint32_t node) const { return node == last() ? goal : cells.doors()[node].at; }
        bool is_goal(std::uint32_t node) const { return node == last(); }
        bool settle(std::uint32_t node) {
            if (!ways.settle(node)) return false;
            const std::uint32_t before = ways.before(node);
            if (trace)
                trace->push_back(
                    {expand_word, before == search::no_node ? start : at(before), at(node), ways.cost(node)});
            return true;
        }
        void reach(std::uint32_t node, double g, std::uint32_t before, search::PriorityQueue& queue) {
            if (ways.improve(node, g, before))
                queue.push({g + cells.metric(at(node), goal), float(-g), node});
        }
        // What can be reached from a point of a leaf.
        void leave(maps::Index c, Point from, double g, std::uint32_t before, search::PriorityQueue& queue) {
            const std::size_t leaf = std::size_t(c);
            if (holds_goal[leaf]) reach(last(), g + cells.metric(from, goal), before, queue);
            const CellStage& stage = *cells.stage_;
            for (const std::uint32_t door : stage.open.of(leaf))
                reach(door, g + cells.metric(from, at(door)), before, queue);
        }
        void expand(std::uint32_t node, search::PriorityQueue& queue) {
            const CellDoor& d = cells.doors()[node];
            for (const maps::Index c : {d.one, d.other}) leave(c, d.at, ways.cost(node), node, queue);
        }
    };

    // Where an end enters free leaves: itself, or if none holds it the middle of one nearby that it sees.
    struct Entry {
        Point at;
        std::vector<maps::Index> leaves;
    };
    Entry entry_of(Point end, const std::vector<maps::Index>& leaves) const {
        Entry entry{end, {}};
        const auto is_free = [&](maps::Index c) { return tree()[c].kind == QuadCell::free; };
        std::copy_if(leaves.begin(), leaves.end(), std::back_inserter(entry.leaves), is_free);
        if (!entry.leaves.empty()) return entry;
        constexpr std::size_t most_tried = 24;
        std::vector<std::pair<double, maps::Index>> near;
        for (maps::Index c = 0; c < maps::Index(tree().cells().size()); ++c)
            if (tree().is_leaf(c) && is_free(c)) near.push_back({distance(end, middle_of(c)), c});
        const std::size_t count = std::min(most_tried, near.size());
        std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(count), near.end());
        const maps::Settled settled = world_.settle(end, 0);
        for (std::size_t i = 0; i < count; ++i)
            for (const maps::Index t : settled.triangles)
                if (sampling::end_of_sight(world_.space, {end, t}, middle_of(near[i].second)) != maps::none)
                    return {middle_of(near[i].second), {near[i].second}};
        return entry;
    }
    Point middle_of(maps::Index c) const { return 0.5 * (tree().low(tree()[c]) + tree().high(tree()[c])); }

    bool search(Point start, Point goal, Route& route) const {
        const Entry from = entry_of(start, at_start_), to = entry_of(goal, at_goal_);
        if (from.leaves.empty() || to.leaves.empty()) return false;
        Space space{*this, from.at, to.at, trace_, search::Ways(doors().size() + 1), {}};
        space.holds_goal.assign(tree().cells().size(), 0);
        for (const maps::Index c : to.leaves) space.holds_goal[std::size_t(c)] = 1;
        search::PriorityQueue queue;
        for (const maps::Index c : from.leaves) space.leave(c, from.at, 0, search::no_node, queue);
        search::Effort effort;
        const std::uint32_t reached = search::best_first(space, queue, effort);
        route.stats.nodes += std::int64_t(effort.settled);
        if (reached == search::no_node) return false;
        route.path = {goal};
        const auto add = [&](Point p) {
            if (route.path.back() != p) route.path.push_back(p);
        };
        for (std::uint32_t node = reached; node != search::no_node; node = space.ways.before(node))
            add(space.at(node));
        add(from.at);
        add(start);
        if (route.path.size() == 1) route.path.push_back(start);
        finish_reversed(route);
        return true;
    }
};

}  // namespace cspace::navigation
