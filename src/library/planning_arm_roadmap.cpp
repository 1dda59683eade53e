#include "planning_arm_roadmap.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cspace/math/threads.hpp"
#include "cspace/search/star_neighbours.hpp"
#include "planning_arm_edges.hpp"
#include "planning_arm_query.hpp"
#include "planning_arm_roadmap_state.hpp"

namespace cspace::planning {

namespace {

using search::NearRow;
using search::NodePair;
using RoadmapState = ArmRoadmap::State;

constexpr std::int64_t most_samples = std::int64_t(1) << 18;  // the nearest of so many take a minute

void check_rule(const RoadmapRule& rule) {
    require(rule.samples >= 0 && rule.samples <= most_samples, "a roadmap has 0 to 2^18 samples");
    require(rule.neighbours >= 0, "the number of neighbours must not be negative");
}

// Makes a roadmap: samples, pairs, proofs.
class RoadmapMaker {
  public:
    RoadmapMaker(const ArmSpace& robot, const RoadmapRule& rule, int threads)
        : robot_(robot), bounds_(robot), threads_(threads) {
        made_.rule = rule;
        made_.width = std::size_t(robot.checker.dof());
    }

    RoadmapState make(const RoadmapState* part) {
        draw_nodes();
        index_nodes();
        keep_proved(choose_pairs(), part);
        finish();
        return std::move(made_);
    }
    RoadmapState restore(std::span<const double> nodes, std::span<const std::int32_t> edges) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const std::size_t k = i % made_.width;
            require(nodes[i] >= box().lower[k] && nodes[i] <= box().upper[k], "a node is out of bounds");
            made_.rows.push_back(float(nodes[i]));
        }
        const auto n = std::int32_t(made_.size());
        for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
            const NodePair pair = {edges[i], edges[i + 1]};
            require(pair.second >= 0 && pair.second < pair.first && pair.first < n &&
                        (made_.pairs.empty() || made_.pairs.back() < pair),
                    "edges must be pairs of nodes, the larger first, in order");
            made_.pairs.push_back(pair);
        }
        index_nodes();
        finish();
        return std::move(made_);
    }

  private:
    const ArmSpace& robot_;
    const FloatBounds bounds_;
    const int threads_;
    RoadmapState made_;

    const Box& box() const { return bounds_.box(); }

    // Calls visit(begin, end) on all threads.
    template <class Visit>
    void over_parts(std::size_t count, const Visit& visit) const {
        constexpr std::size_t least_part = 64;
        over_rows(count, threads_, 1, least_part, [&](std::size_t begin, std::size_t end) {
            visit(begin, end);
            return true;
        });
    }

    void draw_nodes() {
        const std::size_t width = made_.width, n = std::size_t(made_.rule.samples);
        search::HaltonPoints points(halton_table(int(width)), made_.rule.seed);
        auto drawn = filled_vector<float>(n * width);
        auto rows = filled_vector<double>(n * width);
        visit_range(0, n, [&](std::size_t i) {
            box().scale(points.next(), &drawn[i * width]);
            std::copy_n(&drawn[i * width], width, &rows[i * width]);
        });
        std::vector<std::uint8_t> collides(n);
        made_.rows.reserve(n * width);
        robot_.checker.check_rows(rows.data(), n, collides.data(), threads_);
        visit_range(0, n, [&](std::size_t i) {
            const auto row = drawn.begin() + std::ptrdiff_t(i * width);
            if (!collides[i]) made_.rows.insert(made_.rows.end(), row, row + std::ptrdiff_t(width));
        });
    }
    void index_nodes() {
        const std::size_t n = made_.size();
        const int asked = made_.rule.neighbours;
        made_.neighbours = asked > 0 ? asked : search::star_neighbours(n, int(made_.width));
        made_.blocks = search::ConfigurationTree(int(made_.width));
        visit_range(0, n, [&](std::size_t i) {
            made_.blocks.add(made_.row(i), search::ConfigurationTree::no_parent, 0);
        });
    }

    // Each node is paired with its nearest neighbours.
    std::vector<NodePair> choose_pairs() const {
        const std::size_t n = made_.size(), most = std::min(n, std::size_t(made_.neighbours) + 1);
        auto near = filled_vector<std::int32_t>(n * most);
        over_parts(n, [&](std::size_t begin, std::size_t end) {
            std::vector<NearRow> found(most);
            for (std::size_t i = begin; i < end; ++i) {
                find_nearest(made_.blocks, made_.row(i), box(), found);
                for (std::size_t k = 0; k < most; ++k) near[i * most + k] = found[k].row;
            }
        });
        return search::choose_pairs(std::int32_t(n), false, [&](std::int32_t i, auto& listed) {
            const auto first = near.begin() + std::ptrdiff_t(std::size_t(i) * most);
            listed.assign(first, first + std::ptrdiff_t(most));
        });
    }

    // Keeps the pairs whose edges are free of self-collision over their whole length.
    void keep_proved(const std::vector<NodePair>& pairs, const RoadmapState* part) {
        std::vector<std::uint8_t> is_free(pairs.size());
        const ArmOptions options;
        over_parts(pairs.size(), [&](std::size_t begin, std::size_t end) {
            ArmEdges edges(robot_, options, bounds_);
            for (std::size_t k = begin; k < end; ++k)
                is_free[k] = is_proved_in(part, pairs[k]) || is_edge_free(edges, pairs[k]);
        });
        visit_range(0, pairs.size(), [&](std::size_t k) {
            if (is_free[k]) made_.pairs.push_back(pairs[k]);
        });
    }
    static bool is_proved_in(const RoadmapState* part, const NodePair& pair) {
        return part && std::binary_search(part->pairs.begin(), part->pairs.end(), pair);
    }
    bool is_edge_free(ArmEdges& edges, const NodePair& pair) const {
        return edges.is_free(made_.row(std::size_t(pair.first)), made_.row(std::size_t(pair.second)));
    }

    void finish() {
        search::Components components(made_.size());
        made_.lengths.resize(made_.pairs.size());
        visit_range(0, made_.pairs.size(), [&](std::size_t k) {
            const auto [i, j] = made_.pairs[k];
            made_.lengths[k] = box().distance(made_.row(std::size_t(i)), made_.row(std::size_t(j)));
            components.join(i, j);
        });
        made_.components = components.count();
        made_.arcs = search::join_pairs<search::RoadmapArc>(
            made_.size(), made_.pairs,
            [](std::int32_t to, std::int32_t edge) { return search::RoadmapArc{to, edge}; });
    }
};

}  // namespace

void find_nearest(const search::ConfigurationTree& rows, const float* q, const Box& box,
                  std::vector<NearRow>& found) {
    found.resize(std::size_t(kernels::find_nearest_rows(rows.blocks(), rows.size(), rows.width(), q,
                                                        box.wraps, int(found.size()), found.data())));
}

ArmRoadmap::ArmRoadmap(const ArmSpace& robot, const RoadmapRule& rule, const ArmRoadmap* part, int threads) {
    check_space(robot), check_rule(rule);
    const State* const before = part ? part->state_.get() : nullptr;
    if (before)
        require(before->width == std::size_t(robot.checker.dof()) && before->rule.seed == rule.seed &&
                    before->rule.samples <= rule.samples,
                "the other roadmap must be a part");
    state_ = std::make_shared<const State>(RoadmapMaker(robot, rule, threads).make(before));
}
ArmRoadmap::ArmRoadmap(const ArmSpace& robot, const RoadmapRule& rule, std::span<const double> nodes,
                       std::span<const std::int32_t> edges) {
    check_space(robot), check_rule(rule);
    const std::size_t width = std::size_t(robot.checker.dof());
    require(width > 0 ? nodes.size() % width == 0 : nodes.empty(), "a node has one entry per coordinate");
    require(std::int64_t(nodes.size()) <= rule.samples * std::int64_t(width),
            "there are more nodes than samples");
    require(edges.size() % 2 == 0, "an edge has two nodes");
    state_ = std::make_shared<const State>(RoadmapMaker(robot, rule, 1).restore(nodes, edges));
}

const RoadmapRule& ArmRoadmap::rule() const { return state_->rule; }
int ArmRoadmap::width() const { return int(state_->width); }
std::size_t ArmRoadmap::size() const { return state_->size(); }
std::size_t ArmRoadmap::edge_count() const { return state_->pairs.size(); }
int ArmRoadmap::neighbours() const { return state_->neighbours; }
std::int64_t ArmRoadmap::components() const { return std::int64_t(state_->components); }
std::vector<double> ArmRoadmap::nodes() const { return {state_->rows.begin(), state_->rows.end()}; }
std::vector<std::int32_t> ArmRoadmap::edges() const {
    std::vector<std::int32_t> flat;
    flat.reserve(2 * state_->pairs.size());
    for (const auto& [i, j] : state_->pairs) flat.insert(flat.end(), {i, j});
    return flat;
}

}  // namespace cspace::planning
