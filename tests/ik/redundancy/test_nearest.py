"""The nearest of all configurations of a redundant arm, limits aside, against dense samples of all."""

import numpy as np
import pytest

import cspace as cs


def distances(q, seed):
    return np.linalg.norm(np.angle(np.exp(1j * (q - seed))), axis=-1)


def sampled_distance(robot, T, seed, joint, n):
    values = np.linspace(-np.pi, np.pi, n, endpoint=False)
    b = robot.ik(T, locked={joint: values})
    return np.nanmin(distances(b.q, seed))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "iiwa14", "pr2_right"])
@pytest.mark.parametrize("noise", [0.02, 0.3, 2.0])
def test_no_sample_is_nearer(name, noise):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(11)
    joint = int(robot.joint_names.index(robot.ik(robot.fk(np.full(7, 0.3))).freedom[0]))
    for q in robot.random_configuration(25, rng=rng):
        seed = q + rng.uniform(-noise, noise, 7)
        T = robot.fk(q)
        s = robot.ik(T, near=seed, limits=False)
        found = distances(s.q, seed)[0]
        assert s.residual[0] < 1e-10
        assert found <= distances(q, seed) + 1e-12
        assert found <= sampled_distance(robot, T, seed, joint, 2000) + 1e-9


@pytest.mark.parametrize("name", ["gen3", "rizon4"])
def test_arms_without_a_closed_form(name):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(5)
    for q in robot.random_configuration(8, rng=rng, reach=1):
        seed = q + rng.uniform(-0.05, 0.05, 7)
        s = robot.ik(robot.fk(q), near=seed, limits=False)
        assert s.residual[0] < 1e-10
        assert distances(s.q, seed)[0] <= distances(q, seed) + 1e-12


@pytest.mark.parametrize("name", ["panda", "gen3"])
def test_the_way_to_the_seed_is_square_to_the_self_motion(name):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(7)
    for q in robot.random_configuration(10, rng=rng):
        seed = q + rng.uniform(-0.1, 0.1, 7)
        s = robot.ik(robot.fk(q), near=seed, limits=False)
        motion = np.linalg.svd(robot.jacobian(s.q[0]))[2][-1]
        gap = np.angle(np.exp(1j * (s.q[0] - seed)))
        assert abs(motion @ gap) < 1e-9


def test_batches_and_unreachable_goals():
    robot = cs.load_robot("panda")
    q = robot.random_configuration(30, rng=9)
    Ts = robot.fk(q)
    b = robot.ik(Ts, near=q + 0.01)
    assert b.q.shape == (30, 1, 7)
    assert b.count.min() == 1
    assert np.nanmax(b.residual) < 1e-10
    one = robot.ik(Ts[3], near=q[3] + 0.01)
    assert np.allclose(np.angle(np.exp(1j * (b.q[3, 0] - one.q[0]))), 0, atol=1e-12)
    far = Ts[0].copy()
    far[:3, 3] = [3.0, 0, 0]
    s = robot.ik(far, near=q[0])
    assert not s
    assert s.status == "unreachable"
    assert s.out_of_reach > 1
    assert not robot.ik(far)
    assert "out of reach" in robot.ik(far).reason


@pytest.mark.parametrize("name", ["panda", "iiwa14"])
def test_what_is_proven_is_the_nearest(name):
    """Seeds close by, where most answers are proven and not searched for, against samples of all."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(3)
    joint = robot.joint_names.index(robot.ik(robot.fk(np.full(7, 0.3))).freedom[0])
    for q in robot.random_configuration(15, rng=rng):
        for size in (0.01, 0.05, 0.1):
            way = rng.normal(size=7)
            seed = q + size * way / np.linalg.norm(way)
            T = robot.fk(q)
            found = distances(robot.ik(T, near=seed, limits=False).q, seed)[0]
            assert found <= size + 1e-12
            assert found <= sampled_distance(robot, T, seed, joint, 3000) + 1e-9


def test_one_call_answers_like_a_batch_and_like_words():
    """The compiled entry takes a plain pose and a plain seed; everything else goes the long way."""
    robot = cs.load_robot("panda")
    q = robot.random_configuration(20, rng=8)
    seeds = q + np.random.default_rng(1).uniform(-0.3, 0.3, q.shape)
    Ts = robot.fk(q)
    batch = robot.ik(Ts, near=seeds)
    for T, seed, row in zip(Ts, seeds, batch.q, strict=True):
        long_way = robot.ik(T, near=list(seed))
        short = robot.ik(T, near=seed)
        assert np.array_equal(short.q, long_way.q)
        assert short.freedom == long_way.freedom == ("panda_joint7",)
        assert short.branch == long_way.branch
        assert np.allclose(np.angle(np.exp(1j * (short.q - row))), 0, atol=1e-12)
    with pytest.raises(cs.errors.InputError):
        robot.ik(Ts[0], near=np.full(7, np.nan))
    with pytest.raises(cs.errors.InputError):
        robot.ik(np.full((4, 4), np.nan), near=q[0])
    with pytest.raises(cs.errors.InputError):
        robot.ik(Ts[0], near=q[0, :6])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "iiwa14", "pr2_right_torso"])
def test_seeds_in_awkward_places(name):
    """Seeds that are solutions, at the limits, turns away, and beside stretched and folded arms."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(13)
    turning = np.array([kind == "R" for kind in robot.joint_types])
    lower, upper = np.maximum(robot.limits.lower, -np.pi), np.minimum(robot.limits.upper, np.pi)
    middle = 0.5 * (lower + upper)
    ways = rng.normal(size=(6, robot.dof))
    ways *= 0.03 / np.linalg.norm(ways, axis=1)[:, None]
    for q in [*robot.random_configuration(3, rng=rng), middle, np.zeros(robot.dof), lower, upper]:
        T = robot.fk(q)
        assert np.allclose(distances(robot.ik(T, near=q, limits=False).q, q), 0, atol=1e-7)
        for way in ways:
            seed = q + way
            near = robot.ik(T, near=seed, limits=False)
            assert near.residual[0] < 1e-9
            assert distances(near.q, seed)[0] <= np.linalg.norm(way) + 1e-9
            turned = seed + 2 * np.pi * rng.integers(-3, 4, robot.dof) * turning
            far = robot.ik(T, near=turned, limits=False)
            assert distances(far.q, seed)[0] == pytest.approx(distances(near.q, seed)[0], abs=1e-7)
            assert (np.abs(far.q[0] - turned) < np.pi + 1e-9)[turning].all()
            kept = robot.ik(T, near=turned)
            assert len(kept) == 1
            assert (kept.q >= robot.limits.lower).all()
            assert (kept.q <= robot.limits.upper).all()


@pytest.mark.slow
def test_an_empty_answer_is_certified_only_where_it_is_proven():
    """Axes that meet but for a micrometre: five joints share the work of three, yet not quite."""
    rng = np.random.default_rng(5)
    axes = rng.normal(size=(5, 3))
    T_zero = np.eye(4)
    T_zero[:3, 3] = [0.3, -0.5, 0.6]
    robot = cs.Robot.from_screws(axes, 1e-6 * rng.normal(size=(5, 3)), T_zero)
    for q in robot.random_configuration(20, rng=rng):
        found = robot.ik(robot.fk(q))
        assert found or not found.complete
    far = robot.fk(np.zeros(5))
    far[:3, 3] *= 3
    assert not robot.ik(far)
    assert robot.ik(far).complete


def test_what_an_interval_shows_stands_within_limits_and_endless_slides_are_not_certified():
    robot, rng = cs.load_robot("panda"), np.random.default_rng(0)
    for q in robot.random_configuration(30, rng=rng):
        for interval in robot.redundancy(robot.fk(q)):
            assert (interval.q >= robot.limits.lower - 1e-9).all()
            assert (interval.q <= robot.limits.upper + 1e-9).all()
    slides = cs.Robot.from_screws([[1, 0, 0]] * 2, np.zeros((2, 3)), np.eye(4), joint_types="PP")
    assert not slides.redundancy(slides.fk([5, -4.2]), 0).complete
