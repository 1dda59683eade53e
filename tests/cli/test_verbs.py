"""Every verb: the JSON it promises, the text it prints, and that both say what the library says."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

import cspace as cs
from cli import schema
from cli.run import ROOT, cspace
from cspace.cli.app import VERBS, import_verb
from cspace.dynamics import PD

LINES = {
    "robots": "robots --search ur5",
    "info": "info ur5e",
    "fk": "fk ur5e 0.1 -1.2 1 0.2 0.4 0.3",
    "ik": "ik ur5e --xyz 0.4 0.1 0.3 --rpy 0 pi 0",
    "jacobian": "jacobian ur5e 0.1 -1.2 1 0.2 0.4 0.3",
    "dynamics": "dynamics panda --pose ready --qd 0 1 0 0 0 0 0",
    "dh": "dh ur5e",
    "export": "export planar_2r",
    "nav": f"nav {ROOT}/examples/yard.txt --start 1 1 --goal 9 9",
    "plan": "plan ur5e --geometry skeleton --from home --to up",
    "planners": "planners rrt",
    "space": f"space planar_2r --scene {ROOT}/examples/two_links.txt --from -0.3 0.5 --to -1.2 1.25",
    "localize": f"localize {ROOT}/examples/small_drive",
    "slam": f"slam {ROOT}/examples/two_rounds.g2o --robust dcs",
    "evaluate": f"evaluate {ROOT}/examples/small_drive {ROOT}/examples/small_drive",
    "simulate": "simulate puma560 0.1 -1.2 1 0.2 0.4 0.3 --duration 0.1",
    "traj": "traj panda --from ready --to 0.5 0.2 0 -1.5 0 1.8 0.8",
    "doctor": "doctor",
}
Q = [0.1, -1.2, 1.0, 0.2, 0.4, 0.3]


def typed(q) -> list[str]:
    return [repr(float(x)) for x in q]


def test_every_verb_is_tested():
    assert set(LINES) == set(VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_json_is_what_the_schema_says(verb):
    result = cspace(LINES[verb], "--json")
    assert (result.code, result.err) == (0, "")
    assert result.out.count("\n") == 1, "one document on one line"
    schema.check(result.json, f"cspace.{verb}/1")


@pytest.mark.parametrize("name", schema.SCHEMAS)
def test_the_page_documents_every_key(name):
    text = (ROOT / "docs/cli.md").read_text(encoding="utf-8")
    section = text.split(f"### `{name}`")[1].split("\n### ")[0]

    def keys(kind):
        if isinstance(kind, dict):
            for key, inner in kind.items():
                yield key
                yield from keys(inner)
        elif isinstance(kind, list):
            yield from keys(kind[0])

    for key in keys(schema.SCHEMAS[name]):
        assert f"`{key}`" in section, f"docs/cli.md, {name}: {key} is missing"


@pytest.mark.parametrize("verb", VERBS)
def test_help_has_examples_that_parse(verb):
    result = cspace(f"{verb} --help")
    assert result.code == 0
    assert f"usage: cspace {verb}" in result.out
    examples = import_verb(verb).EXAMPLES.strip().splitlines()
    assert examples
    shown = " ".join(result.out.replace("\\\n", "").split())  # a terminal breaks the longer ones
    for line in examples:
        assert line in shown
        assert line.startswith(f"cspace {verb}")


def test_examples_of_the_help_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "examples/cell.toml", tmp_path)
    shutil.copy(ROOT / "examples/two_rounds.g2o", tmp_path)
    shutil.copytree(ROOT / "examples/small_drive", tmp_path / "small_drive")
    (tmp_path / "way.csv").write_text("0 -1.2 1 0 0.3 0\n0.4 -1 0.8 0.2 0.3 0\n0.8 -1.1 1 0.2 0 0.5\n")
    for verb in VERBS:
        for line in import_verb(verb).EXAMPLES.strip().splitlines():
            if not any(word in line for word in ("arm.urdf", "--plot", "yard.geojson", "spheres.json")):
                result = cspace(line.removeprefix("cspace "))
                assert result.code == 0, f"{line}\n{result.err}"


@pytest.mark.parametrize("verb", VERBS)
def test_plain_text_has_neither_colours_nor_boxes(verb):
    result = cspace(LINES[verb])
    assert result.code == 0
    assert result.out
    assert "\x1b" not in result.out
    assert not set(result.out) & set("│─┌└├━┃╭╰║═")
    assert all(line == line.rstrip() for line in result.out.splitlines())


def test_fk_says_what_the_library_says():
    T = cs.load_robot("ur5e").fk(Q)
    found = cspace("fk ur5e --json", *typed(Q)).json
    np.testing.assert_allclose(found["matrix"], T, atol=1e-15)
    np.testing.assert_allclose(cs.pose(found["xyz"], rpy=found["rpy"]), T, atol=1e-12)
    np.testing.assert_allclose(cs.pose(found["xyz"], wxyz=found["wxyz"]), T, atol=1e-12)
    np.testing.assert_allclose(cs.pose(found["xyz"], xyzw=found["xyzw"]), T, atol=1e-12)


def few_joints():
    """Every arm of the catalogue with fewer than six joints."""
    return [row.name for row in cs.robots.rows() if row.dof < 6 and cs.load_robot(row.name).tip is not None]


@pytest.mark.parametrize("name", few_joints())
def test_the_printed_pose_of_an_arm_with_few_joints_is_read_back(name):
    robot = cs.load_robot(name)
    for seed in range(3):
        q = robot.random_configuration(rng=seed, reach=0.3)
        lines = cspace(f"fk {name}", *map(repr, map(float, q))).out.splitlines()
        found = cspace(f"ik {name} --json --matrix", *" ".join(lines[1:5]).split())
        assert found.code == 0, found.json["reason"]
        xyz, wxyz = (next(line for line in lines if line.startswith(form)) for form in ("xyz", "wxyz"))
        words = [*xyz.split()[2:5], "--wxyz", *wxyz.split()[1:5]]
        assert cspace(f"ik {name} --json --xyz", *words).code == 0


def test_degrees_are_typed_and_read():
    rad = cspace("fk ur5e --json", *typed(Q)).json
    deg = cspace("fk ur5e --deg --json", *typed(np.degrees(Q))).json
    np.testing.assert_allclose(deg["matrix"], rad["matrix"], atol=1e-14)
    np.testing.assert_allclose(deg["rpy"], rad["rpy"], atol=1e-14)
    assert "rpy [deg]" in cspace("fk ur5e --deg", *typed(np.degrees(Q))).out


def test_fk_of_another_frame():
    robot = cs.load_robot("ur5e")
    for frame in robot.frames:
        found = cspace(f"fk ur5e --frame {frame} --json", *typed(Q)).json
        np.testing.assert_allclose(found["matrix"], robot.fk(Q, frame=frame), atol=1e-15)


def test_simulate_says_what_the_library_says(tmp_path):
    robot, picture = cs.load_robot("puma560"), tmp_path / "fall.png"
    line = f"simulate puma560 --qd 1 0 0 0 0 0 --duration 0.05 --every 10 --plot {picture} --json"
    found = cspace(line, *typed(Q)).json
    run = robot.simulate(Q, [1, 0, 0, 0, 0, 0], duration=0.05, dt=1e-3, every=10)
    for name in ("times", "q", "qd", "energy"):
        np.testing.assert_array_equal(found[name], getattr(run, name))
    assert picture.stat().st_size > 10_000
    assert found["written"] == [str(picture)]
    told = cspace("simulate puma560 --duration 0.05 --method variational", *typed(Q))
    assert "ended   ended" in told.out
    assert told.code == 0
    assert cspace("simulate puma560 --duration -1", *typed(Q)).code == 2


START, GOAL = "0 -0.8 0 -2.4 0 1.6 0.8", "0.5 0.2 0 -1.5 0 1.8 0.8"


def test_traj_says_what_the_library_says(tmp_path):
    robot = cs.load_robot("panda")
    start, goal = (np.array(text.split(), dtype=float) for text in (START, GOAL))
    picture, table, ros = (tmp_path / name for name in ("move.png", "move.csv", "move.yaml"))
    line = f"traj panda --from {START} --to {GOAL} --jerk 100 --rate 50"
    found = cspace(f"{line} --plot {picture} -o {table} --json").json
    motion = robot.move_to(goal, start=start, jerk=100.0)
    assert found["duration"] == motion.duration
    np.testing.assert_array_equal(found["q"], motion.sample(50).q)
    assert found["written"] == [str(table), str(picture)]
    assert picture.stat().st_size > 10_000
    read = cs.trajectory.from_csv(table)
    np.testing.assert_allclose(read(read.duration), goal, atol=1e-12)
    assert f"wrote {ros}" in cspace(f"{line} -o {ros}").out
    assert ros.read_text().startswith("joint_names: [")


def test_traj_goes_through_waypoints_and_along_lines(tmp_path):
    robot = cs.load_robot("panda")
    way = tmp_path / "way.csv"
    rows = np.array([START.split(), GOAL.split(), [0.6, 0.3, 0.2, -1.2, 0, 1.9, 0.5]], dtype=float)
    way.write_text("a,b,c,d,e,f,g\n" + "\n".join(",".join(map(str, row)) for row in rows))
    for option, path in (("", cs.spline(rows)), ("--blend 0.1", cs.blend(rows, 0.1))):
        found = cspace(f"traj panda --waypoints {way} {option} --json").json
        assert found["duration"] == cs.time_parametrize(path, robot).duration
    line = cspace("traj ur5e --from up --line 0.3 0.2 0.7 --acceleration 8 --speed 0.2 --json")
    if line.code == 0:
        assert line.json["duration"] > 0
    far = cspace("traj ur5e --from up --line 3 0 0 --acceleration 8")
    assert far.code == 1
    assert "no motion" in far.out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--from ready", "one of --to, --waypoints and --line"),
        (f"--to {GOAL} --line 1 0 0", "given: --to and --line"),
        (f"--from ready --to {GOAL} --blend 0.1", "--blend does not go with --to"),
        ("--from ready --line 1 0", "--line has 2 numbers"),
        ("--from ready --line 0.4 0 0.5 --profile cubic", "--profile does not go with --line"),
        (f"--from ready --to {GOAL} -o move.txt", "it must be .yaml, .csv or .json"),
        ("--waypoints nowhere.csv", "nowhere.csv"),
    ],
)
def test_traj_names_what_it_cannot_take(words, message):
    result = cspace(f"traj panda {words}")
    assert result.code in (2, 3)
    assert message in result.err


def test_simulate_holds_pulls_and_pushes_joints():
    robot = cs.load_robot("puma560")
    goal = np.array(Q) + 0.1
    kp, kd = np.arange(1.0, 7.0), 0.5
    line = "simulate puma560 --duration 0.05 --every 10 --json"
    pulled = cspace(line, "--goal", *typed(goal), "--kp", *typed(kp), "--kd", "0.5", "--", *typed(Q)).json
    run = robot.simulate(Q, [0] * 6, control=PD(goal, kp, kd), duration=0.05, dt=1e-3, every=10)
    np.testing.assert_array_equal(pulled["q"], run.q)
    np.testing.assert_array_equal(pulled["tau"], run.tau)
    pushed = cspace(line, "--tau", *typed(kp), "--", *typed(Q)).json
    np.testing.assert_array_equal(pushed["tau"], [kp] * 6)
    held = cspace(line, "--hold", *typed(Q)).json
    np.testing.assert_allclose(held["q"], [Q] * 6, atol=1e-9)
    assert cspace(line, "--tau", "1", "--", *typed(Q)).code == 2
    assert "gains of --hold or --goal" in cspace(line, "--kp", "1", "--", *typed(Q)).err


@pytest.mark.slow
def test_simulate_lets_a_base_float(tmp_path):
    picture = tmp_path / "fall.png"
    line = (
        f"simulate puma560 --floating --xyz 0 0 1 --rpy 0 0 90 --deg --hold --duration 0.2 --plot {picture}"
    )
    fallen = cspace(line, "--json", *typed(Q)).json
    T = np.array(fallen["T_world_base"])
    robot = cs.load_robot("puma560", floating=True)
    centers = robot.center_of_mass(fallen["q"], T_world_base=T)
    times = np.array(fallen["times"])
    np.testing.assert_allclose(centers[:, 2] - centers[0, 2], -0.5 * 9.81 * times**2, atol=1e-9)
    np.testing.assert_allclose(T[0, :2, 0], [0, 1], atol=1e-12)
    assert picture.stat().st_size > 10_000
    assert "z [m]" in cspace(line, *typed(Q)).out
    assert "[v; ω] of the base" in cspace(line, "--qd", "1", "--", *typed(Q)).err


def test_jacobian_says_what_the_library_says():
    robot = cs.load_robot("ur5e")
    for axes in ("base", "tip"):
        found = cspace(f"jacobian ur5e --expressed-in {axes} --json", *typed(Q)).json
        J = robot.jacobian(Q, expressed_in=axes)
        np.testing.assert_allclose(found["jacobian"], J, atol=1e-15)
        sigma = np.linalg.svd(J, compute_uv=False)
        np.testing.assert_allclose(found["singular_values"], sigma, atol=1e-12)
        np.testing.assert_allclose(found["manipulability"], np.prod(sigma), atol=1e-12)


def test_a_stretched_arm_is_singular_and_the_wrist_is_to_blame():
    found = cspace("jacobian ur5e 0.3 -1.2 1 0.2 0 0.3 --json").json
    assert found["singular"]
    assert found["distance_to_singularity"] < 1e-12
    assert not cspace("jacobian planar_2r 0.3 0.4 --json").json["singular"]
    assert cspace("jacobian planar_2r 0.3 0 --json").json["singular"], "position is what a 2R arm is for"


def test_dh_matrices_multiply_to_the_pose():
    for robot in ("ur5e", "puma560", "scara"):
        for convention in ("standard", "modified"):
            found = cspace(f"dh {robot} --convention {convention} --json").json
            T = np.array(found["base"])
            for matrix in found["matrices"]:
                T = T @ matrix
            arm = cs.load_robot(robot)
            allowed = 1e-12 + 2 * found["deviation"]
            np.testing.assert_allclose(T @ found["tool"], arm.fk(np.zeros(arm.dof)), atol=allowed)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("robot", ["ur5e", "puma560", "scara", "stanford"])
def test_dh_symbols_mean_the_numbers(robot, convention):
    """The symbols, evaluated at any angle, are the matrix at that angle."""
    from cspace.model import to_dh

    arm = cs.load_robot(robot)
    table = to_dh(arm.chain, convention=convention)
    symbols = cspace(f"dh {robot} --convention {convention} --json").json["symbols"]
    q = np.random.default_rng(5).uniform(-1, 1, size=arm.dof)
    for i, (texts, A) in enumerate(zip(symbols, table.matrices(q), strict=True)):
        theta = table.theta_offset[i] + (q[i] if table.joint_types[i] == "R" else 0.0)
        values = {f"c{i + 1}": np.cos(theta), f"s{i + 1}": np.sin(theta), f"q{i + 1}": q[i]}
        got = [
            [eval(text.replace(" c", "*c").replace(" s", "*s"), {}, values) for text in row] for row in texts
        ]
        np.testing.assert_allclose(got, A, atol=1e-5)


def test_dh_as_latex_and_markdown():
    latex = cspace("dh puma560 --latex").out
    assert latex.startswith("\\begin{array}")
    assert latex.count("\\begin{bmatrix}") == 6
    markdown = cspace("dh puma560 --markdown").out
    assert markdown.startswith("| i |")
    assert markdown.count("$$") == 12


def test_robots_finds_by_word_and_by_joints():
    names = {row["name"] for row in cspace("robots --search universal --json").json["robots"]}
    assert {"ur5e", "ur10e", "ur3e"} <= names
    assert all(row["dof"] == 7 for row in cspace("robots --dof 7 --json").json["robots"])
    assert cspace("robots").out.count("\n") > 81
    nothing = cspace("robots --search nosuchthing")
    assert (nothing.code, nothing.err) == (1, "")
    assert "no robot" in nothing.out
    assert cspace("robots --search nosuchthing --json").json["robots"] == []


@pytest.mark.parametrize(
    ("line", "verdict", "numbers"),
    [
        ("info ur5e", "exact", 6),
        ("info ur5e --task position", "redundant", 3),
        ("info panda", "redundant", 6),
        ("info planar_2r", "exact", 2),
        ("info planar_2r --task planar", "over-constrained", 3),
        ("info planar_3r", "exact", 3),
        ("info simplified_puma", "exact", 3),
        ("info scara", "over-constrained", 6),
        ("info ur5e --task 5", "redundant", 5),
    ],
)
def test_info_counts_freedoms_against_the_task(line, verdict, numbers):
    freedoms = cspace(line, "--json").json["freedoms"]
    assert (freedoms["verdict"], freedoms["task_numbers"]) == (verdict, numbers)
    assert verdict in cspace(line).out


def test_info_tells_the_geometry():
    facts = cspace("info ur5e --json").json
    assert facts["geometry"]["closed_form"]
    assert "parallel" in facts["geometry"]["family"]
    assert cspace("info scara --json").json["freedoms"]["rank"] == 4
    limits = [joint["upper"] for joint in facts["joints"]]
    np.testing.assert_allclose(limits, cs.load_robot("ur5e").limits.upper)


@pytest.mark.parametrize(("name", "reason"), [("stanford", "has prismatic joints")])
def test_info_tells_first_why_there_is_no_closed_form(name, reason):
    text = cspace(f"info {name} --json").json["geometry"]["text"]
    assert text.startswith(f"no closed form for {name}")
    assert reason in text
    assert "fails" not in text
    assert "no closed form for" in cspace(f"info {name}").out


def test_doctor_is_well_and_says_what_runs():
    result = cspace("doctor")
    assert result.code == 0
    assert cs.__version__ in result.out
    assert cs._core.isa in result.out


def test_rows_within_limits_are_printed_where_the_limits_are():
    """Joint 3 of this arm goes to −235°: a solution found at 137° is shown a whole turn further back."""
    robot = cs.load_robot("irb1600")
    T = robot.fk([0.2, 0.3, -3.9, 0.5, 0.5, 0.6])
    found = cspace("ik irb1600 --json --matrix", *typed(T.ravel())).json["solutions"]
    inside = [row for row in found if row["within_limits"]]
    assert inside
    for row in inside:
        assert (row["q"] >= robot.limits.lower).all()
        assert (row["q"] <= robot.limits.upper).all()
    assert min(abs(row["q"][2] + 3.9) for row in inside) < 1e-9


def test_words_find_robots_without_an_option():
    assert cspace("robots universal --json").json == cspace("robots --search universal --json").json


def test_products_of_link_matrices_in_every_form():
    assert "px = c1 + c12" in cspace("dh planar_2r --products").out
    assert r"p_x &= c_{1} + c_{12}" in cspace("dh planar_2r --products --latex").out
    assert "$$A_{1} A_{2}" in cspace("dh planar_2r --products --markdown").out
    products = cspace("dh planar_2r --products --json").json["products"]
    assert products[0][0] == ["c12", "−s12", "0", "c1 + c12"]
    assert "products" not in cspace("dh planar_2r --json").json


@pytest.mark.parametrize("robot", ["ur5e", "jaco2", "planar_2r", "al5d", "iiwa14"])
def test_explanations_in_every_form(robot):
    result = cspace(f"ik {robot} --explain --json")
    assert result.code == 0
    schema.check(result.json, "cspace.ik_plan/1")
    assert cspace(f"ik {robot} --explain").out.startswith(f"{robot}: ")
    assert "$$" in cspace(f"ik {robot} --explain --markdown").out
    assert r"\begin{align*}" in cspace(f"ik {robot} --explain --latex").out


def test_goals_that_ask_for_less_are_explained():
    result = cspace("ik al5d --explain --goal-parts position direction --tool-axis x --json")
    assert result.code == 0
    schema.check(result.json, "cspace.ik_plan/1")
    assert "goal_tool_turn_x" in result.json["joints"]
    assert cspace("ik al5d --explain --goal-parts positon").code == 2


def test_an_explanation_of_an_arm_that_nothing_solves_is_a_negative_answer():
    result = cspace("ik p8 --explain --json")
    schema.check(result.json, "cspace.ik_plan/1")
    assert result.code == (0 if result.json["branches"] else 1)
    assert bool(result.json["reason"]) == (result.code == 1)
    assert result.json["relations"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("ik ur5e --explain --xyz 1 0 0", "leave --xyz out"),
        ("ik ur5e --explain --plot a.png", "leave --plot out"),
        ("ik ur5e --xyz 1 0 0 --latex", "used with --explain"),
        ("ik ur5e --xyz 1 0 0 --goal-parts position", "used with --explain"),
    ],
)
def test_goals_and_explanations_do_not_mix(line, words):
    result = cspace(line)
    assert result.code == 2
    assert words in result.err
