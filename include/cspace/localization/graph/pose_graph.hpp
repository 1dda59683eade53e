// A graph of poses and landmarks: relative poses measured between two poses, and landmarks seen from poses.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace cspace::localization {

// The relative pose of `to` in `from` was measured as z, with the information W of its error.
template <class Space>
struct RelativePose {
    int from, to;
    typename Space::Pose z;
    typename Space::Square W;
};

enum class SightingKind : unsigned char { point, range_bearing };

// A landmark was seen from a pose: its coordinates in the base, or (in the plane) its range and bearing.
template <class Space>
struct Sighting {
    int pose, landmark;
    SightingKind kind;
    typename Space::Point z;
    typename Space::PointSquare W;  // zeros for what was not measured
};

template <class Space>
struct GraphState {
    std::vector<typename Space::Pose> poses;
    std::vector<typename Space::Point> landmarks;
};

template <class Space>
struct PoseGraph {
    GraphState<Space> start;
    std::vector<RelativePose<Space>> edges;
    std::vector<Sighting<Space>> sightings;
    std::vector<char> is_held, is_landmark_held;        // variables that stay where they are
    std::vector<char> is_trusted, is_sighting_trusted;  // measurements that no robust method doubts

    std::size_t factors() const { return edges.size() + sightings.size(); }
};

// The connected parts of a graph: the part of each pose, then of each landmark, numbered from 0 by first
// member.
template <class Space>
std::vector<int> find_parts(const PoseGraph<Space>& graph) {
    const std::size_t poses = graph.start.poses.size(), all = poses + graph.start.landmarks.size();
    std::vector<int> root(all);
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int i) {
        while (root[std::size_t(i)] != i) i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
        return i;
    };
    const auto join = [&](int i, int j) {
        i = find(i), j = find(j);
        root[std::size_t(i < j ? j : i)] = i < j ? i : j;
    };
    for (const auto& edge : graph.edges) join(edge.from, edge.to);
    for (const auto& sighting : graph.sightings) join(sighting.pose, int(poses) + sighting.landmark);
    std::vector<int> part(all);
    int count = 0;
    for (std::size_t i = 0; i < all; ++i) {
        const int top = find(int(i));
        part[i] = top == int(i) ? count++ : part[std::size_t(top)];
    }
    return part;
}

}  // namespace cspace::localization
