"""Pictures are drawn without a screen and closed after each test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

plt = pytest.importorskip("matplotlib.pyplot", reason="pictures need the extra [plot]")


@pytest.fixture(autouse=True)
def closed_figures(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """No figure is left open, and nothing calls show."""

    def shown(*args: object, **kwargs: object) -> None:
        raise AssertionError("a picture called show")

    monkeypatch.setattr(plt, "show", shown)
    monkeypatch.setattr("matplotlib.figure.Figure.show", shown)
    plt.close("all")
    yield
    plt.close("all")
