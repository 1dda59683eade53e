// Trees of boxes: built from the middle of the boxes along their widest extent.
#pragma once

#include <array>
#include <vector>

#include "cspace/collision/scene.hpp"

namespace cspace::collision {

struct Bounds {
    std::array<double, 3> low, high;
};

// The nodes, and the order of the items: leaf items are numbers in `order`.
struct Tree {
    std::vector<TreeNode> nodes;
    std::vector<int> order;
};

// Leaves have at most so many items. The boxes are rounded outward, and grown.
Tree build_tree(const std::vector<Bounds>& items, int leaf_size, double grown);

// The box around all items.
Bounds bound_all(const std::vector<Bounds>& items);

// Rounded down, and up.
float round_low(double x);
float round_high(double x);

}  // namespace cspace::collision
