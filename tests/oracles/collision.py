"""Collision checks in the plainest way: every sphere against every shape and every sphere, in double."""

import numpy as np

BAND = 5e-6
"""Distance [m] within which checks may count as touching what is free: rounding to float."""


def sphere_places(robot, q):
    """Centres (m, 3) in the world and radii (m,) of all spheres at q, with the link of each."""
    geometry = robot.collision
    centers, radii, links = [], [], []
    for number, name in enumerate(geometry.links):
        own = geometry.spheres[geometry.sphere_links == number]
        T_link = robot.fk(q, frame=name) @ np.linalg.inv(geometry.frames[name][1])
        centers.append(own[:, :3] @ T_link[:3, :3].T + T_link[:3, 3])
        radii.append(own[:, 3])
        links += [name] * len(own)
    return np.concatenate(centers), np.concatenate(radii), links


def clearance(robot, q, scene, pairs=None):
    """The least distance, and the pairs of names within BAND of it."""
    geometry = robot.collision
    centers, radii, links = sphere_places(robot, q)
    links = np.array(links)
    allowed = {frozenset(pair) for pair in scene.allowed}
    found = []
    for shape in scene.obstacles:
        distances = np.asarray(shape.distance(centers)) - radii
        for name in geometry.links:
            if frozenset((name, shape.name)) not in allowed:
                found.append((distances[links == name].min(), (name, shape.name)))
    for a, b in geometry.pairs:
        one, other = geometry.links[a], geometry.links[b]
        if frozenset((one, other)) not in allowed:
            p, q_ = links == one, links == other
            gaps = np.linalg.norm(centers[p][:, None] - centers[q_], axis=-1) - radii[p][:, None] - radii[q_]
            found.append((gaps.min(), (one, other)))
    least = min((distance for distance, _ in found), default=np.inf)
    return least, {frozenset(pair) for distance, pair in found if distance <= least + BAND}
