"""`cspace export`: files written whole, and clear words where nothing can be written."""

from __future__ import annotations

from cli import schema
from cli.run import cspace


def test_a_header_is_written(tmp_path):
    target, example = tmp_path / "ur5e_ik.hpp", tmp_path / "main.cpp"
    result = cspace("export ur5e --lang cpp -o", str(target), "--example", str(example))
    assert result.code == 0
    assert result.out.split() == [str(target), str(example)]
    assert "namespace ur5e" in target.read_text()
    assert '#include "ur5e_ik.hpp"' in example.read_text()


def test_without_a_file_the_text_is_shown():
    result = cspace("export planar_2r --name two")
    assert result.code == 0
    assert "namespace two {" in result.out


def test_c_needs_a_place_for_its_files(tmp_path):
    assert cspace("export ur5e --lang c").code == 2
    result = cspace("export ur5e --lang c -o", str(tmp_path / "arm.h"))
    assert result.code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arm.cpp", "arm.h"]


def test_json(tmp_path):
    written = cspace("export ur5e --json -o", str(tmp_path / "a.hpp")).json
    schema.check(written)
    assert written["written"] == [str(tmp_path / "a.hpp")]
    shown = cspace("export ur5e --lang c --json").json
    schema.check(shown)
    assert set(shown["files"]) == {"ur5e_ik.h", "ur5e_ik.cpp"}


def test_a_joint_is_named_or_numbered():
    assert cspace("export panda --locked q7").out == cspace("export panda --locked panda_joint7").out


def test_refusals(tmp_path):
    result = cspace("export ur5e --lang fortran")
    assert result.code == 2
    assert "no language 'fortran'" in result.err
    assert "cpp" in result.err
    result = cspace("export ur5e -o", str(tmp_path / "nowhere" / "a.hpp"))
    assert result.code == 2
    assert "there is no folder" in result.err
    result = cspace("export panda --locked panda_join7 -o", str(tmp_path / "a.hpp"))
    assert result.code == 2
    assert "panda_joint7" in result.err
    for example in ("a.h", "a.cpp"):
        words = ["-o", str(tmp_path / "a.h"), "--example", str(tmp_path / example)]
        result = cspace("export ur5e --lang c", *words)
        assert result.code == 2
        assert "would overwrite" in result.err
    assert list(tmp_path.iterdir()) == []
