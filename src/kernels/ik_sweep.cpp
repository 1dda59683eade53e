#include "cspace/ik/redundancy/turning_points.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template Sweep make_sweep(const LockedArm&, int, const Posed&, const double*);
template void branches_at(const Sweep&, Pack<4>, Branches<Pack<4>>&);
template FoldValues fold_values(const Redundant&, const Sweep&);
template void onto_curve(const Chain&, int, const Posed&, double, CurvePoint&);
template void descend_to_manifold(const Chain&, int, const Posed&, double, double (*)[max_joints], int, bool*,
                                  const DescentRule&);

void ik_sweep(const LockedArm& locked, int parameter, const Posed& goal, const double* at,
              const double* values, int n, SweptRows* rows) {
    const Sweep sweep = make_sweep(locked, parameter, goal, at);
    sweep_values(sweep, values, n, [&](int k, const SweptRows& found) { rows[k] = found; });
}

}  // namespace cspace::ik::inline CSPACE_ISA
