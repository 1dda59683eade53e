"""Every threshold of the library: its name, its unit and the reason for its value."""

from __future__ import annotations

from typing import Final

ROTATION_ERROR: Final = 1e-6
"""Largest ‖RᵀR − I‖ (max norm, unitless) accepted as a rotation: a matrix typed with seven digits passes, a
shear or a scaled matrix does not."""

TYPED_ROTATION: Final = 2e-5
"""Largest ‖RᵀR − I‖ of a matrix on the command line that stands for the nearest rotation: three products of
entries rounded to five decimals (cspace fk prints six)."""

ROTATION_PROJECTION: Final = 0.1
"""Largest ‖RᵀR − I‖ that projection to the nearest rotation accepts: beyond it the input is not a rotation
but another matrix, and the nearest rotation would be an invention."""

AXIS_LENGTH: Final = 1e-6
"""Shortest vector accepted as a joint axis (unitless, or m where a DH or CAD tool exports lengths): below it
the direction is made of rounding noise, and the file most likely meant zero."""

INERTIA_SYMMETRY: Final = 1e-6
"""Largest difference of opposite inertia entries, relative to the largest entry (at least 1 kg·m²): tables
are printed with six digits; more is a typing error."""

RIGHT_ANGLE: Final = 1e-5
"""[rad] How far files round right angles: 1.5708, 3.14159 and 3.1416 are off by 3.7e-6, 2.7e-6 and 7.3e-6."""

LARGEST_RIGHT_ANGLE: Final = 0.01
"""[rad] Largest rounding of right angles that can be asked for: 1.57 and 3.14 are off by 8e-4 and 1.6e-3, and
nobody prints fewer digits; beyond are angles that are meant."""

ROUNDED_AXES: Final = 1e-9
"""Deviation of axes from a closed form (rad, or lengths of the arm) above which a robot says that its file
may round right angles: files with ten digits stay below it."""

INERTIA_ROUNDING: Final = 1e-5
"""Share of the largest moment of inertia by which the others may fall short of the laws of rigid bodies:
tables are printed with five or six digits, and the tensor of a flat plate lies on the border."""

LEAST_GYRATION: Final = 1e-6
"""Radius of gyration [m] up to which a body is a point: what rounding leaves of an absent tensor."""

MASSLESS_MOTION: Final = 1e-8
"""Root of the kinetic energy of a unit motion, relative to the largest one, up to which it is none: its
square is the rounding of the mass matrix."""

SINGULAR_INERTIA: Final = 1e-13
"""Inertia left to a motion that closed loops allow, relative to its own, that is none: what the others take
away leaves rounding of 1e-16."""

WHOLE_STEP: Final = 1e-9
"""Part of a step by which a duration may exceed a whole number of steps: rounding of their quotient, also of
millions of them."""

LAST_ROW_ERROR: Final = 1e-9
"""Largest deviation of the last row of a homogeneous matrix from [0 … 0 1] (unitless): products and inverses
leave rounding there, a transposed or projective matrix leaves far more."""

GIMBAL_LOCK: Final = 1e-14
"""Sine (or cosine) of the middle angle of a sequence, unitless, below which the outer two axes count as one
line: the rounding of a few products of rotations stays below it, and since the angle set to zero there moves
the rotation by at most this much, the angles still reproduce it."""

PURE_TRANSLATION_ANGLE: Final = 1e-13
"""Rotation angle [rad] up to which a displacement counts as a pure translation when its pole or screw axis is
asked for: such an angle is the rounding of the matrix, and the axis would lie 1e13 translations away."""

WHOLE_TURN: Final = 2.0**-52
"""Largest |sin(θ/2)/(θ/2)|, unitless, that counts as a multiple θ = 2π, 4π, …, where the Jacobian of the
exponential has no inverse: the rounding of θ alone gives as much."""

MEAN_UNIQUENESS: Final = 1e-12
"""Smallest gap of the two largest eigenvalues, relative to the largest, of a mean of rotations that is
unique: below it rounding picks the mean."""

DESCRIPTION_BYTES: Final = 64 * 2**20
"""Largest robot file that is read (bytes): a hundred times the largest humanoid."""

DESCRIPTION_DEPTH: Final = 500
"""Deepest nesting of elements in a robot file: URDF needs five levels; in MJCF each link stands inside the
one before, as deep as the XML reader of MuJoCo goes."""

MJCF_SAME_AXIS: Final = 1e-10
"""Sine of the angle to the z axis below which `zaxis` of MJCF leaves z in place, or turns it over: MuJoCo's
own bound, so that both read the same frame."""

UNLIMITED: Final = 1e300
"""The number that means infinity if a file format needs a finite one (rad, m, or their rates): beyond any
machine, and read back as infinity."""

CALIBRATION_ANGLE: Final = 0.05
"""Angle [rad] between a joint axis as calibrated and as published, at zero, beyond which a calibration is
that of another arm: measured arms stay within 0.01."""

CALIBRATION_DISTANCE: Final = 0.015
"""Distance [m] of the two, likewise: measured arms stay within a few millimetres, and the models most alike
(UR3 and UR3e) differ by 0.0187."""

CALIBRATION_BYTES: Final = 2**20
"""Largest calibration file that is read (bytes): a real one has one thousand."""

DH_PARALLEL: Final = 2.0**-26
"""Angle [rad] up to which consecutive axes get the parallel row of a Denavit–Hartenberg table: the square
root of the rounding, where calling them parallel costs as much as their true normal far away."""

DH_COINCIDENT: Final = 1e-13
"""Distance [m] up to which axes intersect, or lie on one line, in a Denavit–Hartenberg table: ten rows of
such a loss still keep a pose to 1e-12."""

TOML_BYTES: Final = 4 * 2**20
"""Largest TOML robot file that is read (bytes): the reader of the standard library takes a second for it."""

SINGULAR_VALUE: Final = 1e-9
"""Smallest singular value of a Jacobian (m or rad, per rad or m) that is not zero: angles known to 1e-9 rad
cannot be told from singular ones below it, and rounding is far below."""

NEARLY_SINGULAR: Final = 1e-2
"""Singular value of a Jacobian (as SINGULAR_VALUE) below which the command line shows it unasked: joints move
a hundred times as fast as the tip."""

LARGE_RESIDUAL: Final = 1e-9
"""Residual [m, rad] from which the command line shows it unasked: closed forms leave a millionth of it."""

SINGULAR_ROUNDING: Final = 1e-14
"""Singular value of a Jacobian (as SINGULAR_VALUE) below which all are rounding errors."""

LARGEST_NUMBER: Final = 1e12
"""Largest length, mass, inertia or ratio of a robot (SI units): products of a few stay far from overflow, and
the longest link of a Denavit–Hartenberg table of nearly parallel axes fits."""

SLIGHT_MISS: Final = 1e-4
"""Miss of a goal (m, rad) up to which the rounded numbers of a robot's file may be all that is wrong: files
print lengths and angles with four digits or more."""

FAR_GOAL: Final = 100.0
"""Factor by which a goal is farther away than the nearest pose of the tip from which on its unit is doubted:
millimetres are a thousand times too far."""

PLANAR_AXES: Final = 1e-9
"""Sine of the angle between axes, and length of a link relative to all, up to which an arm counts as planar
with that link missing: its tip then leaves the plane by less than anybody measures."""

SAME_PLACE: Final = 1e-10
"""Angle [rad], and distance relative to the reach of an arm, below which two ends of arcs on the boundary of
a workspace are one: a few trigonometric functions cost 1e-15 each."""

TANGENT_PLACE: Final = 1e-6
"""Angle [rad] up to which a piece of the boundary of a workspace is nothing; pieces meet within a hundred
of it times the reach. Circles that touch cross at places known to the square root of the rounding, 1e-8,
and lie within SAME_PLACE of each other for the square root of that, 1e-5."""

MOST_WINDINGS: Final = 100_000
"""Most copies of the solutions of one goal by multiples of 2π: limits of ±2π on six joints give 512. A longer
list would not be useful."""

ON_LIMIT: Final = 1e-9
"""How far beyond a limit (rad, m) a joint still counts as on it: solutions carry a rounding of about 1e-15,
the solvers lose up to 1e-10 on ill-conditioned arms, and no encoder resolves 1e-8."""

DOUBLE_SOLUTION: Final = 3e-7
"""How far beyond a limit (rad, m) a double solution may lie whose true place is on the limit: up to this
distance the core takes two solutions for one, known to the square root of the rounding."""

SAME_TIP: Final = 1e-12
"""Difference of two tip poses (m relative to the reach, rad) below which two configurations reach one goal:
what the core accepts as an exact solution."""

FARTHEST: Final = 1e100
"""Largest number in a configuration, a goal, a seed or a geometric subproblem, and largest sum of a goal's
coordinates (m, rad): their squares still fit a double."""

NUMERIC_TOLERANCE: Final = 1e-9
"""Error of a descent (m of the position, rad of the rotation) that counts as reached unless given: far above
the rounding at which descents end, far below the accuracy of any robot."""

TASK_DONE: Final = 1e-6
"""Error of a task (m, rad) up to which it counts as done unless given: what the small weight of a posture
beside it may cost."""

SETTLED: Final = 1e-10
"""Step (rad, m) that ends the search for the least error of several tasks: its square, which is what
the step can still gain, is rounding."""

WEAK_DIRECTION: Final = 0.01
"""Singular value of a Jacobian (m or rad, per rad or m) below which a direction counts as weak in resolved
rate: a joint would turn a hundred times faster than the frame, which no drive follows."""

DEGREE_LIMITS: Final = (25.0, 720.0)
"""Limits of revolute joints in URDF [rad], above the first and up to the second, that were probably meant in
degrees: four turns are more than an arm's cables bear, and two turns of 360 degrees the most they do."""

DEGREE_ANGLES: Final = (6.5, 720.0)
"""Angles of a rotation [rad], above the first and up to the second, that were probably meant in degrees: an
angle is typed within one turn, 6.283."""

XACRO_SECONDS: Final = 60.0
"""Longest expansion of a xacro file [s]: the largest robots take two."""

XACRO_ELEMENTS: Final = 50_000
"""Most steps and elements of the expansion of a xacro file: the largest robots take ten thousand."""

XACRO_COPIES: Final = 1_000_000
"""Most elements that the macros and blocks of a xacro file copy, all together: each step copies some tens."""

XACRO_BITS: Final = 4096
"""Most bits of a whole number in an expression of xacro: no double has more than 1024 before the point."""

XACRO_ITEMS: Final = 1_000_000
"""Most characters and items that an expression of xacro repeats, pads with or walks over, all together."""

TOML_KEY_PARTS: Final = 100
"""Most parts of a dotted key of TOML: a robot's have two, and the reader's time grows with their square."""

GEOJSON_DEPTH: Final = 100
"""Most levels of collections and features of GeoJSON: files have three, Python allows a thousand."""

HALF_TURN: Final = 1e-12
"""1 + trace R (unitless, the square of the angle that is missing) below which neighbouring poses of a path
are half a turn apart: the axis of such a turn carries the rounding of the poses, a million times larger."""

TRACK_START: Final = 1e-3
"""Distance (rad, m) of a joint in start= from the solution that a branch begins at, above which the answer
says so: configurations that are rounded to three digits are meant to be on the path."""

TRACK_BEYOND: Final = 1e-3
"""Share of the way between two poses, beyond the place where a branch ends, at which it is asked whether
anything reaches the path there: before it the certificate of a solver may be missing, near a fold."""

MAP_CELLS: Final = 1 << 30
"""Most cells of an occupancy grid: their numbers, border and all, fit into 32 bits."""

MAP_BYTES: Final = 1 << 31
"""Most bytes of a map file: two for each cell of the largest grid."""

PNG_PIXELS: Final = 1 << 27
"""Most pixels of a PNG image that is decompressed, for a file of a hundred kilobytes may hold them all: maps
of 11,000 × 11,000 pixels pass, in a few seconds and two gigabytes."""

MESHED_CORNERS: Final = 50_000
"""Most corners of a grid for which the any-angle search prepares polygons whatever the size: it takes a tenth
of a second and some 440 bytes each, and makes the search two to six times faster. Grids of more are mostly
noise, over which runs of cells are as fast."""

CELLS_PER_CORNER: Final = 1000
"""Cells of a large grid for each corner from which on its polygons fit into half a byte per cell."""

RUN_CELLS: Final = 1 << 28
"""Most cells of a grid that is searched over runs: its corners are numbered in rows as long as the next power
of two, which fits into 31 bits then."""

MOST_MARKS: Final = 10_000_000
"""Most times at equal distances along a log: an hour at 3 kHz."""

WIDEST_BELL: Final = 100
"""Largest standard deviation of the bell of a point that scans are matched with, in cells; the core has the
same number. Its stamps take 16 MB."""

WIDEST_SIGMA: Final = 200
"""Largest standard deviation of a likelihood field, in cells: its table by squared distance then has half a
million entries, and bytes no longer tell the distances of neighbouring cells apart."""

FARTHEST_CELL: Final = 1e12
"""Farthest cell from zero, in cells: there float64 still resolves a ten thousandth of a cell."""
ON_WALL: Final = 1e-12
"""How deep inside an obstacle a start or a goal may lie, in sides of the world, and still count as on its
wall: the point of a slanted wall that someone computes is off by a few roundings."""

FARTHEST_POINT: Final = 1e15
"""Largest coordinate [m] of a world: beyond it products of three coordinates and their rests leave the
range in which exact decisions are exact, and neighbouring numbers are decimetres apart."""

FINEST_CELL: Final = 1e-30
"""Smallest side of a cell [m]: products of four lengths stay in the range of float64."""

LEAST_REACH: Final = 1e-60
"""Least reach of walls in a potential [m], and the inverse of the largest: its fourth power stays in the
range of float64."""

HARMONIC_RESIDUAL: Final = 1e-11
"""By what share of itself a cell of a harmonic field may differ from the mean of the four beside it:
roundings make 1e-15, and even in the middle of a thousand free cells neighbours differ by 1e-6 of
themselves."""
HARMONIC_CYCLES: Final = 400
"""Most cycles of the solver: corridors of thousands of cells take a hundred."""
NAVIGATION_SQUARES: Final = 400_000
"""Most squares of a proof that a navigation function has one minimum: twenty discs take some tens of
thousands, and so many a third of a second."""
NAVIGATION_STEPS: Final = 20_000
"""Most steps of a descent of a navigation function: along walls, where it is stiff, some thousands are
taken."""
DESCENT_LOOKS: Final = 40_000
"""Most looks at a potential on the way down: descents that arrive take some hundreds, and so many take five
milliseconds."""
SAMPLE_STEP: Final = 0.1
"""Longest edge of a tree of samples, in sides of the world: about the ball of RRT* at a thousand nodes, and
short enough that the first edges pass between obstacles."""
SCAN_NOISE: Final = 0.2
"""The most noise of a reading, of a sensor's range: with more, the distance that a robot keeps from walls to
be sure to see them comes near to none."""

DIAGRAM_CHORD: Final = 1e-4
"""How far a polyline may lie from a parabola of a Voronoi diagram, in sides of the world: less than the width
of a line in a picture of it."""

QUADTREE_DEPTH: Final = 12
"""The level down to which mixed squares are split: upright gaps of a two-thousandth of the world's side are
found, and what stays open is soon given up."""
UNIFORM_DEPTH: Final = 9
"""The same for squares of one size, of which there are 4ᵏ: a quarter of a million."""
QUADTREE_CELLS: Final = 4_000_000
"""Most squares of a tree, some hundreds of megabytes; the answer stays open beyond."""

MOST_DERIVED: Final = 8
"""Most worlds grown by a radius or converted that are kept with a world: making one takes milliseconds."""

FINE_SIDES: Final = 1024
"""Sides of the polygons around corners where 32 sides have closed the path of a disc or stopped its descent:
they exceed the disc by 5e-6 of the radius."""

CHORD_OF_CLEARANCE: Final = 0.01
"""Share of the clearance by which a polyline on a Voronoi diagram may be nearer to walls than its curves."""

TINY_DISC: Final = 1e-6
"""Radius of a disc, in sides of the world, below which the sides of the polygons around corners are too short
for a Voronoi diagram: the disc follows that of the world that is not grown."""

DISC_FITS: Final = 1e-9
"""Share of a radius by which the clearance of a path must exceed it to show that a disc fits: clearances
carry some roundings of the coordinates."""

MOST_SAMPLES: Final = 10**8
"""Most samples, and nearest neighbours, of a planner: their nodes fit into 32 bits, and a tree of so many
takes some gigabytes."""

FINEST_LEVEL: Final = 20
"""Deepest level of a quadtree: the core numbers a million squares along a side."""

HARMONIC_FIELDS: Final = 2
"""Most harmonic fields that are kept with a grid: each takes about fifty bytes per cell."""

NAVIGATION_FUNCTIONS: Final = 8
"""Most navigation functions that are kept with a world: a proof takes up to a third of a second."""

ON_GOAL_WALL: Final = 1e-9
"""Clearance of a goal, in sides of the world, up to which it counts as on a wall, where a navigation function
is 1: nearer, the function is too steep for a proof."""

LEAST_INFLUENCE: Final = 1e-9
"""Least reach of walls in the potential of A*, in cells, in place of zero: its inverse stays finite, and no
cell is so near to a wall."""

CELL_ROUNDING: Final = 1e-9
"""By how much of a cell a length may miss a multiple of the cell side and still count as one: 3 × 0.1 differs
from 0.3 by rounding."""

SIMULATION_STEPS: Final = 1e7
"""Most steps of a run of a vehicle: a row of seven numbers each."""

CAR_POSES: Final = 20.0
"""Poses of a path of a car in each turning radius: a chord leaves its arc by 3e-4 of the radius."""

TRACK_POSES: Final = 50.0
"""The same of a curve that a vehicle follows: a chord leaves its arc by 5e-5 of the radius."""

MOST_SIDES: Final = 1 << 20
"""Most sides of a polygon in place of a disc: its sides are then as far apart as the directions of walls are
told apart, and it exceeds the disc by 5e-12 of the radius."""

TIGHT_GAP: Final = 1e-9
"""By how much of its width a gap may be narrower than a disc and still count as one that the disc just
passes: coordinates carry a few roundings."""

OFFSET_SLACK: Final = 1e-10
"""Distance, in sides of the world, by which a point of an offset boundary may be nearer to walls than the
radius, and gaps between its pieces: a hundred times ON_WALL, as pieces end where circles meet."""

OFFSET_PIECE: Final = 1e-12
"""Length of a piece of an offset boundary, of its wall or arc, below which it is rounding."""

ON_ONE_LINE: Final = 1e-15
"""Distance of corners from a line, in diameters of a polygon, up to which it has no area: a few roundings."""

DEFAULT_CELLS: Final = 200
"""Cells along the longer side of the bounds unless given: gaps of a two-hundredth of the world count as
narrow."""

BRANCH_OFFSET: Final = 1e-6
"""Part of its own length up to which an elbow or a prismatic joint counts as being on the line: rounding
moves it by the root of 1e-15 there."""

BRANCH_LENGTH: Final = 1e-9
"""Length of a line from shoulder to wrist [m] below which it has no direction: rounding of the two points."""

NO_DERIVATIVE: Final = 1e-10
"""Ratio of the Jacobian's singular values (lengths over the arm's) below which a solution has no derivative:
rounding leaves 1e-16, and the derivative's own digits are lost long before."""

PRINTED_FACTOR: Final = 1e-5
"""Factor of a formula (a length: over that of the arm or of a usual link) below which its term is not
printed: rounded right angles."""

PRINTED_ROUNDING: Final = 1e-8
"""Factor of a formula, over the largest, below which its term is a rounding and never printed: right angles
are given with nine digits or more."""

PRINTED_MISS: Final = 1e-12
"""Distance or angle [m, rad] by which axes miss a relation, below which it is not printed: rounding."""

PRINTED_ZERO: Final = 1e-9
"""Number of a printed table below which it is 0: the cosine of a right angle."""

SQUARE_WRIST: Final = 1e-4
"""Cosine of the twist of a wrist up to which it counts as square: its folds then have a closed form."""

DOUBLE_DIRECTION: Final = 1e-5
"""Singular value, relative to the largest, of a direction that is left alone where a configuration is moved
onto a limit: that of the double solution itself."""

SAME_SWIVEL: Final = 1e-9
"""Distance of arm angles [rad] up to which they are one: rounding of the conditions that they solve."""

INSIDE_END: Final = 1e-6
"""How far inside an interval of arm angles its end is looked at [rad]: there the joint that stops is nearest
its limit."""

MOVING_JOINT: Final = 1e-6
"""Smallest entry of the unit direction of a self-motion [rad or m] that is motion: files round axes."""

RESTING_JOINT: Final = 1e-9
"""Change [rad or m] of a joint that rests along a self-motion: rounding of the steps back onto the curve."""

SAME_MEMBER: Final = 1e-6
"""Distance [rad, m] from a seed within which a configuration of a self-motion is the seed."""

ORIENTATION_KEPT: Final = 1e-3
"""Largest angle [rad] at which the search for the distance of a goal counts the orientation as kept, if the
distance [m] is more."""

INTEGER_ROUNDING: Final = 1e-13
"""Distance from an integer up to which the factor of a formula is that integer: cosines of right angles."""

SYMBOL_PARALLEL: Final = 1e-12
"""Sine of the angle between axes up to which formulas write the sum of their angles: rounding."""

FORM_DEVIATION: Final = 1e-13
"""Difference of a closed form from the true arm (over the arm's length, rad) that an explanation mentions:
less is rounding."""

UPRIGHT_TURN: Final = 1e-12
"""Largest 1 − |cosine| of the angle of a revolute axis to z in an arm of the xy plane: its tip leaves the
plane by a millionth of the reach."""

LEVEL_SLIDE: Final = 1e-6
"""Largest |cosine| of the angle of a prismatic axis to z in an arm of the xy plane: as UPRIGHT_TURN."""

UPRIGHT_TIP: Final = 1e-9
"""Distance of the tip at zero from the plane of the first two axes, over its distance from the base, up to
which the arm stands upright: the rounding of a file."""

LEAST_SLIDE: Final = 1e-3
"""Least range of the starts of a prismatic joint without limits [m], where the goal is at the base."""

REACH_ROUNDING: Final = 1e-9
"""Share by which the sum of the links may fall short of the farthest tip: roundings of its terms."""

POSSIBLE_MOTION: Final = 1e-9
"""Share of the largest singular value of a Jacobian up to which a direction counts as impossible."""

SELF_CHECK: Final = 1e-9
"""Largest |fk(ik(T)) − T| [m, unitless] that passes the self-check: far above rounding, far below any use."""

SAME_MINIMUM: Final = 1e-3
"""Distance of minima of a drawn field, in sides of the world, up to which they are one: descents end no
nearer."""

PARALLEL_RAYS: Final = 1e-9
"""Share of a ray's way by which it may change over a picture while all its rays count as parallel."""

DRAWN_LENGTH: Final = 1e-9
"""Length [m] of a link from which on it is drawn: shorter ones are points."""

DRAWN_PLANE: Final = 1e-6
"""Sine of the angle by which the axes of an arm that is drawn in a plane may miss it: files round axes."""

DRAWN_MOTION: Final = 1e-12
"""The largest velocity, torque or force of a simulation that a picture leaves out [SI units]: rounding around
zero of values of size one is smaller by four orders."""

DRAWN_SHARE: Final = 1e-9
"""Share of the largest torque below which a cause of torques is not drawn: differences of two torques have a
rounding of that order where they cancel."""

LEAST_DIVISOR: Final = 1e-12
"""Least divisor of a picture, in place of zero: lengths and shares of what is drawn are far above it."""

ROUNDED_UNIT: Final = 2.0**-51
"""Difference of the length of a vector from one (unitless) that is the rounding of its division by its
length."""

HULL_FLAT: Final = 1e-9
"""Share of the extent of points up to which they lie in a plane or a line, and triangles of their hull in a
common plane: coordinates of CAD files carry about 1e-7, but a plate of a micrometre is still a solid."""

HULL_DETERMINANT: Final = 2.0**-49
"""Rounding of a determinant of three differences, relative to the sum of the absolute products in it: twelve
operations lose less than sixteen times 2^-53."""

MESH_BYTES: Final = 256 * 2**20
"""Largest mesh file that is read (bytes): five million triangles, a hundred times a detailed robot link."""

DEFICIT_ACCURACY: Final = 2e-4
"""How far the bounds of what spheres leave outside may be apart [m]: robots are built less accurately."""

MEASURE_TOLERANCE: Final = 1.0 / 2000.0
"""Share of the diagonal of a mesh by which the bounds of a measured cover may be apart: 0.1 mm of a link of
20 cm, below the tolerance of its casting."""

IN_PLANE: Final = 1e-9
"""Distance [m] from the plane of an arm, relative to the size of a shape (at least 1 m), up to which a corner
lies in it, and sine up to which an axis is normal to it or lies in it: coordinates computed with rotations
are off by some 1e-16."""

SAME_CORNER: Final = 1e-13
"""Distance between corners of a section, and of a corner from the line between its neighbours, relative to
the size of the section, up to which a corner is none: where a plane cuts edges is off by some 1e-16."""

BEYOND_MARGIN: Final = 1e-4
"""Clearance [m] beyond the margin at which an escape from a collision aims: its steps end on the far side."""

FLAT_CLEARANCE: Final = 1e-9
"""Gradient of a clearance [m/rad or 1] at which no direction leads out of a collision."""

IN_REGION: Final = 1e-9
"""How far outside a region of poses (m, rad) a pose still counts as inside: solutions of inverse kinematics
reach their pose up to about 1e-12 on arms of some metres, and a region may be a single pose."""

SMALL_TURN: Final = 1e-3
"""Angle (rad) below which a − sin a counts as a³ / 6: the share that is left out, a² / 20, is below 1e-7, and
the difference would lose its digits."""

POINT_RADIUS: Final = 1e-6
"""Radius [m] of the points of a cloud without one, where a check takes spheres: below the rounding of floats
that other checks carry."""

FLAT_SHARE: Final = 1e-3
"""The thickness of flat solids in their cover, as a share of the longest side: much less than COVER_SHARE."""

LEAST_COVERED: Final = 1e-9
"""The least side of a solid in its cover [m]: far below the distance that checks keep."""

LEAST_MOTION: Final = 1e-6
"""The least range [rad or m]: trees keep configurations as floats of 32 bits, which resolve no less within a
turn."""

LEAST_SPACING: Final = 1e-4
"""The least distance of samples [rad or m]: a motion through the whole space takes ten milliseconds."""

LEAST_GAIN: Final = 1e-12
"""The least gain, distance of influence, step and side of a cell of planners: products of a few stay far from
the smallest double."""

DEPENDENT_COLUMN: Final = 1e-5
"""Length of what others leave of a column of a regressor of length one up to which it depends on them: angles
of files with six digits leave 5e-6, a column of its own a hundredth and more."""

LEAST_EXCITATION: Final = 1e-6
"""Singular value of the equations of an identification, relative to the largest, up to which the data leave a
direction undetermined: torques measured to six digits leave nothing of it."""

UNDETERMINED: Final = 1e-6
"""Share of a parameter in an undetermined direction of length one up to which it is determined all the same:
above the rounding of singular vectors, below every real share."""

CONVERGED_FIT: Final = 1e-12
"""Relative decrease of a sum of squares, and step relative to its scale, after which a fit of parameters
ends: some thousand roundings."""

LOST_MOTION: Final = 1e-12
"""How much a unit wrench moves a frame, relative to that of the best one, that is nothing: rounding leaves
1e-16, and of the root, as a singular value, 1e-6 is nearly singular."""

LOOP_CLOSED: Final = 1e-12
"""Size of the residual of closed loops, relative to the mechanism, up to which they are closed: a hundred
products of poses leave 1e-14."""

LOOP_OPEN: Final = 1e-6
"""Size of this residual above which forces are not computed: configurations typed with seven digits pass, and
a pin that far off is an error."""

LOOP_RANK: Final = 1e-9
"""Singular value of the Jacobian of closed loops, relative to the largest, up to which a row follows from the
others: closed loops leave 1e-12, and nearer to a singular configuration the forces are meaningless."""

LOOP_RANK_SLACK: Final = 100.0
"""How much the rows of open loops differ from dependent ones, relative to their residual."""

LOOP_SINGULAR: Final = 1e-6
"""Singular value of the columns that follow the driven ones, relative to the largest of the Jacobian, up to
which they are stuck: at a dead point they are known to the square root of the rounding."""

LOOP_MOTION: Final = 1e-6
"""Share of a velocity or acceleration by which it may tear loops apart: those typed with seven digits
pass."""

ALIKE_ROWS: Final = 1e-6
"""Relative difference of lengths below which the first of two rows is taken as independent: rounding does not
choose the names of dependent rows."""

SAME_MODE: Final = 1e-6
"""Largest difference of joints [rad, or m relative to the mechanism] of two configurations that are one
assembly mode: at a double one they are known to 1e-8."""

SHORTEST_PART: Final = 1e-9
"""Shortest part of a step along the motion of a mechanism: there joints move a million times as fast as the
driven ones, which is the neighbourhood of a dead point."""

SAME_WAYPOINT: Final = 1e-9
"""Distance of neighbouring waypoints, relative to the length of the path, up to which they are one: a spline
through points so close turns on the spot."""

FARTHEST_WAYPOINT: Final = 1e15
"""Largest number of a waypoint, of a control point and of the parameter of a path [rad or m]: beyond it
neighbouring numbers are 0.1 rad apart, and fifth powers leave the range of float64."""

SHORTEST_PIECE: Final = 1e-30
"""Least length of a piece of a path [rad or m]: fifth powers of its inverse stay in the range of float64."""

LEAST_LIMIT: Final = 1e-25
"""Least limit above zero of velocity, acceleration, jerk or torque with which a path is timed [SI]: speeds
and durations stay in the range in which barriers of the timing converge."""

LARGEST_DERIVATIVE: Final = 1e300
"""Of a motion, by the sum of the magnitudes of all its terms: sums of such numbers fit a double."""

SHORTEST_BLEND: Final = 1e-12
"""Reach of a blend, relative to the numbers of its path, below which the path stops at the corner: the
control points of the blend would be one point to rounding."""

PATH_CORNER: Final = 1e-9
"""Jump of a derivative of a path, relative to its size, up to which it is continuous: neighbouring pieces are
rounded differently."""

STRAIGHT_TURN: Final = 1e-10
"""Turn of a path at a waypoint [rad] up to which its legs are one line."""

REVERSED_TURN: Final = 0.02
"""Turn short of 180° [rad] from which on a path stops at a waypoint: a blend so sharp turns on the spot."""

STANDING_SPEED: Final = 1e-12
"""Squared speed along a path, relative to the largest, below which the tangent of its root is not taken: it
is vertical at zero."""

STILL_JOINT: Final = 1e-12
"""Slope of a joint along a path, relative to the largest one, up to which it does not move: a thousand
roundings."""

SHORTENED_PARTS: Final = (0.0, 1e-4, 1e-2, 0.1, 0.3, 0.6)
"""Shares by which the followed part of a Cartesian path is shortened until a motion ends there: near a
singular configuration joints move without bound on the last of it, and a chain may end before a search."""

SHORTENED_WITHIN: Final = 2e-4
"""Share of a Cartesian path within which the end of its followed part is found."""

LAUNCH_PART: Final = 1e-6
"""Length of the launch of a motion from rest, relative to its path: it takes a hundredth of the time."""

BARRIER_GAP: Final = 1e-4
"""Of the duration of a motion under jerk limits, relative, to that of the best one on its grid."""

TIMED_WITHIN: Final = 1e-3
"""Change of the duration of a motion along a path, relative, up to which its intervals are halved."""

FEED_HELD: Final = 1e-3
"""Part of a feed by which a motion may be slower where no limit slows it: else intervals are divided."""

FEED_LOST: Final = 1e-5
"""Part of the duration that an interval below its feed may lose: what the barrier method leaves is less."""

CURVE_FITTED: Final = 1e-6
"""Distance [rad or m] of a fitted path from a curve, by default: controllers resolve no less."""

TIME_ROUNDING: Final = 1e-12
"""Part of the duration of a trajectory by which a time may lie outside of it: sums of a million steps."""

CONTINUITY_ROUNDING: Final = 1e-9
"""Jump of a derivative, relative to its largest value, up to which it is continuous: polynomials evaluated
from both ends of a piece differ by their rounding, a thousandth of this."""

LIMIT_ROUNDING: Final = 1e-9
"""Part of a limit (of positions at least of 1 rad or m) by which a motion may exceed it: the rounding of the
sums of its pieces, which controllers do not notice."""

LIMIT_BINDS: Final = 1e-6
"""Part of a limit, as above, within which a motion is at it."""

ROOT_CONVERGED: Final = 4e-16
"""Last step towards the root of a polynomial, relative to its interval: two units in the last place."""

CHAIN_AT_LIMIT: Final = 1e-3
"""What is left of 1 − x² at a limit."""

CHAIN_LEAST_VOLUME: Final = 1e-6
"""Of the best determinant: nearer to singularities all are equally bad."""

CHAIN_TURN_WEIGHT: Final = 1e-3
"""Of a free turn against the joints in the motion of a chain: a joint that only turns the tip about its free
axis rests, and the turn costs nothing else."""

CHAIN_RELAXED: Final = 3e-3
"""[rad or m] Largest step of a joint at which a chain counts as one of least motion: its poses are corrected
afterwards."""

CHAIN_CORRECTION: Final = 1e-4
"""Singular value below which a chain is not corrected towards its poses: the joints would have to jump."""

CHAIN_HELD: Final = 1e-6
"""Damping of a chain, as a share of its stiffness: the goal leaves a joint that turns the tip about its free
axis undetermined."""

POSE_ROUNDING: Final = 1e-13
"""[m or rad] Of a pose that is reached."""

PATH_START: Final = 1e-6
"""[m or rad] Of a start from the begin of a path: solutions of inverse kinematics are closer."""

LEAST_TOLERANCE: Final = 1e-10
"""[m and rad] Of a joint path: corrected poses of an arm of ten metres are as exact as that."""

SHORTEST_PATH_PIECE: Final = 1e-6
"""[m or rad] A piece that is off and this short ends its branch: the joints would have to jump."""

PATH_POSE_LEFT: Final = 1e-9
"""Error of a corrected pose, lengths over that of the arm, above which it is not reached."""

SHORTEST_MARGIN: Final = 1e-9
"""[m] Of a motion from obstacles, that is named: less is rounding."""

NEARLY_STRAIGHT: Final = 3e-4
"""[rad or m] Distance of the curve from a straight motion of the joints, at most, summed over the joints."""

LEAST_DEVIATION: Final = 1e-3
"""[rad or m] A corner that has to be rounded less is not rounded: the motion stops there."""

PATH_CURVED: Final = 1e-9
"""Second derivative above which a piece is a blend, not a leg."""

TIGHTENED_LEAST: Final = 1e-6
"""Share of a limit by which it is tightened at least where samples exceed it: else a round leaves a little of
what its neighbours change."""

LEAST_FACTOR: Final = 1e-30
"""Of a duration, and the inverse of the largest: with others derivatives leave the range of numbers."""

NEGLIGIBLE_TERM: Final = 1e-300
"""Coefficient of a polynomial of a duration, relative to the largest: up to the longest duration its term is
far below the rounding of the others, and quotients by it leave the range of numbers."""

PATH_START_ROUNDING: Final = 1e-8
"""[rad or m] By which the begin of a joint path is moved onto the start: what Newton's method leaves."""

MOTION_CHECK_STEP: Final = 1e-3
"""[s] Between the configurations at which the result is checked once more."""

MOTION_CHECK_EXCESS: Final = 1e-6
"""Share of a limit from which on that check says it exceeded: it looks for faults, not for roundings."""

SMOOTH_CORNER: Final = 1e-9
"""Change of direction that is rounding: the path goes straight on."""

REPEATED_POSE: Final = 1e-12
"""[m, rad] A leg that is shorter repeats its pose."""

NEAR_HALF_TURN: Final = 1e-9
"""[rad] How near to 180° a rotation has two shortest ways."""

COLLINEAR_POINTS: Final = 1e-9
"""Sine of the angle at the middle one of three points that are on a line."""
SIDE_SLIP: Final = 1e-9
"""Part of a twist [m/s or rad/s] that may lie outside of what wheels allow, and of a wheel matrix that may
miss a
direction: rounding is far below, and a slide that was meant far above."""

SHORT_STEP: Final = 0.01
"""Length of a step of odometry [m] below which its direction of travel is noise, so that the odometry model
of Thrun takes the first turn as zero."""

LOG_BYTES: Final = 1 << 30
"""Largest log that is read, after decompression: a day of a laser scanner; the numbers take as much again."""

LARGEST_VARIANCE: Final = 1e12
"""Largest number in the covariance of a start [m², rad²]: beyond it roundings are as large as the variances
of sensors. A start that may be anywhere is None."""

LARGEST_LOGGED: Final = 1e18
"""Largest number of a log: beyond it squares overflow, and nothing measures so much; stamps in nanoseconds
are below."""

PRINTED_ROTATION: Final = 1e-3
"""By how much a printed matrix may miss a rotation and still be projected on one: files print four digits and
more."""

ALIGNMENT_ROUNDING: Final = 1e-14
"""Spread of points relative to their largest coordinate that is rounding, so that it determines no
rotation."""

LEVEL_TILT: Final = 1e-3
"""Tilt [rad] up to which a pose of space counts as planar: rounding of quaternions printed with four
digits."""

CLOSEST_LANDMARK: Final = 1e-3
"""Distance of a landmark [m] below which its bearing has the derivative that it has there: nearer than any
sensor sees, the derivative grows without bound."""

ITERATED_STEP: Final = 1e-10
"""Step [m, rad] at which an iterated filter has converged: far below what any sensor resolves."""

KNOWN_EXACTLY: Final = 1e-14
"""Ratio of eigenvalues of a covariance below which a direction counts as known exactly: a smoother learns
nothing
about it, and rounding fills it."""

COVARIANCE_SYMMETRY: Final = 1e-9
"""Part of its largest entry by which a covariance may miss symmetry, or fall below zero: rounding of
products."""

SYMMETRIC_INFORMATION: Final = 1e-9
"""Difference of the halves of an information matrix, relative to its largest entry, that is rounding: files
print nine digits and more."""

SINGULAR_INFORMATION: Final = 1e-12
"""Least eigenvalue of an information matrix, relative to the largest, up to which it determines nothing in
one direction: centimetres beside tenths of degrees leave 1e-4, rounding 1e-16."""

UNIFORM_ANGLE: Final = 3.2899
"""Variance of an angle that is uniform on the circle [rad²], π²/3: a larger one is none of an angle."""

LARGEST_IN_GRAPH: Final = 1e100
"""Largest number of a pose graph: the square of a position, times an information, stays far from overflow."""

GRAPH_STEP: Final = 1e-5
"""Largest entry of the last step of a pose graph [m or rad]: a hundredth of a millimetre, and the next step
of Gauss-Newton is smaller by far."""

GRAPH_DECREASE: Final = 1e-9
"""Decrease of χ² that the last step of a pose graph predicts, relative to χ²: thousandths of what is asked of
its digits."""

SAME_CHI2: Final = 1e-6
"""Difference of two values of χ², relative, within which they are of one optimum: steps that end the search
leave 1e-9."""

LEAST_LIKELIHOOD: Final = 1e-12
"""What no range of a beam is less likely than [1/m]: its logarithm is finite, and far below that of any range
that is measured anywhere."""

UNIFORM_SHARE: Final = 1e-6
"""Share of the probability that each update of the histogram filter spreads over all free cells: small enough
to change no answer, large enough that a robot that was carried away is found within a few scans."""

FALSE_READINGS: Final = 1e-3
"""Likelihood of a reading of a landmark that no landmark explains, over that of a perfect one: beyond 3.7
standard deviations a reading is more likely false."""

WHOLE_CELLS: Final = 1e-6
"""Cells of a field by which the farthest cell of a histogram filter may miss a whole number of them: rounding
of sides such as 0.25 m over 0.05 m."""

STANDING: Final = 1e-3
"""A distance [m] or turn [rad] below which a robot stands: the jitter of odometry at rest."""

LEAST_OF_BEST: Final = 1e-4
"""Probability of a cell of the histogram filter, over that of the best one, below which it is in no mode: all
such cells together hold less than a per cent."""

__all__ = [name for name in globals() if name.isupper()]
