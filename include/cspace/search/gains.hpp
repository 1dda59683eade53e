// The strengths of an artificial potential (Khatib 1986, "Real-time obstacle avoidance for manipulators and
// mobile robots"): the goal attracts, with ½ k d² near it and a cone beyond, and what is nearer than rho_0
// repels with ½ k_r (1/ρ − 1/ρ₀)².
#pragma once

namespace cspace::search {

struct Gains {
    double k = 1, k_r = 1;
    double rho_0 = 1;  // how far obstacles repel [m]
    double cone = 1;   // from how far on the goal attracts with the same force [the unit of d]

    double attraction(double d) const { return d < cone ? 0.5 * k * d * d : k * cone * (d - 0.5 * cone); }
    double repulsion(double rho) const {
        const double near = rho < rho_0 ? 1 / rho - 1 / rho_0 : 0;
        return 0.5 * k_r * near * near;
    }
    // By how much it grows with the distance: not at all, or less than nothing.
    double repulsion_rate(double rho) const {
        return rho < rho_0 ? -k_r * (1 / rho - 1 / rho_0) / (rho * rho) : 0;
    }
    // By how much that rate grows with the distance.
    double repulsion_stiffness(double rho) const {
        if (!(rho < rho_0)) return 0;
        const double inverse = 1 / rho;
        return k_r * inverse * inverse * inverse * (inverse + 2 * (inverse - 1 / rho_0));
    }
};

}  // namespace cspace::search
