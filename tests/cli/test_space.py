"""`cspace space`: components, paths to every solution of a position, pictures, and how it ends."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cli.schema import check

WALLS = "0.75 0.95\n1.35 0.75\n1.45 1.3\n0.95 1.45\n\n-1.45 0.25\n-0.85 0.35\n-1.05 0.95\n"


@pytest.fixture
def walls(tmp_path):
    path = tmp_path / "walls.txt"
    path.write_text(WALLS)
    return path


def test_a_path_leads_to_a_solution_of_the_position(walls):
    result = cspace(f"space planar_2r --scene {walls} --from -0.3 0.5 --to -1.2 1.25 --json")
    assert result.code == 0
    document = result.json
    check(document)
    arm = cs.load_robot("planar_2r")
    path = np.array(document["path"])
    np.testing.assert_array_equal(path[0], [-0.3, 0.5])
    np.testing.assert_allclose(arm.fk(path[-1])[:2, 3], [-1.2, 1.25], atol=1e-9)
    assert len(document["goals"]) == 2
    space = cs.configuration_space(arm, cs.PolygonWorld.from_text(walls))
    assert len(document["components"]) == len(space.components)
    assert space.free(path).all()


def test_degrees_are_read_and_printed(walls):
    result = cspace(f"space planar_2r --scene {walls} --from 0 0 --to-q 90 0 --deg")
    assert result.code == 0
    assert "[deg]" in result.out
    assert result.out.splitlines()[-1].split() == ["90.000", "0.000"]


def test_a_scene_file_and_a_picture(tmp_path):
    scene, picture = tmp_path / "cell.toml", tmp_path / "space.png"
    cs.Scene([cs.Box([0.4, 0.3, 1.0], [1.2, 0.6, 0.0], "post")]).save(scene)
    result = cspace(f"space planar_2r --scene {scene} --link-radius 0.05 --plot {picture} --json")
    assert result.code == 0
    assert result.json["obstacles"] == ["post"]
    assert result.json["written"] == [str(picture)]
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        ("--from 0 0 --to 5 5", 1, ""),
        ("--from 0 0 --to-q 0.85 0", 1, "blocked"),
        ("--from 0 0", 0, "lies in component 0"),
        ("--to 1 1", 2, "--from"),
        ("--from 0.85 0 --to-q 0 0", 2, "touches"),
        ("--from 0 0 0 --to-q 0 0", 2, ""),
        ("--link-radius -1", 2, "link_radius"),
        ("--plot way.xyz", 2, "xyz"),
    ],
)
def test_how_it_ends(walls, words, code, text):
    result = cspace(f"space planar_2r --scene {walls} {words}")
    assert result.code == code, result
    assert text in result.out + result.err


def test_files_that_cannot_be_used(tmp_path):
    missing = cspace(f"space planar_2r --scene {tmp_path / 'none.toml'}")
    assert missing.code == 3
    assert "none.toml" in missing.err
    crossed = tmp_path / "crossed.txt"
    crossed.write_text("0.5 0\n1 1\n1 0\n0.5 1\n")
    assert "crosses itself" in cspace(f"space planar_2r --scene {crossed}").err
