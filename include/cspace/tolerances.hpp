// Every threshold of the core: its name, its unit and the reason for its value.
#pragma once

namespace cspace::tolerance {

// Sine of an angle, or a length relative to the vectors it comes from, that is nothing but rounding: a few
// operations on unit vectors leave some ten units in the last place (2.2e-16).
inline constexpr double rounding = 1.5e-14;

// A few units in the last place, relative: what a sum of a dozen products loses.
inline constexpr double last_digits = 1e-15;

// Keeps a quotient finite: smaller than every square of a length that counts, and its inverse does not
// overflow.
inline constexpr double nonzero = 1e-300;

// Share by which search radii and bounds of the plane are widened: far above what rounding changes in sums
// and products of coordinates, far below every width that counts.
inline constexpr double widening = 1e-9;

// Error of an answer relative to the lengths in the problem, up to which it counts as an exact solution: a
// thousand times what the formulas lose, a thousand times less than anybody can build or measure.
inline constexpr double exact = 1e-12;

// Imaginary part of a root, relative to its size, up to which a conjugate pair is taken for a double real
// root: coefficients carry errors of about 1e-16, which move a double root by their square root.
inline constexpr double double_root = 1e-7;

// Distance on the unit circles below which two answers of one subproblem are the same: a double root comes
// out of the refinement scattered by the square root of the rounding, some 1e-8.
inline constexpr double same_turns = 3e-7;

// Smallest singular value, relative, below which the quartic of two angles may lose pairs of roots that lie
// closer than that; the formulas for the singular case then offer their candidates too.
inline constexpr double degenerate_pair = 1e-5;

// Two axes count as parallel below this angle [rad], as meeting below this distance (times the arm's length):
// robot files round a right angle to 1.5708, which bends an axis by 4e-6 rad; calibration moves it by 1e-4.
inline constexpr double axis_relation = 2e-5;

// The closed form of an arm whose true geometry differs by less than this (m and rad, over the arm's length)
// needs no correction: the difference drowns in rounding.
inline constexpr double geometry_exact = 2e-14;

// Above this deviation (m and rad, over the arm's length) the list of a doubtful goal may lack solutions: of
// two catalogue arms off by 3e-12 and 5e-10 none were lost next to 3,000 singular poses, of two off by 7e-6
// some.
inline constexpr double visible_deviation = 1e-8;

// A square root's argument within this band of zero (relative) marks two solutions about to merge: outside it
// the closed form keeps twelve digits, inside it the careful path decides.
inline constexpr double fold_band = 1e-10;

// A quantity that fixes a joint (a lever arm over the arm's length, a sine) below this is rounding noise: the
// joint is free and the pose singular.
inline constexpr double free_joint = 1e-12;

// Component of a unit vector of joint rates below which a joint rests: rounding decides its sign.
inline constexpr double resting = 1e-9;

// Smallest singular value of the Jacobian (lengths over the arm's length) below which in every configuration
// an arm is redundant: rounding leaves 1e-16, and the worst of real arms reaches 1e-3 somewhere.
inline constexpr double always_singular = 1e-9;

// A configuration is a solution if forward kinematics meets the goal within this (rad, and m over the arm's
// length): far above what rounding costs near a singularity, far below what any robot can tell.
inline constexpr double reached = 1e-9;

// A goal counts as beyond an arm only if it misses what the axes allow by this (rad, and m over the arm's
// length): ten times what a solution may miss.
inline constexpr double beyond = 1e-8;

// Solutions closer than this [rad] are one, unless conditioning says otherwise (see ik/refine.hpp).
inline constexpr double same_solution = 1e-9;

// Two candidates that conditioning cannot tell apart are one solution if the configuration halfway between
// them meets the goal this well (as `reached`): rounding leaves 1e-15, a fold between two solutions more.
inline constexpr double halfway = 2e-14;

// Largest entry of RᵀR − I accepted in a goal (ROTATION_ERROR in Python): numbers typed with seven digits
// pass.
inline constexpr double rotation_error = 1e-6;

// Largest sum of a goal's coordinates [m] (FARTHEST in Python): their squares still fit a double.
inline constexpr double farthest = 1e100;

// Largest deviation of a pose's last row from (0, 0, 0, 1): it is written, never computed, up to rounding.
inline constexpr double last_row = 1e-9;

// Sine of the angle by which a fixed rotation may miss a multiple of 90° and still be taken for it: the
// rounding of a rotation that somebody wrote as 1.5707963267948966.
inline constexpr double right_angle = 2.5e-16;

// Gap, relative to the arm, below which a candidate of the algebra is surely meant: a double root is off by
// 1e-8, a wrong pairing of the two conditions by a good part of the arm.
inline constexpr double sure_candidate = 1e-3;

// Largest joint change [rad] of the first and of the second Newton step of a polished solution: a first step
// of 1e-3 leaves 1e-6, a second one of 1e-6 leaves 1e-12. Larger steps come near singularities, which the
// careful path looks at.
inline constexpr double polish_reach = 1e-3, polished = 1e-7;
// Largest first step [rad] after which none follows: second derivatives of the pose are at most 6 [1/rad], so
// that less than 1e-15 is left of its error.
inline constexpr double polished_at_once = 1e-8;

// Squares of lengths between these bounds neither lost digits to underflow (below 2e-308) nor overflowed, and
// their inverses do not either.
inline constexpr double least_square = 1e-280, largest_square = 1e280;

// Length [rad] up to which the last digit of a rotation vector's length does not show in its matrix: somewhat
// more than a full turn.
inline constexpr double one_turn = 6.3;

// A point this near to the border of a cell [cells] is on it, and the square of a radius [half cells] this
// near to a whole number, relative to it, is that number: sums and quotients of decimal fractions are that
// much off.
inline constexpr double cell_border = 1e-9;

// A unit in the last place of a float, relative.
inline constexpr double float_rounding = 1.2e-7;

// Length [m] added to every radius in collision checks, per metre of the robot's reach where that is longer
// than one metre: a sphere placed in floats is off by up to 4e-7 m, and two of them meet.
inline constexpr double collision_slack = 2e-6;

// Two distances [m] that differ by less are equal, and two of their gradients [m/rad] are one: rounding of
// forward kinematics in double leaves 1e-15.
inline constexpr double same_distance = 1e-12, same_gradient = 1e-9;

// Inertia left to a joint, relative to that of the body which it turns or slides, that is none: what the
// joints beyond take away leaves rounding of 1e-16. Likewise of a motion that closed loops allow.
inline constexpr double singular_inertia = 1e-13;
// The same in floats, which leave rounding of 1e-7.
inline constexpr float singular_inertia_of_floats = 1e-6f;
// Closed loops: φ, without units, up to which they are closed, and from which on nothing is gained by another
// step.
inline constexpr double loop_closed = 1e-12, loop_projected = 2e-14;
// A row of K, relative to the largest, that depends on others; and by how much more for each unit of φ, since
// the rows of open loops are not quite dependent.
inline constexpr double loop_rank = 1e-9, loop_rank_slack = 100.0;

}  // namespace cspace::tolerance
