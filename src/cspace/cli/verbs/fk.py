"""`cspace fk`: where a frame is at given joints."""

from __future__ import annotations

import argparse
from typing import Final

from cspace.cli.arguments import add_chain, add_degrees, add_joints, add_robot
from cspace.cli.exits import Exit
from cspace.cli.output import Output
from cspace.cli.poses import pose_document, show_pose
from cspace.cli.robot import load_chosen, need_chain, read_configuration

EXAMPLES: Final = """
cspace fk ur5e 0 -pi/2 pi/2 0 pi/2 0
cspace fk puma560 10 -20 30 0 45 0 --deg
cspace fk arm.urdf 0.1 0.2 --frame elbow_link --json
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_robot(parser)
    add_joints(parser)
    parser.add_argument("--frame", metavar="LINK", help="a frame other than the tip")
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the pose of the frame in the base."""
    robot = load_chosen(args)
    if args.frame is None:
        need_chain(robot)
    q = read_configuration(args.q, robot, "q", degrees=args.deg)
    T = robot.fk(q) if args.frame is None else robot.fk(q, frame=args.frame)
    frame = args.frame or robot.tip
    if out.as_json:
        ends = {"robot": robot.name, "base": robot.base, "frame": frame}
        out.document({"schema": "cspace.fk/1", **ends, "q": q.tolist(), **pose_document(T)})
    else:
        show_pose(out, T, f"{frame} in {robot.base}", degrees=args.deg)
    return Exit.DONE
