"""The part of the page on the completeness of the results."""

from __future__ import annotations

from typing import Any

SIZES = {"0": "nominal", "0.001": "disturbed by 1e-3", "0.0001": "disturbed by 1e-4"}
KINDS = {
    "random": "random",
    "1e-02": "1e-2 rad from singular",
    "1e-04": "1e-4 rad from singular",
    "1e-06": "1e-6 rad from singular",
}
Results = dict[str, Any]


def total(results: Results, size: str, kind: str) -> dict[str, float]:
    """Sums over the arms, and the worst residual of any."""
    entries = [sizes[size][kind] for sizes in results.values()]
    sums = {key: sum(e[key] for e in entries) for key in ("poses", "missed", "false", "withheld")}
    return {**sums, "residual": max(e["residual"] for e in entries)}


def line(results: Results, size: str, kind: str) -> str:
    sums = total(results, size, kind)
    poses = int(sums["poses"])
    shares = [f"{100 * (poses - sums['missed']) / poses:.3f} %", f"{100 * sums['withheld'] / poses:.3f} %"]
    counts = [f"{poses:,}", f"{int(sums['missed'])}", shares[0], f"{int(sums['false'])}", shares[1]]
    return "| " + " | ".join([SIZES[size], KINDS[kind], *counts, f"{sums['residual']:.0e}"]) + " |"


def least_certified(results: Results) -> str:
    """The arm with the fewest certificates on random poses."""
    shares = {
        (arm, size): 1 - run["random"]["withheld"] / run["random"]["poses"]
        for arm, sizes in results.items()
        for size, run in sizes.items()
    }
    arm, size = min(shares, key=lambda key: shares[key])
    return f"{arm}, {SIZES[size]}, {100 * shares[arm, size]:.2f} %"


def section(results: Results) -> str:
    if not results:
        return "Not measured."
    head = ["arms", "poses", "number", "missed", "recovered", "falsely certified", "certificate withheld"]
    head.append("worst residual")
    lines = [head, ["---"] * len(head)]
    table = ["| " + " | ".join(cells) + " |" for cells in lines]
    table += [line(results, size, kind) for size in SIZES for kind in KINDS]
    return f"""Each of the {len(results)} six-joint arms of the catalogue, nominal and with axes and points
disturbed. A pose is generated from a configuration, and the result must contain this configuration, within
1e-5, or, near a fold, within 1e-13 divided by the smallest singular value of the Jacobian. A certificate
states that no solution is missing. It is false if the configuration is missing. The arm with the smallest
share of certified random poses is {least_certified(results)}.

{chr(10).join(table)}"""
