"""Animations of arms: as many pictures as the motion lasts, and what is refused."""

from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import cspace as cs
from cspace.errors import InputError, InputTypeError


@pytest.fixture(scope="module")
def robot():
    return cs.load_robot("ur5e")


@pytest.fixture(scope="module")
def motion(robot):
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    return robot.move_to(q + 0.8, start=q, acceleration=8.0, jerk=80.0)


def test_an_arm_moves_in_real_time(robot, motion, tmp_path):
    scene = cs.Scene([cs.Sphere(0.1, (0.2, -0.5, 0.9), name="lamp")])
    film = cs.plot.animation(motion, robot=robot, scene=scene, rate=4.0)
    cs.plot.save(film, tmp_path / "motion.gif", dpi=25)
    with Image.open(tmp_path / "motion.gif") as gif:
        shown = 0.0
        pictures = []
        for k in range(gif.n_frames):
            gif.seek(k)
            shown += gif.info["duration"]
            pictures.append(np.asarray(gif.convert("L"), dtype=float))
    assert 1e3 * motion.duration <= shown <= 1e3 * motion.duration + 1600.0  # and still at the end
    changes = [np.abs(b - a).mean() for a, b in pairwise(pictures)]
    assert max(changes) > 1.0  # the arm moves


def test_what_cannot_be_shown_is_refused(robot, motion):
    with pytest.raises(InputTypeError, match="robot="):
        cs.plot.animation(motion)
    with pytest.raises(InputError, match="of 6 joints, panda of 7"):
        cs.plot.animation(motion, robot=cs.load_robot("panda"))
    with pytest.raises(InputError, match="pictures"):
        cs.plot.animation(motion, robot=robot, rate=1e4)
    none = robot.move_linear(cs.pose((5.0, 0, 0)), start=motion(0.0), acceleration=8.0)
    with pytest.raises(InputError, match="no motion to show"):
        cs.plot.animation(none, robot=robot)
    with pytest.raises(InputTypeError):
        cs.plot.animation(3, robot=robot)
