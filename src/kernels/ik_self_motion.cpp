#include "cspace/ik/near_singular.hpp"
#include "once.hpp"

namespace cspace::inline CSPACE_ISA {
template void decompose_matrix(SmallSvd<6, ik::max_joints>&, bool);
}

namespace cspace::ik::inline CSPACE_ISA {

template CurveEnd follow_curve(const Chain&, const TipConstraint&, const double*, const double*, VisitCurve,
                               int, double);
template bool find_self_motion(const Chain&, const Posed&, double, const double*, const PoseSvd&, double*);
template int accept_solution(Solutions&, const Chain&, const Posed&, double, double*, int, int);

}  // namespace cspace::ik::inline CSPACE_ISA
