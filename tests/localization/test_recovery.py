"""Recovery of particle filters: slips of wheels, the end of the map, few beams, rays through walls."""

from __future__ import annotations

import numpy as np
import pytest
from tests.localization.test_particles import CLEAN, WAY, building, route

import cspace as cs
from cspace import _core
from cspace.localization import LaserScanner, ParticleFilter, Scans, simulate
from cspace.localization.filters.rows import relate_rows
from cspace.localization.particles.evidence import NEW_SCORE, WALL_SLACK, RayJudge, open_unknown
from cspace.localization.particles.models import Judgement, make_model
from cspace.localization.particles.placing import lift_share
from cspace.localization.particles.recovery import LOST_UPDATES, ScoreMonitor
from cspace.maps import EvidenceGrid

SCANNER = LaserScanner(most_range=15.0)


def mapped_part(grid, rng, share=0.6):
    """The map of a building of which a part is unknown: beyond a random line."""
    rows, columns = grid.blocked.shape
    angle = rng.uniform(-np.pi, np.pi)
    y, x = np.mgrid[:rows, :columns]
    along = x * np.cos(angle) + y * np.sin(angle)
    known = along < np.quantile(along, share)
    sums = np.where(grid.blocked, 300, -300) * known
    return EvidenceGrid(sums.astype(np.int32), grid.resolution, np.asarray(grid.origin))


def walk_beam(judge, p, end, step=0.01):
    """Whether a beam goes through a wall well before its end, by small steps."""
    far = float(np.hypot(*(end - p)))
    reach = np.arange(0.0, far, step)
    cells = np.floor((p + np.outer(reach / far, end - p) - judge.field.origin) / judge.field.resolution)
    rows, columns = cells[:, 1].astype(int), cells[:, 0].astype(int)
    inside = (rows >= 0) & (columns >= 0)
    inside &= (rows < judge.walls.blocked.shape[0]) & (columns < judge.walls.blocked.shape[1])
    hit = ~inside
    hit[inside] = judge.walls.blocked[rows[inside], columns[inside]]
    first = reach[np.argmax(hit)] if hit.any() else far
    return first < far - WALL_SLACK, abs(first - (far - WALL_SLACK)) < 2 * judge.field.resolution


def free_pose(grid, rng):
    rows, columns = np.nonzero(~grid.blocked)
    k = rng.integers(len(rows))
    x, y = grid.origin + grid.resolution * (np.array([columns[k], rows[k]]) + 0.5)
    return np.array([x, y, rng.uniform(-np.pi, np.pi)])


@pytest.mark.parametrize("seed", range(4))
def test_rays_are_judged_as_by_walking_along_them(seed):
    rng = np.random.default_rng(seed)
    grid = building(seed)
    part = mapped_part(grid, rng)
    model = make_model(part, SCANNER)
    judge = RayJudge(model.field, model.walls, model.known)
    poses = np.array([free_pose(grid, rng) for _ in range(5)])
    ends = rng.uniform(-4, 4, (60, 2))
    laser = rng.uniform(-0.1, 0.1, 2)
    seen = judge.look(ends, laser, poses)
    for i, pose in enumerate(poses):
        R = cs.rotation_2d(pose[2])
        p, origin = ends @ R.T + pose[:2], R @ laser + pose[:2]
        counted, unknown, whole, close = [], 0, 0.0, 0
        for end in p:
            crosses, is_close = walk_beam(judge, origin, end)
            column, row = np.floor((end - model.field.origin) / model.field.resolution).astype(int)
            rows, columns = model.field.scores.shape
            inside = 0 <= row < rows and 0 <= column < columns
            score = model.field.scores[row, column] / 255 if inside else model.field.outside / 255
            is_new = (not inside or not part.known[row, column]) and score < NEW_SCORE
            close += is_close
            if crosses:
                counted.append(0.0)
            elif is_new:
                unknown += 1
                whole += NEW_SCORE
            else:
                counted.append(score)
        whole = (whole + sum(counted)) / len(p)
        slack = close / len(p) + 0.02  # rays that end within two cells of the bound may be judged either way
        assert seen.whole[i] == pytest.approx(whole, abs=slack)
        assert seen.unknown[i] == pytest.approx(unknown / len(p), abs=slack)


@pytest.mark.parametrize("seed", range(4))
def test_open_fields_weigh_what_rays_see_before_walls(seed):
    """Ends in unknown cells count a half, beside known walls as much as those, outside of the map, too."""
    rng = np.random.default_rng(seed)
    part = mapped_part(building(seed), rng)
    model = make_model(part, SCANNER)
    opened = open_unknown(model.field, model.known)
    assert (opened.scores[model.known] == model.field.scores[model.known]).all()
    new = round(255 * NEW_SCORE)
    np.testing.assert_array_equal(
        opened.scores[~model.known], np.maximum(model.field.scores[~model.known], new)
    )
    assert opened.outside == new
    poses = np.array([free_pose(part.to_grid(), rng) for _ in range(20)])
    ends = rng.uniform(-6, 6, (40, 2))
    seen = model.rays.look(ends, np.zeros(2), poses)
    by_field = RayJudge(opened, None, None).look(ends, np.zeros(2), poses)
    np.testing.assert_allclose(seen.ends, by_field.ends, atol=1 / 255)
    assert open_unknown(model.field, None) is model.field


@pytest.mark.parametrize("seed", range(4))
def test_parts_of_the_evidence_add_up(seed):
    rng = np.random.default_rng(seed)
    grid = building(seed)
    model = make_model(mapped_part(grid, rng), SCANNER)
    poses = np.array([free_pose(grid, rng) for _ in range(20)])
    seen = model.rays.look(rng.uniform(-5, 5, (40, 2)), np.zeros(2), poses)
    assert (seen.whole <= (1 - seen.unknown) * seen.score + NEW_SCORE * seen.unknown + 1e-12).all()
    open_air = RayJudge(model.field, None, model.known).look(rng.uniform(-5, 5, (40, 2)), np.zeros(2), poses)
    np.testing.assert_allclose(
        open_air.whole, (1 - open_air.unknown) * open_air.score + NEW_SCORE * open_air.unknown
    )
    blind = RayJudge(model.field, None, None).look(rng.uniform(-5, 5, (40, 2)), np.zeros(2), poses)
    np.testing.assert_allclose(blind.whole, blind.ends)
    np.testing.assert_allclose(blind.score, blind.ends)


def test_the_true_place_beats_others_along_rays_where_half_of_the_map_is_unknown():
    """Ends alone prefer known walls elsewhere, less so where ends in unknown cells are open."""
    by_rays, by_ends, by_open, trials = 0, 0, 0, 0
    rng = np.random.default_rng(8)
    angles = np.linspace(-np.pi / 2, np.pi / 2, 61)
    for trial in range(160):
        grid = building(trial)
        model = make_model(mapped_part(grid, rng, 0.6), SCANNER)
        truth = free_pose(grid, rng)
        ranges = cs.maps.cast_rays(grid, truth[:2], truth[2] + angles)
        ends = ranges[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        seen = model.rays.look(ends, np.zeros(2), truth[None])
        if not 0.2 < seen.unknown[0] < 0.6:
            continue
        found = cs.localization.search_pose(ends, model.field, most=8, least_score=0.2, margin=1.0)
        false = found.poses[np.hypot(*(found.poses[:, :2] - truth[:2]).T) > 1.0]
        others = model.rays.look(ends, np.zeros(2), false)
        trials += 1
        by_rays += seen.whole[0] > others.whole.max()
        by_open += seen.ends[0] > others.ends.max()
        walls = RayJudge(model.field, None, None)
        by_ends += walls.look(ends, np.zeros(2), truth[None]).ends[0] > (
            walls.look(ends, np.zeros(2), false).ends.max()
        )
    assert trials >= 20
    assert by_rays > 0.6 * trials
    assert by_rays >= 2 * by_ends
    assert by_rays > by_open > by_ends


@pytest.mark.parametrize("seed", range(6))
def test_the_share_of_the_first_particles_is_lifted_and_their_ratios_stay(seed):
    rng = np.random.default_rng(seed)
    cloud = _core.ParticleCloud(400, seed)
    cloud.place(rng.normal(size=(400, 3)))
    count = int(rng.integers(20, 380))
    cloud.add_logs(np.where(np.arange(400) < count, -rng.uniform(0, 40), 0.0) + rng.uniform(-3, 0, 400))
    before = cloud.weights()
    lift_share(cloud, count, 0.1)
    after = cloud.weights()
    share = after[:count].sum()
    assert share >= 0.1 - 1e-6
    assert share < 1.05 * max(0.1, before[:count].sum())
    np.testing.assert_allclose(
        after[count:] / after[count:].sum(), before[count:] / before[count:].sum(), atol=1e-6
    )


@pytest.mark.parametrize("seed", range(6))
def test_wheels_that_slip_do_not_lose_the_robot(seed):
    """Half a metre that the odometry did not see, once: found again without a search of the map."""
    rng = np.random.default_rng(seed)
    grid = building(seed % 3 + 3)
    log = simulate(route(WAY), grid, CLEAN, rng=seed)
    poses = log.truth.at(log.scans.times)
    pf = ParticleFilter(grid, sensor=CLEAN, start=poses[0], rng=seed)
    slip = int(rng.integers(10, len(poses) - 12))
    for k in range(1, len(poses)):
        step = relate_rows(poses[k - 1], poses[k])
        if k == slip:
            step += rng.choice([-1, 1], 3) * rng.uniform([0.3, 0, 0], [0.5, 0, 0.2])
        pf.predict(step, 0.5)
        pf.update(log.scans[k])
        away = np.hypot(*(pf.pose - poses[k])[:2])
        assert away < (0.2 if k < slip or k > slip + 5 else 0.9)
    assert pf.status == "localised"


@pytest.mark.parametrize("seed", range(5))
def test_scans_of_few_beams_move_nobody_away(seed):
    """A scan of a dozen ends, half of them false, fits somewhere else by chance."""
    rng = np.random.default_rng(seed)
    grid = building(seed % 3 + 3)
    log = simulate(route(WAY), grid, SCANNER, rng=seed)
    poses, scans = log.truth.at(log.scans.times), log.scans
    ranges = np.array(scans.ranges)
    for k in rng.choice(np.arange(5, len(poses)), 6, replace=False):
        kept = rng.choice(len(scans.angles), 14, replace=False)
        values = np.full(len(scans.angles), scans.most)
        values[kept] = ranges[k, kept]
        values[kept[:7]] = rng.uniform(0.2, 3.0, 7)
        ranges[k] = values
    spoiled = Scans(scans.times, ranges, scans.angles, scans.most, scans.T_base_laser)
    pf = ParticleFilter(grid, sensor=SCANNER, start=poses[0], rng=seed)
    for k in range(1, len(poses)):
        pf.predict(relate_rows(poses[k - 1], poses[k]), 0.5)
        pf.update(spoiled[k])
        assert np.hypot(*(pf.pose - poses[k])[:2]) < 0.6
    assert not [event for event in pf.events if event.kind == "search"]


@pytest.mark.parametrize("seed", range(12))
def test_a_robot_that_drives_off_its_map_is_not_sent_elsewhere(seed):
    rng = np.random.default_rng(seed)
    grid = building(3)
    log = simulate(route(WAY), grid, SCANNER, rng=seed)
    poses = log.truth.at(log.scans.times)
    for _ in range(100):
        part = mapped_part(grid, rng, rng.uniform(0.4, 0.7))
        cells = np.floor((poses[:, :2] - part.origin) / part.resolution).astype(int)
        known = part.known[cells[:, 1], cells[:, 0]]
        if known[0] and 0.3 < known.mean() < 0.8:
            break
    pf = ParticleFilter(part, sensor=SCANNER, start=poses[0], rng=seed)
    for k in range(1, len(poses)):
        pf.predict(relate_rows(poses[k - 1], poses[k]), 0.5)
        pf.update(log.scans[k])
        if known[: k + 1].all():
            assert np.hypot(*(pf.pose - poses[k])[:2]) < 0.6
    assert not [event for event in pf.events if event.kind == "search"]


def test_searches_find_more_places_at_the_end_of_the_map_where_unknown_cells_are_open():
    opened, shut, trials = 0, 0, 0
    rng = np.random.default_rng(5)
    angles = np.linspace(-np.pi / 2, np.pi / 2, 61)
    for trial in range(200):
        grid = building(trial)
        model = make_model(mapped_part(grid, rng, 0.5), SCANNER)
        truth = free_pose(grid, rng)
        ranges = cs.maps.cast_rays(grid, truth[:2], truth[2] + angles)
        ends = ranges[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        if not 0.3 < model.rays.look(ends, np.zeros(2), truth[None]).unknown[0] < 0.6:
            continue
        trials += 1
        for field in (model.open, model.field):
            found = cs.localization.search_pose(ends, field, most=8, least_score=0.2, margin=1.0)
            is_found = bool((np.hypot(*(found.poses[:, :2] - truth[:2]).T) < 0.5).any())
            opened += is_found and field is model.open
            shut += is_found and field is model.field
    assert trials >= 20
    assert opened > 1.3 * shut


def test_a_robot_whose_beams_go_through_walls_is_lost_however_well_they_end():
    monitor = ScoreMonitor(0.7)
    for _ in range(LOST_UPDATES):
        assert not monitor.is_lost
        through = Judgement(0.95, 0.2)
        monitor.see(through)
        assert monitor.wants_search(through)
        monitor.add(through, True)
        assert monitor.is_crossing
    assert monitor.is_lost
    monitor.add(Judgement(0.95, 0.9), True)
    assert not monitor.is_lost
    assert not monitor.is_crossing
