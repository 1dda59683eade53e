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
        Point low = walls.points[0], high = low;
        for (const Point& p : walls.points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        return 0.5 * (low + high);
    }
};

}  // namespace cspace::navigation
