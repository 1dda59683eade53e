"""How a command line ends: every exit code, with a message that helps and nothing half written."""

from __future__ import annotations

import io
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import cspace as cs
from cli.run import command, cspace, environment
from cspace.cli import app
from cspace.cli.app import VERBS
from cspace.cli.exits import Exit
from cspace.cli.output import Output, Table
from cspace.files import whole_file

BAD_LINES = [
    ("nosuchverb", "no verb 'nosuchverb'"),
    ("fkk ur5e", "did you mean 'fk'"),
    ("--json fk", "the verb comes first"),
    ("fk", "required: ROBOT"),
    ("fk ur5f 0 0 0 0 0 0", "'ur5e'"),
    ("ik zzz --xyz 1 2 3", "cspace robots lists all"),
    ("info zzz", "cspace robots WORD searches them"),
    ("fk ur5e 0 0 0", "has 6 joints, q has 3 values"),
    ("fk ur5e 0 0 0 0 0 nan", "'nan' is not a finite number"),
    ("fk ur5e 0 0 0 0 0 -inf", "'-inf' is not a finite number"),
    ("fk ur5e 0 0 0 0 0 pi/0", "not a finite number"),
    ("fk ur5e 0 0 0 0 0 zero", "'zero' is not a number"),
    ("fk ur5e 0 0 0 0 0 0 --frame wrist_9_link", "wrist_3_link"),
    ("fk ur5e 0 0 0 0 0 0 --tip nolink", "nolink"),
    ("fk ur5e 0 0 0 0 0 0 --nonsense", "unrecognized arguments: --nonsense"),
    ("ik ur5e", "no goal is given: give a pose"),
    ("ik ur5e --xyz 1 2", "expected 3 arguments"),
    ("ik ur5e --xyz 1 2 3 --xy 1 2", "--xyz and --xy"),
    ("ik ur5e --xyz 1 2 3 --rpy 0 0 0 --wxyz 1 0 0 0", "one orientation only"),
    ("ik ur5e --xyz 1 2 3 --wxyz 0 0 0 0", "quaternion"),
    ("ik ur5e --matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 --look-at 1 0 0", "leave --look-at out"),
    ("ik ur5e --xy 0.4 0.1 --rpy 0 0 0", "instead of --rpy give --angle, or --xyz"),
    ("ik ur5e --xyz 0.4 0.1 0.3 --angle 1", "give --xy with it"),
    ("ik ur5e --xy 0.4 0.1 --angle 1", "is not a planar arm"),
    ("ik ur5e --xyz 0.4 any 0.3 --rpy 0 0 0", "--position with --rotation needs three coordinates"),
    ("ik ur5e --xyz any any any", "position has None for all three coordinates"),
    ("ik ur5e --xyz 0.4 0.1 every", "'every' is not a number"),
    ("ik ur5e --xyz 0.4 0.1 0.3 --look-at 1 0 0", "--position and --look-at cannot be combined"),
    ("ik ur5e --direction 0 0 0", "direction is zero"),
    ("ik ur5e --direction 0 0", "expected 3 arguments"),
    ("ik ur5e --direction 0 0 1 --tool-axis w", "axis 'w' is unknown"),
    ("ik ur5e --direction 0 0 1 --tool-axis 1 0", "a name or three numbers, got 2"),
    ("ik ur5e --direction 0 0 1 --tool-axis 1 0 w", "'w' is not a number"),
    (
        "ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --tool-axis x",
        "--tool-axis can only be combined",
    ),
    ("ik ur5e --angle-to z 1", "--angle-to needs a position: give --xyz too"),
    ("ik ur5e --xyz 0.4 0.1 0.3 --angle-to x w", "--angle-to takes an axis and an angle: 'w'"),
    ("ik ur5e --xyz 0.4 0.1 0.3 --angle-to x 4", "expected 0 to π rad"),
    ("ik ur5e --xyz 0.4 0.1 0.3 --direction 0 0 1 --swivel 1", "--swivel needs a full pose"),
    ("ik planar_2r --xy 0.4 0.1 --swivel 1", "--swivel needs a full pose"),
    ("ik ur5e --xyz 0.4 0.1 0.3 --direction 0 0 1 --locked goal_turn=1", "goal_tool_turn_z"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --locked elbow=1", "did you mean 'elbow_joint'?"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --locked elbow_joint", "not of the form NAME=VALUE"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --locked elbow_joint=w", "'w' is not a number"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --locked elbow_joint=1 q3=2", "--locked names elbow_joint twice"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --swivel 1", "ur5e has no swivel"),
    (
        "ik iiwa14 --xyz 0.4 0 0.3 --rpy 0 3 0 --swivel 1 --locked q1=0",
        "--swivel can only be combined",
    ),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --samples 3", "leave --samples out"),
    ("ik panda --xyz 0.4 0 0.3 --rpy 0 3 0 --samples 0", "samples is 0; it must be 1 to"),
    ("ik panda --xyz 0.4 0 0.3 --rpy 0 3 0 --samples many", "invalid int value: 'many'"),
    (
        "ik panda --xyz 0.4 0 0.3 --rpy 0 3 0 --samples 3 --near 0 0 0 0 0 0 0",
        "--samples cannot be combined with --near",
    ),
    (
        "ik ur5e --explain --locked q2=1 --goal-parts position",
        "--locked can only be combined with a full pose; leave --goal-parts out",
    ),
    ("ik ur5e --explain --tool-axis x", "--tool-axis can only be combined"),
    ("ik ur5e --explain --look-at 1 0 0", "leave --look-at out"),
    ("ik ur5e --explain --samples 3", "leave --samples out"),
    ("ik ur5e --explain --near 0 0 0 0 0 0", "leave --near out"),
    ("ik ur5e --matrix 2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "rotation"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --near 1 2", "--near has 2 values"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --limits maybe", "invalid choice: 'maybe'"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --plot /nosuchfolder/x.png", "there is no folder"),
    ("ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --plot picture.bmp", ".png, .svg, .pdf"),
    (f"ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --plot {'x' * 300}.png", "name too long"),
    ("ik ur5e --xyz 1_0 0 0.3 --rpy 0 3 0", "'1_0' is not a number"),
    ("fk ur5e 0 0 0 0 0 1_0", "'1_0' is not a number"),
    ("info ur5e --task lots", "no task 'lots'"),
    ("dh ur5e --convention classic", "invalid choice: 'classic'"),
    ("dh ur5e --latex --markdown", "not allowed with"),
    ("dh ur5e --time-limit 0", "'0' is not a time limit"),
    ("dh ur5e --time-limit 1e30", "not a time limit"),
    *(
        (f"{line}=--", "-- is not a value")
        for line in (
            "ik ur5e --xyz 0.4 0 0.3 --rpy 0 3 0 --plot",
            "fk ur5e 0 0 0 0 0 0 --xacro-arg",
            "fk ur5e 0 0 0 0 0 0 --time-limit",
            "export ur5e -o",
        )
    ),
    ("jacobian ur5e 0 0 0 0 0 0 --expressed-in world", "invalid choice"),
]


@pytest.mark.parametrize(("line", "message"), BAD_LINES, ids=[line for line, _ in BAD_LINES])
def test_a_bad_line_is_refused_with_code_2(line, message):
    result = cspace(line)
    assert result.code == Exit.USAGE
    assert message in result.err
    assert result.out == ""
    assert result.err.startswith("cspace: ")
    assert "Traceback" not in result.err


@pytest.mark.parametrize(
    "line", ["info {}", "info {}.urdf", "nav {}.png", "{}", "fk ur5e 0 0 0 0 0 0 --frame {}", "fk ur5e {}"]
)
def test_long_words_are_not_repeated_whole(line):
    result = cspace(line.format("x" * 5000))
    assert result.code in (Exit.USAGE, Exit.BAD_FILE)
    assert len(result.err) < 1000
    assert "cs.robots" not in result.err


BAD_FILES = [
    ("broken.urdf", "<robot name='r'>\n<link name='a'/>\n<link></robot>", ":3:"),
    ("type.urdf", "<robot name='r'>\n<link name='a'/><link name='b'/>\n"
     "<joint name='j' type='revolvy'><parent link='a'/><child link='b'/></joint></robot>", ":3:"),
    ("cycle.urdf", "<robot name='r'><link name='a'/><link name='b'/>\n"
     "<joint name='j' type='locked'><parent link='a'/><child link='b'/></joint>\n"
     "<joint name='k' type='locked'><parent link='b'/><child link='a'/></joint></robot>", "cycle.urdf"),
    ("axis.urdf", "<robot name='r'><link name='a'/><link name='b'/>\n"
     "<joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 0'/></joint>\n"
     "</robot>", ":2:"),
    ("limits.urdf", "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='j' type='revolute'>"
     "<parent link='a'/><child link='b'/><limit lower='1' upper='-1' effort='1' velocity='1'/></joint>\n"
     "</robot>", "reversed"),
    ("nan.urdf", "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='j' type='locked'>"
     "<parent link='a'/><child link='b'/><origin xyz='nan 0 0'/></joint></robot>", "nan"),
    ("recipe.urdf", "two eggs and some flour", "recipe.urdf"),
    ("empty.urdf", "", "empty.urdf"),
    ("broken.toml", "name = [", "broken.toml"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "message"), BAD_FILES, ids=[row[0] for row in BAD_FILES])
@pytest.mark.parametrize("verb", ["info", "dh", "fk"])
def test_a_bad_file_is_refused_with_code_3(tmp_path, verb, name, text, message):
    path = tmp_path / name
    path.write_text(text)
    result = cspace(verb, str(path))
    assert result.code == Exit.BAD_FILE, result.err
    assert name in result.err
    assert message in result.err
    assert result.out == ""


def test_a_file_that_is_not_there_is_a_bad_file(tmp_path):
    result = cspace("info", str(tmp_path / "gone.urdf"))
    assert result.code == Exit.BAD_FILE
    assert "gone.urdf" in result.err


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


SEEN_AT_TERMINALS = [
    "info ur5e", "info fetch", "info so101", "ik panda --explain", "ik jaco2 --explain", "dh ur5e --products",
    "ik panda --xyz 0.4 0.2 0.4 --rpy 180 0 90 --deg", "ik ur5e --xyz 3 0 0", "robots", "planners", "doctor",
    "traj panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8", "simulate panda", "info no_such_robot",
    "plan panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8", "dynamics panda", "fk ur5e 0 0 0 0 0 0",
    "--help", *(f"{verb} --help" for verb in app.VERBS),
]  # fmt: skip


@pytest.mark.parametrize("line", SEEN_AT_TERMINALS)
def test_nothing_is_wider_than_a_terminal_of_eighty_columns(monkeypatch, line):
    monkeypatch.setenv("COLUMNS", "80")
    streams = Terminal(), Terminal()
    monkeypatch.setattr("sys.stdout", streams[0])
    monkeypatch.setattr("sys.stderr", streams[1])
    app.main(line.split())
    text = re.sub(r"\x1b\[[0-9;]*m", "", "".join(stream.getvalue() for stream in streams))
    assert text
    assert [each for each in text.splitlines() if len(each) > 80] == []


def test_a_terminal_gets_a_table_with_lines(monkeypatch):
    pytest.importorskip("rich")
    monkeypatch.setenv("COLUMNS", "160")
    monkeypatch.setattr("sys.stdout", stream := Terminal())
    assert app.main(["ik", "ur5e", "--xyz", "0.4", "0.1", "0.3", "--rpy", "0", "pi", "0"]) == Exit.DONE
    shown = stream.getvalue()
    assert "─" in shown
    assert "shoulder" in shown
    monkeypatch.setattr("sys.stdout", stream := Terminal())
    for line in ("info ur5e", "dh scara", "jacobian ur5e 0 1 1 1 1 1", "robots", "fk ur5e 0 0 0 0 0 0"):
        assert app.main(line.split()) == Exit.DONE


GOALS = [
    "ur5e --xyz 0.4 0.2 0.4 --rpy 180 0 90 --deg",
    "ur5e --xyz 0.4 0.1 0.3 --rpy 0 pi 0",
    "puma560 --xyz 0.5 0 0.3 --wxyz 0 1 0 0 --near 0 0 0 0 0 0",
    "kr6_r900 --xyz 0.4 0.1 0.5 --rpy 0 90 0 --deg",
    "stanford --xyz 0.3 0.2 0.4 --rpy 0 1 0",
    "jaco2 --xyz 0.3 0.2 0.5 --rpy 0 1 0",
    "scara --xyz 0.4 0.1 -0.1",
    "planar_2r --xy 0.6 0.3",
    "panda --xyz 0.4 0.1 0.4 --rpy pi 0 0 --samples 2",
    "ur5e --xyz 4 0 0 --rpy 180 0 90 --deg",
]


@pytest.mark.parametrize("columns", [80, 100])
@pytest.mark.parametrize("goal", GOALS)
def test_no_line_of_a_terminal_wraps_and_joints_are_rounded_only(monkeypatch, goal, columns):
    pytest.importorskip("rich")
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setattr("sys.stdout", stream := Terminal())
    code = app.main(["ik", *goal.split()])
    lines = re.sub(r"\x1b\[[0-9;]*m", "", stream.getvalue()).splitlines()
    assert max(map(len, lines)) <= columns
    document = cspace(f"ik {goal} --json").json
    assert code == (Exit.DONE if document["solutions"] else Exit.NEGATIVE)
    shown = [line.split() for line in lines if re.match(r"\d+ ", line)]
    assert len(shown) == len(document["solutions"])
    for row, words in zip(document["solutions"], shown, strict=True):
        robot = cs.load_robot(document["robot"])
        turned = [q * 180 / np.pi if "--deg" in goal else q for q in row["q"]]
        values = [
            t if kind == "R" else q for t, q, kind in zip(turned, row["q"], robot.joint_types, strict=True)
        ]
        for value, word in zip(values, words[1:], strict=False):
            decimals = len(word.partition(".")[2])
            assert decimals >= (1 if "--deg" in goal else 3)
            assert abs(float(word) - value) <= 0.501 * 10.0**-decimals


def test_details_show_every_column(monkeypatch):
    goal = "kr6_r900 --xyz 0.4 0.1 0.5 --rpy 0 90 0 --deg"
    short, full = cspace(f"ik {goal}").out, cspace(f"ik {goal} --details").out
    for word in ("limits", "singularity", "branch", "residual", " out by ", "elbow up"):
        assert word in full
    assert "residual" not in short
    assert "out of limits" in short


def test_a_terminal_without_rich_gets_plain_tables_and_is_told_once_what_draws_them(monkeypatch):
    monkeypatch.setitem(sys.modules, "rich.console", None)
    monkeypatch.setattr("sys.stdout", stream := Terminal())
    out = Output()
    table = Table(["name", "value"])
    table.add("x", "1")
    out.table(table)
    out.table(table)
    assert stream.getvalue().count("pip install 'cspace[cli]'") == 1
    assert stream.getvalue().count("x         1\n") == 2


def test_a_terminal_gets_colours_unless_it_or_its_user_does_not_want_them(monkeypatch):
    for name, value in (("NO_COLOR", "1"), ("TERM", "dumb"), ("TERM", "xterm")):
        with monkeypatch.context() as patch:
            patch.delenv("NO_COLOR", raising=False)
            patch.setenv("TERM", "xterm")
            patch.setenv("WT_SESSION", "1")
            patch.setenv(name, value)
            patch.setattr("sys.stdout", stream := Terminal())
            assert app.main(["fk", "ur5e", "0", "0", "0", "0", "0", "0"]) == Exit.DONE
            assert ("\x1b[" in stream.getvalue()) == (value == "xterm")


FULL = "/dev/full"
"""The device on which every write meets a full disk."""


@pytest.mark.slow
@pytest.mark.skipif(not Path(FULL).is_char_device(), reason="needs the device /dev/full")
@pytest.mark.parametrize(
    "line",
    [
        *("--help", "--version", "fk --help", "robots", "robots --json", "info ur5e", "info ur5e --json"),
        *("fk ur5e 0 0 0 0 0 0", "ik ur5e --xyz 0.4 0.1 0.3 --rpy 0 3 0", "jacobian ur5e 0 1 1 1 1 1"),
        *("dh ur5e", "dh ur5e --latex", "doctor"),
    ],
)
def test_a_full_disk_is_told_and_is_no_internal_error(line):
    with open(FULL, "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "cspace", *line.split()],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            env=environment(),
            check=False,
        )
    assert done.returncode == Exit.USAGE
    assert done.stderr.startswith("cspace: the answer cannot be written: No space left on device")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="needs a limit on the size of files")
def test_a_picture_for_which_there_is_no_room_leaves_what_was_there(tmp_path):
    pytest.importorskip("matplotlib.pyplot")
    path = tmp_path / "x.png"
    path.write_text("old")
    script = (
        "import resource, signal, sys\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "import matplotlib.pyplot  # which writes caches of its own\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))\n"
        "from cspace.cli import main\n"
        "sys.exit(main(sys.argv[1:]))"
    )
    words = [
        sys.executable,
        "-c",
        script,
        *["ik", "ur5e", "--xyz", "0.4", "0.1", "0.3", "--rpy", "0", "3", "0", "--plot"],
        str(path),
    ]
    done = subprocess.run(words, capture_output=True, text=True, env=environment(), check=False)
    assert (done.returncode, path.read_text(), list(tmp_path.iterdir())) == (Exit.USAGE, "old", [path])
    assert f"{path} cannot be written: File too large" in done.stderr


def test_a_time_limit_ends_a_verb_with_code_5(monkeypatch, capsys):
    def sleep(args: object, out: object) -> int:
        time.sleep(30)
        return Exit.DONE

    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr("cspace.cli.verbs.doctor.run", sleep)
    start = time.perf_counter()
    assert app.main(["doctor", "--time-limit", "0.05"]) == Exit.TIME_LIMIT
    assert time.perf_counter() - start < 10
    assert capsys.readouterr().err == "cspace: stopped after 0.05 s (--time-limit)\n"
    assert signal.getsignal(signal.SIGINT) is before


def test_a_time_limit_that_is_not_reached_changes_nothing():
    line = "fk ur5e 0 0 0 0 0 0"
    assert cspace(line, "--time-limit", "60") == cspace(line)


def test_an_interrupt_within_a_time_limit_is_an_interrupt(monkeypatch):
    monkeypatch.setattr("cspace.cli.verbs.doctor.run", lambda args, out: signal.raise_signal(signal.SIGINT))
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        assert app.main(["doctor", "--time-limit", "60"]) == Exit.INTERRUPTED
    finally:
        signal.signal(signal.SIGINT, previous)


def test_pipes_and_json_do_without_rich(monkeypatch):
    monkeypatch.setitem(sys.modules, "rich", None)
    monkeypatch.setitem(sys.modules, "rich.console", None)
    assert cspace("robots").code == Exit.DONE
    assert cspace("robots --json").code == Exit.DONE


def test_a_missing_matplotlib_is_told(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    result = cspace("ik ur5e --xyz 0.4 0.1 0.3 --rpy 0 pi 0 --plot", str(tmp_path / "x.png"))
    assert result.code == Exit.MISSING_EXTRA
    assert "pip install 'cspace[plot]'" in result.err
    assert list(tmp_path.iterdir()) == []


def test_an_unexpected_fault_is_one_line_and_code_70(monkeypatch, capsys):
    def fail(verb: str) -> None:
        raise ZeroDivisionError("the sky\nfell")

    monkeypatch.setattr(app, "import_verb", fail)
    assert app.main(["fk", "ur5e"]) == Exit.INTERNAL
    message = capsys.readouterr().err
    assert "ZeroDivisionError: the sky" in message
    assert "--debug" in message
    with pytest.raises(ZeroDivisionError):
        app.main(["fk", "ur5e", "--debug"])


def test_an_interrupt_is_code_130(monkeypatch, capsys):
    def interrupt(verb: str) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(app, "import_verb", interrupt)
    assert app.main(["fk", "ur5e"]) == Exit.INTERRUPTED
    assert capsys.readouterr().err == "cspace: interrupted\n"


def test_nothing_half_written_is_left(tmp_path):
    path = tmp_path / "answer.txt"
    path.write_text("old")

    def write_and_fail() -> None:
        with whole_file(path) as draft:
            draft.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        write_and_fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
    with whole_file(path) as draft:
        draft.write_text("whole")
    assert path.read_text() == "whole"
    assert list(tmp_path.iterdir()) == [path]


def test_help_and_version():
    assert cspace("").code == cspace("--help").code == cspace("help").code == Exit.DONE
    for verb, summary in VERBS.items():
        assert f"{verb} " in cspace("--help").out
        assert summary in " ".join(cspace("--help").out.split())
    assert cspace("--version").out.startswith("cspace ")


def test_a_reader_that_leaves_is_no_error():
    """`cspace robots | head -1`: one line is read, then the pipe is closed; not a word of complaint."""
    process = subprocess.Popen(
        [sys.executable, "-m", "cspace", "dh", "ur5e", "--markdown"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment(PYTHONUNBUFFERED="1"),
    )
    process.stdout.close()
    error = process.stderr.read()
    process.stderr.close()
    assert process.wait(timeout=60) == Exit.CLOSED_PIPE
    assert error == b""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
def test_control_c_ends_quietly(tmp_path):
    """A run is interrupted in the middle of its work, by the signal that Ctrl-C sends."""
    script = (
        "import signal, sys, time, cspace.cli.app as app\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it\n"
        "def load(verb):\n    print('ready', flush=True)\n    time.sleep(60)\n"
        "app.import_verb = load\nsys.exit(app.main(['fk', 'ur5e']))\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment()
    )
    assert process.stdout.readline() == b"ready\n"
    time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=30)
    assert process.returncode == Exit.INTERRUPTED
    assert error == b"cspace: interrupted\n"


def test_a_terminal_that_cannot_show_a_character_is_no_error():
    done = subprocess.run(
        [sys.executable, "-m", "cspace", "info", "ur5e"],
        capture_output=True,
        timeout=60,
        env=environment(PYTHONIOENCODING="ascii"),
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.parametrize(
    ("words", "unwanted"),
    [
        (["--help"], {"numpy", "argparse", "rich", "matplotlib"}),
        (["fk", "--help"], {"rich", "matplotlib", "scipy", "cspace.robots"}),
        (
            ["ik", "ur5e", "--xyz", "0.4", "0.1", "0.3", "--rpy", "0", "3", "0"],
            {"rich", "matplotlib", "scipy"},
        ),
    ],
)
def test_only_what_a_verb_needs_is_imported(words, unwanted):
    script = (
        "import sys; from cspace.cli import main; code = main(sys.argv[1:]);"
        "print(*sys.modules, file=sys.stderr); sys.exit(code)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, *words], capture_output=True, text=True, env=environment(), check=False
    )
    assert done.returncode == 0
    others = {verb for verb in VERBS if verb != words[0]}
    loaded = set(done.stderr.split())
    assert not loaded & (unwanted - {"numpy"})
    assert not {f"cspace.cli.verbs.{verb}" for verb in others} & loaded


def test_the_module_runs_as_a_command():
    done = command("fk", "ur5e", "0", "0", "0", "0", "0", "-1e-3", "--json")
    assert done.returncode == 0
    assert done.stdout.startswith('{"schema": "cspace.fk/1"')


@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell that closes streams")
def test_a_closed_output_is_no_error():
    words = [sys.executable, "-m", "cspace", "info", "ur5e"]
    done = subprocess.run(
        ["sh", "-c", 'exec "$@" >&-', "sh", *words], stderr=subprocess.PIPE, env=environment(), check=False
    )
    assert (done.returncode, done.stderr) == (0, b"")


POSE = "--xyz 0.4 0.1 0.3 --rpy"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("fk ur5e 0 -90 90 0 90 0", True),
        ("fk ur5e 0 -90 90 0 90 0 --deg", False),
        ("fk ur5e 0 -pi/2 pi/2 0 6.28 0", False),
        ("jacobian ur5e 0 -90 90 0 90 0", True),
        ("jacobian ur5e 0 -1 1 0 1 0", False),
        (f"ik ur5e {POSE} 0 180 0", True),
        (f"ik ur5e {POSE} 0 180 0 --deg", False),
        (f"ik ur5e {POSE} 0 pi 0 --near 0 -90 90 0 0 0", True),
        (f"ik ur5e {POSE} 0 pi 0", False),
        ("ik planar_3r --xy 1.5 0.8 --angle 30", True),
        ("ik planar_3r --xy 1.5 0.8 --angle 0.5", False),
    ],
)
def test_angles_that_seem_to_be_degrees_are_noticed_at_a_terminal_alone(line, told, monkeypatch):
    monkeypatch.setattr("sys.stdout", stream := Terminal())
    app.main(line.split())
    assert ("--deg" in stream.getvalue()) == told
    assert "--deg" not in cspace(line).out


@pytest.mark.parametrize(
    ("line", "old", "new"),
    [
        ("ik panda --xyz 0.4 0.1 0.4 --rpy pi 0 0 --fixed panda_joint7=0.3", "--fixed", "--locked"),
        ("ik panda --explain --asked position", "--asked", "--goal-parts"),
        ("export panda --fixed panda_joint7", "--fixed", "--locked"),
        ("export panda --fixed=panda_joint7", "--fixed", "--locked"),
    ],
)
def test_an_old_option_names_the_new_one(line, old, new):
    done = cspace(line)
    assert done.code == 2
    assert f"unknown option {old}: use {new};" in done.err
