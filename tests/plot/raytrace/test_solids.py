"""Rays against solids: what is met lies on the surface, nothing lies before it, misses are misses."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.plot.obstacles import bodies_of
from cspace.plot.raytrace.layer import see_solids
from cspace.plot.raytrace.solids import Facets, Solid, bounding_pieces, make_arrow
from cspace.plot.raytrace.view import Rays, View
from cspace.shapes import Box, Hull

GREY = np.full(3, 0.5)


def cameras(rng: np.random.Generator) -> dict[str, Rays]:
    """An eye and a far light, both looking at a box about the origin through the square [-1, 1]²."""
    eye, right, up = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    spread, nothing = np.array([0.8 * right, 0.8 * up, 0.0 * eye]), np.zeros((2, 3))
    return {
        "eye": Rays(np.array([*nothing, 3.0 * eye]), spread / 3.0 + np.array([*nothing, -eye])),
        "light": Rays(spread + np.array([*nothing, 3.0 * eye]), np.array([*nothing, -eye])),
    }


def meetings(solid: Solid, rays: Rays, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The first t of every ray (m,), inf where it misses, and the normals (m, 3) there, else NaN."""
    t, normals = np.full(x.shape, np.inf), np.full((len(x), 3), np.nan)
    for piece in bounding_pieces(solid):
        found = piece.meet(rays, x, y)
        nearer = found < t
        t = np.where(nearer, found, t)
        normals[nearer] = piece.normals(rays.points(x[nearer], y[nearer], t[nearer]))
    return t, normals


def signed_distance(solid: Solid | Facets, x: np.ndarray) -> np.ndarray:
    """How far points are from a tapered capsule, a cylinder or a convex body of facets, negative inside.

    Slow, by sampling its spheres or by its definition; beyond edges of facets it is less than the distance.
    """
    if isinstance(solid, Facets):
        normals = [np.cross(p[1] - p[0], p[2] - p[0]) for p in solid.polygons]
        sides = [(x - p[0]) @ (n / np.linalg.norm(n)) for p, n in zip(solid.polygons, normals, strict=True)]
        return np.max(sides, axis=0)
    axis = solid.b - solid.a
    length = np.linalg.norm(axis)
    if solid.round:
        share = np.linspace(0, 1, 2001)[:, None]
        centers = solid.a + share * axis
        radii = solid.radius_a + share[:, 0] * (solid.radius_b - solid.radius_a)
        return np.array([(np.linalg.norm(p - centers, axis=1) - radii).min() for p in x])
    u = axis / length
    y = (x - solid.a) @ u
    around = np.linalg.norm(x - solid.a - y[:, None] * u, axis=1)
    radius = solid.radius_a + y / length * (solid.radius_b - solid.radius_a)
    return np.maximum.reduce([around - radius, -y, y - length])


SOLIDS = {
    "capsule": Solid(np.array([-0.4, 0.1, 0]), np.array([0.5, -0.2, 0.3]), 0.2, 0.2, GREY),
    "tapered": Solid(np.array([-0.4, 0.1, 0]), np.array([0.5, -0.2, 0.3]), 0.3, 0.1, GREY),
    "growing": Solid(np.array([-0.4, 0.1, 0]), np.array([0.5, -0.2, 0.3]), 0.1, 0.3, GREY),
    "sphere": Solid(np.zeros(3), np.zeros(3), 0.4, 0.4, GREY),
    "swallowed": Solid(np.zeros(3), np.array([0.1, 0, 0]), 0.4, 0.1, GREY),
    "cylinder": Solid(np.array([0, 0, -0.3]), np.array([0.1, 0.2, 0.4]), 0.25, 0.25, GREY, round=False),
    "cone": Solid(np.array([0, 0, -0.3]), np.array([0.1, 0.2, 0.4]), 0.25, 0.0, GREY, round=False),
}
AROUND = np.array([[-1.0] * 3, [1.0] * 3])
TILTED = cs.pose([0.05, -0.1, 0.1], rpy=[0.4, -0.7, 0.2])
FLAT_SIDED = {
    "box": bodies_of(Box([0.5, 0.7, 0.3], TILTED), GREY, AROUND)[0],
    "hull": bodies_of(Hull(np.random.default_rng(2).uniform(-0.5, 0.5, (20, 3)), TILTED), GREY, AROUND)[0],
}
BODIES = SOLIDS | FLAT_SIDED


@pytest.mark.parametrize("camera", ["eye", "light"])
@pytest.mark.parametrize("name", BODIES)
def test_the_first_meeting_lies_on_the_surface(name, camera):
    solid, rng = BODIES[name], np.random.default_rng(3)
    for _ in range(8):
        rays = cameras(rng)[camera]
        x, y = rng.uniform(-1, 1, size=(2, 400))
        t, normals = meetings(solid, rays, x, y)
        hit = np.flatnonzero(np.isfinite(t))
        assert 0.02 < len(hit) / len(x) < 0.98
        some = hit[:40]
        points = rays.points(x[some], y[some], t[some])
        allowed = 1e-3 if solid.round else 1e-9  # a capsule's distance is sampled
        assert np.abs(signed_distance(solid, points)).max() < allowed
        before = rays.points(x[some], y[some], t[some] - 0.01)
        assert (signed_distance(solid, before) > -1e-4).all(), "nothing of the solid lies before the meeting"
        np.testing.assert_allclose(np.linalg.norm(normals[hit], axis=1), 1.0, atol=1e-9)
        ways = rays.points(x[hit], y[hit], t[hit] + 1.0) - rays.points(x[hit], y[hit], t[hit])
        assert (np.einsum("ij,ij->i", normals[hit], ways) < 1e-9).all(), "normals face the ray"


@pytest.mark.slow
@pytest.mark.parametrize("camera", ["eye", "light"])
@pytest.mark.parametrize("name", BODIES)
def test_rays_that_miss_stay_outside(name, camera):
    rng = np.random.default_rng(4)
    rays = cameras(rng)[camera]
    x, y = rng.uniform(-1, 1, size=(2, 400))
    t, _ = meetings(BODIES[name], rays, x, y)
    for i in np.flatnonzero(~np.isfinite(t))[:40]:
        along = rays.points(np.full(200, x[i]), np.full(200, y[i]), np.linspace(1.5, 4.5, 200))
        assert signed_distance(BODIES[name], along).min() > -1e-4


@pytest.mark.parametrize("name", SOLIDS)
def test_two_balls_hold_every_piece(name):
    for rays in cameras(np.random.default_rng(5)).values():
        x, y = np.random.default_rng(6).uniform(-1, 1, size=(2, 2000))
        for piece in bounding_pieces(SOLIDS[name]):
            t = piece.meet(rays, x, y)
            hit = np.isfinite(t)
            (a, r), (b, s) = (2 * piece.balls)[:2]  # one ball is both
            hull = Solid(a, b, r + 1e-9, s + 1e-9, GREY)
            assert (signed_distance(hull, rays.points(x[hit], y[hit], t[hit])) < 1e-4).all()


def test_an_outline_pixel_holds_the_share_that_many_rays_find():
    plt = pytest.importorskip("matplotlib.pyplot")
    ax = plt.figure(figsize=(1.2, 1.2), dpi=50).add_subplot(projection="3d")
    for axis in "xyz":
        getattr(ax, f"set_{axis}lim")(-0.7, 0.7)
    ax.figure.canvas.draw()
    view = View(ax, 1.0)
    for solid in BODIES.values():
        layer = see_solids(view, [solid])
        rows, columns = np.divmod(layer.pixels, view.width)
        steps = (np.arange(16) + 0.5) / 16
        dx, dy = (each.ravel() for each in np.meshgrid(steps, steps))
        x, y = (columns[:, None] + dx).ravel(), (rows[:, None] + dy).ravel()
        share = np.isfinite(meetings(solid, view.rays, x, y)[0]).reshape(-1, 256).mean(axis=1)
        assert ((share > 0.1) & (share < 0.9)).sum() > 20
        assert np.abs(layer.coverage - share).max() < 0.2
        assert abs(layer.coverage.sum() - share.sum()) < 0.01 * share.sum()
    plt.close(ax.figure)


def test_an_arrow_ends_where_it_points():
    pieces = make_arrow(np.array([0.1, 0.2, 0.3]), np.array([0.0, 0.0, 0.5]), 0.02, GREY)
    np.testing.assert_allclose(pieces[-1].b, [0.1, 0.2, 0.8], atol=1e-15)
    np.testing.assert_allclose(pieces[0].b, pieces[-1].a, atol=1e-15)


@pytest.mark.parametrize("name", FLAT_SIDED)
def test_the_corners_of_facets_hold_them(name):
    for rays in cameras(np.random.default_rng(5)).values():
        x, y = np.random.default_rng(6).uniform(-1, 1, size=(2, 2000))
        for piece in bounding_pieces(BODIES[name]):
            points = rays.points(x, y, piece.meet(rays, x, y))[np.isfinite(piece.meet(rays, x, y))]
            corners = np.array([center for center, _ in piece.balls])
            assert ((points > corners.min(axis=0) - 1e-9) & (points < corners.max(axis=0) + 1e-9)).all()


def test_a_facet_behind_the_eye_is_not_seen():
    rays = Rays(np.array([[0, 0, 0], [0, 0, 0], [0, 0, 0.0]]), np.array([[1, 0, 0], [0, 1, 0], [0, 0, -1.0]]))
    square = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    place = np.zeros(1)
    for height, seen in ((-2.0, True), (2.0, False)):
        [piece] = bounding_pieces(Facets([square + np.array([0, 0, height])], GREY))
        assert np.isfinite(piece.meet(rays, place, place)).all() == seen
    [back] = bounding_pieces(Facets([square[::-1] - np.array([0, 0, 2])], GREY))
    assert np.isinf(back.meet(rays, place, place)).all(), "its back is not seen"


def test_a_layer_names_the_body_that_is_nearest():
    plt = pytest.importorskip("matplotlib.pyplot")
    ax = plt.figure(figsize=(1.2, 1.2), dpi=50).add_subplot(projection="3d")
    ax.figure.canvas.draw()
    view = View(ax, 1.0)
    middle = np.full(3, 0.5)
    bodies = [Solid(middle + k * view.eye, middle + k * view.eye, 0.2, 0.2, GREY) for k in (-0.5, 0.5)]
    layer = see_solids(view, bodies)
    assert set(layer.owner) == {0, 1}
    both = [see_solids(view, [body]) for body in bodies]
    depth = np.full((2, view.width * view.height), np.inf)
    for k, each in enumerate(both):
        depth[k, each.pixels] = each.depth
    sure = layer.coverage == 1.0
    assert (layer.owner == depth.argmin(axis=0)[layer.pixels])[sure].all()
    plt.close(ax.figure)
