// A shortest path over the cells of a grid by A*, and one that may turn anywhere by Theta*.
#include <cspace/navigation/grid/grid_route.hpp>
#include <cspace/navigation/grid/search.hpp>
#include <cstdio>
#include <string>
#include <vector>

using namespace cspace;

int main() {
    const std::vector<std::string> drawing = {
        "..........",  // row 0 has the least y
        ".#######..",  //
        ".......#..",  //
        ".####..#..",  //
        ".......#..",
    };
    maps::BitGrid grid(int(drawing.size()), int(drawing[0].size()));
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            grid.set(row, column, drawing[std::size_t(row)][std::size_t(column)] == '#');
    const maps::GridFrame frame = {0.5, {0, 0}};  // cells of 0.5 m
    const maps::Cell start = {2, 2}, goal = {4, 9};

    navigation::GridScratch scratch;  // memory that searches share
    navigation::GridAnswer answer;
    double lengths[2] = {};
    for (const bool any_angle : {false, true}) {
        navigation::GridQuery query;  // A*, and no step cuts the corner of a blocked cell
        if (any_angle) {
            query.planner = navigation::GridPlanner::theta_star;
            query.metric = navigation::Metric::euclidean;
        }
        find_way(grid, start, goal, query, scratch, answer);
        navigation::Route route;
        draw_route(frame, frame.center(start), frame.center(goal), answer, route);
        std::printf("%s: %.3f m, %d cells expanded\n", any_angle ? "Theta*" : "A*", route.length,
                    int(route.stats.nodes));
        for (const Point& p : route.path) std::printf("  (%.2f, %.2f)", p.x, p.y);
        std::printf("\n");
        lengths[any_angle] = route.length;
    }
    return answer.found && lengths[1] <= lengths[0] ? 0 : 1;
}
