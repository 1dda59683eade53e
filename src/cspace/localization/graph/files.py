"""Files of pose graphs: g2o, TORO, .graph and Victoria Park, read whole or not at all."""

from __future__ import annotations

import io
import math
import os
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError, LogError, check_known
from cspace.files import path_of, read_regular
from cspace.localization.graph.graph_arrays import Graph
from cspace.localization.logs.lines import Lines, unpack_gzip
from cspace.spatial import pose, rotation
from cspace.spatial.sequences import matrix_of_fixed
from cspace.tables import count_things
from cspace.tolerances import LARGEST_IN_GRAPH, LOG_BYTES, SINGULAR_INFORMATION, UNIFORM_ANGLE

FORMATS: Final = ("g2o", "toro", "graph", "victoria")
LARGEST_ID: Final = 2**63 - 1
"""Ids are kept as integers of 64 bits."""
MOST_DIGITS: Final = 100
"""Of an id, with zeros before it."""
LEFT_OUT: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "g2o": ("ROBOTLASER1", "RAWLASER1", "LASER_ROBOT_DATA", "RGBD_DATA", "DATA_FEATURE_POINTXY"),
        "toro": ("EQUIV",),
        "victoria": (),
    }
)
"""Records that relate no variables: what a pose saw before anything was recognised in it, and pairs of
poses whose edge is listed too."""
PARAMETERS: Final = "PARAMS_"
"""Begins records of sensors: calibrations, which matter to the measurements that name them alone."""
ZIP: Final = b"PK\x03\x04"
GZIP: Final = b"\x1f\x8b"

ANGLES: Final = ("x", "y", "z", "roll", "pitch", "yaw")
"""The numbers of a pose in space by angles about fixed axes; with a quaternion there is one more."""
PLANE_UPPER: Final = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""The order of the numbers of a symmetric matrix: its upper triangle by rows."""
TORO_UPPER: Final = ((0, 0), (0, 1), (1, 1), (2, 2), (0, 2), (1, 2))
"""xx, xy, yy, θθ, xθ, yθ."""
POINT_UPPER: Final = ((0, 0), (0, 1), (1, 1))
SPACE_UPPER: Final = tuple((i, j) for i in range(6) for j in range(i, 6))
SPACE_POINT_UPPER: Final = tuple((i, j) for i in range(3) for j in range(i, 3))


class Edge(NamedTuple):
    """A relative pose of a file, with the line it stands in."""

    first: int
    second: int
    motion: Array
    information: Array
    line: int


class Seen(NamedTuple):
    """A landmark that a pose saw; ranged: as range and bearing."""

    pose: int
    landmark: int
    point: Array
    information: Array
    ranged: bool
    line: int
    sensor: int | None = None


@dataclass
class Draft:
    """What the lines of a file have said so far."""

    lines: Lines
    covariances: bool = False
    offsets: dict[int, Array] = field(default_factory=dict)
    poses: dict[int, Array] = field(default_factory=dict)
    landmarks: dict[int, Array] = field(default_factory=dict)
    fixed: dict[int, int] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    seen: list[Seen] = field(default_factory=list)
    skipped: dict[str, int] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    unweighted: int = 0

    def ids(self, line: int, words: list[str], count: int) -> list[int]:
        """The first words as ids."""
        found = []
        if len(words) < count:
            raise self.lines.error(
                line, f"the line has {len(words)} of {count_things(count, 'id')}; it may be cut"
            )
        for word in words[:count]:
            if not word.isdecimal() or len(word) > MOST_DIGITS or int(word) > LARGEST_ID:
                raise self.lines.error(
                    line, f"{word[:40]!r} is no id; ids are whole numbers from 0 to 2⁶³ − 1"
                )
            found.append(int(word))
        return found

    def add_variable(self, line: int, words: list[str], count: int, kind: str) -> tuple[int, list[float]]:
        """The id and the numbers of a vertex, which must be new."""
        (name,) = self.ids(line, words, 1)
        if name in self.poses or name in self.landmarks:
            raise self.lines.error(line, f"vertex {name} is given for the second time; remove one")
        return name, self.values(line, words[1:], count, kind)

    def values(self, line: int, words: list[str], count: int, kind: str) -> list[float]:
        """So many finite numbers, no more and no less."""
        if len(words) != count:
            raise self.lines.error(
                line, f"{kind} has {len(words)} numbers after its ids; {count} expected; the line may be cut"
            )
        try:
            found = list(map(float, words))
        except ValueError:
            found = [math.nan]
        if not all(map(math.isfinite, found)):
            return self.lines.numbers(line, words, kind)
        if max(map(abs, found)) > LARGEST_IN_GRAPH:
            raise self.lines.error(
                line, f"{kind} must not exceed {LARGEST_IN_GRAPH:g}, and one of its numbers does"
            )
        return found

    def matrix(self, values: list[float], order: tuple[tuple[int, int], ...]) -> Array:
        """The symmetric matrix of these numbers."""
        size = 1 + max(j for _, j in order)
        found = np.empty((size, size))
        for (i, j), value in zip(order, values, strict=True):
            found[i, j] = found[j, i] = value
        return found

    def edge_matrix(self, values: list[float], order: tuple[tuple[int, int], ...]) -> Array:
        """The matrix of an edge; the identity where TORO leaves it out."""
        if values:
            return self.matrix(values, order)
        self.unweighted += 1
        return np.eye(1 + max(j for _, j in order))

    def quaternion_pose(self, line: int, values: list[float]) -> Array:
        """The numbers t and the quaternion x, y, z, w of any length but zero."""
        if not any(values[3:]):
            raise self.lines.error(
                line, "the quaternion is zero and gives no direction; the identity is 0 0 0 1"
            )
        return np.array(values)

    def pair(self, line: int, words: list[str]) -> tuple[int, int]:
        """The ids of an edge."""
        first, second = self.ids(line, words, 2)
        if first == second:
            raise self.lines.error(line, f"the edge joins {first} to itself; remove it")
        return first, second


Reader = Callable[[Draft, int, list[str]], None]


def read_fixed(draft: Draft, line: int, words: list[str]) -> None:
    """FIX id …"""
    for name in draft.ids(line, words, len(words)):
        draft.fixed[name] = line


def read_plane_vertex(draft: Draft, line: int, words: list[str]) -> None:
    """VERTEX_SE2 id x y θ"""
    name, values = draft.add_variable(line, words, 3, "a pose of the plane")
    draft.poses[name] = np.array(values)


def read_space_vertex(draft: Draft, line: int, words: list[str]) -> None:
    """VERTEX_SE3:QUAT id x y z qx qy qz qw"""
    name, values = draft.add_variable(line, words, 7, "a pose in space")
    draft.poses[name] = draft.quaternion_pose(line, values)


def read_angle_vertex(draft: Draft, line: int, words: list[str]) -> None:
    """VERTEX3 id x y z roll pitch yaw"""
    name, values = draft.add_variable(line, words, 6, "a pose in space")
    draft.poses[name] = np.array(values)


def read_point_vertex(draft: Draft, line: int, words: list[str]) -> None:
    """VERTEX_XY id x y"""
    name, values = draft.add_variable(line, words, 2, "a landmark of the plane")
    draft.landmarks[name] = np.array(values)


def read_space_point_vertex(draft: Draft, line: int, words: list[str]) -> None:
    """VERTEX_TRACKXYZ id x y z"""
    name, values = draft.add_variable(line, words, 3, "a landmark in space")
    draft.landmarks[name] = np.array(values)


def read_plane_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE_SE2 i j x y θ, information by rows"""
    add_plane_edge(draft, line, words, PLANE_UPPER)


def read_toro_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE2 i j x y θ, matrix as xx xy yy θθ xθ yθ, or none"""
    add_plane_edge(draft, line, words, TORO_UPPER, may_lack=True)


def add_plane_edge(
    draft: Draft, line: int, words: list[str], order: tuple[tuple[int, int], ...], may_lack: bool = False
) -> None:
    """An edge of the plane whose matrix has this order; may_lack: the matrix may be missing."""
    first, second = draft.pair(line, words)
    count = 3 if may_lack and len(words) == 2 + 3 else 9
    values = draft.values(line, words[2:], count, "an edge of the plane")
    draft.edges.append(Edge(first, second, np.array(values[:3]), draft.edge_matrix(values[3:], order), line))


def read_space_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE_SE3:QUAT i j x y z qx qy qz qw, information by rows"""
    first, second = draft.pair(line, words)
    values = draft.values(line, words[2:], 28, "an edge in space")
    motion, information = draft.quaternion_pose(line, values[:7]), draft.matrix(values[7:], SPACE_UPPER)
    draft.edges.append(Edge(first, second, motion, information, line))


def read_angle_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE3 i j x y z roll pitch yaw, information by rows, or none; angles about fixed axes"""
    first, second = draft.pair(line, words)
    values = draft.values(line, words[2:], 6 if len(words) == 2 + 6 else 27, "an edge in space")
    motion = np.array(values[:6])
    draft.edges.append(Edge(first, second, motion, draft.edge_matrix(values[6:], SPACE_UPPER), line))


def read_point_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE_SE2_XY pose landmark x y, information xx xy yy; LANDMARK of Victoria Park with the covariance"""
    first, second = draft.pair(line, words)
    values = draft.values(line, words[2:], 5, "a sighting")
    information = draft.matrix(values[2:], POINT_UPPER)
    draft.seen.append(Seen(first, second, np.array(values[:2]), information, False, line))


def read_bearing_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE_BEARING_SE2_XY pose landmark bearing information"""
    first, second = draft.pair(line, words)
    bearing, weight = draft.values(line, words[2:], 2, "a bearing")
    if not weight > 0:
        raise draft.lines.error(line, f"the information of the bearing is {weight:g}; it must be positive")
    draft.seen.append(Seen(first, second, np.array([np.nan, bearing]), np.diag([1.0, weight]), True, line))


def read_range_edge(draft: Draft, line: int, words: list[str]) -> None:
    """BR pose landmark bearing range, and the deviations of both"""
    first, second = draft.pair(line, words)
    bearing, distance, *deviations = draft.values(line, words[2:], 4, "a bearing and range")
    if not min(deviations) > 0:
        raise draft.lines.error(line, f"a deviation is {min(deviations):g}; both must be positive")
    information = np.diag(np.array(deviations[::-1]) ** -2.0)
    draft.seen.append(Seen(first, second, np.array([distance, bearing]), information, True, line))


def read_space_point_edge(draft: Draft, line: int, words: list[str]) -> None:
    """EDGE_SE3_TRACKXYZ pose landmark sensor x y z, information by rows"""
    first, second = draft.pair(line, words)
    (sensor,) = draft.ids(line, words[2:], 1)
    values = draft.values(line, words[3:], 9, "a sighting")
    information = draft.matrix(values[3:], SPACE_POINT_UPPER)
    draft.seen.append(Seen(first, second, np.array(values[:3]), information, False, line, sensor))


def read_offset(draft: Draft, line: int, words: list[str]) -> None:
    """PARAMS_SE3OFFSET id x y z qx qy qz qw: where a sensor is mounted"""
    (sensor,) = draft.ids(line, words, 1)
    values = draft.values(line, words[1:], 7, "an offset")
    if sensor in draft.offsets:
        raise draft.lines.error(line, f"sensor {sensor} is given for the second time; remove one")
    draft.offsets[sensor] = make_poses([draft.quaternion_pose(line, values)])[0]


RECORDS: Final[Mapping[str, Mapping[str, Reader]]] = MappingProxyType(
    {
        "g2o": {
            "FIX": read_fixed,
            "VERTEX_SE2": read_plane_vertex,
            "VERTEX_XY": read_point_vertex,
            "VERTEX_SE3:QUAT": read_space_vertex,
            "VERTEX_TRACKXYZ": read_space_point_vertex,
            "EDGE_SE2": read_plane_edge,
            "EDGE_SE2_XY": read_point_edge,
            "EDGE_BEARING_SE2_XY": read_bearing_edge,
            "EDGE_SE3:QUAT": read_space_edge,
            "EDGE_SE3_TRACKXYZ": read_space_point_edge,
            "PARAMS_SE3OFFSET": read_offset,
        },
        "toro": {
            "VERTEX2": read_plane_vertex,
            "VERTEX": read_plane_vertex,
            "VERTEX3": read_angle_vertex,
            "EDGE2": read_toro_edge,
            "EDGE": read_toro_edge,
            "EDGE3": read_angle_edge,
            "BR": read_range_edge,
        },
        "victoria": {"ODOMETRY": read_plane_edge, "LANDMARK": read_point_edge},
    }
)
"""The records of each format, by their first word."""


def read_graph(cls: type[Graph], path: str | os.PathLike[str], format: str | None) -> Graph:
    """See PoseGraph.read."""
    name = path_of(path, "a pose graph is given by its path")
    if format is not None:
        check_known("format", format, FORMATS)
    lines = unpack_lines(name)
    rows = list(lines.rows())
    if not rows:
        raise LogError("the file has no lines", path=name)
    kind = format or find_format(lines, name, rows[0])
    draft = Draft(lines, covariances=kind in ("graph", "victoria"))
    family = "toro" if kind == "graph" else kind
    records = RECORDS[family]
    for line, words in rows:
        reader = records.get(words[0])
        if reader is not None:
            reader(draft, line, words[1:])
        elif words[0] in LEFT_OUT[family] or words[0].startswith(PARAMETERS):
            draft.skipped[words[0]] = draft.skipped.get(words[0], 0) + 1
        else:
            raise lines.error(
                line, f"no record {words[0][:40]!r} of {kind} is known; records: {', '.join(records)}"
            )
    if kind == "graph" and format is None:
        choose_meaning(draft)
    move_to_bases(draft)
    return finish_draft(cls, draft)


def choose_meaning(draft: Draft) -> None:
    """Files that end in .graph hold covariances or information. As covariances, angles cannot spread more
    than over the whole circle.
    """
    spread = [np.diag(each.information)[(each.motion.size + 1) // 2 :].max() for each in draft.edges]
    if spread and float(np.median(spread)) > UNIFORM_ANGLE:
        draft.covariances = False
        draft.notes.append(
            "the matrices are read as information; as covariances their angles would exceed the circle"
        )


def move_to_bases(draft: Draft) -> None:
    """Sightings in the frames of sensors, in those of the poses that carry them."""
    if not draft.offsets:
        return
    for k, each in enumerate(draft.seen):
        if each.sensor is None:
            continue
        T = draft.offsets.get(each.sensor)
        if T is None:
            raise draft.lines.error(each.line, f"there is no sensor {each.sensor}; add its PARAMS_SE3OFFSET")
        R = T[:3, :3]
        point, information = R @ each.point + T[:3, 3], R @ each.information @ R.T
        draft.seen[k] = each._replace(point=point, information=information)


def unpack_lines(name: str) -> Lines:
    """The lines of a file, of a gzip, or of the only graph in a zip."""
    data = read_regular(name, "pose graph", LOG_BYTES, LogError)
    if data.startswith(GZIP):
        data = unpack_gzip(name, data)
    elif data.startswith(ZIP):
        data = unzip_graph(name, data)
    try:
        return Lines(name, data.decode("utf-8-sig").splitlines())
    except UnicodeDecodeError as fault:
        line = data.count(b"\n", 0, fault.start) + 1
        raise LogError("this is no pose graph: the text is not UTF-8", path=name, line=line) from None


def unzip_graph(name: str, data: bytes) -> bytes:
    """The only file in a zip, apart from what macOS adds."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            files = [each for each in archive.infolist() if not each.is_dir()]
            files = [each for each in files if not each.filename.startswith("__MACOSX/")]
            if len(files) != 1:
                raise LogError(f"the zip has {len(files)} files; unpack it and give one of them", path=name)
            if files[0].file_size > LOG_BYTES:
                raise LogError(f"decompressed, the file exceeds {LOG_BYTES} bytes", path=name)
            return archive.read(files[0])
    except (zipfile.BadZipFile, EOFError, OSError, RuntimeError) as fault:
        raise LogError(f"the zip file is damaged or cut: {fault}", path=name) from None


def find_format(lines: Lines, name: str, first: tuple[int, list[str]]) -> str:
    """The format by the first record, and TORO's with covariances by the ending of the file."""
    line, words = first
    for kind, records in RECORDS.items():
        if words[0] in records or (words[0].startswith(PARAMETERS) and kind == "g2o"):
            return "graph" if kind == "toro" and name.endswith((".graph", ".graph.gz")) else kind
    raise lines.error(
        line, f"{words[0][:40]!r} begins no pose graph; g2o, TORO, .graph and Victoria Park are known"
    )


def finish_draft(cls: type[Graph], draft: Draft) -> Graph:
    """The graph of all lines, its poses in the order of their ids."""
    lines = draft.lines
    start_given = bool(draft.poses)
    add_missing_variables(draft)
    ids, landmark_ids = sorted(draft.poses), sorted(draft.landmarks)
    row = {name: k for k, name in enumerate(ids)}
    landmark_row = {name: k for k, name in enumerate(landmark_ids)}
    flat = {draft.poses[name].shape == (3,) for name in ids} | {
        edge.motion.shape == (3,) for edge in draft.edges
    }
    if not ids:
        raise LogError("the file has no poses and no edges", path=lines.path)
    if len(flat) > 1:
        raise LogError(
            "the file has poses of the plane and poses in space; a graph has one kind", path=lines.path
        )
    d, size = (2, 3) if flat.pop() else (3, 6)
    for each in draft.seen:
        if each.point.shape != (d,):
            raise lines.error(each.line, "the sighting is not of the same space as the poses")
    try:
        return cls(
            poses=make_poses([draft.poses[name] for name in ids]),
            edges=np.array([(row[each.first], row[each.second]) for each in draft.edges], np.int32).reshape(
                -1, 2
            ),
            motions=make_poses([each.motion for each in draft.edges]),
            information=stack_information(draft, draft.edges, size),
            landmarks=np.array([draft.landmarks[name] for name in landmark_ids]).reshape(-1, d),
            sightings=np.array(
                [(row[each.pose], landmark_row[each.landmark]) for each in draft.seen], np.int32
            ).reshape(-1, 2),
            points=np.array([each.point for each in draft.seen]).reshape(-1, d),
            point_information=stack_information(draft, draft.seen, d),
            ranged=np.array([each.ranged for each in draft.seen], bool),
            fixed=np.array([row[name] for name in draft.fixed if name in row] or [0], np.intp),
            fixed_landmarks=np.array(
                [landmark_row[name] for name in draft.fixed if name in landmark_row], np.intp
            ),
            ids=np.array(ids, np.int64),
            landmark_ids=np.array(landmark_ids, np.int64),
            start_given=start_given,
            notes=list_notes(draft),
        )
    except InputError as fault:
        raise LogError(str(fault), path=lines.path) from None


def make_poses(rows: list[Array]) -> Array:
    """Poses (k, 3) or (k, 4, 4) of rows x, y, θ; of x, y, z and three angles; or of x, y, z and a
    quaternion.
    """
    if not rows:
        return np.zeros((0, 3))
    widths = {len(row) for row in rows}
    if widths == {3}:
        return np.array(rows)
    made = np.empty((len(rows), 4, 4))
    for width in widths:
        which = [k for k, row in enumerate(rows) if len(row) == width]
        numbers = np.array([rows[k] for k in which])
        turn, xyz = numbers[:, 3:], numbers[:, :3]
        has_angles = width == len(ANGLES)
        R = matrix_of_fixed((0, 1, 2), turn) if has_angles else rotation(xyzw=turn)
        made[which] = pose(xyz, matrix=R)
    return made


def list_notes(draft: Draft) -> tuple[str, ...]:
    """What was left out or mended."""
    notes = [f"{count_things(n, 'record')} {kind} left out" for kind, n in draft.skipped.items()]
    if draft.unweighted:
        notes.append(f"{count_things(draft.unweighted, 'edge')} without a matrix: the identity is taken")
    return (*notes, *draft.notes)


def stack_information(draft: Draft, measured: Sequence[Edge | Seen], size: int) -> Array:
    """The information matrices of measurements (k, size, size); an error with the line of the first bad
    one.
    """
    given = np.array([each.information for each in measured]).reshape(-1, size, size)
    bad = find_indefinite(given)
    if len(bad) and size == len(ANGLES):
        turned = transpose_mixed_blocks(given)
        if not len(find_indefinite(turned)):
            draft.notes.append(
                f"the blocks of positions and rotations are transposed: {len(bad)} of {len(given)} matrices"
                " would not be positive definite as they are"
            )
            given, bad = turned, bad[:0]
    if len(bad):
        least, largest = np.linalg.eigvalsh(given[bad[0]])[[0, -1]]
        what = "covariance" if draft.covariances else "information"
        kind = "singular" if least >= -SINGULAR_INFORMATION * abs(largest) else "negative"
        raise draft.lines.error(
            measured[bad[0]].line,
            f"the {what} matrix is {kind}, with the least eigenvalue {least:.3g}; it must be positive"
            " definite",
        )
    if not draft.covariances:
        return given
    inverted = np.array([not (isinstance(each, Seen) and each.ranged) for each in measured], bool)
    given[inverted] = np.linalg.inv(given[inverted])
    return given


def find_indefinite(matrices: Array) -> npt.NDArray[np.intp]:
    """The rows of matrices (k, n, n) that are not clearly positive definite."""
    values = np.linalg.eigvalsh(matrices)
    return np.flatnonzero(~(values[:, 0] > SINGULAR_INFORMATION * values[:, -1]))


def transpose_mixed_blocks(matrices: Array) -> Array:
    """Matrices (k, 6, 6) with their blocks of positions and rotations transposed.

    gtsam turns the two halves around without this, so that files written by way of it have these blocks
    wrong.
    """
    turned = matrices.copy()
    turned[:, :3, 3:] = matrices[:, 3:, :3]
    turned[:, 3:, :3] = matrices[:, :3, 3:]
    return turned


def add_missing_variables(draft: Draft) -> None:
    """Files without any vertices leave them to be computed; in others an edge may name none that is
    missing.
    """
    lines, has_poses, has_landmarks = draft.lines, bool(draft.poses), bool(draft.landmarks)
    spatial = any(edge.motion.shape != (3,) for edge in draft.edges)
    no_pose, no_point = (np.zeros(6), np.zeros(3)) if spatial else (np.zeros(3), np.zeros(2))

    def require(name: int, line: int, own: dict[int, Array], others: dict[int, Array], known: bool) -> None:
        if name in own:
            return
        if name in others:
            raise lines.error(
                line, f"vertex {name} is of the other kind: edges join poses, sightings end at landmarks"
            )
        if known:
            raise lines.error(line, f"there is no vertex {name}; add it, or remove the edge")
        own[name] = no_pose if own is draft.poses else no_point

    for edge in draft.edges:
        require(edge.first, edge.line, draft.poses, draft.landmarks, has_poses)
        require(edge.second, edge.line, draft.poses, draft.landmarks, has_poses)
    for each in draft.seen:
        require(each.pose, each.line, draft.poses, draft.landmarks, has_poses)
        require(each.landmark, each.line, draft.landmarks, draft.poses, has_landmarks)
    for name, line in draft.fixed.items():
        if name not in draft.poses and name not in draft.landmarks:
            raise lines.error(line, f"FIX names vertex {name}, which does not exist")
