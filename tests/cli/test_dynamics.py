"""`cspace dynamics` and `cspace simulate`: units, joints by name, bases, wrenches, loops, long robots."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cspace import model
from cspace.cli.output import Output
from cspace.mechanisms import FourBar

RNG = np.random.default_rng(11)


def typed(values) -> list[str]:
    return [repr(float(x)) for x in values]


def long_robot(n: int, *, branches: bool = False) -> model.Description:
    """A chain of n joints with long names, or two of them from one base."""
    links, joints = [model.Link("base", model.Inertial(1.0, (0, 0, 0), np.eye(3)))], []
    for side in ("left", "right") if branches else ("left",):
        parent = "base"
        for k in range(n):
            name = f"{side}_elbow_pitch_{k}"
            links.append(model.Link(f"{name}_link", model.Inertial(0.5, (0.1, 0, 0.1), 0.01 * np.eye(3))))
            axis = ((0, 0, 1), (0, 1, 0), (1, 0, 0))[k % 3]
            place = cs.pose((0, 0, 0.1))
            joints.append(
                model.Joint(f"{name}_joint", "continuous", parent, f"{name}_link", place, axis=axis)
            )
            parent = f"{name}_link"
    return model.Description("long", tuple(links), tuple(joints))


@pytest.fixture
def four_bar(tmp_path):
    linkage = FourBar(ground=1.0, crank=0.3, coupler=0.9, rocker=0.7)
    path = tmp_path / "four_bar.toml"
    model.to_toml(replace(linkage.robot.description, loops=linkage.loops), path)
    return path, linkage


def test_degrees_count_for_angles_rates_and_accelerations():
    robot = cs.load_robot("ur5e")
    q, qd, qdd = RNG.uniform(-2, 2, (3, 6))
    words = [
        ["--qd", *typed(rate), "--qdd", *typed(more), "--", *typed(at)]
        for at, rate, more in ((q, qd, qdd), tuple(np.degrees([q, qd, qdd])))
    ]
    rad, deg = (
        cspace("dynamics ur5e --json", *words[0]).json,
        cspace("dynamics ur5e --deg --json", *words[1]).json,
    )
    for name in ("q", "qd", "qdd", "tau"):
        np.testing.assert_allclose(deg[name], rad[name], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(rad["tau"], robot.inverse_dynamics(q, qd, qdd), atol=1e-12)
    fallen = [
        cspace(f"simulate ur5e --duration 0.02 --json {flag}", "--qd", *typed(rate), "--", *typed(at)).json[
            "q"
        ]
        for flag, at, rate in (("", q, qd), ("--deg", np.degrees(q), np.degrees(qd)))
    ]
    np.testing.assert_allclose(fallen[1], fallen[0], atol=1e-9)


@pytest.mark.parametrize("verb", ["dynamics", "simulate"])
def test_units_may_be_typed_behind_values_of_rates(verb):
    line = f"{verb} ur5e 10deg 0.2rad 0 0 pi/2 0 --json"
    found = cspace(line, "--qd", "90deg", "0", "0", "0", "0", "pi/4").json
    qd = np.array(found["qd"]).reshape(-1, 6)[0]
    np.testing.assert_allclose(qd, [np.pi / 2, 0, 0, 0, 0, np.pi / 4], atol=1e-15)
    same = cspace(f"{line} --deg", "--qd", "90deg", "0", "0", "0", "0", "pi/4").json
    np.testing.assert_allclose(np.array(same["qd"]).reshape(-1, 6)[0], qd, atol=1e-15)


def test_heads_have_units_and_numbers_are_in_them():
    text = cspace("dynamics ur5e 0 -90 90 0 0 0 --deg --qd 0 90 0 0 0 0").out
    for word in ("q [deg]", "qd [deg/s]", "qdd [deg/s²]", " torque [N·m]", "gravity torque [N·m]"):
        assert word in text.splitlines()[0]
    row = text.splitlines()[2].split()
    assert row[:4] == ["shoulder_lift_joint", "-90", "90", "0"]
    assert "q [rad]" in cspace("dynamics ur5e 0 0 0 0 0 0").out
    mixed = cspace("dynamics stanford --deg --qd 90 0 1 0 0 0").out.splitlines()
    assert "qd [deg/s, m/s]" in mixed[0]
    assert "torque [N·m, N]" in mixed[0]
    assert [line.split()[1] for line in mixed[1:4]] == ["revolute", "revolute", "prismatic"]
    assert [line.split()[3] for line in mixed[1:4]] == ["90", "0", "1"]
    heads = cspace("simulate stanford --deg --duration 0.01").out.splitlines()[0]
    assert "[deg]" in heads
    assert "[m]" in heads


def test_gains_and_torques_have_no_degrees():
    for flag in ("", "--deg"):
        found = cspace(f"dynamics ur5e {flag} --tau q1=10 --json").json
        np.testing.assert_allclose(found["tau"], [10, 0, 0, 0, 0, 0])


def test_joints_are_typed_by_name_or_not_at_all():
    robot = cs.load_robot("panda")
    home = robot.named_poses.get("home", np.zeros(7))
    np.testing.assert_array_equal(cspace("dynamics panda --json").json["q"], home)
    assert "configuration" in cspace("dynamics panda").out
    found = cspace("dynamics panda --pose ready panda_joint4=-90 q1=20deg --qd q2=45 --deg --json").json
    q = robot.named_poses["ready"].copy()
    q[3], q[0] = -np.pi / 2, np.radians(20)
    np.testing.assert_allclose(found["q"], q, atol=1e-15)
    np.testing.assert_allclose(found["qd"], [0, np.pi / 4, 0, 0, 0, 0, 0], atol=1e-15)
    pulled = cspace("simulate panda --pose ready --goal q1=1 --duration 0.01 --json").json
    goal = robot.named_poses["ready"].copy()
    assert np.argmax(np.abs(np.array(pulled["tau"][0]) - robot.gravity_torques(goal))) == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("0 0 0", "q has 3 values"),
        ("q1=1 2", "with names and without"),
        ("--qd q9=1", "q9"),
        ("0 0 0 0 0 0 0 --pose ready", "JOINT=VALUE changes a joint"),
        ("--wrench panda_link8 0 0 x 0 0 0", "six numbers"),
        ("--wrench nowhere 0 0 1 0 0 0", "nowhere"),
        ("--what mass weight", "weight"),
    ],
)
def test_what_cannot_be_read_is_named(words, message):
    for verb in ("dynamics", "simulate"):
        if verb == "simulate" and "--what" in words:
            continue
        result = cspace(f"{verb} panda {words}")
        assert result.code == 2
        assert message in result.err


def test_a_floating_base_carries_wrenches_and_payloads():
    q, qd, qdd = RNG.uniform(-1, 1, 7), *RNG.uniform(-1, 1, (2, 13))
    w = [1.0, -2.0, 3.0, 0.1, 0.2, -0.3]
    robot = cs.load_robot("panda", floating=True).with_payload(1.5, frame="panda_link7")
    T = cs.pose((0.1, 0.2, 0.3), rpy=(0.3, -0.2, 0.1))
    gravity = (0.0, 1.0, -3.0)
    for axes in ("base", "tip"):
        options = "--floating --xyz 0.1 0.2 0.3 --rpy 0.3 -0.2 0.1 --payload 1.5@panda_link7 --gravity 0 1 -3"
        line = (
            f"dynamics panda {options} --expressed-in {axes} --frame panda_link8 --json --wrench panda_link8"
        )
        found = cspace(line, *typed(w), "--qd", *typed(qd), "--qdd", *typed(qdd), "--", *typed(q)).json
        acts = {"gravity": gravity, "wrenches": {"panda_link8": w}, "expressed_in": axes, "T_world_base": T}
        np.testing.assert_allclose(found["tau"], robot.inverse_dynamics(q, qd, qdd, **acts), atol=1e-9)
        felt = robot.operational_space(q, "panda_link8", T_world_base=T)
        np.testing.assert_allclose(found["operational_inertia"], felt.inertia, atol=1e-9)
        assert found["frame"] == "panda_link8"
    line = f"simulate panda {options} --duration 0.01 --every 10 --json --wrench panda_link8"
    found = cspace(line, *typed(w), "--", *typed(q)).json
    acts = {"gravity": gravity, "wrenches": {"panda_link8": w}, "T_world_base": T}
    run = robot.simulate(q, np.zeros(13), duration=0.01, dt=1e-3, every=10, **acts)
    np.testing.assert_allclose(found["q"], run.q, atol=1e-12)
    np.testing.assert_allclose(found["T_world_base"], run.T_world_base, atol=1e-12)
    assert "base about z" in cspace("dynamics panda --floating").out
    assert "mass felt at panda_link8" in cspace("dynamics panda --pose ready --frame panda_link8").out


def test_several_matrices_and_a_picture(tmp_path):
    picture = tmp_path / "tau.png"
    told = cspace(f"dynamics panda --pose ready --what mass coriolis --plot {picture}")
    assert told.code == 0
    assert "mass matrix [SI units]" in told.out
    assert "coriolis matrix [SI units]" in told.out
    assert picture.stat().st_size > 10_000
    assert cspace(f"dynamics panda --plot {picture} --json").json["written"] == [str(picture)]


@pytest.mark.parametrize("verb", ["dynamics", "simulate --duration 0.01"])
def test_tables_of_long_and_branching_robots_fit(verb, tmp_path):
    path = tmp_path / "long.toml"
    model.to_toml(long_robot(15, branches=True), path)
    for line in (
        f"{verb} {path}",
        f"{verb} {path} --floating --deg",
        f"{verb} {path} --qd right_elbow_pitch_3_joint=1",
    ):
        told = cspace(line)
        assert told.code == 0, told.err
        table = told.out.split("\n\n")[0].splitlines()
        assert max(map(len, table)) <= 100 + ("--qd" in line and verb == "dynamics") * 20
        assert sum("elbow" in row for row in table) == 30
    assert "branches" in cspace(f"{verb} {path} --payload 1").err


def test_matrices_are_broken_at_narrow_terminals(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setenv("COLUMNS", "60")
    stream = Terminal()
    values = RNG.normal(size=(3, 9))
    Output(stream=stream).matrix(values, "M")
    lines = stream.getvalue().splitlines()
    assert max(map(len, lines)) <= 60 + 8  # codes of colours
    assert sum("columns" in line for line in lines) == 2
    numbers = [float(word) for line in lines for word in line.split() if "." in word]
    assert len(numbers) == 27


def test_files_with_loops_are_simulated_as_mechanisms(four_bar):
    path, linkage = four_bar
    assert "pin (revolute: coupler to rocker)" in cspace(f"info {path}").out
    assert cspace(f"info {path} --json").json["loops"] == ["pin (revolute: coupler to rocker)"]
    assert cspace("info ur5e --json").json["loops"] == []
    found = cspace(f"simulate {path} crank=50 --qd crank=30 --deg --duration 0.1 --dt 0.005 --json").json
    q = np.array(found["q"])
    assert np.abs(linkage.residual(q)).max() < 1e-9
    np.testing.assert_allclose(q[0, 0], np.radians(50), atol=1e-9)
    np.testing.assert_allclose(found["qd"][0][0], np.radians(30), atol=1e-9)
    assert np.ptp(found["energy"]) < 1e-6
    assert "closed loops" in cspace(f"simulate {path} crank=50 --deg --duration 0.01").out
    for words in ("--method variational", "--stop-at-limits"):
        refused = cspace(f"simulate {path} crank=50 --deg {words}")
        assert refused.code == 2
        assert "has closed loops" in refused.err
    assert "cannot be closed" in cspace(f"simulate {path} rocker=160 --deg").err


def test_dynamics_of_files_with_loops(four_bar):
    path, linkage = four_bar
    pushed = cspace(f"dynamics {path} crank=0.9 --qd crank=2 --tau crank=1 --json").json
    q, qd = np.array(pushed["q"]), np.array(pushed["qd"])
    qdd = linkage.forward_dynamics(q, qd, np.array([1.0, 0.0, 0.0]))
    np.testing.assert_allclose(pushed["qdd"], qdd, atol=1e-9)
    assert pushed["warnings"] == []
    assert "loops cut" in cspace(f"dynamics {path} crank=0.9").out


def test_gains_have_no_default_where_a_joint_moves_nothing():
    told = cspace("simulate gen3_lite --hold")
    assert told.code == 2
    assert "joint_6" in told.err
    assert "--kp" in told.err
    assert "joint_6" in cspace("simulate gen3_lite --hold --kp 1 --kd 1").err


def test_robots_without_masses_are_told_where_masses_are():
    for verb in ("dynamics", "simulate"):
        refused = cspace(f"{verb} kr6_r900")
        assert refused.code == 2
        assert "cspace robots --has inertia" in refused.err
    heavy = {row["name"] for row in cspace("robots --has inertia --json").json["robots"]}
    for name in cs.robots.names():
        assert (cs.load_robot(name).mass > 0.0) == (name in heavy), name
    both = cspace("robots --has inertia link_frames --dof 7 --json").json["robots"]
    assert all(row["dof"] == 7 and not {"inertia", "link frames"} & set(row["missing"]) for row in both)
