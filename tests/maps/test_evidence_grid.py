"""Evidence grids against slow sums over rays, and their laws: the order of scans, parts, files."""

import pickle
from dataclasses import dataclass, field

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, MapError
from cspace.maps import EvidenceGrid


@dataclass
class Laser:
    """What EvidenceGrid reads of scans."""

    times: np.ndarray
    ranges: np.ndarray
    angles: np.ndarray
    most: float = 20.0
    T_base_laser: np.ndarray = field(default_factory=lambda: np.eye(3))

    def part(self, keep):
        return Laser(self.times[keep], self.ranges[keep], self.angles, self.most, self.T_base_laser)


def random_scans(rng, scans=12, beams=30):
    ranges = rng.uniform(0.05, 8, (scans, beams)).astype(np.float32)
    ranges[rng.random(ranges.shape) < 0.1] = 25.0
    ranges[rng.random(ranges.shape) < 0.05] = np.nan
    T = cs.pose_2d(xytheta=rng.uniform(-0.5, 0.5, 3))
    laser = Laser(np.arange(scans) * 0.1, ranges, np.linspace(-2, 2, beams), 20.0, T)
    return laser, rng.uniform(-3, 3, (scans, 3))


def cells_between(a, b):
    """The cells (row, column) of a segment in units of cells, in order."""
    t = [0.0, 1.0]
    for k in range(2):
        low, high = sorted((a[k], b[k]))
        borders = np.arange(np.ceil(low), np.floor(high) + 1)
        t += [(border - a[k]) / (b[k] - a[k]) for border in borders]
    t = np.unique(np.clip(t, 0, 1))
    middles = a + ((t[:-1] + t[1:]) / 2)[:, None] * (b - a)
    return [(int(np.floor(y)), int(np.floor(x))) for x, y in middles]


def slow_sums(scans, poses, resolution, hit, miss, max_range, clear_range):
    """Evidence by cell (row, column) of the endless grid, in a dict."""
    sums = {}
    for pose, ranges in zip(poses, scans.ranges, strict=True):
        T = cs.pose_2d(xytheta=pose) @ scans.T_base_laser
        hits, misses = set(), set()
        for angle, measured in zip(scans.angles, ranges.astype(float), strict=True):
            returned = np.isfinite(measured) and measured < scans.most
            is_hit = returned and measured <= max_range
            length = measured if is_hit else max_range if returned else clear_range
            if length <= 0:
                continue
            a, b = T[:2, 2], T[:2, 2] + length * (T[:2, :2] @ (np.cos(angle), np.sin(angle)))
            cells = cells_between(a / resolution, b / resolution)
            if is_hit:
                hits.add(cells[-1])
            misses.update(cells[:-1] if is_hit else cells)
        for cell in hits:
            sums[cell] = sums.get(cell, 0) + hit
        for cell in misses - hits:
            sums[cell] = sums.get(cell, 0) + miss
    return sums


@pytest.mark.parametrize("seed", range(10))
def test_sums_are_those_of_all_rays(seed):
    rng = np.random.default_rng(seed)
    scans, poses = random_scans(rng)
    resolution = rng.uniform(0.05, 0.5)
    max_range, clear_range = rng.choice([4.0, np.inf]), rng.choice([0.0, 3.0])
    grid = EvidenceGrid.from_scans(
        scans, poses, resolution, max_range=max_range, clear_range=clear_range, hit=0.8, miss=0.4
    )
    wanted = slow_sums(scans, poses, resolution, 139, -41, max_range, clear_range)
    got = {
        (row + grid.corner[0], column + grid.corner[1]): int(grid.sums[row, column])
        for row, column in np.argwhere(grid.known)
    }
    assert got == {cell: value for cell, value in wanted.items() if value}


@pytest.mark.parametrize("seed", range(5))
def test_the_order_of_scans_their_parts_and_threads_change_nothing(seed):
    rng = np.random.default_rng(seed)
    scans, poses = random_scans(rng, 300, 20)
    whole = EvidenceGrid.from_scans(scans, poses, 0.1, clear_range=2.0)
    order = rng.permutation(len(poses))
    shuffled = EvidenceGrid.from_scans(scans.part(order), poses[order], 0.1, clear_range=2.0, threads=3)
    np.testing.assert_array_equal(shuffled.sums, whole.sums)
    parts = EvidenceGrid.from_scans(scans.part(order[:7]), poses[order[:7]], 0.1, clear_range=2.0)
    parts = parts.add(scans.part(order[7:]), poses[order[7:]], clear_range=2.0)
    np.testing.assert_array_equal(parts.sums, whole.sums)
    assert parts.corner == whole.corner
    np.testing.assert_array_equal(parts.origin, whole.origin)


def test_a_room_is_mapped():
    blocked = np.zeros((60, 80), bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = blocked[20:30, 30:40] = True
    room = cs.OccupancyGrid(blocked, 0.1)
    rng = np.random.default_rng(1)
    poses = np.column_stack([rng.uniform(0.5, 2.5, 60), rng.uniform(0.5, 5.5, 60), rng.uniform(-3, 3, 60)])
    angles = np.linspace(-np.pi, np.pi, 360, endpoint=False)
    ranges = cs.maps.cast_rays(room, poses[:, None, :2], poses[:, 2:] + angles) + 0.02
    grid = EvidenceGrid.from_scans(Laser(np.arange(60.0), ranges.astype(np.float32), angles), poses, 0.1)
    made = grid.to_grid(unknown="free")
    seen = grid.known & (np.abs(grid.evidence) > 100)
    rows, columns = np.argwhere(seen).T
    x, y = grid.origin[0] + 0.1 * (columns + 0.5), grid.origin[1] + 0.1 * (rows + 0.5)
    inside = (x > 0) & (x < 8) & (y > 0) & (y < 6)
    wrong = room.is_free(np.column_stack([x, y])[inside]) == made.blocked[rows, columns][inside]
    assert wrong.mean() < 0.02
    assert grid.probability[seen].max() > 0.99


def test_timed_poses_are_interpolated():
    rng = np.random.default_rng(2)
    scans, poses = random_scans(rng, 10, 12)
    timed = cs.localization.TimedPoses(np.arange(10) * 0.1 + 0.25, poses)
    inside = scans.times >= 0.25
    grid = EvidenceGrid.from_scans(scans, timed, 0.1)
    wanted = EvidenceGrid.from_scans(scans.part(inside), timed.at(scans.times[inside]), 0.1)
    np.testing.assert_array_equal(grid.sums, wanted.sums)


def some_grid(seed=0):
    rng = np.random.default_rng(seed)
    percent = rng.integers(0, 101, (17, 23)) / 100
    percent[rng.random(percent.shape) < 0.3] = np.nan
    percent[percent == 0.5] = np.nan
    return percent, EvidenceGrid.from_probability(percent, 0.05, (1.0, -2.5))


def test_raw_maps_keep_per_cents(tmp_path):
    percent, grid = some_grid()
    grid.save_ros(tmp_path / "map.yaml", mode="raw")
    again = EvidenceGrid.from_ros(tmp_path / "map.yaml")
    np.testing.assert_array_equal(again.sums, grid.sums)
    np.testing.assert_array_equal(again.origin, grid.origin)
    np.testing.assert_array_equal(grid.known, ~np.isnan(percent))
    again.save_ros(tmp_path / "again.yaml", mode="raw")
    assert (tmp_path / "again.pgm").read_bytes() == (tmp_path / "map.pgm").read_bytes()


def test_trinary_maps_keep_kinds(tmp_path):
    percent, grid = some_grid(1)
    grid.save_ros(tmp_path / "map.yaml")
    again = EvidenceGrid.from_ros(tmp_path / "map.yaml")
    np.testing.assert_array_equal(again.known, grid.known)
    np.testing.assert_array_equal(again.to_grid().blocked, grid.to_grid().blocked)
    free = cs.OccupancyGrid.from_ros(tmp_path / "map.yaml", unknown="free")
    np.testing.assert_array_equal(free.blocked, grid.to_grid(unknown="free").blocked)
    np.testing.assert_array_equal(free.blocked, np.nan_to_num(percent) > 0.65)


def test_scale_maps_have_partly_free_cells(tmp_path):
    grey = np.arange(256, dtype=np.uint8).reshape(16, 16)
    (tmp_path / "map.pgm").write_bytes(b"P5\n16 16\n255\n" + grey.tobytes())
    text = "image: map.pgm\nmode: scale\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 1\n"
    (tmp_path / "map.yaml").write_text(text + "occupied_thresh: 0.8\nfree_thresh: 0.2\n")
    got = EvidenceGrid.from_ros(tmp_path / "map.yaml").probability[::-1].ravel()
    wanted = np.clip((grey.ravel() / 255 - 0.2) / 0.6, 0, 1)
    np.testing.assert_allclose(got, wanted, atol=0.003)
    with pytest.raises(MapError, match="EvidenceGrid"):
        cs.OccupancyGrid.from_ros(tmp_path / "map.yaml")
    (tmp_path / "map.yaml").write_text(
        text.replace("scale", "colour") + "occupied_thresh: 0.8\nfree_thresh: 0.2\n"
    )
    with pytest.raises(MapError, match=r":2: mode is 'colour'"):
        EvidenceGrid.from_ros(tmp_path / "map.yaml")


def test_likelihood_fields_know_unknown_cells():
    _, grid = some_grid(2)
    field = grid.likelihood_field()
    whole = grid.to_grid(unknown="free").likelihood_field()
    np.testing.assert_array_equal(field.scores, np.where(grid.known, whole.scores, 0))
    np.testing.assert_array_equal(field.origin, grid.origin)


def test_grids_are_pickled():
    _, grid = some_grid(3)
    again = pickle.loads(pickle.dumps(grid))
    np.testing.assert_array_equal(again.sums, grid.sums)
    assert repr(again) == repr(grid)


def test_what_cannot_be_mapped_is_refused():
    rng = np.random.default_rng(4)
    scans, poses = random_scans(rng, 5, 6)
    with pytest.raises(InputTypeError, match="scans"):
        EvidenceGrid.from_scans(np.ones((3, 3)), poses)
    with pytest.raises(InputError, match="one pose per scan"):
        EvidenceGrid.from_scans(scans, poses[:-1])
    with pytest.raises(InputError, match="poses"):
        EvidenceGrid.from_scans(scans, np.full((5, 3), np.nan))
    with pytest.raises(InputError, match="cells; the maximum"):
        EvidenceGrid.from_scans(scans, poses * [1e6, 1e6, 1])
    with pytest.raises(InputError, match="too far"):
        EvidenceGrid.from_scans(scans, poses + 1e14)
    with pytest.raises(InputError, match="resolution"):
        EvidenceGrid.from_scans(scans, poses, 0.0)
    with pytest.raises(InputError, match="hit"):
        EvidenceGrid.from_scans(scans, poses, hit=0.4)
    with pytest.raises(InputError, match="clear_range"):
        EvidenceGrid.from_scans(scans, poses, clear_range=-1.0)
    with pytest.raises(InputError, match="32 bits"):
        EvidenceGrid(np.full((2, 2), 2**31 - 9, np.int32), 1.0, (0, 0)).add(scans, poses)
    with pytest.raises(InputError, match="int32"):
        EvidenceGrid(np.zeros((2, 2)), 1.0, (0, 0))
    with pytest.raises(InputError, match="0 to 1"):
        EvidenceGrid.from_probability([[2.0]])
    with pytest.raises(InputError, match="threshold"):
        some_grid()[1].to_grid(0.2)
