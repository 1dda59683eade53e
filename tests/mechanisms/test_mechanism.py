"""Mechanisms from files, and what they share."""

import numpy as np
import pytest

import cspace as cs
from cspace import model
from cspace.errors import DescriptionError, InputError, InputTypeError
from cspace.mechanisms import FourBar, Mechanism

MJCF = """
<mujoco model="bars">
  <worldbody>
    <body name="crank"><joint name="crank" axis="0 -1 0"/>
      <geom type="capsule" fromto="0 0 0 .3 0 0" size=".02"/>
      <body name="coupler" pos=".3 0 0"><joint name="coupler" axis="0 -1 0"/>
        <geom type="capsule" fromto="0 0 0 .9 0 0" size=".02"/></body></body>
    <body name="rocker" pos="1 0 0"><joint name="rocker" axis="0 -1 0"/>
      <geom type="capsule" fromto="0 0 0 .7 0 0" size=".02"/>
      <site name="end" pos=".7 0 0"/></body>
  </worldbody>
  <equality>{}</equality>
</mujoco>"""

SITES = '<connect name="pin" site1="tip" site2="end"/>'


def test_a_linkage_from_mjcf_is_the_one_from_lengths():
    text = MJCF.replace(
        'size=".02"/></body></body>', 'size=".02"/><site name="tip" pos=".9 0 0"/></body></body>'
    )
    linkage = Mechanism(cs.Robot.from_mjcf(text.format(SITES)))
    assert [loop.type for loop in linkage.loops] == ["spherical"]
    ours = FourBar(1.0, 0.3, 0.9, 0.7)
    assert linkage.joint_names == ours.joint_names
    q = ours.assembly_modes({"crank": 0.5}).q[0]
    assert np.abs(linkage.residual(q)).max() < 1e-14
    assert linkage.dof(q) == 1
    found = linkage.close({"crank": 0.5}, near=q + 0.1)
    np.testing.assert_allclose(found.q, q, atol=1e-12)


def test_a_weld_holds_bodies_together():
    text = MJCF.format('<weld name="glue" body1="coupler" body2="rocker" relpose=".9 0 0 0 1 0 0"/>')
    mechanism = Mechanism(cs.Robot.from_mjcf(text))
    assert len(mechanism.constraints.rows) == 6
    assert not mechanism.close({"crank": 0.5, "coupler": 2.0})


def test_loops_are_written_to_toml_and_read_back():
    for mechanism in (FourBar(1.0, 0.3, 0.9, 0.7), cs.mechanisms.Delta(0.2, 0.05, 0.25, 0.6)):
        text = mechanism.robot.to_toml()
        again = Mechanism(cs.Robot.from_toml(text))
        q = np.random.default_rng(0).normal(size=len(again.joint_names))
        np.testing.assert_array_equal(again.residual(q), mechanism.residual(q))
    joint = model.Loop("cross", "universal", "coupler", "rocker", axis=(1, 0, 0), second_axis=(0, 0, 1))
    description = FourBar(1.0, 0.3, 0.9, 0.7).robot.description
    from dataclasses import replace

    text = model.to_toml(replace(description, loops=(joint,)))
    (back,) = model.from_toml(text).loops
    np.testing.assert_array_equal(back.second_axis, joint.second_axis)
    with pytest.raises(DescriptionError, match="is a rod without a length"):
        model.from_toml(text.replace("universal", "distance").replace("second_axis = [0.0, 0.0, 1.0]\n", ""))


def test_loops_in_code():
    robot = FourBar(1.0, 0.3, 0.9, 0.7).robot
    open_tree = cs.Robot(model.Description("open", robot.description.links, robot.description.joints))
    with pytest.raises(InputError, match="open has no closed loops; give loops="):
        Mechanism(open_tree)
    linkage = Mechanism(open_tree, robot.description.loops)
    assert repr(linkage) == "<Mechanism open: 3 coordinates, 1 loop>"
    assert linkage.mobility(dimension=2) == 1
    both = Mechanism(robot, [model.Loop("rod", "distance", "ground", "rocker", length=0.4)])
    assert [loop.name for loop in both.loops] == ["pin", "rod"]
    with pytest.raises(InputTypeError, match="Mechanism needs a Robot, got Description"):
        Mechanism(robot.description)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"type": "distance"}, "is a rod without a length"),
        ({"type": "distance", "length": 0.0}, "length of loop 'a' is 0"),
        ({"type": "spherical", "length": 1.0}, "length= is for loops of type 'distance'"),
        ({"type": "revolute", "second_axis": (1, 0, 0)}, "second_axis= is for loops of type 'universal'"),
    ],
)
def test_loops_with_wrong_numbers(changes, message):
    with pytest.raises(InputError, match=message):
        model.Loop("a", parent="x", child="y", **changes)


def test_configurations_by_name():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    np.testing.assert_array_equal(linkage.configuration({"rocker": 2.0}), [0, 0, 2])
    assert linkage.configuration({"crank": [1.0, 2.0]}).shape == (2, 3)
    assert linkage.kinetic_energy(np.zeros(3), np.zeros(3)) == 0
