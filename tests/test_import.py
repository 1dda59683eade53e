import subprocess
import sys

import pytest

import cspace
from cli.run import environment

BEFORE = set(
    subprocess.run(
        [sys.executable, "-c", "import sys, logging; print(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
)
"""What an interpreter that never heard of cspace has loaded: sites add modules of their own."""


def test_the_compiled_core_and_the_package_have_one_version():
    assert cspace.__version__ == cspace._core.__version__


def test_completion_offers_the_public_names_and_nothing_else():
    offered = {name for name in dir(cspace) if not name.startswith("_")}
    assert offered == {*cspace.__all__, "errors", "tolerances"} - {"__version__"}
    assert all(hasattr(cspace, name) for name in offered)


def test_what_functions_take_beside_arrays_is_at_the_top():
    assert cspace.Limits is cspace.model.Limits


def test_an_unknown_name_carries_what_python_needs_to_suggest_another():
    with pytest.raises(AttributeError) as caught:
        _ = cspace.load_robt
    assert caught.value.name == "load_robt"
    assert caught.value.obj is cspace


def fresh(script: str) -> str:
    """What a fresh interpreter prints."""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, env=environment(), check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_import_alone_loads_no_room_and_no_numpy():
    loaded = set(fresh("import sys, cspace; print(*sys.modules)").split())
    assert not loaded & {"numpy", "cspace.spatial", "cspace._core", "difflib", "dataclasses", "re"} - BEFORE
    assert {name for name in loaded if name.startswith("cspace")} == {"cspace", "cspace.errors"}


def test_a_robot_is_loaded_without_the_network_half_of_the_standard_library():
    loaded = set(fresh("import sys, cspace; cspace.load_robot('ur5e'); print(*sys.modules)").split())
    assert not loaded & {"ssl", "http.client", "urllib.request", "email", "xml.sax", "socket"} - BEFORE


def test_a_star_import_brings_every_public_name():
    names = fresh("from cspace import *; print(*[name for name in dir()])").split()
    assert set(cspace.__all__) <= set(names)
    assert set(cspace.spatial.__all__) < set(cspace.__all__)


def test_questions_for_private_names_load_nothing():
    script = "import sys, cspace; print(hasattr(cspace, '__wrapped__'), 'numpy' in sys.modules)"
    assert fresh(script).split() == ["False", "False"]


INTERRUPTED = """
import os, signal, sys, threading, time
import cspace as cs
robot, scene = cs.load_robot("planar_2r", geometry="skeleton"), cs.Scene([cs.Sphere(0.1, [1, 1, 0])])
came = 0
try:
    threading.Timer(float(sys.argv[1]), os.kill, (os.getpid(), signal.SIGINT)).start()
    {call}
    time.sleep(5)
except KeyboardInterrupt:
    came = 1
{call}
print(came, "whole")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to a process there")
@pytest.mark.parametrize("after", [0.005, 0.02, 0.05, 0.08, 0.12])
@pytest.mark.parametrize("call", ["cs.plan(robot, [2, 0], [2.5, 0], scene)", "robot.ik(position=[1, 1, 0])"])
def test_an_interrupt_leaves_no_room_half_imported(call: str, after: float) -> None:
    script = INTERRUPTED.format(call=call)
    done = subprocess.run(
        [sys.executable, "-c", script, str(after)],
        capture_output=True,
        text=True,
        env=environment(),
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "1 whole\n"
