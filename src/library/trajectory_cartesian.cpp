#include "trajectory_cartesian.hpp"

#include "cspace/spatial/left_jacobian.hpp"
#include "cspace/spatial/rotation.hpp"

namespace cspace::trajectory {

namespace {

Vec3d read_vector(const double* v) { return {v[0], v[1], v[2]}; }
void write_vector(const Vec3d& v, double* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

// A polynomial of degree 5 and its first two derivatives at u.
struct Polynomial {
    Vec3d value, slope, bend;
};
Polynomial evaluate_polynomial(const double* coefficients, double u) {
    Polynomial p{read_vector(coefficients + 15), {0, 0, 0}, {0, 0, 0}};
    for (int k = 4; k >= 0; --k) {
        p.bend = u * p.bend + 2.0 * p.slope;
        p.slope = u * p.slope + p.value;
        p.value = u * p.value + read_vector(coefficients + 3 * k);
    }
    return p;
}

// The displacement (Rot − 1) arm, which needs no difference of large numbers where the axis is far away.
Vec3d displace_arm(const CartesianPieces& path, std::size_t piece, double u) {
    double s, c;
    sincos(0.5 * path.rate[piece] * u, s, c);
    const Vec3d axis = read_vector(path.axis.data() + 3 * piece);
    const Vec3d aside = cross(axis, read_vector(path.arm.data() + 3 * piece));
    return (2.0 * s) * (c * aside + s * cross(axis, aside));
}

}  // namespace

void evaluate_poses(const CartesianPieces& path, const CartesianPlaces& places, double* T) {
    for (std::size_t i = 0; i < places.u.size(); ++i, T += 16) {
        const std::size_t piece = std::size_t(places.piece[i]);
        const double u = places.u[i], *R = path.R.data() + 9 * piece;
        const Mat3d turn =
            spatial::rotation_of_rotvec(evaluate_polynomial(path.turn.data() + 18 * piece, u).value);
        const Vec3d p =
            evaluate_polynomial(path.point.data() + 18 * piece, u).value + displace_arm(path, piece, u);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                T[4 * r + c] = turn.m[r][0] * R[c] + turn.m[r][1] * R[3 + c] + turn.m[r][2] * R[6 + c];
        T[3] = p.x, T[7] = p.y, T[11] = p.z;
        T[12] = T[13] = T[14] = 0.0, T[15] = 1.0;
    }
}

void evaluate_twists(const CartesianPieces& path, const CartesianPlaces& places, double* first,
                     double* second) {
    for (std::size_t i = 0; i < places.u.size(); ++i, first += 6, second += 6) {
        const std::size_t piece = std::size_t(places.piece[i]);
        const double u = places.u[i];
        const Polynomial point = evaluate_polynomial(path.point.data() + 18 * piece, u);
        const Polynomial turn = evaluate_polynomial(path.turn.data() + 18 * piece, u);
        const Vec3d spin = path.rate[piece] * read_vector(path.axis.data() + 3 * piece);
        const Vec3d arm = read_vector(path.arm.data() + 3 * piece) + displace_arm(path, piece, u);
        const Vec3d around = cross(spin, arm);
        const spatial::AngularRates<double> omega = spatial::angular_rates(turn.value, turn.slope, turn.bend);
        write_vector(point.slope + around, first);
        write_vector(point.bend + cross(spin, around), second);
        write_vector(omega.velocity, first + 3);
        write_vector(omega.acceleration, second + 3);
    }
}

}  // namespace cspace::trajectory
