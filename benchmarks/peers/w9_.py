"""w9-pathfinding: compiled searches over grids with costs."""

import math

import numpy as np
from w9_pathfinding import envs, pf

NAME, PACKAGE, MODULE = "w9-pathfinding", "w9-pathfinding", "w9_pathfinding"


def ways(blocked, costs=None, search="AStar"):
    """Asks for the way between cells (row, column), without cutting corners; costs of the cells to be
    entered."""
    weights = np.where(blocked, -1.0, 1.0 if costs is None else costs)
    grid = envs.Grid(
        weights.tolist(),
        diagonal_movement=envs.DiagonalMovement.only_when_no_obstacle,
        diagonal_movement_cost_multiplier=math.sqrt(2),
    )
    finder = getattr(pf, search)(grid)

    def prepare(start, goal):
        return (int(start[1]), int(start[0])), (int(goal[1]), int(goal[0]))

    def read(path):
        return np.array([(y, x) for x, y in path]).reshape(-1, 2)

    return prepare, lambda ends: finder.find_path(*ends), read
