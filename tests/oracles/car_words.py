"""Shortest curves of a car found numerically: Newton's method on every word from many starts."""

from __future__ import annotations

import itertools

import numpy as np

TURN = 2 * np.pi


def drive(poses, turn, length):
    """Poses (..., 3) after a signed length on a circle of radius 1 (turn ±1) or straight on (0)."""
    x, y, theta = np.moveaxis(poses, -1, 0)
    if turn == 0:
        return np.stack([x + length * np.cos(theta), y + length * np.sin(theta), theta + 0 * length], -1)
    after = theta + turn * length
    return np.stack(
        [x + turn * (np.sin(after) - np.sin(theta)), y - turn * (np.cos(after) - np.cos(theta)), after], -1
    )


def end(word, lengths):
    """Where a word (k turns) of lengths (..., k) ends, from the origin."""
    pose = np.zeros((*lengths.shape[:-1], 3))
    for k, turn in enumerate(word):
        pose = drive(pose, turn, lengths[..., k])
    return pose


def error(word, lengths, goal):
    e = end(word, lengths) - goal
    e[..., 2] = (e[..., 2] + np.pi) % TURN - np.pi
    return e


def solutions(word, goal, starts, steps=40):
    """Lengths (m, 3) of a word of three segments that meet a goal, from starts (n, 3)."""
    x, h = starts.copy(), 1e-7
    for _ in range(steps):
        e = error(word, x, goal)
        columns = [(error(word, x + h * unit, goal) - error(word, x - h * unit, goal)) for unit in np.eye(3)]
        J = np.stack(columns, -1) / (2 * h)
        singular = np.abs(np.linalg.det(J)) < 1e-9
        J[singular] += 1e-3 * np.eye(3)
        move = np.linalg.solve(J, e[..., None])[..., 0]
        x -= move * np.minimum(1, 1 / np.maximum(1e-12, np.abs(move).max(-1)))[..., None]
    return x[np.abs(error(word, x, goal)).max(-1) < 1e-9]


def dubins(goal, rng, starts=200):
    """Length of the shortest forward word of three segments from the origin to a goal, radius 1."""
    best, far = np.inf, np.hypot(goal[0], goal[1])
    for word in itertools.product((1, 0, -1), repeat=3):
        if word[0] == word[1] or word[1] == word[2]:
            continue
        size = [TURN if turn else far + 4 for turn in word]
        found = solutions(word, goal, rng.uniform(0, 1, (starts, 3)) * size)
        for k, turn in enumerate(word):
            if turn:
                found[:, k] %= TURN
                found[np.abs(found[:, k] - TURN) < 1e-8, k] = 0.0
        found = found[(found > -1e-9).all(-1)]
        if len(found):
            best = min(best, found.sum(-1).min())
    return best


def reeds_shepp(goal, rng, starts=200):
    """Length of the shortest word of three segments from the origin, driven either way, radius 1."""
    best, far = np.inf, np.hypot(goal[0], goal[1])
    for word in itertools.product((1, 0, -1), repeat=3):
        if word[0] == word[1] or word[1] == word[2]:
            continue
        size = [np.pi if turn else far + 4 for turn in word]
        found = solutions(word, goal, rng.uniform(-1, 1, (starts, 3)) * size)
        for k, turn in enumerate(word):
            if turn:
                found[:, k] = (found[:, k] + np.pi) % TURN - np.pi
        if len(found):
            best = min(best, np.abs(found).sum(-1).min())
    return best
