"""What every test folder shares: the option that turns skips into failures where everything is installed."""

from __future__ import annotations

import os
import signal
from collections.abc import Generator

import pytest

os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("CSPACE_CACHE", "")  # tests keep no covers in the home folder
signal.signal(
    signal.SIGINT, signal.default_int_handler
)  # a shell ignores Ctrl-C in what it starts in the background


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--no-skips", action="store_true", help="a skipped test is a failed one")


def skip_is_failure(report: pytest.TestReport | pytest.CollectReport) -> None:
    """A skip that names a missing part is a failure; a part that was deselected never gets here."""
    if report.skipped and not hasattr(report, "wasxfail"):
        report.outcome = "failed"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    if item.config.getoption("--no-skips"):
        skip_is_failure(report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    if collector.config.getoption("--no-skips"):
        skip_is_failure(report)
    return report
