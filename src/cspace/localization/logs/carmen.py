"""Logs of the Carnegie Mellon Robot Navigation Toolkit (CARMEN): ODOM, FLASER and ROBOTLASER1 messages."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import LogError
from cspace.localization.log import Log, Scans
from cspace.localization.logs.lines import Lines, mend_clock
from cspace.math.wrapping import wrap_angle
from cspace.mobile import Odometry, TimedPoses
from cspace.spatial import inverse_pose_2d, pose_2d, to_xytheta
from cspace.tables import count_things

SKIPPED = {"NEFF", "SYNC", "RLASER", "LASER3", "LASER4", "LASER5", "RAWLASER1", "RAWLASER2", "RAWLASER3"}
SKIPPED |= {"RAWLASER4", "ROBOTLASER2", "TRUEPOS", "SIMULATOR_TRUEPOS", "GPS", "NMEAGGA", "NMEARMC", "IMU"}
SKIPPED |= {"BUMPER", "SONAR", "POSITION", "MARKER", "PANTILT", "SCANMARK", "POSITIONHEAD", "MOVEMENT"}
"""Messages that are known and not read."""
RECORDS = {"ODOM", "FLASER", "ROBOTLASER1", "PARAM"} | SKIPPED
SAME_TIME = 2.0
"""Seconds by which an ODOM message may differ from the scan before it and still belong to the same moment."""
DEFAULT_MOST = 81.0
"""From this range on [m] a reading of a SICK laser means that nothing returned."""


@dataclass
class Messages:
    """What the lines say: poses with times, and scans with their poses."""

    odometry: list[list[float]] = field(default_factory=list)  # x, y, θ, time, 1 if it repeats a scan, line
    scans: list[list[float]] = field(default_factory=list)  # laser x, y, θ, robot x, y, θ, time, line
    ranges: list[np.ndarray[tuple[int], np.dtype[np.float32]]] = field(default_factory=list)
    angles: Array | None = None
    most: float = DEFAULT_MOST
    skipped: Counter[str] = field(default_factory=Counter)
    resets: int = 0  # repetitions with a time that is not their own
    after_scan: bool = False  # no ODOM since the last scan
    negative: int = 0  # ranges that are not above zero
    lengths: dict[str, int] = field(default_factory=dict)  # values of the first message of each kind


def read_carmen(lines: Lines) -> Log:
    """A log of CARMEN; LogError for an unknown message, a line that is cut, or scans of changing size.

    FLASER has no angles: beam k of n lies at −90° + k 180°/n, of 181 and 361 beams over n − 1. In a corrected
    log, of gmapping for example, an ODOM without a time repeats the corrected pose of the scan before it, and
    the ODOM messages after it go on from there with the raw increments: these are chained into the raw
    odometry, and the poses of the scans are the truth. Times that tell nothing are replaced by the order of
    the messages.
    """
    messages = Messages()
    for number, words in lines.rows():
        if words[0] in SKIPPED:
            messages.skipped[words[0]] += 1
        elif words[0] == "ODOM":
            add_odometry(messages, lines, number, words)
        elif words[0] in ("FLASER", "ROBOTLASER1"):
            add_scan(messages, lines, number, words)
        elif words[0] == "PARAM":
            if words[1:2] == ["robot_front_laser_max"] and len(words) > 2:
                messages.most = read_most(lines, number, words[2])
        else:
            raise lines.error(number, f"no message {words[0]!r} is known in logs of CARMEN")
    if not messages.odometry and not messages.scans:
        raise LogError("the log has neither ODOM nor FLASER nor ROBOTLASER1 messages", path=lines.path)
    return assemble_log(messages)


def add_odometry(messages: Messages, lines: Lines, number: int, words: list[str]) -> None:
    """ODOM x y θ tv rv acceleration time host logger-time."""
    if len(words) < max(8, messages.lengths.setdefault("ODOM", len(words))):
        rest = "the line is cut"
        if len(words) == GFS_WORDS:
            rest = "this seems to be a .gfs file of gmapping; give the log that it was made of"
        raise lines.error(number, f"ODOM has {len(words) - 1} values; 9 expected, {rest}")
    x, y, theta = lines.numbers(number, words[1:4], "x, y and θ of ODOM")
    time = lines.numbers(number, words[7:8], "the time of ODOM")[0]
    repeats = messages.after_scan and [x, y, theta] == messages.scans[-1][3:6]
    if repeats and abs(time - messages.scans[-1][6]) > SAME_TIME:
        messages.resets += 1
    messages.after_scan = False
    messages.odometry.append([x, y, theta, time, float(repeats), number])


GFS_WORDS = 5
"""Words of ODOM in .gfs files: x, y, θ and the time alone."""


def add_scan(messages: Messages, lines: Lines, number: int, words: list[str]) -> None:
    """FLASER n ranges, laser pose, robot pose, time; ROBOTLASER1 with its angles before the ranges."""
    is_plain = words[0] == "FLASER"
    at = 1 if is_plain else 8
    if len(words) <= at:
        raise lines.error(number, f"{words[0]} has {len(words) - 1} values; the line is cut")
    head = lines.numbers(number, words[1 : at + 1], f"the head of {words[0]}")
    count = lines.whole(number, words[at], "the number of ranges")
    ranges = words[at + 1 : at + 1 + count]
    tail = words[at + 1 + count :]
    if not is_plain and tail:
        tail = tail[1 + lines.whole(number, tail[0], "the number of remissions") :]
    place = 6 if is_plain else 11
    least = max(place + 1, messages.lengths.setdefault(words[0], len(tail)))
    if count < 1 or len(ranges) < count or len(tail) < least:
        raise lines.error(
            number, f"{words[0]} of {count} ranges has {len(words) - 1} values; the line is cut"
        )
    if messages.ranges and len(messages.ranges[-1]) != count:
        raise lines.error(
            number, f"the scan has {count} beams and the one before {len(messages.ranges[-1])}; split the log"
        )
    if messages.angles is None:
        messages.angles = beam_angles(head, count)
        if not is_plain:
            messages.most = read_most(lines, number, words[5])
    messages.ranges.append(read_ranges(messages, lines, number, ranges))
    messages.after_scan = True
    messages.scans.append(lines.numbers(number, [*tail[:6], tail[place], str(number)], "a pose"))


def read_most(lines: Lines, number: int, word: str) -> float:
    """The range of the laser, above zero."""
    (most,) = lines.numbers(number, [word], "the range of the laser")
    if most <= 0:
        raise lines.error(number, f"the range of the laser is {most:g}; it must be above zero")
    return most


def read_ranges(
    messages: Messages, lines: Lines, number: int, words: list[str]
) -> np.ndarray[tuple[int], np.dtype[np.float32]]:
    """The ranges of a scan; NaN for those that are not above zero, which are counted."""
    try:
        ranges = np.array(words, dtype=np.float64)
    except ValueError:
        raise lines.error(number, "a range of the scan is no number") from None
    below = ranges <= 0
    messages.negative += int(below.sum())
    ranges[below] = np.nan
    ranges[ranges > tolerances.LARGEST_LOGGED] = np.inf
    return ranges.astype(np.float32)


def beam_angles(head: list[float], count: int) -> Array:
    """The angles of the beams (b,): from the head of ROBOTLASER1, or those of a SICK laser.

    FLASER has no angles. 181 and 361 beams include both ends of half a turn, 401 those of 100 degrees, and
    other numbers of beams leave the last end out.
    """
    if len(head) > 1:
        return np.asarray(head[1] + head[3] * np.arange(count))
    span = WITH_BOTH_ENDS.get(count, np.pi)
    return np.asarray(-0.5 * span + span / (count - (count in WITH_BOTH_ENDS)) * np.arange(count))


WITH_BOTH_ENDS = {181: np.pi, 361: np.pi, 401: np.radians(100.0)}
"""Numbers of beams at which a SICK laser measures both ends of its field of view, and that field [rad]:
steps of a degree, a half and a quarter."""


def assemble_log(messages: Messages) -> Log:
    """Odometry, scans and truth on one clock that starts at the first message."""
    rows = np.array(messages.odometry).reshape(-1, 6)
    scans = np.array(messages.scans).reshape(-1, 8)
    is_corrected = 2 * max(messages.resets, messages.skipped[GMAPPING]) > len(scans)
    notes = [f"{count} {name} messages are not read" for name, count in sorted(messages.skipped.items())]
    if messages.negative:
        notes.append(f"{messages.negative} ranges are not above zero; they count as no return")
    if is_corrected:
        rows, added = fill_odometry(rows, scans)
        if added:
            notes.append(
                f"{count_things(added, 'corrected pose')} without odometry before them are taken for it"
            )
    jumps = (rows[:, 4] == 1) & is_corrected  # in a raw log a robot at rest repeats its pose
    times, scan_times, clock = mend_times(rows[~jumps], scans)
    notes += clock
    if len(rows):
        odometry = chain_odometry(rows[:, :3], jumps, times)
    else:
        odometry = Odometry.from_poses(scan_times, scans[:, 3:6])
        notes.append("the odometry is that of the scans")
    truth = None
    if is_corrected:
        truth = TimedPoses(scan_times, scans[:, 3:6])
        notes.append(f"{len(truth)} corrected poses are the truth; the raw odometry was chained between")
    packed = pack_scans(messages, scans, scan_times, notes) if len(scans) else None
    return Log(odometry, packed, truth=truth, notes=tuple(notes))


GMAPPING = "NEFF"
"""A message that gmapping writes after each scan, in logs with its corrected poses."""


def fill_odometry(rows: Array, scans: Array) -> tuple[Array, int]:
    """The messages of odometry (n, 6) of a corrected log, with one more before each scan that has none since
    the scan before: its own pose. And how many were added."""
    before = np.searchsorted(rows[:, 5], scans[:, 7]) - 1
    bare = scans[(before >= 0) & (rows[before, 4] == 1)] if len(rows) else scans[:0]
    added = np.column_stack([bare[:, 3:7], np.zeros(len(bare)), bare[:, 7] - HALF_LINE])
    filled = np.concatenate([rows, added])
    return filled[np.argsort(filled[:, 5], kind="stable")], len(bare)


HALF_LINE = 0.5
"""A message that is added before a scan stands half a line before it."""


def mend_times(rows: Array, scans: Array) -> tuple[Array, Array, list[str]]:
    """The times of odometry and scans from the first message on, and notes of what was mended.

    Where most scans have no time of their own, because times were lost or printed with few digits, the
    messages of odometry are counted instead, and a scan belongs to the one before it.
    """
    lines = np.concatenate([rows[:, 5], scans[:, 7]])
    order = np.argsort(lines, kind="stable")
    stamps = np.concatenate([rows[:, 3], scans[:, 6]])
    mended, notes = mend_clock(stamps[order])
    stamps[order] = mended - mended[0]
    distinct = len(np.unique(stamps[len(rows) :]))
    if 2 * distinct < len(scans):
        is_scan = np.arange(len(lines))[order] >= len(rows)
        ticks = ~is_scan
        ticks[1:] |= is_scan[:-1]  # two scans in a row are not at one time
        stamps[order] = COUNTED * (np.cumsum(ticks) - 1.0)
        stamps -= stamps[order[0]]
        notes = [
            f"the clock has {distinct} times for {len(scans)} scans; messages are counted instead, as if"
            f" {COUNTED} s apart"
        ]
    return stamps[: len(rows)], stamps[len(rows) :], notes


COUNTED = 0.1
"""Seconds between messages that have no times: the period of the odometry of most robots."""


def chain_odometry(poses: Array, jumps: npt.NDArray[np.bool_], times: Array) -> Odometry:
    """Odometry from poses (n, 3) whose frame jumps where a row is marked: increments are taken after it."""
    T = pose_2d(xytheta=poses)
    increments = to_xytheta(inverse_pose_2d(T[:-1]) @ T[1:])[~jumps[1:]]
    if jumps[0]:  # when the first step began is unknown
        increments = increments[1:]
    return Odometry.from_increments(times, increments)


def pack_scans(messages: Messages, scans: Array, times: Array, notes: list[str]) -> Scans:
    """The scans with the pose of the laser on the robot, which their lines repeat."""
    mounts = to_xytheta(inverse_pose_2d(pose_2d(xytheta=scans[:, 3:6])) @ pose_2d(xytheta=scans[:, :3]))
    mount = np.median(mounts, axis=0)
    spread = np.abs(
        np.concatenate([mounts[:, :2] - mount[:2], wrap_angle(mounts[:, 2:] - mount[2])], axis=1)
    ).max()
    if spread > MOUNT_SPREAD:
        notes.append(f"the pose of the laser on the robot varies by {spread:.2g}; the median is used")
    assert messages.angles is not None
    return Scans(times, np.array(messages.ranges), messages.angles, messages.most, pose_2d(xytheta=mount))


MOUNT_SPREAD = 0.01
"""By how much the pose of the laser on the robot may vary [m, rad]: the rounding of printed poses far
away."""
