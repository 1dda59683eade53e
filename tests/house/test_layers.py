"""Rooms import downward only, siblings never sideways; optional parts only inside functions."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from house import tree

CPP_FILES = sorted(path for ending in ("*.hpp", "*.cpp") for path in (tree.ROOT / "include").rglob(ending))
KERNEL_FILES = sorted((tree.ROOT / "src/kernels").glob("*.cpp"))
BINDING_FILES = sorted((tree.ROOT / "src/bindings").glob("*.cpp"))
# Rooms whose solvers src/kernels and src/library compile, and the headers of plain data that bindings share.
COMPILED_ROOMS = {
    *("collision", "dynamics", "ik", "kinematics", "localization", "maps", "mobile", "navigation"),
    *("planning", "search", "shapes", "trajectory"),
}
PLAIN_HEADERS = {
    "cspace/collision/robot.hpp",
    "cspace/collision/scene.hpp",
    "cspace/collision/workspace.hpp",
    "cspace/dynamics/loop_memory.hpp",
    "cspace/dynamics/make_links.hpp",  # converts the joints and bodies of a robot
    "cspace/dynamics/multibody.hpp",
    "cspace/dynamics/roll_out_task.hpp",
    "cspace/ik/chain.hpp",
    "cspace/ik/solution.hpp",
    "cspace/ik/tracking/layers.hpp",
    "cspace/kinematics/closed_loops.hpp",
    "cspace/kinematics/loop_places.hpp",
    "cspace/kinematics/pose_matrix.hpp",
    "cspace/localization/graph/options.hpp",
    "cspace/localization/landmarks/options.hpp",
    "cspace/localization/landmarks/rejection_sum.hpp",  # counts
    "cspace/mobile/car_pose.hpp",
    "cspace/mobile/walk_rates.hpp",
    "cspace/navigation/curves/curve.hpp",
    "cspace/navigation/route.hpp",
    "cspace/planning/options.hpp",
    "cspace/shapes/plain.hpp",
}
# What a plain header needs of other rooms: its bindings reach these too, the others may not.
REACHED_THROUGH = {
    "cspace/ik/chain.hpp": {"cspace/kinematics/forward.hpp", "cspace/kinematics/jacobian.hpp"},
    "library/trajectory_timing.hpp": {"cspace/trajectory/path_rows.hpp"},  # its first half is plain data
}


def cspace_room(module: str) -> str | None:
    """The room that a module name of the package points into; None for modules of others."""
    parts = module.split(".")
    if parts[0] != "cspace":
        return None
    return parts[1] if len(parts) > 1 else "cspace"


@pytest.mark.parametrize("path", tree.python_files(), ids=tree.module_name)
def test_every_file_belongs_to_a_room_of_the_diagram(path):
    assert tree.room_of(path) in tree.RANK, "give the room its tier in tests/house/tree.py"


@pytest.mark.parametrize("path", tree.python_files(), ids=tree.module_name)
def test_imports_go_downward_and_never_sideways(path):
    room = tree.room_of(path)
    for found in tree.imports(path):
        target = cspace_room(found.module)
        if target is None or target == room:
            continue
        if target not in tree.RANK:
            assert room == "cspace" or target == "__version__", f"{found.where}: imports {found.module}"
            continue
        assert tree.RANK[target] < tree.RANK[room], f"{found.where}: {room} may not import {target}"


def test_files_of_a_room_import_each_other_in_no_circle():
    modules = {tree.module_name(p) for p in tree.python_files() if p.name != "__init__.py"}
    below = {
        tree.module_name(p): {found.module for found in tree.imports(p)} & modules
        for p in tree.python_files()
        if p.name != "__init__.py"
    }
    while free := {module for module, imported in below.items() if not imported}:
        below = {module: imported - free for module, imported in below.items() if module not in free}
    assert not below, f"files in circles, and those that import them: {sorted(below)}"


@pytest.mark.parametrize("path", tree.python_files(), ids=tree.module_name)
def test_only_numpy_and_the_standard_library_are_imported_at_import(path):
    optional = tree.OPTIONAL_IMPORTS.get(tree.room_of(path), set())
    for found in tree.imports(path):
        package = found.module.split(".")[0]
        if package in {"cspace", "numpy"} or package in sys.stdlib_module_names:
            continue
        assert package in optional, f"{found.where}: {package} is no dependency of this room"
        assert not found.at_import, f"{found.where}: {package} is optional: import it where it is used"


@pytest.mark.parametrize("path", CPP_FILES, ids=lambda path: str(path.relative_to(tree.ROOT)))
def test_headers_include_the_standard_library_and_lower_rooms_only(path):
    parts = path.relative_to(tree.ROOT / "include/cspace").parts
    for line, target in tree.includes(path):
        where = f"{path.relative_to(tree.ROOT)}:{line}"
        if target.startswith("<"):
            assert re.fullmatch(r"<[a-z0-9_]+(\.h)?>", target), f"{where}: no such library here: {target}"
            continue
        assert target.startswith('"cspace/'), f"{where}: write the path from cspace/: {target}"
        room = target.strip('"').split("/")[1]
        if len(parts) == 1 or room == parts[0] or room.endswith(".hpp"):
            continue
        assert tree.RANK[room] < tree.RANK[parts[0]], f"{where}: {parts[0]} may not include {room}"


@pytest.mark.parametrize("path", KERNEL_FILES, ids=lambda path: path.name)
def test_kernels_hold_plain_arrays_and_know_no_python(path):
    containers = {"vector", "string", "map", "set", "deque", "list", "unordered_map", "functional", "memory"}
    for line, target in tree.includes(path):
        name = target.strip('<>"')
        where = f"{path.relative_to(tree.ROOT)}:{line}"
        assert name not in containers, f"{where}: a container here is compiled per instruction set and leaks"
        assert not name.startswith(("Python.h", "nanobind", "numpy")), f"{where}: kernels know no Python"


def test_the_walls_hold(tmp_path, monkeypatch):
    """A sideways import and an optional import at module level are found by the functions used above."""
    package = tmp_path / "cspace"
    (package / "ik").mkdir(parents=True)
    path = package / "ik" / "bad.py"
    path.write_text("import matplotlib\nfrom cspace import planning\ndef f():\n    import rich\n")
    monkeypatch.setattr(tree, "ROOT", tmp_path)
    monkeypatch.setattr(tree, "PACKAGE", package)
    found = {i.module: i.at_import for i in tree.imports(path)}
    assert found == {"matplotlib": True, "cspace.planning": True, "rich": False}
    assert tree.RANK["planning"] == tree.RANK[tree.room_of(path)]


def reachable_headers(path: Path) -> set[str]:
    """Every header of the project that a C++ file includes, directly or through others, by its path below
    include or src."""
    seen: set[Path] = set()
    waiting = [path]
    while waiting:
        at = waiting.pop()
        for _, target in tree.includes(at):
            name = target.strip('"<>')
            places = [at.parent / name, tree.ROOT / "include" / name, tree.ROOT / "src" / name]
            found = next((place.resolve() for place in places if place.is_file()), None)
            if found is not None and found not in seen:
                seen.add(found)
                waiting.append(found)
    roots = (tree.ROOT / "include", tree.ROOT / "src")
    return {str(path.relative_to(root)) for path in seen for root in roots if path.is_relative_to(root)}


@pytest.mark.parametrize("path", BINDING_FILES, ids=lambda path: path.name)
def test_bindings_include_no_solver(path):
    reached = reachable_headers(path)
    shared = PLAIN_HEADERS.union(*(REACHED_THROUGH[name] for name in reached & set(REACHED_THROUGH)))
    solvers = {
        name
        for name in reached - shared
        if name.startswith("cspace/") and name.split("/")[1] in COMPILED_ROOMS
    }
    assert not solvers, f"call a function of src/library instead of including {sorted(solvers)}"


def test_every_room_of_headers_with_a_solver_is_behind_the_library():
    folders = {path.name for path in (tree.ROOT / "include/cspace").iterdir() if path.is_dir()}
    assert folders - COMPILED_ROOMS == {"math", "model", "spatial"}, "vectors, descriptions and rotations"


def test_plain_headers_are_reached():
    reached = set().union(*(reachable_headers(path) for path in BINDING_FILES))
    assert reached >= PLAIN_HEADERS.union(*REACHED_THROUGH.values()), "remove what no binding reaches"
