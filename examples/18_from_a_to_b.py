"""A Panda moves from A to B: five laws of motion side by side, the limits that bind, and a file for ROS."""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np

import cspace as cs

robot = cs.load_robot("panda")
a = np.radians([0, -45, 0, -135, 0, 90, 45])
b = np.radians([60, 10, -20, -90, 15, 110, 0])

for profile in ("double_s", "trapezoidal", "cubic", "quintic", "septic"):
    jerk = None if profile == "trapezoidal" else 400.0
    motion = robot.move_to(b, start=a, profile=profile, jerk=jerk)
    v, a_most, j = (np.abs(np.stack(motion.extremes(order)[::2])).max() for order in (1, 2, 3))
    print(f"{profile:12} {motion.duration:.3f} s, at most {v:.2f} rad/s, {a_most:.1f} rad/s², {j:.0f} rad/s³")
    assert motion.check(robot)

motion = robot.move_to(b, start=a, jerk=400)
for each in motion.binding(robot)[:3]:
    print(f"{each.joint} is at its {each.limit} limit from {each.begin:.3f} to {each.end:.3f} s")

# A start that already moves, and a motion there and back at half the speed.
moving = robot.move_to(b, start=a, start_velocity=np.full(7, -0.3), jerk=400)
print("already moving:", moving)
tour = motion.then(motion.reversed()).scaled(2)
assert np.array_equal(tour(tour.duration), a)
assert tour.check(robot)

file = Path(mkdtemp()) / "motion.yaml"
cs.trajectory.to_ros(tour, file, rate=100)
print(file.read_text().count("positions"), "points for ROS")
