// Every threshold of the core: its name, its unit and the reason for its value.
#pragma once

namespace cspace::tolerance {

// Sine of an angle, or a length relative to the vectors it comes from, that is nothing but rounding: a few
// operations on unit vectors leave some ten units in the last place (2.2e-16).
inline constexpr double rounding = 1.5e-14;

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

}  // namespace cspace::tolerance
