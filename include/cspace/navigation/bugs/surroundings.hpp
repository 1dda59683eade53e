// The walls around a robot that measures their distances.
#pragma once

#include "cspace/navigation/voronoi/edge_tree.hpp"

namespace cspace::navigation {

// The walls as sites, made once for a world.
struct Surroundings {
    voronoi::Sites sites;
    voronoi::EdgeTree tree;

    explicit Surroundings(const maps::Boundary& walls)
        : sites(voronoi::sites_of(walls, middle_of(walls))), tree(sites) {}

  private:
    static Point middle_of(const maps::Boundary& walls) {
        if (walls.size() == 0) return {};
        const auto [low, high] = bounds_of(walls.points);
        return 0.5 * (low + high);
    }
};

}  // namespace cspace::navigation
