"""A way around a wall: planned, proved, and checked at a thousand configurations."""

import numpy as np

import cspace as cs

robot = cs.load_robot("ur5e")
scene = cs.Scene(
    [
        cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], name="wall"),
        cs.HalfSpace(offset=-0.25, name="floor"),
    ]
)
start = np.radians([-60, -80, 90, -100, -90, 0])
goal = np.radians([60, -80, 90, -100, -90, 0])

straight = robot.edge(start, goal, scene)
print(f"the straight way is {straight.verdict}: {straight.reason}")

plan = cs.plan(robot, start, goal, scene)
print(plan.reason)
for corner in plan.path:
    print(np.degrees(corner).round(1))
print(f"least clearance {plan.clearance:.3f} m, certified: {plan.certified}")
assert not robot.collides(plan.sample(0.005), scene).any()

pose = cs.plan(robot, start, robot.fk(goal), scene)
print(f"to the pose of the goal, by solution {pose.goal}: length {pose.cost:.2f}")
