"""The histogram filter: the probability of every cell of x, y and θ."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, bounded_number, positive_number, whole_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.localization.checks import Running, read_covariance, read_pose
from cspace.localization.filters.rows import (
    adjoin_rows,
    carry_covariance,
    find_twist,
    follow_rows,
    move_pose,
    relate_rows,
)
from cspace.localization.particles.models import FEWEST_BEAMS, ScanModel, find_walls, make_field
from cspace.localization.particles.particle_filter import (
    FULL_STEP,
    OTHER_SHARE,
    START_DEVIATIONS,
    measure_step,
    read_motion,
)
from cspace.localization.particles.placing import FreePlaces
from cspace.localization.particles.state import FilterEvent, PoseMode
from cspace.localization.sensors import LaserScanner, read_sensor
from cspace.maps import ByteField
from cspace.spatial import log_se2, pose_2d, rotation_2d
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import LEAST_OF_BEST, STANDING, UNIFORM_SHARE, WHOLE_CELLS

MOST_CELLS: Final = 4_000_000
"""The most cells: 25 ms per update with 60 beams on one core."""
MOST_BEAMS: Final = 257
"""The most beams whose scores are summed in 16 bits."""
MODE_REACH: Final = (1.5, 0.6)
"""How far around its best cell a mode reaches [m] and [rad]."""
LISTED_MODES: Final = 5
"""The most modes that are listed."""
LEAST_SHARE: Final = 0.01
"""Share of the probability from which a mode is listed."""


@tabulate("status", "reason", "pose", "covariance", "modes")
class HistogramFilter(Running):
    """Where a robot is, as the probability of each cell of x, y and θ.

    grid: an OccupancyGrid or an EvidenceGrid. motion, sensor: as of ParticleFilter, without the beam model.
    resolution [m], headings: the sides of cells, and how many sectors the heading has. start: pose (3,) or
    (3, 3), or None where the robot may be anywhere; start_covariance (3, 3), 10 cm and 0.05 rad unless given.
    threads: 0 is one per processor; the answer is the same. On one core an update with 60 beams takes 6 ns
    per cell, 10 ms for 36 m × 39 m with 0.25 m and 72 headings, and 40 ns if resolution is no multiple of
    that of the grid; a step 3 to 6 ns. Raises InputError for too many cells. Source: Thrun, Burgard & Fox
    2005, section 8.2.
    """

    _instead = "keep its belief"

    def __init__(
        self,
        grid: Any,
        *,
        motion: Any | None = None,
        sensor: LaserScanner | None = None,
        resolution: float = 0.25,
        headings: int = 72,
        start: npt.ArrayLike | None = None,
        start_covariance: npt.ArrayLike | None = None,
        threads: int = 1,
    ) -> None:
        if isinstance(grid, ByteField) or not hasattr(grid, "likelihood_field"):
            raise InputTypeError(
                f"grid is {name_type(grid)}; give an OccupancyGrid or an EvidenceGrid, for ROS maps"
                " cspace.maps.EvidenceGrid.from_ros(path)"
            )
        self.grid, self.noise = grid, read_motion(motion)
        self.side = positive_number(resolution, "resolution")
        self.sectors = whole_number(headings, "headings", 8, 720)
        self.threads = whole_number(threads, "threads", 0, 1024)
        self._places = FreePlaces(grid, np.inf)
        self._lay_cells(read_sensor(sensor, LaserScanner))
        self._pending, self._since, self._seconds = np.zeros(3), np.zeros(3), 0.0
        self._given: Array | None = None
        self._found: list[PoseMode] | None = None
        self.updates, self.score, self._is_known = 0, float("nan"), start is not None
        self.belief = np.tile(self._free / (self.sectors * self._free.sum()), (self.sectors, 1, 1))
        if start is not None:
            self._put_start(start, start_covariance)
        self._spare, self._sums = np.empty_like(self.belief), np.empty(self.belief.size, np.int32)

    def _lay_cells(self, sensor: LaserScanner) -> None:
        """The centres of the cells, which of them are free, and the field for their size."""
        if sensor.model != "likelihood_field":
            raise InputError("the histogram filter has no beam model; give model='likelihood_field'")
        low, high = np.asarray(self._places.low), np.asarray(self._places.high)
        columns, rows = np.ceil((high - low) / self.side).tolist()
        if rows * columns * self.sectors > MOST_CELLS:
            raise InputError(
                f"{rows:g} × {columns:g} × {self.sectors} cells are more than {MOST_CELLS}; give a coarser"
                " resolution or fewer headings"
            )
        columns, rows = int(columns), int(rows)
        x, y = low[0] + self.side * (np.arange(columns) + 0.5), low[1] + self.side * (np.arange(rows) + 0.5)
        theta = (np.arange(self.sectors) + 0.5) * (2 * np.pi / self.sectors) - np.pi
        self._axes = theta, y, x
        self._free = self._places.find_coarse_cells(self.side, (rows, columns)).astype(np.uint8)
        sigma = float(np.hypot(sensor.sigma, 0.5 * self.side))
        self.model = ScanModel(make_field(find_walls(self.grid), sigma, sensor.floor), sensor)
        t, v, u = np.meshgrid(theta, y, x, indexing="ij")
        self._centers = np.stack([u.ravel(), v.ravel(), t.ravel()], axis=-1)
        self._cloud: _core.ParticleCloud | None = None
        self._lattice = self._lay_lattice()

    def _lay_lattice(self) -> _core.LatticeScores | None:
        """The scores of all cells at once; None where their centres are no whole cells of the field apart."""
        field = self.model.field
        theta, y, x = self._axes
        step = round(self.side / field.resolution)
        if step < 1 or abs(self.side / field.resolution - step) * max(self._free.shape) > WHOLE_CELLS:
            return None
        first = (np.array([x[0], y[0]]) - field.origin) / field.resolution
        headings = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        rows, columns = self._free.shape
        return _core.LatticeScores(field.scores, field.outside, step, first, rows, columns, headings)

    def _put_start(self, start: npt.ArrayLike, covariance: npt.ArrayLike | None) -> None:
        pose = read_pose(start)
        self._places.check_start(pose)
        P = np.diag(np.square(START_DEVIATIONS)) if covariance is None else read_covariance(covariance)
        cell = 2 * np.pi / self.sectors
        P = P + np.diag([self.side**2, self.side**2, cell**2]) / 12
        xi = find_twist(pose, self._centers)
        log = -0.5 * np.einsum("ni,ij,nj->n", xi, np.linalg.inv(P), xi)
        self.belief = np.exp(log - log.max()).reshape(self.sectors, *self._free.shape)
        self.belief /= self.belief.sum()

    def predict(
        self, increment: npt.ArrayLike, dt: float = 0.0, *, covariance: npt.ArrayLike | None = None
    ) -> None:
        """Moves the probability by odometry, as ParticleFilter.predict; steps below a cell are kept until
        the next update."""
        row = read_pose(increment, "increment")
        if covariance is not None:
            A = adjoin_rows(relate_rows(row, np.zeros(3)))
            Q = np.zeros((3, 3)) if self._given is None else self._given
            self._given = carry_covariance(A, Q) + read_covariance(covariance, "covariance")
        self._pending, self._since = follow_rows(self._pending, row), follow_rows(self._since, row)
        self._seconds += bounded_number(dt, "dt", 0.0, "give seconds, not below zero")
        self._found = None
        if measure_step(self._pending) > self.side:
            self._move()

    def _move(self) -> None:
        if measure_step(self._pending) < STANDING:
            return
        xi = log_se2(pose_2d(xytheta=self._pending))
        Q = self.noise.covariance(xi, self._seconds) if self._given is None else self._given
        theta, sector = self._axes[0], 2 * np.pi / self.sectors
        shifts = rotation_2d(theta) @ self._pending[:2]
        R = rotation_2d(theta + self._pending[2])
        deviations = np.sqrt(np.einsum("kij,jl,kil->ki", R, Q[:2, :2], R).clip(0.0))
        steps = np.concatenate([shifts[:, ::-1], deviations[:, ::-1]], axis=1) / self.side
        turn, turn_sigma = self._pending[2] / sector, float(np.sqrt(Q[2, 2])) / sector
        old, new = self.belief.ravel(), self._spare.ravel()
        sectors, rows, columns = self.belief.shape
        is_left = _core.move_belief(old, sectors, rows, columns, steps, turn, turn_sigma, self.threads, new)
        self.belief, self._spare = self._spare, self.belief
        if not is_left:  # it drove off the map
            self.belief[:] = self._free / (self.sectors * self._free.sum())
            self._is_known, self.updates = False, 0
        self._pending, self._seconds, self._given = np.zeros(3), 0.0, None

    def update(self, scan: Any) -> None:
        """Multiplies by the likelihood of a scan (one row of Scans, or ends of beams in base (m, 2))."""
        self._move()
        share = 1.0 if not self.updates else min(1.0, measure_step(self._since) / FULL_STEP)
        ends = self.model.read_ends(scan)
        if len(ends) < FEWEST_BEAMS:
            return
        used, exponent = self.model.choose_ends(ends)
        sums = self._sum_scores(used)
        self.updates, self._found = self.updates + 1, None
        if share <= STANDING / FULL_STEP:
            best = int(sums.reshape(self.sectors, -1)[:, self._free.ravel() > 0].max())
        else:
            self._since = np.zeros(3)
            sectors, rows, columns = self.belief.shape
            best = _core.weigh_belief(
                self.belief.ravel(),
                sectors,
                rows,
                columns,
                sums,
                self._free.ravel(),
                share * exponent * self.model.nats,
                UNIFORM_SHARE,
                self.threads,
                self._spare.ravel(),
            )
            self.belief, self._spare = self._spare, self.belief
        self.score = best / (255.0 * len(used))

    def _sum_scores(self, ends: Array) -> npt.NDArray[np.int32]:
        """The sums of the scores (0 … 255) of all ends of beams (m, 2), for every cell, flat."""
        if self._lattice is not None and len(ends) <= MOST_BEAMS:
            self._lattice.sum(ends / self.model.field.resolution, self.threads, self._sums)
            return self._sums
        if self._cloud is None:
            self._cloud = _core.ParticleCloud(len(self._centers), 0)
            self._cloud.place(self._centers)
        means = self._cloud.score(self.model.map, ends, self.threads)
        return np.rint(255.0 * len(ends) * means).astype(np.int32)

    @property
    def modes(self) -> tuple[PoseMode, ...]:
        """The best cells with what lies around them, of 1 % of the probability or more, heaviest first."""
        if self._found is None:
            self._found = find_modes(self.belief, self._centers)
        return tuple(self._found)

    @property
    def pose(self) -> Array:
        """The mean of the heaviest mode, x, y [m], θ [rad] (3,)."""
        return self.modes[0].pose

    @property
    def covariance(self) -> Array:
        """The covariance (3, 3) of the heaviest mode, of ξ in T exp ξ, in base."""
        return self.modes[0].covariance

    @property
    def particles(self) -> Array:
        """The centres of the cells with the most probability, (k, 3), in place of particles."""
        rows = np.argsort(self.belief.ravel())[::-1][:SHOWN_CELLS]
        return self._centers[rows]

    @property
    def events(self) -> tuple[FilterEvent, ...]:
        """None: this filter never searches."""
        return ()

    @property
    def status(self) -> str:
        """One of "localised"; "ambiguous", with much of the probability in other modes; "lost", before the
        first scan, and where the odometry left the map, until the next one."""
        if not self.updates and not self._is_known:
            return "lost"
        first, *others = self.modes
        if any(mode.share >= OTHER_SHARE for mode in others) or first.share < LEAST_MAIN_SHARE:
            return "ambiguous"
        return "localised"

    @property
    def reason(self) -> str:
        """The status as one sentence."""
        listed = count_things(len(self.modes), "mode")
        text = f"{listed}, the heaviest with {self.modes[0].share:.0%} of the probability"
        return text if self.updates else f"{text}; nothing measured yet"

    def __bool__(self) -> bool:
        return self.status == "localised"

    def __len__(self) -> int:
        """How many cells there are."""
        return int(self.belief.size)

    def __repr__(self) -> str:
        return one_line("HistogramFilter", f"{len(self)} cells: {self.status}, {self.reason}")


SHOWN_CELLS: Final = 2000
"""Cells that stand for particles."""
LEAST_MAIN_SHARE: Final = 0.5
"""Share of the probability that the heaviest mode needs."""


def find_modes(belief: Array, poses: Array) -> list[PoseMode]:
    """The best cell with those around it, then the best of the others, and so on."""
    rows = np.flatnonzero(belief.ravel() > LEAST_OF_BEST * belief.max())
    weights, poses = belief.ravel()[rows], poses[rows]
    modes: list[PoseMode] = []
    while len(modes) < LISTED_MODES and len(weights):
        best = int(np.argmax(weights))
        xi = find_twist(poses[best], poses)
        near = (np.hypot(xi[:, 0], xi[:, 1]) < MODE_REACH[0]) & (np.abs(xi[:, 2]) < MODE_REACH[1])
        share = float(weights[near].sum())
        if modes and share < LEAST_SHARE:
            break
        w = weights[near] / share
        pose = move_pose(poses[best], w @ xi[near])
        away = find_twist(pose, poses[near])
        modes.append(PoseMode(pose, (w[:, None] * away).T @ away, share))
        weights, poses = weights[~near], poses[~near]
    return sorted(modes, key=lambda mode: -mode.share)
