"""The errors of cspace: each message names the subject, the value, the rule and the remedy."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import wraps
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING, Final, ParamSpec, TypeVar

__all__ = [
    "CspaceError",
    "DescriptionError",
    "InputError",
    "InputTypeError",
    "LogError",
    "MapError",
    "MeshError",
    "MissingExtraError",
    "Renamed",
    "RoadmapError",
    "TimeLimitError",
    "UnknownNameError",
    "attribute_error",
    "check_kind",
    "check_known",
    "keyword_error",
    "module_error",
    "name_new_keywords",
    "name_type",
    "plain_letters",
    "shorten",
    "shown",
    "suggest",
]

Given = ParamSpec("Given")
Answer = TypeVar("Answer")

SHOWN: Final = (str, int, float)
"""What reads well in a message, whatever it is."""

SHORT: Final = 80
"""The most characters of a value that a message shows."""
LONGEST: Final = 200
"""The most characters of a name or a path that a message shows."""
LONG: Final = re.compile(rf"(?<!\w)'[^']{{{LONGEST},}}'|(?<!\w)\"[^\"]{{{LONGEST},}}\"|\S{{{LONGEST},}}")
"""What no message repeats whole: a quoted name, or a path."""

RENAMED: Final = MappingProxyType(
    {
        "IK": "ik",
        "IK_batched": "ik",
        "Family": "SelfMotion",
        "Price": "Stats",
        "Q": "q",
        "StillDirection": "InvariantDirection",
        "StillPoint": "InvariantPoint",
        "accel": "forward_dynamics",
        "asked": "goal_parts",
        "computeCartesianPath": "track",
        "configs": "named_poses",
        "coriolis": "coriolis_matrix",
        "families": "self_motions",
        "fdyn": "simulate",
        "fixed": "locked",
        "fkine": "fk",
        "fkine_all": "fk_all",
        "fwdKin": "fk",
        "getGlobalLinkTransform": "fk",
        "getJacobian": "jacobian",
        "getKinematicFamily": "ik_plan",
        "gravload": "gravity_torques",
        "hasKnownDecomposition": "ik_plan",
        "held": "locked",
        "hold": "locked",
        "ik_LM": "ik",
        "ikine": "ik",
        "ikine_LM": "ik",
        "ikine_a": "ik",
        "inertia": "mass_matrix",
        "is_LS": "status",
        "jacob0": "jacobian",
        "jacobe": "jacobian",
        "line": "summary",
        "missing": "out_of_reach",
        "n": "dof",
        "names": "joint_names",
        "nq": "dof",
        "payload": "with_payload",
        "price": "stats",
        "q0": "near",
        "qlim": "limits",
        "qr": "named_poses",
        "qz": "named_poses",
        "rne": "inverse_dynamics",
        "robot": "solver",
        "seed": "near= or rng",
        "sees": "sensing",
        "setFromIK": "ik",
        "still_directions": "invariant_directions",
        "still_points": "invariant_points",
        "tool": "with_tool",
        "why": "cause",
    }
)
"""Attributes and keywords of earlier versions and of other libraries, and ours."""
FOREIGN_NAMES: Final = MappingProxyType(
    {
        "CIRC": "robot.move_arc",
        "DHRobot": 'cs.Robot.from_dh(table, convention="standard")',
        "DhRobot": 'cs.Robot.from_dh(table, convention="standard")',
        "DurationDiscretization": "cycle= of cs.trajectory.state_to_state",
        "ERobot": "cs.load_robot(path)",
        "GaussNewtonOptimizer": "cs.PoseGraph.read(path).optimize()",
        "HPRobot": "cs.Robot.from_screws(axes, points, T_zero)",
        "ISAM2": "cs.IncrementalGraph().add(i, j, z, information)",
        "InputParameter": "cs.trajectory.state_to_state(start, goal, velocity=, acceleration=, jerk=)",
        "JointAccelerationConstraint": "acceleration= of cs.time_parametrize",
        "JointTorqueConstraint": "torque=True of cs.time_parametrize",
        "JointVelocityConstraint": "velocity= of cs.time_parametrize",
        "LIN": "robot.move_linear",
        "Link": "cs.model.Link",
        "Marginals": "answer.covariance(i) of a pose graph",
        "PTP": "robot.move_to",
        "RevoluteDH": 'cs.Robot.from_dh(table, convention="standard")',
        "RobotModel": "cs.load_robot(path)",
        "RobotTrajectory": "cs.time_parametrize(path, robot)",
        "Ruckig": "cs.trajectory.state_to_state(start, goal, velocity=, acceleration=, jerk=)",
        "SE2": "cs.pose_2d",
        "SE3": "cs.pose([x, y, z], rpy=[…])",
        "SO3": "cs.rotation(rpy=[…])",
        "SplineInterpolator": "cs.spline(waypoints)",
        "Synchronization": 'synchronize="time", "phase" or "none"',
        "TOPPRA": "cs.time_parametrize(path, robot, start_speed=v0, end_speed=v1)",
        "URDF": "cs.load_robot(path)",
        "UrdfRobot": "cs.load_robot(path)",
        "aba": "robot.forward_dynamics(q, qd, tau, friction=False)",
        "addCollisionObject": "scene.add(shape)",
        "amcl": 'cs.localize(log, grid, filter="mcl")',
        "astar": 'cs.navigate(world, start, goal, planner="a_star")',
        "a_star": 'cs.navigate(world, start, goal, planner="a_star")',
        "attachObject": "scene.attach(name, frame, T_frame_object, touch=[…])",
        "buildModelFromMJCF": "cs.load_robot(path)",
        "buildModelFromUrdf": "cs.load_robot(path)",
        "buildReducedModel": 'cs.load_robot(path, locked={"joint": value})',
        "ccrba": "robot.centroidal_momentum_matrix(q)",
        "centerOfMass": "robot.center_of_mass(q)",
        "computeABADerivatives": "robot.forward_dynamics_derivatives(q, qd, tau)",
        "computeCartesianPath": "robot.move_linear(T, start=q)",
        "computeCoriolisMatrix": "robot.coriolis_matrix(q, qd)",
        "computeFrameJacobian": "robot.jacobian(q, frame)",
        "computeGeneralizedGravity": "robot.gravity_torques(q)",
        "computeJointJacobian": "robot.jacobian(q, frame)",
        "computeJointTorqueRegressor": "robot.regressor(q, qd, qdd)",
        "computeRNEADerivatives": "robot.inverse_dynamics_derivatives(q, qd, qdd)",
        "compute_trajectory": "cs.time_parametrize(path, robot, start_speed=v0, end_speed=v1)",
        "createData": "the robot itself; there is no data beside it",
        "crba": "robot.mass_matrix(q)",
        "ctraj": "robot.move_linear(T, start=q)",
        "dijkstra": 'cs.navigate(world, start, goal, planner="dijkstra")',
        "ekf_slam": "cs.localization.run_ekf_slam(log)",
        "evo_ape": "cs.ate(b, a)",
        "evo_rpe": "cs.rpe(b, a, delta=1)",
        "exp6": "cs.exp_se3(v)",
        "fast_slam2": "cs.localization.run_fast_slam(log)",
        "fk": "robot.fk(q) of robot = cs.load_robot(name)",
        "forwardKinematics": "robot.fk_all(q)",
        "forward_kinematics": "robot.fk(q)",
        "framesForwardKinematics": "robot.fk(q, frame)",
        "getKinematicFamily": "robot.ik_plan()",
        "global_localization": "start=None of cs.localize",
        "gmapping": "cs.slam(log)",
        "gridpoints": "grid= of cs.time_parametrize",
        "gridpt_max_err_threshold": "tolerance= of cs.time_parametrize",
        "initialpose": "start=(x, y, θ) of cs.localize",
        "intermediate_positions": "cs.time_parametrize(cs.spline(waypoints), jerk=…)",
        "inverse_kinematics": "robot.ik(T)",
        "isPathValid": "robot.edge(q_a, q_b, scene)",
        "isStateColliding": "robot.collides(q, scene)",
        "jtraj": 'robot.move_to(q1, start=q0, profile="quintic", duration=…)',
        "laser_max_beams": "cs.LaserScanner(beams=)",
        "log6": "cs.log_se3(T)",
        "map_saver": "cs.maps.EvidenceGrid.save_ros(path)",
        "map_server": "cs.maps.EvidenceGrid.from_ros(path)",
        "marginalCovariance": "answer.covariance(i) of a pose graph",
        "max_particles": "most= of cs.ParticleFilter",
        "minimum_duration": "duration= of cs.trajectory.state_to_state",
        "min_acceleration": "lowest_acceleration= of cs.trajectory.state_to_state",
        "min_particles": "n= of cs.ParticleFilter",
        "min_velocity": "lowest_velocity= of cs.trajectory.state_to_state",
        "models": "cs.load_robot(name); cs.robots.names() lists the robots",
        "mstraj": "cs.time_parametrize(cs.blend(via, deviation), robot)",
        "mtraj": 'robot.move_to(q1, start=q0, profile="trapezoidal")',
        "nv": "robot.dof",
        "plot": "cs.plot.robot(robot, q)",
        "q0": 'a configuration of yours, or robot.named_poses["home"]',
        "randomConfiguration": "robot.random_configuration(rng=7)",
        "readG2o": "cs.PoseGraph.read(path)",
        "rnea": "robot.inverse_dynamics(q, qd, qdd, friction=False)",
        "rrt": 'cs.navigate(world, start, goal, planner="rrt"), for arms cs.plan(…, planner="rrt")',
        "setFromIK": "robot.ik(T, near=q)",
        "set_joint_value_target": "cs.plan(robot, start, q, scene)",
        "set_pose_target": "cs.plan(robot, start, T, scene)",
        "slam_toolbox": "cs.slam(log)",
        "current_velocity": "start_velocity= of cs.trajectory.state_to_state",
        "target_acceleration": "goal_acceleration= of cs.trajectory.state_to_state",
        "teach": "cs.plot.robot(robot, q)",
        "trapezoidal": 'robot.move_to(q1, start=q0, profile="trapezoidal")',
    }
)
"""Functions and classes of other libraries, and what to write here."""
FOREIGN_KEYWORDS: Final = MappingProxyType(
    {
        "ik": MappingProxyType(
            dict.fromkeys(
                ("rpy", "wxyz", "xyzw", "quaternion", "quat", "euler", "xyz"),
                "use cs.pose(xyz, rpy=…) as the goal, or position= and rotation= for its parts",
            )
            | dict.fromkeys(("orientation", "R"), "use rotation= for the orientation alone, (3, 3)")
            | dict.fromkeys(
                ("T", "target", "pose", "target_pose", "matrix"), "use the pose (4, 4) first: robot.ik(T)"
            )
            | dict.fromkeys(("q_init", "initial", "guess", "q_start", "init", "initial_guess"), "use near=")
            | {"mask": "use position=, rotation= or direction= for the parts of the pose that matter"}
            | dict.fromkeys(
                ("tol", "tolerance", "eps", "max_iterations", "ilimit"),
                "use no tolerance: solutions are exact up to rounding; robot.ik_numeric has one",
            )
            | dict.fromkeys(("timeout", "time_limit"), "use no time limit: a list takes microseconds")
            | dict.fromkeys(
                ("frame", "link", "end", "ee", "tip", "end_effector"),
                "use cs.load_robot(name, tip=…), whose tip is the frame that reaches the goal",
            )
        )
    }
)
"""Keywords of functions of other libraries, by our function, and what to write here."""
FOREIGN_WORDS: Final = MappingProxyType(
    {
        "a*": "a_star",
        "amcl": "mcl",
        "astar": "a_star",
        "bfs": "wavefront",
        "d*": "d_star_lite",
        "fast_slam": "fastslam",
        "gmapping": "graph",
        "jps": "jump_point_search",
        "kalman": "ekf",
        "local": "tip",
        "particle": "mcl",
        "particle_filter": "mcl",
        "particles": "mcl",
        "pf": "mcl",
        "slam_toolbox": "graph",
        "theta*": "theta_star",
        "ucs": "dijkstra",
        "world": "base",
    }
)
"""Choices that other libraries offer under another name, and ours."""


class CspaceError(Exception):
    """The root of every error that cspace raises on purpose."""

    def __str__(self) -> str:
        """The message without the quotes that KeyError puts around it; long names and paths are shortened."""
        text = str(self.args[0]) if self.args else type(self).__name__
        return LONG.sub(lambda found: shorten(found[0]), text)


class InputError(CspaceError, ValueError):
    """A value that breaks a rule: NaN, a wrong shape, a non-rotation, limits upside down."""


class InputTypeError(CspaceError, TypeError):
    """An argument of a type that cannot be used, or a combination of arguments that makes no sense."""


class UnknownNameError(CspaceError, KeyError):
    """A name that is not in the list: robot, frame, joint, method. The message suggests the nearest."""


class TimeLimitError(CspaceError, TimeoutError):
    """A computation that took longer than its time_limit."""


class _FileError(CspaceError, ValueError):
    """A file that cannot be read; contains the file and, if known, the line."""

    def __init__(self, message: str, *, path: str | None = None, line: int | None = None) -> None:
        where = "" if path is None else shorten(path) + (": " if line is None else f":{line}: ")
        super().__init__(where + message)
        self.path = path
        self.line = line


class DescriptionError(_FileError):
    """A robot or scene description that cannot be read; contains the file and, if known, the line."""


class LogError(_FileError):
    """A log of a robot that cannot be read; contains the file and, if known, the line."""


class MapError(_FileError):
    """A map file that cannot be read; contains the file and, if known, the line."""


class MeshError(_FileError):
    """A mesh file that cannot be read; contains the file and, if known, the line."""


class RoadmapError(_FileError):
    """A roadmap file that cannot be read, or is that of another robot; contains the file."""


class MissingExtraError(CspaceError, ImportError):
    """An optional part is not installed; the message contains the command that installs it."""

    def __init__(self, extra: str, purpose: str) -> None:
        super().__init__(f"{purpose} needs an optional part; install it with: pip install 'cspace[{extra}]'")
        self.extra = extra
        self.purpose = purpose

    def __reduce__(self) -> tuple[type[MissingExtraError], tuple[str, str]]:
        """The arguments from which pickle reconstructs it, instead of the message."""
        return type(self), (self.extra, self.purpose)


def suggest(subject: str, name: object, known: Iterable[str], *, owner: str = "") -> UnknownNameError:
    """The error for an unknown name: the name, the most similar known names, and the list if it is short."""
    import difflib  # costs a millisecond, which `import cspace` does not pay

    names, asked = sorted(known), shorten(str(name), SHORT)
    found = (difflib.get_close_matches(word, names, n=3, cutoff=0.5) for word in (asked, asked.lower()))
    near = [repr(n) for n in next(filter(None, found), ())]
    spelt = {plain_letters(n): n for n in names}
    if (ours := FOREIGN_WORDS.get(asked.lower(), spelt.get(plain_letters(asked)))) in names:
        near = [repr(ours)]
    said = repr(asked) if isinstance(name, SHOWN) else f"of type {type(name).__name__}"
    text = f"no {subject} {said}" + (f" in {owner}" if owner else "")
    if near:
        text += "; did you mean " + " or ".join(filter(None, [", ".join(near[:-1]), near[-1]])) + "?"
    if not names:
        text += f"; there are no {_plural(subject)}"
    elif len(names) <= 30:
        text += ("" if near else ";") + f" {_plural(subject)}: " + ", ".join(names)
    elif near:
        text += f" {len(names)} {_plural(subject)} are known"
    else:
        text += f"; {len(names)} {_plural(subject)} are known"
    return UnknownNameError(text)


def plain_letters(name: str) -> str:
    """A name without capitals and separators, its stars in words: RRT* and rrt_star are rrtstar."""
    return re.sub(r"[\W_]", "", name.lower().replace("*", "star"))


def check_known(subject: str, name: object, known: Iterable[str]) -> None:
    """The error of suggest, raised for a value that is none of the known names."""
    if not (isinstance(name, str) and name in known):
        raise suggest(subject, name, known)


def check_kind(subject: str, value: object, kind: type | tuple[type, ...], remedy: str) -> None:
    """InputTypeError for a value that is of none of some classes, with what to give instead."""
    if not isinstance(value, kind):
        raise InputTypeError(f"{subject} is {name_type(value)}; {remedy}")


def keyword_error(text: str) -> TypeError:
    """The error for "f() got an unexpected keyword argument 'name'", with the new name of an old keyword."""
    name = text.rpartition(" keyword argument ")[2].partition("'")[2].partition("'")[0]
    function = text.partition("(")[0].rpartition(".")[2]
    words = FOREIGN_KEYWORDS.get("ik" if function == "solve" else function)
    if words and (remedy := words.get(name)):
        return InputTypeError(f"unknown keyword {name!r}: {remedy}")
    if name not in RENAMED:
        return TypeError(text)
    return InputTypeError(f"unknown keyword {name!r}: use {RENAMED[name]}=")


def name_new_keywords(function: Callable[Given, Answer]) -> Callable[Given, Answer]:
    """The function, whose error for an old or foreign keyword contains ours; see keyword_error."""

    @wraps(function)
    def call(*args: Given.args, **keywords: Given.kwargs) -> Answer:
        try:
            return function(*args, **keywords)
        except TypeError as error:
            if type(error) is not TypeError or not keywords.keys() & RENAMED.keys():
                raise
            raise keyword_error(str(error)) from None

    return call


def attribute_error(owner: object, name: str) -> AttributeError:
    """The error for an unknown attribute, with the new name of an old attribute.

    The `_elsewhere` of the class names attributes of other classes, with what to do instead; one with
    `_knows_foreign_names` answers to the functions of other libraries.
    """
    text = f"{type(owner).__name__!r} object has no attribute {name!r}"
    own = owner.__dict__ if type(owner).__dictoffset__ else ()
    known = {*dir(type(owner)), *getattr(type(owner), "__annotations__", ()), *own}
    if (ours := RENAMED.get(name)) in known:
        text += f": use {ours}"
    elif hint := getattr(type(owner), "_elsewhere", {}).get(name):
        text += f"; {hint}"
    elif getattr(type(owner), "_knows_foreign_names", False) and (call := FOREIGN_NAMES.get(name)):
        text += f": use {call}"
    return AttributeError(text, name=name, obj=owner)


def module_error(module: ModuleType, name: str) -> AttributeError:
    """The error for an unknown name of a module, with the new name of an old one."""
    text = f"module {module.__name__!r} has no attribute {name!r}"
    if (ours := RENAMED.get(name)) in module.__dict__:
        text += f": use {ours}"
    elif call := FOREIGN_NAMES.get(name):
        text += f": use {call}"
    return AttributeError(text, name=name, obj=module)


class Renamed:
    """A class whose error for an unknown attribute contains the new name of an old one."""

    __slots__ = ()

    if not TYPE_CHECKING:  # type checkers report such names themselves

        def __getattr__(self, name: str) -> object:
            raise attribute_error(self, name)


def name_type(value: object) -> str:
    """The type of a value with its article: a str, an int, an ndarray."""
    name = type(value).__name__
    return f"{'an' if re.match('[aeioAEIO]|nd', name) else 'a'} {name}"


def shown(value: object) -> str:
    """A value for a message: texts and numbers as they are, and the type of anything else."""
    text = repr(value) if isinstance(value, SHOWN) else f"an object of type {type(value).__name__}"
    return shorten(text, SHORT)


def shorten(text: str, most: int = LONGEST) -> str:
    """A text shortened in the middle to fit into a message."""
    return text if len(text) <= most else text[: most - most // 2] + "…" + text[1 - most // 2 :]


def _plural(noun: str) -> str:
    if " or " in noun:
        return " and ".join(map(_plural, noun.split(" or ")))
    if noun.endswith("is"):
        return noun[:-2] + "es"
    if noun.endswith("y") and noun[-2:-1] not in "aeiou":
        return noun[:-1] + "ies"
    return noun + ("es" if noun.endswith(("s", "x", "ch", "sh")) else "s")
