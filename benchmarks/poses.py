"""Conversions of poses against scipy's: medians of one call and of a batch, the same numbers for both.

Run `python benchmarks/poses.py`. Ratios above 1 say that cspace is faster; those below 1 are losses.
Our readers check that their input is a rotation; scipy's objects were checked when they were made, so making
the object from the matrix counts for scipy where the matrix is what a user has.
"""

from __future__ import annotations

import platform
import statistics
import time
from collections.abc import Callable

import numpy as np
import scipy
from scipy.spatial.transform import Rotation, Slerp

import cspace as cs

BATCH = 100_000


def median_time(call: Callable[[], object], *, rounds: int = 15, shortest: float = 2e-3) -> float:
    """The median over rounds of the time of one call [s]; each round lasts at least `shortest`."""
    call()
    start = time.perf_counter()
    call()
    number = max(1, int(shortest / max(time.perf_counter() - start, 1e-9)))
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        for _ in range(number):
            call()
        times.append((time.perf_counter() - start) / number)
    return statistics.median(times)


def contenders(n: int) -> dict[str, tuple[Callable[[], object], Callable[[], object]]]:
    """Name → (ours, scipy's) for a batch of n, or for one rotation without a batch axis if n is 0."""
    size = n or ()
    R, S = cs.random_rotation(size, rng=1), cs.random_rotation(size, rng=2)
    T = cs.random_pose(size, rng=3)
    rpy, w, q = cs.to_rpy(R), cs.to_rotvec(R), cs.to_xyzw(R)
    xi = cs.log_se3(T)
    theirs = {
        "rpy → matrix": (
            lambda: cs.rotation(rpy=rpy),
            lambda: Rotation.from_euler("xyz", rpy).as_matrix(),
        ),
        "matrix → rpy": (
            lambda: cs.to_rpy(R),
            lambda: Rotation.from_matrix(R).as_euler("xyz"),
        ),
        "quaternion → matrix": (
            lambda: cs.rotation(xyzw=q),
            lambda: Rotation.from_quat(q).as_matrix(),
        ),
        "matrix → quaternion": (
            lambda: cs.to_xyzw(R),
            lambda: Rotation.from_matrix(R).as_quat(),
        ),
        "exp SO(3)": (
            lambda: cs.exp_so3(w),
            lambda: Rotation.from_rotvec(w).as_matrix(),
        ),
        "log SO(3)": (
            lambda: cs.log_so3(R),
            lambda: Rotation.from_matrix(R).as_rotvec(),
        ),
    }
    if n == 0:
        theirs["slerp, one fraction"] = (
            lambda: cs.slerp(R, S, 0.3),
            lambda: Slerp([0.0, 1.0], Rotation.from_matrix(np.stack([R, S])))(0.3).as_matrix(),
        )
    else:
        t = np.linspace(0.0, 1.0, n)
        theirs["slerp, one pair"] = (
            lambda: cs.slerp(R[0], R[1], t),
            lambda: Slerp([0.0, 1.0], Rotation.from_matrix(R[:2]))(t).as_matrix(),
        )
    try:
        from scipy.spatial.transform import RigidTransform
    except ImportError:
        return theirs
    c = np.concatenate([xi[..., 3:], xi[..., :3]], axis=-1)
    theirs["exp SE(3)"] = (
        lambda: cs.exp_se3(xi),
        lambda: RigidTransform.from_exp_coords(c).as_matrix(),
    )
    theirs["log SE(3)"] = (
        lambda: cs.log_se3(T),
        lambda: RigidTransform.from_matrix(T).as_exp_coords(),
    )
    theirs["inverse"] = (
        lambda: cs.inverse_pose(T),
        lambda: RigidTransform.from_matrix(T).inv().as_matrix(),
    )
    return theirs


def main() -> None:
    machine = f"{platform.machine()}, Python {platform.python_version()}"
    print(f"cspace {cs.__version__}, scipy {scipy.__version__}, numpy {np.__version__}, {machine}")
    for n, unit, scale in ((0, "µs per call", 1e6), (BATCH, f"ns per item of {BATCH}", 1e9 / BATCH)):
        print(f"\n{unit:24}{'cspace':>10}{'scipy':>10}{'ratio':>8}")
        for name, (ours, theirs) in contenders(n).items():
            a, b = median_time(ours) * scale, median_time(theirs) * scale
            print(f"{name:24}{a:10.2f}{b:10.2f}{b / a:8.2f}")
    T = cs.random_pose(rng=3)
    print(f"\nas_pose of one array: {median_time(lambda: cs.as_pose(T)) * 1e6:.2f} µs")


if __name__ == "__main__":
    main()
