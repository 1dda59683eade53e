// The words of the compiled methods; Python reads the signature from their first line.
#include "kinematics_load.hpp"

const char kinematics_fk_doc[] =
    R"doc(fk($self, q, frame=None, *, T_world_base=None, out=None, threads=None)
--

The pose of a frame at a configuration (forward kinematics).

T_base_frame(q) = L₀ M₁(q₁) L₁ M₂(q₂) … Lₙ, with the joint motions Mᵢ (a turn or a slide) and the fixed Lᵢ
between.

q (..., n): joint coordinates [rad or m], in the order of `joint_names`. frame: its name; without it the tip.
T_world_base (..., 4, 4): where the base is, for a floating base or to place the robot; the result is then
T_world_frame. out (..., 4, 4): float64 array to write into. threads: 1 for one configuration, for a batch all
processors (0 or None).

Returns T (..., 4, 4), which maps coordinates in the frame to coordinates in the base.
Raises InputError for a wrong shape or NaN, UnknownNameError for an unknown frame.

Murray, Li and Sastry 1994, section 3.2.)doc";

const char kinematics_jacobian_doc[] =
    R"doc(jacobian($self, q, frame=None, *, point=None, expressed_in='base', T_world_base=None, out=None, threads=None)
--

The geometric Jacobian of a frame, or of a point fixed to it.

[v; ω] = J(q) q̇, where v [m/s] is the velocity of the point and ω [rad/s] the angular velocity of the frame.

q (..., n): joint coordinates [rad or m]. frame: its name; without it the tip. point (..., 3): in
coordinates of that frame [m]; without it the origin. expressed_in: "base" (the axes in which fk gives its
result) or "tip" (the axes of the frame itself). T_world_base (..., 4, 4): where the base is. out (..., 6,
dof): float64 array to write into. threads: as in fk.

Returns J (..., 6, dof), rows [v; ω]; the columns of a floating base, [v; ω] of the base at its origin in
world axes, come first. Raises InputError for a wrong shape or NaN, UnknownNameError for an unknown frame or
axes.

Whitney 1969; Siciliano et al. 2009, section 3.1.)doc";

const char kinematics_fk_jacobian_doc[] =
    R"doc(fk_jacobian($self, q, frame=None, *, point=None, expressed_in='base', T_world_base=None, out=None, threads=None)
--

The pose and the Jacobian of a frame in one pass, for less than the price of both.

q, frame, point, expressed_in, T_world_base, threads: as in jacobian. out: the pair of arrays to write into.

Returns (T, J): T (..., 4, 4) as of fk, J (..., 6, dof) as of jacobian.)doc";
