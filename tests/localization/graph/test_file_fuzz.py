"""Cut and mutated files of pose graphs are read as far as they go, or refused with file and line."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, LogError
from localization.mutations import mutate

PLANE = "100 0 0 100 0 400"
FILES = {
    "g2o": "".join(f"VERTEX_SE2 {k} {k} 0 0\n" for k in range(4))
    + "VERTEX_XY 9 1 1\nFIX 0\n"
    + "".join(f"EDGE_SE2 {k} {k + 1} 1 0 0 {PLANE}\n" for k in range(3))
    + "EDGE_SE2_XY 0 9 1 1 10 0 10\nEDGE_SE2_XY 1 9 0 1 10 0 10\nEDGE_BEARING_SE2_XY 2 9 2.3 10\n",
    "space": "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"
    + "".join(f"VERTEX_SE3:QUAT {k} {k} 0 0 0 0 0 1\n" for k in range(3))
    + "VERTEX_TRACKXYZ 7 1 1 1\n"
    + "".join(
        f"EDGE_SE3:QUAT {k} {k + 1} 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n"
        for k in range(2)
    )
    + "EDGE_SE3_TRACKXYZ 0 7 0 1 1 1 1 0 0 1 0 1\n",
    "toro": "".join(f"VERTEX2 {k} {k} 0 0\n" for k in range(4))
    + "".join(f"EDGE2 {k} {k + 1} 1 0 0 100 0 100 400 0 0\n" for k in range(3)),
    "toro_space": "".join(f"VERTEX3 {k} {k} 0 0 0 0 0\n" for k in range(3))
    + "".join(f"EDGE3 {k} {k + 1} 1 0 0 0 0 0\n" for k in range(2)),
    "victoria": "".join(
        f"ODOMETRY {k} {k + 1} 1 0 0.1 0.1 0 0 0.1 0 0.1\nLANDMARK {k + 1} {50 + k % 3} 3 -1 0.1 0 0.1\n"
        for k in range(5)
    ),
}
WORDS = ["nan", "inf", "-inf", "1e400", "1e308", "1e200", "-1", "0", "1e-320", "", "x", "#", "\x00", "٣"]
WORDS += ["9" * 20, "9" * 5000, "0" * 5000, "1_0", "0x10", "VERTEX_SE2", "EDGE_SE2", "EDGE2", "FIX", "-"]


def read_strictly(path) -> cs.PoseGraph | LogError:
    """The graph, or what names the file; warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return cs.PoseGraph.read(path)
        except LogError as error:
            found = error
    assert path.name in str(found)
    return found


@pytest.mark.parametrize("name", FILES)
def test_files_cut_anywhere_hold_a_part_or_name_the_cut_line(tmp_path, name):
    """What is read begins as the whole does; numbers that a cut shortens may be others in the last edge."""
    path = tmp_path / "cut.g2o"
    path.write_text(FILES[name])
    whole = cs.PoseGraph.read(path)
    counts = []
    for size in range(len(FILES[name])):
        text = FILES[name][:size]
        path.write_text(text)
        found = read_strictly(path)
        if isinstance(found, LogError):
            line = re.search(r"cut\.g2o:(\d+)", str(found))
            assert line is None or 1 <= int(line[1]) <= text.count("\n") + 1
            continue
        n, k = len(found.poses), len(found.edges)
        counts.append((n, k, len(found.sightings)))
        clean = max(0, k - (not text.endswith("\n")))
        assert np.array_equal(found.ids[: n - 1], whole.ids[: n - 1])
        assert np.array_equal(found.motions[:clean], whole.motions[:clean])
        assert np.array_equal(found.information[:clean], whole.information[:clean])
    assert counts
    assert counts == sorted(counts)
    assert counts[-1][:2] == (len(whole.poses), len(whole.edges))


@pytest.mark.parametrize("name", FILES)
def test_mutated_files_are_read_and_optimized_or_refused(tmp_path, name):
    rng, path, read = np.random.default_rng(len(name)), tmp_path / "mutated.g2o", 0
    for _ in range(400):
        path.write_text(mutate(FILES[name], WORDS, rng), encoding="utf-8")
        found = read_strictly(path)
        if isinstance(found, LogError):
            continue
        read += 1
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                answer = found.optimize()
            except CspaceError:
                continue
        assert not answer or (np.isfinite(answer.poses).all() and np.isfinite(answer.chi2))
    assert 20 < read < 380


@pytest.mark.parametrize(
    "line", ["VERTEX_SE2", "FIX", "EDGE_SE2 0", "EDGE_BEARING_SE2_XY", "EDGE_SE2_XY 0", "VERTEX_XY"]
)
def test_lines_without_their_ids_are_named(tmp_path, line):
    path = tmp_path / "short.g2o"
    path.write_text(f"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 {PLANE}\n{line}\n")
    found = read_strictly(path)
    assert line == "FIX" or (isinstance(found, LogError) and "short.g2o:4" in str(found))


@pytest.mark.parametrize("length", [1e-320, 1e-200, 3.0, 1e99])
def test_quaternions_of_any_length_are_directions(tmp_path, length):
    path = tmp_path / "long.g2o"
    path.write_text(f"VERTEX_SE3:QUAT 0 0 0 0 0 0 {length:g} {length:g}\n")
    found = read_strictly(path)
    assert isinstance(found, cs.PoseGraph)
    assert np.allclose(found.poses[0, :3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-3)


@pytest.mark.parametrize("size", [1e101, 1e200, 1.7e308])
@pytest.mark.parametrize("name", ["poses", "motions", "information"])
def test_numbers_whose_products_overflow_are_named(name, size):
    given = {"poses": np.zeros((2, 3)), "motions": [[1, 0, 0.0]], "information": np.eye(3)}
    given[name] = np.asarray(given[name]) + size * np.eye(3)[: len(given[name])]
    with pytest.raises(CspaceError, match=name):
        cs.PoseGraph(edges=[(0, 1)], **given)
    if name != "poses":
        with pytest.raises(CspaceError, match="largest allowed"):
            cs.IncrementalGraph().add(0, 1, given["motions"][0], given["information"])
