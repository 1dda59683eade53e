#include "planning_two_joints.hpp"

#include <stdexcept>
#include <utility>

#include "cspace/math/made_once.hpp"
#include "cspace/planning/two_joints/bitmap.hpp"
#include "cspace/planning/two_joints/boundaries.hpp"
#include "cspace/planning/two_joints/path.hpp"

namespace cspace::planning {

namespace {

using namespace two_joints;

std::vector<Piece> pieces_from(const PieceTables& tables) {
    const std::size_t count = tables.ends.size();
    if (tables.radii.size() != count || tables.obstacles.size() != count)
        throw std::invalid_argument("ends, radii and obstacles must have equal lengths");
    std::vector<Piece> pieces;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto end = std::size_t(tables.ends[k]);
        if (end <= begin || end > tables.corners.size()) throw std::invalid_argument("ends must increase");
        pieces.push_back(
            make_piece(tables.corners.subspan(begin, end - begin), tables.radii[k], tables.obstacles[k]));
        begin = end;
    }
    return pieces;
}

Joint joint_from(const JointNumbers& numbers, bool wraps) {
    return {numbers.sign, numbers.offset, numbers.lower, numbers.upper, wraps};
}

struct Swept {
    explicit Swept(const Space& space) : sweep(space), components(sweep) {}
    const Sweep sweep;
    const Components components;
};

}  // namespace

struct TwoJointSpace::State {
    State(const Arm& arm, const std::vector<Piece>& pieces) : space(arm, pieces) {}

    const Space space;
    const Swept& swept() const {
        return swept_.get([&] { return std::make_unique<Swept>(space); });
    }

  private:
    MadeOnce<Swept> swept_;
};

TwoJointSpace::TwoJointSpace(Point base, std::array<double, 2> lengths, double link_radius,
                             std::array<JointNumbers, 2> joints, std::array<bool, 2> wraps,
                             const PieceTables& pieces) {
    const Arm arm{base,
                  lengths[0],
                  lengths[1],
                  link_radius,
                  joint_from(joints[0], wraps[0]),
                  joint_from(joints[1], wraps[1])};
    state_ = std::make_shared<State>(arm, pieces_from(pieces));
}

Table<std::uint8_t> TwoJointSpace::bitmap(int rows, int columns) const {
    Table<std::uint8_t> cells{filled_vector<std::uint8_t>(std::size_t(rows) * std::size_t(columns)),
                              std::size_t(columns)};
    draw_bitmap(state_->space, rows, columns, cells.values.data(),
                [](std::int32_t) { return std::uint8_t(1); });
    return cells;
}

Table<std::int32_t> TwoJointSpace::obstacle_map(int rows, int columns) const {
    Table<std::int32_t> cells{
        filled_vector<std::int32_t>(std::size_t(rows) * std::size_t(columns), no_obstacle),
        std::size_t(columns)};
    draw_bitmap(state_->space, rows, columns, cells.values.data(),
                [&](std::int32_t piece) { return state_->space.obstacle_of(piece); });
    return cells;
}

std::vector<std::int32_t> TwoJointSpace::obstacles_at(std::span<const Point> configurations) const {
    std::vector<std::int32_t> found(configurations.size());
    InterruptPoll poll(16);
    for (std::size_t i = 0; i < found.size(); ++i) {
        poll.step();
        found[i] = state_->space.obstacle_of(state_->space.blocks(configurations[i].x, configurations[i].y));
    }
    return found;
}

std::tuple<Table<Point>, Table<std::int32_t>, Table<std::int32_t>, Table<std::int32_t>>
TwoJointSpace::boundaries() const {
    std::tuple<Table<Point>, Table<std::int32_t>, Table<std::int32_t>, Table<std::int32_t>> tables;
    auto& [points, ends, kinds, obstacles] = tables;
    for (const BoundaryCurve& curve : trace_boundaries(state_->swept().sweep)) {
        points.values.insert(points.values.end(), curve.points.begin(), curve.points.end());
        ends.values.push_back(std::int32_t(points.values.size()));
        kinds.values.push_back(std::int32_t(curve.kind));
        obstacles.values.push_back(curve.obstacle);
    }
    return tables;
}

std::tuple<Table<double>, Table<Point>, Table<std::int32_t>> TwoJointSpace::components() const {
    std::tuple<Table<double>, Table<Point>, Table<std::int32_t>> tables;
    auto& [areas, inside, regions] = tables;
    areas.columns = 2;
    for (const Component& one : state_->swept().components.all()) {
        areas.values.insert(areas.values.end(), {one.least_area, one.greatest_area});
        inside.values.push_back({one.q_1, one.q_2});
        regions.values.push_back(one.region);
    }
    return tables;
}

int TwoJointSpace::component_at(Point configuration) const {
    return state_->swept().components.find_component(configuration.x, configuration.y);
}

Table<Point> TwoJointSpace::find_path(Point start, Point goal) const {
    const Swept& swept = state_->swept();
    return {PathFinder(swept.sweep, swept.components).find(start, goal)};
}

}  // namespace cspace::planning
