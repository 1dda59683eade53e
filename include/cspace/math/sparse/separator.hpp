// Vertex separators of weighted graphs: few nodes that leave two parts of about the same weight (Karypis &
// Kumar 1998, "A fast and high quality multilevel scheme for partitioning irregular graphs"; Hendrickson &
// Rothberg 1998, "Improving the run time and quality of nested dissection ordering").
//
// The graph is made coarser by merging neighbours, separated where it is small, and the separator is refined
// on the way back: a node that leaves it for one part pulls its neighbours of the other part in (Fiduccia &
// Mattheyses 1982).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace {

// A graph whose nodes and edges have weights.
struct WeightedGraph {
    std::vector<int> weights;
    std::vector<std::size_t> starts{0};  // of the neighbours of each node, and their number
    std::vector<int> neighbours;         // each pair in both directions
    std::vector<int> strengths;          // of each neighbour

    int nodes() const { return int(weights.size()); }
    // visit(neighbour, strength)
    template <class Visit>
    void visit_neighbours(int node, const Visit& visit) const {
        for (std::size_t k = starts[std::size_t(node)]; k < starts[std::size_t(node) + 1]; ++k)
            visit(neighbours[k], strengths[k]);
    }
};

enum class Part : std::uint8_t { left, right, separator };

namespace separators {

inline constexpr double largest_part = 0.65;  // of all weights; more balance costs larger separators
inline constexpr int coarse_nodes = 100;      // a graph of so many is separated directly
inline constexpr double uneven_nodes =
    1.5;  // largest weight of a coarse node, against the mean of the coarsest
inline constexpr double least_shrinking = 0.95;  // nodes of a coarser graph against those of the finer one
inline constexpr std::size_t most_levels = 40;   // of coarser graphs
inline constexpr int seeds = 8;                  // separators grown on the coarsest graph; the least is kept
inline constexpr int many_nodes = 4000;  // above it, separators of a coarser graph are tried several times
inline constexpr int tries = 8;          // which are cheap there, and all that is left is to refine
inline constexpr int most_passes = 10;   // of refinement, on each graph
inline constexpr int patience = 300;     // moves without a gain, before a pass ends

// Numbers that look random, the same on every machine (Knuth's linear congruential generator MMIX).
class Draws {
  public:
    int below(int n) {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return int((state_ >> 33) % std::uint64_t(n));
    }

  private:
    std::uint64_t state_ = 1;
};

// A separator of a graph, and how moves change it.
class Separator {
  public:
    explicit Separator(const WeightedGraph& graph)
        : graph_(&graph),
          part_(std::size_t(graph.nodes()), Part::right),
          pull_{std::vector<int>(std::size_t(graph.nodes()), 0),
                std::vector<int>(std::size_t(graph.nodes()), 0)},
          is_locked_(std::size_t(graph.nodes()), 0) {
        for (int weight : graph.weights) total_ += weight;
        largest_ = std::max(int(largest_part * total_), total_ / 2 + 1);
    }

    const std::vector<Part>& parts() const { return part_; }
    int weight(Part part) const { return weight_[std::size_t(part)]; }
    // Less is better: the weight of the separator, then how uneven the parts are.
    std::pair<int, int> score() const {
        const int uneven = std::abs(weight_[0] - weight_[1]);
        const bool is_uneven = std::max(weight_[0], weight_[1]) > largest_;
        return {is_uneven ? total_ + uneven : weight_[2], uneven};
    }

    // Grows the left part from a seed until it is as large as the right one.
    void grow(Draws& draws) {
        std::fill(part_.begin(), part_.end(), Part::right);
        set_weights();
        queue_[0] = {};
        int next = draws.below(graph_->nodes());
        while (weight_[0] < weight_[1]) {
            int node = take_node(Part::left);
            if (node < 0) {  // the next seed, where the graph is in parts
                while (part_[std::size_t(next)] != Part::right) next = (next + 1) % graph_->nodes();
                enter_separator(next);
                continue;
            }
            move_node(node, Part::left);
        }
        queue_[0] = {};
    }
    // The parts of a coarser graph.
    void project(const Separator& coarse, const std::vector<int>& coarse_node) {
        for (std::size_t k = 0; k < part_.size(); ++k) part_[k] = coarse.part_[std::size_t(coarse_node[k])];
        set_weights();
    }

    void refine() {
        for (int pass = 0; pass < most_passes; ++pass) {
            if (!run_pass()) break;
        }
    }

  private:
    struct Candidate {
        int gain, node;
        bool operator<(const Candidate& other) const {
            return gain != other.gain ? gain < other.gain : node < other.node;
        }
    };
    struct Move {
        int node;
        Part to;
        std::size_t pulled;  // begin of what it pulled in
    };
    static Part other(Part part) { return part == Part::left ? Part::right : Part::left; }

    int gain(int node, Part to) const {
        return graph_->weights[std::size_t(node)] - pull_[std::size_t(other(to))][std::size_t(node)];
    }
    void set_weights() {
        weight_[0] = weight_[1] = weight_[2] = 0;
        for (int node = 0; node < graph_->nodes(); ++node) {
            weight_[std::size_t(part_[std::size_t(node)])] += graph_->weights[std::size_t(node)];
            pull_[0][std::size_t(node)] = pull_[1][std::size_t(node)] = 0;
            graph_->visit_neighbours(node, [&](int i, int) {
                const Part part = part_[std::size_t(i)];
                if (part != Part::separator)
                    pull_[std::size_t(part)][std::size_t(node)] += graph_->weights[std::size_t(i)];
            });
        }
    }
    void offer(int node) {
        for (Part to : {Part::left, Part::right}) queue_[std::size_t(to)].push({gain(node, to), node});
    }
    // The best node of the separator to move; −1: none.
    int take_node(Part to) {
        auto& queue = queue_[std::size_t(to)];
        while (!queue.empty()) {
            const Candidate top = queue.top();
            if (is_current(top, to)) return queue.pop(), top.node;
            queue.pop();
        }
        return -1;
    }
    bool is_current(const Candidate& found, Part to) const {
        const auto node = std::size_t(found.node);
        return part_[node] == Part::separator && !is_locked_[node] && found.gain == gain(found.node, to);
    }
    // Changes the part of a node, and what its neighbours pull.
    void set_part(int node, Part part) {
        const int weight = graph_->weights[std::size_t(node)];
        const Part before = std::exchange(part_[std::size_t(node)], part);
        weight_[std::size_t(before)] -= weight, weight_[std::size_t(part)] += weight;
        graph_->visit_neighbours(node, [&](int i, int) {
            if (before != Part::separator) pull_[std::size_t(before)][std::size_t(i)] -= weight;
            if (part != Part::separator) pull_[std::size_t(part)][std::size_t(i)] += weight;
        });
    }
    void enter_separator(int node) {
        set_part(node, Part::separator);
        offer(node);
        offer_neighbours(node);
    }
    void offer_neighbours(int node) {
        graph_->visit_neighbours(node, [&](int i, int) {
            if (part_[std::size_t(i)] == Part::separator && !is_locked_[std::size_t(i)]) offer(i);
        });
    }
    void move_node(int node, Part to) {
        moves_.push_back({node, to, pulled_.size()});
        set_part(node, to);
        graph_->visit_neighbours(node, [&](int i, int) {
            if (part_[std::size_t(i)] == other(to)) pulled_.push_back(i);
        });
        for (std::size_t k = moves_.back().pulled; k < pulled_.size(); ++k) enter_separator(pulled_[k]);
        offer_neighbours(node);
    }
    void undo_move() {
        const Move last = moves_.back();
        moves_.pop_back();
        for (; pulled_.size() > last.pulled; pulled_.pop_back()) set_part(pulled_.back(), other(last.to));
        set_part(last.node, Part::separator);
    }
    // Moves nodes one by one, each at most once, and goes back to the best separator; whether that is better.
    bool run_pass() {
        std::fill(is_locked_.begin(), is_locked_.end(), 0);
        moves_.clear(), pulled_.clear();
        queue_[0] = {}, queue_[1] = {};
        for (int node = 0; node < graph_->nodes(); ++node) {
            if (part_[std::size_t(node)] == Part::separator) offer(node);
        }
        const auto first = score();
        auto best = first;
        std::size_t kept = 0;
        InterruptPoll poll(1 << 6);
        while (moves_.size() < kept + patience) {
            poll.step();
            Part to;
            const int node = choose_move(to);
            if (node < 0) break;
            is_locked_[std::size_t(node)] = 1;
            move_node(node, to);
            if (score() < best) best = score(), kept = moves_.size();
        }
        while (moves_.size() > kept) undo_move();
        return best < first;
    }
    // The move of most gain that keeps the parts balanced; towards the lighter part where two are the same.
    int choose_move(Part& to) {
        int node[2], value[2];
        for (Part part : {Part::left, Part::right}) {
            const auto k = std::size_t(part);
            node[k] = peek_node(part);
            value[k] = node[k] >= 0 ? gain(node[k], part) : 0;
            const bool fits =
                node[k] >= 0 && (weight_[k] + graph_->weights[std::size_t(node[k])] <= largest_ ||
                                 weight_[k] < weight_[1 - k]);
            if (!fits) node[k] = -1;
        }
        if (node[0] < 0 && node[1] < 0) return -1;
        const bool is_left =
            node[1] < 0 ||
            (node[0] >= 0 && (value[0] != value[1] ? value[0] > value[1] : weight_[0] < weight_[1]));
        to = is_left ? Part::left : Part::right;
        return take_node(to);
    }
    int peek_node(Part to) {
        auto& queue = queue_[std::size_t(to)];
        while (!queue.empty() && !is_current(queue.top(), to)) queue.pop();
        return queue.empty() ? -1 : queue.top().node;
    }

    const WeightedGraph* graph_;
    std::vector<Part> part_;
    std::vector<int> pull_[2];  // weights of the neighbours in each part
    std::vector<char> is_locked_;
    std::priority_queue<Candidate> queue_[2];  // with entries that are out of date
    std::vector<Move> moves_;
    std::vector<int> pulled_;
    int weight_[3] = {0, 0, 0}, total_ = 0, largest_ = 0;
};

// The node of a coarser graph for each node: pairs of neighbours, those of the strongest edges first to be
// found.
inline int match_neighbours(const WeightedGraph& graph, Draws& draws, std::vector<int>& coarse_node) {
    const int n = graph.nodes();
    int total = 0;
    for (int weight : graph.weights) total += weight;
    const int largest = int(uneven_nodes * total / coarse_nodes);
    std::vector<int> order(std::size_t(n), 0);
    for (int k = 0; k < n; ++k) {
        const int place = draws.below(k + 1);
        order[std::size_t(k)] = order[std::size_t(place)];
        order[std::size_t(place)] = k;
    }
    coarse_node.assign(std::size_t(n), -1);
    int count = 0;
    InterruptPoll poll(1 << 10);
    for (int node : order) {
        poll.step();
        if (coarse_node[std::size_t(node)] >= 0) continue;
        int best = -1, most = 0;
        graph.visit_neighbours(node, [&](int i, int strength) {
            if (coarse_node[std::size_t(i)] >= 0) return;
            if (graph.weights[std::size_t(node)] + graph.weights[std::size_t(i)] > largest) return;
            const bool is_lighter = best >= 0 && strength == most &&
                                    graph.weights[std::size_t(i)] < graph.weights[std::size_t(best)];
            if (strength > most || is_lighter) best = i, most = strength;
        });
        coarse_node[std::size_t(node)] = count;
        if (best >= 0) coarse_node[std::size_t(best)] = count;
        ++count;
    }
    return count;
}

inline WeightedGraph merge_nodes(const WeightedGraph& graph, const std::vector<int>& coarse_node, int count) {
    std::vector<int> first(std::size_t(count), -1), second(std::size_t(count), -1);
    for (int node = 0; node < graph.nodes(); ++node) {
        const auto to = std::size_t(coarse_node[std::size_t(node)]);
        (first[to] < 0 ? first : second)[to] = node;
    }
    WeightedGraph coarse;
    coarse.weights.reserve(std::size_t(count)), coarse.starts.reserve(std::size_t(count) + 1);
    std::vector<std::size_t> place(std::size_t(count),
                                   0);  // of a neighbour among those of the node, plus one
    InterruptPoll poll(1 << 10);
    for (int node = 0; node < count; ++node) {
        poll.step();
        const std::size_t begin = coarse.neighbours.size();
        int weight = 0;
        for (int member : {first[std::size_t(node)], second[std::size_t(node)]}) {
            if (member < 0) continue;
            weight += graph.weights[std::size_t(member)];
            graph.visit_neighbours(member, [&](int i, int strength) {
                const int to = coarse_node[std::size_t(i)];
                if (to == node) return;
                std::size_t& at = place[std::size_t(to)];
                if (at > begin && at <= coarse.neighbours.size() && coarse.neighbours[at - 1] == to) {
                    coarse.strengths[at - 1] += strength;
                } else {
                    coarse.neighbours.push_back(to), coarse.strengths.push_back(strength);
                    at = coarse.neighbours.size();
                }
            });
        }
        coarse.weights.push_back(weight);
        coarse.starts.push_back(coarse.neighbours.size());
    }
    return coarse;
}

// A graph and coarser ones made from it, by merging neighbours again and again.
class Hierarchy {
  public:
    // least: nodes from which a graph is not made coarser; most: coarser graphs.
    Hierarchy(const WeightedGraph& graph, int least, std::size_t most, Draws& draws) : graph_(graph) {
        coarser_.reserve(most);
        while (coarsest().nodes() > least && coarser_.size() < most) {
            std::vector<int> coarse_node;
            const int count = match_neighbours(coarsest(), draws, coarse_node);
            if (count > least_shrinking * coarsest().nodes()) break;
            coarser_.push_back(merge_nodes(coarsest(), coarse_node, count));
            coarse_node_.push_back(std::move(coarse_node));
        }
    }
    const WeightedGraph& coarsest() const { return level(coarser_.size()); }
    // The separator of the coarsest graph, refined on each finer one.
    Separator bring_back(Separator found) const {
        for (std::size_t k = coarser_.size(); k-- > 0;) {
            Separator finer(level(k));
            finer.project(found, coarse_node_[k]);
            finer.refine();
            found = std::move(finer);
        }
        return found;
    }

  private:
    const WeightedGraph& level(std::size_t k) const { return k == 0 ? graph_ : coarser_[k - 1]; }

    const WeightedGraph& graph_;
    std::vector<WeightedGraph> coarser_;  // than the graph, and than the one before
    std::vector<std::vector<int>> coarse_node_;
};

inline Separator separate_coarsest(const WeightedGraph& graph, Draws& draws) {
    Separator best(graph);
    for (int seed = 0; seed < seeds; ++seed) {
        Separator grown(graph);
        grown.grow(draws);
        grown.refine();
        if (seed == 0 || grown.score() < best.score()) best = grown;
    }
    return best;
}

}  // namespace separators

// The part of each node: no edge joins left and right. A part may be empty, where the graph is dense or
// small.
inline std::vector<Part> find_separator(const WeightedGraph& graph) {
    using namespace separators;
    if (graph.nodes() == 0) return {};
    Draws draws;
    const Hierarchy upper(graph, many_nodes, most_levels, draws);
    const int count = graph.nodes() > many_nodes ? tries : 1;
    Separator best(upper.coarsest());
    for (int k = 0; k < count; ++k) {
        const Hierarchy lower(upper.coarsest(), coarse_nodes, most_levels, draws);
        Separator found = lower.bring_back(separate_coarsest(lower.coarsest(), draws));
        if (k == 0 || found.score() < best.score()) best = std::move(found);
    }
    return upper.bring_back(std::move(best)).parts();
}

}  // namespace cspace
