"""What holds for the whole tree: one version, no prints, no paths of one machine, a light import."""

from __future__ import annotations

import ast
import re
import subprocess
import sys

import cspace
from house import tree

# Standard modules that cost time and that `import cspace` has no use for.
HEAVY = {
    *("xml", "argparse", "asyncio", "multiprocessing", "concurrent", "tomllib", "unittest", "email", "http"),
    *("urllib.request", "sqlite3", "ctypes.util", "importlib.metadata", "pydoc", "doctest", "csv", "gzip"),
}


def loaded_by(statement: str) -> set[str]:
    """The modules that a fresh interpreter holds after running the statement."""
    script = f"{statement}; import sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_import_loads_numpy_and_nothing_heavy():
    extra = loaded_by("import cspace") - loaded_by("import numpy")
    foreign = {
        name
        for name in extra
        if name.split(".")[0] not in sys.stdlib_module_names and name.split(".")[0] not in {"cspace", "numpy"}
    }
    assert foreign == set(), "import these where they are used"
    assert {name for name in extra if name in HEAVY or name.split(".")[0] in HEAVY} == set()


def test_there_is_one_version():
    header = (tree.ROOT / "include/cspace/version.hpp").read_text()
    version = re.search(r'CSPACE_VERSION "([^"]+)"', header).group(1)
    assert cspace.__version__ == version
    for name, text in tree.tracked_texts():
        if name.startswith(("src/", "include/", "cmake/")) or name in {"pyproject.toml", "CMakeLists.txt"}:
            if name == "include/cspace/version.hpp":
                continue
            assert f'"{version}"' not in text, f"{name} repeats the version"


def test_the_library_never_prints():
    for path in tree.python_files():
        if tree.room_of(path) == "cli":
            continue
        for node in tree.nodes(path):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id != "print", f"{path.relative_to(tree.ROOT)}:{node.lineno} prints"
    for name, text in tree.tracked_texts():
        if name.startswith(("src/", "include/")) and name.endswith((".hpp", ".cpp")):
            assert not re.search(r"\bprintf\s*\(|std::c(out|err)\b", text), f"{name} prints"


def test_every_function_can_be_read_at_a_glance():
    for path in tree.python_files():
        for node in tree.nodes(path):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                assert lines <= 70, f"{path.relative_to(tree.ROOT)}: {node.name} has {lines} lines"


def test_no_file_holds_a_path_of_one_machine():
    for name, text in tree.tracked_texts():
        found = re.search(r"(?<![\w.])/(work|farm|root|tmp)/[a-z]\S*", text)
        assert not found, f"{name}: {found.group(0) if found else ''}"


FOREIGN_STATE = {"model/xacro_child.py": "xacro.substitution_args has no other way in"}


def test_private_attributes_are_set_by_the_file_of_their_class():
    """A file sets the private attributes of its own classes; other rooms give a method or an argument."""
    for path in tree.python_files():
        name, text = str(path.relative_to(tree.PACKAGE)), path.read_text(encoding="utf-8")
        own = set(re.findall(r"\b(?:self|cls)\.(_\w+)|^    (_\w+):", text, re.M))
        for found in re.finditer(
            r"^\s*(?!self\b)[\w.]+\.(_(?!_|repr_html_)\w+)(?:: [^=\n]+)? = ", text, re.M
        ):
            known = any(found.group(1) in pair for pair in own) or name in FOREIGN_STATE
            assert known, f"{name}: {found.group().strip()}"


def test_no_random_state_is_global():
    """Randomness is an argument: nobody draws from numpy's global generator."""
    for path in tree.python_files():
        text = path.read_text(encoding="utf-8")
        found = re.search(r"\bnp\.random\.(?!Generator|default_rng|SeedSequence|PCG64|BitGenerator)\w+", text)
        assert not found, f"{path.relative_to(tree.ROOT)}: {found.group(0) if found else ''}"


UNTYPED = re.compile(r"\b(robot|arm|chain): Any\b")


def test_arguments_that_are_robots_or_chains_have_a_type():
    for path in [*tree.python_files(), tree.ROOT / "src/bindings/stubs.pat"]:
        found = UNTYPED.search(path.read_text(encoding="utf-8"))
        assert not found, (
            f"{path}: {found and found[0]}; write KinematicModel, HasSolver, HasGeometry or Chain"
        )
