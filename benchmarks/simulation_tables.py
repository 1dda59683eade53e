"""The part of the page on simulation, and its lines of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
PEERS = {
    "cspace": "**cspace**, RK4",
    "cspace, variational": "**cspace**, variational",
    "mujoco": "MuJoCo, RK4",
    "pinocchio": "Pinocchio's aba in a loop of Python, RK4",
}


def section(results: Results) -> str:
    """Steps of one motion and of a batch, and how far the ends are apart."""
    measured = results["simulation"]
    if not measured:
        return "Not measured."
    body = []
    for name, title in PEERS.items():
        cells = [
            f"{measured[kind][name]['median']:.0f} ({measured[kind][name]['p95']:.0f})"
            if name in measured[kind]
            else "—"
            for kind in ("single", "batch")
        ]
        apart = measured["difference"]["single"].get(name)
        body.append([title, *cells, "—" if apart is None else f"{apart:.1e}"])
    times = table(["", "one motion", "per row of 256, one thread", "end differs by [rad]"], body)
    energy = []
    for name, title in (("rk4", "RK4"), ("variational", "variational")):
        part = measured["energy"][name]
        cells = [f"{value:.1e}" for value in part["largest"]]
        energy.append([title, *cells, ", ".join(f"{value:.1f}" for value in part["growth"])])
    steps = [f"{1e3 * dt:g} ms" for dt in measured["energy"]["rk4"]["steps"]]
    heads = ["", *steps, "mean of the last tenth / of the first"]
    about = "Largest energy error of a double pendulum in 400 s, over 3 m g l:"
    return f"{times}\n\n{about}\n\n{table(heads, energy)}"


def energy_row(results: Results) -> Row:
    what = "energy of a double pendulum over 400 s: error falls per halved step, RK4 / variational"
    wanted = "≥ 14× / ≥ 3.8×, without drift"
    if not results["simulation"]:
        return row(what, wanted, "", "", None)
    measured = results["simulation"]["energy"]
    falls = {
        name: min(a / b for a, b in zip(part["largest"], part["largest"][1:], strict=False))
        for name, part in measured.items()
    }
    growth = max(measured["variational"]["growth"])
    holds = falls["rk4"] >= 14 and falls["variational"] >= 3.8 and growth < 3
    return row(what, wanted, "", f"{falls['rk4']:.0f}× / {falls['variational']:.2f}×", holds)


def memory_row(results: Results) -> Row:
    what = "memory of 10⁴ roll-outs of 10³ steps with `every=`, relative to the answer"
    if not results["simulation"]:
        return row(what, "≤ 2×", "", "", None)
    measured = results["simulation"]["memory"]
    share = measured["peak"] / measured["answer"]
    return row(what, "≤ 2×", "", f"{share:.2f}×", share <= 2)


ROWS = [energy_row, memory_row]
