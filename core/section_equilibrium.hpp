// Equilibrium of one cross-section (theory: "Section equilibrium"): from the resultants carried by the section to
// the strains of all tubes, in the twist-free frame R_b shared by the tubes.
//
// Unknown strains: curvature (kx, ky), tangent slope (wx, wy), and per tube twist tau = u_3 and stretch eta = v_3 - 1.
// Equations: sum of N_xy = S, sum of M_xy = Q, and N_3, M_3 of every tube given.
#pragma once
#include <cmath>

#include "dual.hpp"
#include "robot.hpp"

namespace tactr {

constexpr double SECTION_TOLERANCE = 1e-10;  // scaled residual of every equation of a section
constexpr int SECTION_ITERATIONS = 60;

template <class E>
struct StrainsOf {
    E kx, ky, wx, wy;
    E tau[MAX_TUBES], eta[MAX_TUBES];  // by position among the tubes present
};
using Strains = StrainsOf<double>;

/// A tendon at one cross-section, in its host's material frame.
template <class P>
struct TendonState {
    P r[2], dr[2], tension;
    int slot;
};

/// Resultants N_i, M_i (elastic part plus tendons) of one tube, in R_b, at the given strains.
/// c, s: cosine and sine of psi_i. ustar: rest curvature and twist in the tube's frame.
template <class T, class P>
inline void elastic_wrench(const TubePiece& tube, const P* ustar, const T& c, const T& s, const Strains& e, int slot,
                           T N[3], T M[3]) {
    const double stretch = 1.0 + e.eta[slot];
    N[0] = T(tube.GA * stretch * e.wx);
    N[1] = T(tube.GA * stretch * e.wy);
    N[2] = T(tube.EA * e.eta[slot]);
    const T bx = (c * e.kx + s * e.ky - ustar[0]) * tube.EIx;
    const T by = (c * e.ky - s * e.kx - ustar[1]) * tube.EIy;
    M[0] = c * bx - s * by;
    M[1] = s * bx + c * by;
    M[2] = T(tube.GJ * (e.tau[slot] - ustar[2]));
}

/// Tendon data kept from the last evaluation, for the tangent stiffness and the tendon's length.
struct TendonTangent {
    double x, y;      // r in R_b
    double t[3];      // unit tangent in R_b
    double stiffness; // tension / |q|
    double speed;     // |q|
};

/// Adds lambda t and lambda r x t of one tendon to its host's resultants, in R_b.
template <class T, class P, class E>
inline void add_tendon(const TendonState<P>& tendon, const T& c, const T& s, const StrainsOf<E>& e, T N[3], T M[3],
                       T& speed, T direction[3], T r[2]) {
    const int i = tendon.slot;
    const E stretch = 1.0 + e.eta[i];
    r[0] = c * tendon.r[0] - s * tendon.r[1];
    r[1] = s * tendon.r[0] + c * tendon.r[1];
    // q = [u] r + r' + v
    const T qx = c * tendon.dr[0] - s * tendon.dr[1] + stretch * e.wx - e.tau[i] * r[1];
    const T qy = s * tendon.dr[0] + c * tendon.dr[1] + stretch * e.wy + e.tau[i] * r[0];
    const T qz = stretch + e.kx * r[1] - e.ky * r[0];
    speed = square_root(qx * qx + qy * qy + qz * qz);
    const T inverse = T(1.0) / speed;
    direction[0] = qx * inverse;
    direction[1] = qy * inverse;
    direction[2] = qz * inverse;
    const T fx = tendon.tension * direction[0], fy = tendon.tension * direction[1], fz = tendon.tension * direction[2];
    N[0] += fx;
    N[1] += fy;
    N[2] += fz;
    M[0] += r[1] * fz;
    M[1] -= r[0] * fz;
    M[2] += r[0] * fy - r[1] * fx;
}

/// d(N_x, N_y, N_3, M_x, M_y, M_3) / d(kx, ky, wx, wy, tau, eta) of one tube.
using TubeTangent = double[6][6];

inline void elastic_tangent(const TubePiece& tube, double c, double s, const Strains& e, int slot, TubeTangent& J) {
    for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) J[a][b] = 0.0;
    const double stretch = 1.0 + e.eta[slot];
    J[0][2] = J[1][3] = tube.GA * stretch;
    J[0][5] = tube.GA * e.wx;
    J[1][5] = tube.GA * e.wy;
    J[2][5] = tube.EA;
    J[3][0] = tube.EIx * c * c + tube.EIy * s * s;
    J[3][1] = J[4][0] = (tube.EIx - tube.EIy) * c * s;
    J[4][1] = tube.EIx * s * s + tube.EIy * c * c;
    J[5][4] = tube.GJ;
}

/// Adds lambda/|q| (I - t t^T), seen through r, to the tangent of the tendon's host.
inline void add_tendon_tangent(const TendonTangent& tendon, const Strains& e, int slot, TubeTangent& J) {
    const double g = tendon.stiffness, x = tendon.x, y = tendon.y;
    const double* t = tendon.t;
    const double stretch = 1.0 + e.eta[slot];
    const double G00 = g * (1.0 - t[0] * t[0]), G11 = g * (1.0 - t[1] * t[1]), G22 = g * (1.0 - t[2] * t[2]);
    const double G01 = -g * t[0] * t[1], G02 = -g * t[0] * t[2], G12 = -g * t[1] * t[2];
    const double G[3][3] = {{G00, G01, G02}, {G01, G11, G12}, {G02, G12, G22}};
    double F[3][6];
    for (int a = 0; a < 3; ++a) {
        F[a][0] = G[a][2] * y;
        F[a][1] = -G[a][2] * x;
        F[a][2] = stretch * G[a][0];
        F[a][3] = stretch * G[a][1];
        F[a][4] = x * G[a][1] - y * G[a][0];
        F[a][5] = e.wx * G[a][0] + e.wy * G[a][1] + G[a][2];
    }
    for (int b = 0; b < 6; ++b) {
        J[0][b] += F[0][b];
        J[1][b] += F[1][b];
        J[2][b] += F[2][b];
        J[3][b] += y * F[2][b];
        J[4][b] -= x * F[2][b];
        J[5][b] += x * F[1][b] - y * F[0][b];
    }
}

/// The section's Jacobian with every tube's 2x2 block (tau, eta) eliminated: a 4x4 system, factored.
struct SectionFactor {
    int count, guided;
    double inverse[MAX_TUBES][2][2];   // of d(M_3, N_3)/d(tau, eta)
    double coupling[MAX_TUBES][2][4];  // d(M_3, N_3)/d(kx, ky, wx, wy)
    double lift[MAX_TUBES][4][2];      // d(Q, S)/d(tau, eta) times inverse
    double lu[4][4];                   // rows Qx, Qy, Sx, Sy; unit lower part below the diagonal
    double pivot[4];                   // inverse diagonal

    bool factor(const TubeTangent* J, int tubes, bool guided_section) {
        constexpr int row[4] = {3, 4, 0, 1};
        count = tubes;
        guided = guided_section;
        double A[4][4] = {};
        for (int i = 0; i < tubes; ++i) {
            const double a = J[i][5][4], b = J[i][5][5], c = J[i][2][4], d = J[i][2][5];
            const double determinant = a * d - b * c;
            if (!(determinant > 0.0)) return false;
            const double f = 1.0 / determinant;
            inverse[i][0][0] = d * f;
            inverse[i][0][1] = -b * f;
            inverse[i][1][0] = -c * f;
            inverse[i][1][1] = a * f;
            if (guided_section) continue;
            for (int k = 0; k < 4; ++k) {
                coupling[i][0][k] = J[i][5][k];
                coupling[i][1][k] = J[i][2][k];
            }
            for (int r = 0; r < 4; ++r) {
                const double p = J[i][row[r]][4], q = J[i][row[r]][5];
                lift[i][r][0] = p * inverse[i][0][0] + q * inverse[i][1][0];
                lift[i][r][1] = p * inverse[i][0][1] + q * inverse[i][1][1];
                for (int k = 0; k < 4; ++k)
                    A[r][k] += J[i][row[r]][k] - lift[i][r][0] * coupling[i][0][k] - lift[i][r][1] * coupling[i][1][k];
            }
        }
        return guided_section || eliminate(A);
    }

    /// Solves in place for L right-hand sides. In: total (Q, S), per tube (M_3, N_3). Out: (kx, ky, wx, wy), (tau, eta).
    template <int L>
    void solve(double total[4][L], double tube[MAX_TUBES][2][L]) const {
        if (!guided) {
            for (int i = 0; i < count; ++i)
                for (int r = 0; r < 4; ++r)
                    for (int l = 0; l < L; ++l)
                        total[r][l] -= lift[i][r][0] * tube[i][0][l] + lift[i][r][1] * tube[i][1][l];
            for (int r = 1; r < 4; ++r)
                for (int k = 0; k < r; ++k)
                    for (int l = 0; l < L; ++l) total[r][l] -= lu[r][k] * total[k][l];
            for (int r = 3; r >= 0; --r)
                for (int l = 0; l < L; ++l) {
                    for (int k = r + 1; k < 4; ++k) total[r][l] -= lu[r][k] * total[k][l];
                    total[r][l] *= pivot[r];
                }
            for (int i = 0; i < count; ++i)
                for (int a = 0; a < 2; ++a)
                    for (int k = 0; k < 4; ++k)
                        for (int l = 0; l < L; ++l) tube[i][a][l] -= coupling[i][a][k] * total[k][l];
        }
        for (int i = 0; i < count; ++i)
            for (int l = 0; l < L; ++l) {
                const double m = tube[i][0][l], n = tube[i][1][l];
                tube[i][0][l] = inverse[i][0][0] * m + inverse[i][0][1] * n;
                tube[i][1][l] = inverse[i][1][0] * m + inverse[i][1][1] * n;
            }
    }

  private:
    /// Gaussian elimination without pivoting: the matrix is positive definite up to strains of the order 1e-4.
    bool eliminate(double A[4][4]) {
        for (int k = 0; k < 4; ++k) {
            if (!(A[k][k] > 0.0)) return false;
            pivot[k] = 1.0 / A[k][k];
            for (int r = k + 1; r < 4; ++r) {
                const double f = A[r][k] * pivot[k];
                lu[r][k] = f;
                for (int c = k + 1; c < 4; ++c) A[r][c] -= f * A[k][c];
            }
            for (int c = k; c < 4; ++c) lu[k][c] = A[k][c];
        }
        return true;
    }
};

}  // namespace tactr
