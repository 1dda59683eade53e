"""Every displacement is one turn and one slide: screws in space, the pole in the plane; and in between."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from spatial.draws import ANGLES, BATCHES, close, poses, twists


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_screw_of_a_displacement_reproduces_it(angle, batch):
    T = poses(angle, batch)
    screw = cs.screw_of(T)
    close(screw.pose(), T)
    close(cs.exp_se3(screw.twist), T)
    close(screw.pose(0.25) @ screw.pose(0.75), T)
    assert np.shape(screw.pitch) == np.shape(screw.magnitude) == batch


def test_the_screw_axis_slides_along_itself():
    T = poses("any", (20,))
    screw = cs.screw_of(T)
    slide = (screw.pitch * screw.magnitude)[:, None] * screw.axis
    for along in (-2.0, 0.0, 3.0):
        p = screw.point + along * screw.axis
        close(cs.transform_points(T, p), p + slide)
    close(np.sum(screw.point * screw.axis, axis=-1), np.zeros(20))


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_twist_and_screw_there_and_back(angle, batch):
    xi = twists(angle, batch)
    screw = cs.twist_to_screw(xi)
    close(cs.screw_to_twist(screw), xi)
    close(np.linalg.norm(screw.axis, axis=-1), np.ones(batch))


def test_a_screw_made_by_hand():
    screw = cs.Screw(axis=(0, 0, 2), point=(1, 0, 5), pitch=0.1, magnitude=np.pi)
    close(screw.pose(), [[-1, 0, 0, 2], [0, -1, 0, 0], [0, 0, 1, 0.1 * np.pi], [0, 0, 0, 1]])
    again = cs.screw_of(screw.pose())
    close(again.axis, [0.0, 0.0, 1.0])
    close(again.point, [1.0, 0.0, 0.0])
    close(np.array([again.pitch, again.magnitude]), [0.1, np.pi])


def test_pure_translations_and_the_identity_are_screws():
    move = cs.screw_of(cs.pose((0.0, -3.0, 4.0)))
    assert move.is_translation
    assert (move.pitch, move.magnitude) == (np.inf, 5.0)
    close(move.axis, [0.0, -0.6, 0.8])
    rest = cs.screw_of(np.eye(4))
    assert rest.is_translation
    assert rest.magnitude == 0.0
    close(rest.axis, [0.0, 0.0, 1.0])
    close(rest.pose(), np.eye(4))
    close(cs.Screw((1, 0, 0), (7, 7, 7), np.inf, 2.0).pose(), cs.pose((2, 0, 0)))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0, 0, 0), (0, 0, 0), 0.0, 1.0), "axis is zero"),
        (((0, 0, 1), (0, 0, 0), np.nan, 1.0), "pitch is NaN"),
        (((0, 0, 1), (0, 0, 0), -np.inf, 1.0), "pitch is NaN or -inf"),
        (((0, 0, 1), (0, 0, np.inf), 0.0, 1.0), "screw point holds inf"),
        (((0, 0, 1), (0, 0, 0), 0.0, np.inf), "magnitude holds inf"),
        ((np.ones((2, 3)), np.ones((3, 3)), 0.0, 1.0), "do not broadcast"),
    ],
)
def test_screws_that_are_none(arguments, message):
    with pytest.raises(InputError, match=message):
        cs.Screw(*arguments)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_the_pole_stays_in_place_and_the_turn_about_it_is_the_displacement(batch):
    T = cs.random_pose_2d(batch, rng=1)
    pole = cs.pole_of(T)
    assert np.shape(pole.exists) == np.shape(pole.angle) == batch
    assert np.all(pole.exists)
    close(cs.transform_points_2d(T, pole.point), pole.point, atol=1e-11)
    to_pole = cs.pose_2d(pole.point)
    close(to_pole @ cs.pose_2d(theta=pole.angle) @ cs.inverse_pose_2d(to_pole), T, atol=1e-11)
    assert pole.reason == ""


def test_a_pure_translation_has_no_pole_and_says_so():
    pole = cs.pole_of(cs.pose_2d((1.0, 2.0)))
    assert not pole
    assert not pole.exists
    assert np.isnan(pole.point).all()
    assert pole.angle == 0.0
    assert pole.translation.tolist() == [1.0, 2.0]
    assert pole.reason == "a pure translation by (1, 2) has no fixed point"
    some = cs.pole_of(cs.pose_2d([[1.0, 2.0], [1.0, 2.0]], theta=[0.0, np.pi]))
    assert some
    assert some.exists.tolist() == [False, True]
    close(some.point[1], [0.5, 1.0])
    assert "1 of 2" in some.reason


def test_the_pole_is_where_the_screw_axis_pierces_the_plane():
    T = cs.random_pose_2d(20, rng=2)
    screw = cs.screw_of(cs.embed_pose_2d(T))
    close(screw.point[:, :2], cs.pole_of(T).point, atol=1e-10)
    close(screw.pitch, np.zeros(20))


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("between", [cs.interpolate, cs.interpolate_decoupled, cs.slerp])
def test_interpolation_starts_at_the_start_and_ends_at_the_end(between, angle, batch):
    start = poses("any", batch)
    end = start @ poses(angle, batch, seed=5)
    if between is cs.slerp:
        start, end = start[..., :3, :3], end[..., :3, :3]
    close(between(start, end, 0.0), start)
    close(between(start, end, 1.0), end)
    half = between(start, end, 0.5)
    if angle not in {"π", "π + 1e-9", "π - 1e-9"}:
        close(between(start, half, 0.5), between(start, end, 0.25))
        close(between(end, start, 0.25), between(start, end, 0.75))


def test_the_screw_motion_has_a_constant_twist_and_slerp_a_constant_speed():
    start, end = cs.random_pose((2, 7), rng=3)
    t = np.linspace(0.0, 1.0, 11)
    path = cs.interpolate(start[:, None], end[:, None], t)
    assert path.shape == (7, 11, 4, 4)
    steps = cs.log_se3(cs.inverse_pose(path[:, :-1]) @ path[:, 1:])
    close(steps, np.broadcast_to(steps[:, :1], steps.shape))
    turn = cs.slerp(start[:, None], end[:, None], t)
    angles = cs.rotation_distance(turn[:, :-1], turn[:, 1:])
    close(angles, np.broadcast_to(cs.rotation_distance(start, end)[:, None] / 10.0, (7, 10)))
    close(turn, path[..., :3, :3])
    straight = cs.to_xyz(cs.interpolate_decoupled(start[:, None], end[:, None], t))
    close(np.diff(straight, axis=1), np.broadcast_to((straight[:, -1:] - straight[:, :1]) / 10.0, (7, 10, 3)))


def test_the_screw_motion_does_not_depend_on_the_base_frame():
    start, end, T_new_base = cs.random_pose((3, 5), rng=4)
    close(
        cs.interpolate(T_new_base @ start, T_new_base @ end, 0.3),
        T_new_base @ cs.interpolate(start, end, 0.3),
    )


def test_planar_interpolation_turns_about_the_pole():
    start, end = cs.random_pose_2d((2, 6), rng=5)
    pole = cs.pole_of(end @ cs.inverse_pose_2d(start)).point
    reach = cs.to_xytheta(start)[:, :2] - pole
    for t in (0.0, 0.4, 1.0, 1.5):
        between = cs.interpolate_2d(start, end, t)
        radius = np.linalg.norm(cs.to_xytheta(between)[:, :2] - pole, axis=-1)
        close(radius, np.linalg.norm(reach, axis=-1), atol=1e-10)
    close(cs.interpolate_2d(start, end, 1.0), end)
    close(
        cs.embed_pose_2d(cs.interpolate_2d(start, end, 0.4)),
        cs.interpolate(cs.embed_pose_2d(start), cs.embed_pose_2d(end), 0.4),
    )


def test_shapes_that_do_not_broadcast_are_named():
    with pytest.raises(InputError, match=r"start and end \(2,\) and t \(3,\) do not broadcast"):
        cs.interpolate(cs.random_pose(2, rng=1), np.eye(4), np.zeros(3))
    with pytest.raises(InputError, match=r"start \(2,\) and end \(3,\)"):
        cs.slerp(cs.random_rotation(2, rng=1), cs.random_rotation(3, rng=1), 0.5)
