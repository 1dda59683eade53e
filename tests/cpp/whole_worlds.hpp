// Worlds of whole numbers, where everything that is degenerate happens: obstacles touch, overlap, cross
// themselves, stand in line.
#pragma once

#include <random>
#include <vector>

#include "cspace/maps/outlines.hpp"

// Up to eight polygons of three to five corners, or walls without thickness, in a square of a side from 3
// to 10.
inline cspace::maps::Outlines whole_polygons(std::mt19937& random, bool walls) {
    cspace::maps::Outlines world;
    const int side = 3 + int(random() % 8);
    world.high = {double(side), double(side)};
    const int obstacles = 1 + int(random() % 8);
    for (int o = 0; o < obstacles; ++o) {
        std::vector<cspace::Point> ring;
        const int corners = walls ? 2 : 3 + int(random() % 3);
        for (int i = 0; i < corners; ++i)
            ring.push_back({double(random() % unsigned(side + 1)), double(random() % unsigned(side + 1))});
        world.add_ring(ring, o);
    }
    return world;
}

// Unit squares at a third of the places of a square with a side from 4 to 11: many meet in a corner.
inline cspace::maps::Outlines whole_boxes(std::mt19937& random) {
    cspace::maps::Outlines world;
    const int side = 4 + int(random() % 8);
    world.high = {double(side), double(side)};
    int owner = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            if (random() % 3 != 0) continue;
            const double u = x, v = y;
            const cspace::Point box[4] = {{u, v}, {u + 1, v}, {u + 1, v + 1}, {u, v + 1}};
            world.add_ring(box, owner++);
        }
    return world;
}
