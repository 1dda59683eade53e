"""Widest and shortest ways on a drawn diagram: its lines cut into short pieces, and Dijkstra on them."""

from __future__ import annotations

import heapq
import itertools

import numpy as np

from oracles.clearance import nearest


def pieces_of(diagram, landings, rings, step):
    """A graph of the diagram's lines, cut into pieces no longer than a step [m] and at the landings (k, 2):
    neighbours {node: [(other, length, width)]}, and the nodes of the landings. Widths are least clearances at
    the ends of pieces, so too large by half a step at most."""
    lines = [line for line, _ in diagram.arcs]
    on = [closest(lines, p) for p in landings]
    named, drawn = [None] * len(landings), []
    for k, line in enumerate(lines):
        points, marks = cut(line, [(i, t, n) for n, (arc, i, t) in enumerate(on) if arc == k], step)
        nodes = [(k, j) for j in range(len(points))]
        nodes[0], nodes[-1] = (int(diagram.ends[k][0]),), (int(diagram.ends[k][1]),)
        for n, j in marks:
            named[n] = nodes[j]
        drawn += zip(itertools.pairwise(nodes), itertools.pairwise(points), strict=True)
    ends = np.array([pair for _, pair in drawn])
    lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    widths = nearest(ends.reshape(-1, 2), rings)[0].reshape(-1, 2).min(axis=1)
    graph = {}
    for ((a, b), _), length, width in zip(drawn, lengths.tolist(), widths.tolist(), strict=True):
        graph.setdefault(a, []).append((b, length, width))
        graph.setdefault(b, []).append((a, length, width))
    return graph, named


def closest(lines, p):
    """The line, its segment and the place in it (0 to 1) that are nearest to a point."""
    where = [(k, i) for k, line in enumerate(lines) for i in range(len(line) - 1)]
    begin = np.concatenate([line[:-1] for line in lines])
    along = np.concatenate([line[1:] for line in lines]) - begin
    t = ((p - begin) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300)
    t = np.clip(t, 0, 1)
    best = int(np.argmin(np.hypot(*(begin + t[:, None] * along - p).T)))
    return (*where[best], float(t[best]))


def cut(line, cuts, step):
    """The points of a line cut into pieces, and at (segment, place, name);
    and (name, number of its point)."""
    points, marks = [line[0]], []
    for i, (a, b) in enumerate(itertools.pairwise(line)):
        places = [(t, None) for t in np.linspace(0, 1, int(np.hypot(*(b - a)) / step) + 2)[1:]]
        for t, name in sorted(places + [(t, n) for j, t, n in cuts if j == i], key=lambda place: place[0]):
            points.append(a + t * (b - a))
            if name is not None:
                marks.append((name, len(points) - 1))
    return np.array(points), marks


def shortest(graph, start, goal, floor):
    """The length of the shortest way over pieces no narrower than the floor; inf where there is none."""
    best, queue = {start: 0.0}, [(0.0, start)]
    while queue:
        length, node = heapq.heappop(queue)
        if node == goal:
            return length
        if length > best[node]:
            continue
        for other, more, width in graph[node]:
            if width >= floor and length + more < best.get(other, np.inf):
                best[other] = length + more
                heapq.heappush(queue, (length + more, other))
    return np.inf


def widest(graph, start, goal):
    """The largest least width of a way between two nodes."""
    best, queue = {start: np.inf}, [(-np.inf, start)]
    while queue:
        narrow, node = heapq.heappop(queue)
        if node == goal:
            return -narrow
        for other, _, width in graph[node]:
            least = min(-narrow, width)
            if least > best.get(other, 0):
                best[other] = least
                heapq.heappush(queue, (-least, other))
    return 0.0
