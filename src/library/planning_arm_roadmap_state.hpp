// What roadmaps of arms hold: for files of the library, not for bindings.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "cspace/planning/box.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/nearest_row.hpp"
#include "cspace/search/roadmap.hpp"
#include "cspace/search/shortest_way.hpp"
#include "planning_arm_roadmap.hpp"

namespace cspace::planning {

struct ArmRoadmap::State {
    RoadmapRule rule;
    std::size_t width = 0;
    int neighbours = 0;
    std::vector<float> rows;              // (n, width)
    search::ConfigurationTree blocks{0};  // the same, as the search for neighbours reads them
    std::vector<search::NodePair> pairs;  // the edges
    std::vector<float> lengths;           // of the edges
    search::Adjacency<search::RoadmapArc> arcs;
    std::size_t components = 0;

    std::size_t size() const { return width > 0 ? rows.size() / width : 0; }
    const float* row(std::size_t node) const { return rows.data() + node * width; }
};

struct RoadmapWorld::State {
    using Verdicts = std::vector<std::atomic<search::EdgeState>>;

    const std::shared_ptr<const ArmRoadmap> roadmap;
    const std::shared_ptr<const collision::Checker> checker, map_checker;  // map_checker: of its own edges
    const EdgeTest search;
    const float resolution;
    Verdicts nodes, edges;
};

// The nearest of many rows, as many as there is place for or fewer.
void find_nearest(const search::ConfigurationTree& rows, const float* q, const Box& box,
                  std::vector<search::NearRow>& found);

}  // namespace cspace::planning
