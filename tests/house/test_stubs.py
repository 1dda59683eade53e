"""The stub of the compiled core is what the core says it is."""

import pytest

from data import ROOT


@pytest.mark.oracle
def test_the_stub_of_the_core_has_not_drifted(monkeypatch):
    pytest.importorskip("nanobind", reason="the stub generator is a development dependency")
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    import stubs

    assert stubs.generate() == stubs.STUB.read_text(encoding="utf-8"), "run tools/stubs.py"
