// Equilibrium of one cross-section (theory: "Section equilibrium"): from the resultants carried by the section to
// the strains of all tubes, in the twist-free frame R_b shared by the tubes.
//
// Unknown strains: curvature (kx, ky), tangent slope (wx, wy), and per tube twist tau = u_3 and stretch eta = v_3 - 1.
// Equations: sum of N_xy = S, sum of M_xy = Q, and N_3, M_3 of every tube given.
#pragma once
#include <cmath>

#include "dual.hpp"
#include "robot.hpp"
#include "tube_state.hpp"

namespace tactr {

constexpr double SECTION_TOLERANCE = 1e-10;  // scaled residual of every equation of a section
constexpr int SECTION_ITERATIONS = 100;

template <class E>
struct StrainsOf {
    E kx, ky, wx, wy;
    E tau[MAX_TUBES], eta[MAX_TUBES];  // by position among the tubes present
};
using Strains = StrainsOf<double>;

/// Only what belongs to the tubes present.
template <class E>
TACTR_ANY inline void copy_strains(const StrainsOf<E>& from, int tubes, StrainsOf<E>& to) {
    to.kx = from.kx;
    to.ky = from.ky;
    to.wx = from.wx;
    to.wy = from.wy;
    for (int a = 0; a < tubes; ++a) {
        to.tau[a] = from.tau[a];
        to.eta[a] = from.eta[a];
    }
}

/// On the line from one to another at a share of the way, 1 at the other.
inline void carry_on(const Strains& from, const Strains& to, double share, int tubes, Strains& out) {
    const auto line = [share](double a, double b) { return a + share * (b - a); };
    out.kx = line(from.kx, to.kx);
    out.ky = line(from.ky, to.ky);
    out.wx = line(from.wx, to.wx);
    out.wy = line(from.wy, to.wy);
    for (int a = 0; a < tubes; ++a) {
        out.tau[a] = line(from.tau[a], to.tau[a]);
        out.eta[a] = line(from.eta[a], to.eta[a]);
    }
}

/// A tendon at one cross-section, in its host's material frame.
template <class P>
struct TendonState {
    P r[2], dr[2], tension;
    int slot;
};

/// Elastic resultants of one tube, in R_b, at the given strains; c, s: cosine and sine of psi_i. An axial force acts
/// at the neutral axis r = (x, y, 0): N_3 = EA ((v - v*) + (u - u*) x r)_3, and r x N_3 e3 adds to the moment.
template <class T, class A, class C, class E>
TACTR_ANY inline void elastic_wrench(const TubeState<C>& tube, const A& c, const A& s, const StrainsOf<E>& e, int slot, T N[3], T M[3]) {
    const E stretch = 1.0 + e.eta[slot];
    const T ux = c * e.kx + s * e.ky - tube.ustar[0];
    const T uy = c * e.ky - s * e.kx - tube.ustar[1];
    T bx = ux * tube.EIx, by = uy * tube.EIy;
    N[0] = T(tube.GA * stretch * e.wx);
    N[1] = T(tube.GA * stretch * e.wy);
    if (tube.plain) {
        N[2] = T(tube.EA * e.eta[slot]);
    } else {
        N[0] -= (c * tube.vstar[0] - s * tube.vstar[1]) * tube.GA;
        N[1] -= (s * tube.vstar[0] + c * tube.vstar[1]) * tube.GA;
        N[2] = (e.eta[slot] - tube.vstar[2] + ux * tube.axis[1] - uy * tube.axis[0]) * tube.EA;
        bx += N[2] * tube.axis[1];
        by -= N[2] * tube.axis[0];
    }
    M[0] = c * bx - s * by;
    M[1] = s * bx + c * by;
    M[2] = T(tube.GJ * (e.tau[slot] - tube.ustar[2]));
}

/// Tendon data kept from the last evaluation, for the tangent stiffness and the tendon's length.
template <class R>
struct TendonTangentOf {
    R x, y;      // r in R_b
    R t[3];      // unit tangent in R_b
    R stiffness; // tension / |q|
    R inverse;   // 1 / |q|
};
using TendonTangent = TendonTangentOf<double>;

/// Adds lambda t and lambda r x t of one tendon to its host's resultants, in R_b.
template <class T, class A, class P, class E>
TACTR_ANY inline void add_tendon(const TendonState<P>& tendon, const A& c, const A& s, const StrainsOf<E>& e, T N[3], T M[3],
                       T& inverse, T direction[3], T r[2]) {
    const int i = tendon.slot;
    const E stretch = 1.0 + e.eta[i];
    r[0] = c * tendon.r[0] - s * tendon.r[1];
    r[1] = s * tendon.r[0] + c * tendon.r[1];
    // q = [u] r + r' + v
    const T qx = c * tendon.dr[0] - s * tendon.dr[1] + stretch * e.wx - e.tau[i] * r[1];
    const T qy = s * tendon.dr[0] + c * tendon.dr[1] + stretch * e.wy + e.tau[i] * r[0];
    const T qz = stretch + e.kx * r[1] - e.ky * r[0];
    inverse = T(1.0) / square_root(qx * qx + qy * qy + qz * qz);
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

/// Tangent stiffness of one tube, d(N, M)/d(v, u) in R_b: symmetric, so only one of each pair is kept.
template <class R>
struct TubeTangentOf {
    R vv[6];     // xx, xy, xz, yy, yz, zz
    R uu[6];
    R vu[3][3];  // dN/du
};
using TubeTangent = TubeTangentOf<double>;

template <class R>
TACTR_ANY inline void elastic_tangent(const TubeState<R>& tube, const R& c, const R& s, TubeTangentOf<R>& K) {
    K = TubeTangentOf<R>{};
    K.vv[0] = K.vv[3] = tube.GA;
    K.vv[5] = tube.EA;
    K.uu[0] = tube.EIx * c * c + tube.EIy * s * s;
    K.uu[1] = (tube.EIx - tube.EIy) * c * s;
    K.uu[3] = tube.EIx * s * s + tube.EIy * c * c;
    K.uu[5] = tube.GJ;
    if (tube.plain) return;
    const R x = c * tube.axis[0] - s * tube.axis[1], y = s * tube.axis[0] + c * tube.axis[1];
    K.vu[2][0] = y * tube.EA;
    K.vu[2][1] = -x * tube.EA;
    K.uu[0] += y * y * tube.EA;
    K.uu[1] -= x * y * tube.EA;
    K.uu[3] += x * x * tube.EA;
}

/// Twice the elastic energy of one tube per length, from its elastic resultants in R_b.
inline double elastic_energy(const TubeState<double>& tube, double c, double s, const double N[3], const double M[3]) {
    double bx = c * M[0] + s * M[1], by = c * M[1] - s * M[0];
    if (!tube.plain) {
        bx -= N[2] * tube.axis[1];
        by += N[2] * tube.axis[0];
    }
    return bx * bx / tube.EIx + by * by / tube.EIy + M[2] * M[2] / tube.GJ + N[2] * N[2] / tube.EA +
           (N[0] * N[0] + N[1] * N[1]) / tube.GA;
}

/// Adds G = lambda/|q| (I - t t^T), seen through r, to the tangent of the tendon's host.
template <class R>
TACTR_ANY inline void add_tendon_tangent(const TendonTangentOf<R>& tendon, TubeTangentOf<R>& K) {
    const R g = tendon.stiffness, x = tendon.x, y = tendon.y;
    const R* t = tendon.t;
    const R gx = g * t[0], gy = g * t[1];
    const R xx = g - gx * t[0], xy = -gx * t[1], xz = -gx * t[2];
    const R yy = g - gy * t[1], yz = -gy * t[2], zz = g - g * t[2] * t[2];
    K.vv[0] += xx;
    K.vv[1] += xy;
    K.vv[2] += xz;
    K.vv[3] += yy;
    K.vv[4] += yz;
    K.vv[5] += zz;
    const R column[3] = {x * xy - y * xx, x * yy - y * xy, x * yz - y * xz};  // dF/du_3
    const R z[3] = {xz, yz, zz};
    for (int a = 0; a < 3; ++a) {
        K.vu[a][0] += y * z[a];
        K.vu[a][1] -= x * z[a];
        K.vu[a][2] += column[a];
    }
    K.uu[0] += y * y * zz;
    K.uu[1] -= x * y * zz;
    K.uu[2] += y * column[2];
    K.uu[3] += x * x * zz;
    K.uu[4] -= x * column[2];
    K.uu[5] += x * column[1] - y * column[0];
}

/// Rows of one tube's Jacobian: d(N_x, N_y, M_x, M_y, M_3, N_3) / d(kx, ky, wx, wy, tau, eta), v = (1 + eta) (wx, wy, 1).
template <class R>
struct TubeRowsOf {
    R Nx[6], Ny[6], Mx[6], My[6], M3[6], N3[6];

    TACTR_ANY void set(const TubeTangentOf<R>& K, const R& wx, const R& wy, const R& eta) {
        const R f = 1.0 + eta;
        row(Nx, K.vu[0][0], K.vu[0][1], K.vu[0][2], K.vv[0], K.vv[1], K.vv[2], wx, wy, f);
        row(Ny, K.vu[1][0], K.vu[1][1], K.vu[1][2], K.vv[1], K.vv[3], K.vv[4], wx, wy, f);
        row(N3, K.vu[2][0], K.vu[2][1], K.vu[2][2], K.vv[2], K.vv[4], K.vv[5], wx, wy, f);
        row(Mx, K.uu[0], K.uu[1], K.uu[2], K.vu[0][0], K.vu[1][0], K.vu[2][0], wx, wy, f);
        row(My, K.uu[1], K.uu[3], K.uu[4], K.vu[0][1], K.vu[1][1], K.vu[2][1], wx, wy, f);
        row(M3, K.uu[2], K.uu[4], K.uu[5], K.vu[0][2], K.vu[1][2], K.vu[2][2], wx, wy, f);
    }

  private:
    TACTR_ANY static void row(R* r, const R& ux, const R& uy, const R& uz, const R& vx, const R& vy, const R& vz, const R& wx, const R& wy, const R& f) {
        r[0] = ux;
        r[1] = uy;
        r[2] = f * vx;
        r[3] = f * vy;
        r[4] = uz;
        r[5] = wx * vx + wy * vy + vz;
    }
};

using TubeRows = TubeRowsOf<double>;

/// The section's Jacobian with every tube's 2x2 block (tau, eta) eliminated: a 4x4 system, factored.
template <class R>
struct SectionFactorOf {
    int count, guided;
    R inverse[MAX_TUBES][2][2];   // of d(M_3, N_3)/d(tau, eta)
    R coupling[MAX_TUBES][2][4];  // d(M_3, N_3)/d(kx, ky, wx, wy)
    R lift[MAX_TUBES][4][2];      // d(Q, S)/d(tau, eta) times inverse
    R lu[4][4];                   // rows Qx, Qy, Sx, Sy; unit lower part below the diagonal
    R pivot[4];                   // inverse diagonal

    TACTR_APART MaskOf<R> factor(const TubeRowsOf<R>* J, int tubes, bool guided_section) {
        count = tubes;
        guided = guided_section;
        R A[4][4] = {};
        MaskOf<R> regular = true;
        for (int i = 0; i < tubes; ++i) {
            const R a = J[i].M3[4], b = J[i].M3[5], c = J[i].N3[4], d = J[i].N3[5];
            const R determinant = a * d - b * c;
            regular = regular & (determinant > 0.0);
            if (none(regular)) return regular;
            const R f = 1.0 / determinant;
            inverse[i][0][0] = d * f;
            inverse[i][0][1] = -b * f;
            inverse[i][1][0] = -c * f;
            inverse[i][1][1] = a * f;
            if (guided_section) continue;
            for (int k = 0; k < 4; ++k) {
                coupling[i][0][k] = J[i].M3[k];
                coupling[i][1][k] = J[i].N3[k];
            }
            const R* rows[4] = {J[i].Mx, J[i].My, J[i].Nx, J[i].Ny};
            for (int r = 0; r < 4; ++r) {
                const R p = rows[r][4], q = rows[r][5];
                const R u = p * inverse[i][0][0] + q * inverse[i][1][0];
                const R v = p * inverse[i][0][1] + q * inverse[i][1][1];
                lift[i][r][0] = u;
                lift[i][r][1] = v;
                for (int k = 0; k < 4; ++k) A[r][k] += rows[r][k] - u * J[i].M3[k] - v * J[i].N3[k];
            }
        }
        return guided_section ? regular : regular & eliminate(A);
    }

    /// Solves in place for L right-hand sides. In: total (Q, S), per tube (M_3, N_3). Out: (kx, ky, wx, wy), (tau, eta).
    template <int L>
    TACTR_APART void solve(R (*__restrict total)[L], R (*__restrict tube)[2][L]) const {
        if (!guided) {
            R x[4][L];
            for (int r = 0; r < 4; ++r)
                for (int l = 0; l < L; ++l) x[r][l] = total[r][l];
            for (int i = 0; i < count; ++i)
                for (int r = 0; r < 4; ++r) {
                    const R f = lift[i][r][0], g = lift[i][r][1];
                    for (int l = 0; l < L; ++l) x[r][l] -= f * tube[i][0][l] + g * tube[i][1][l];
                }
            eliminated(x);
            for (int i = 0; i < count; ++i)
                for (int a = 0; a < 2; ++a) {
                    const R *c = coupling[i][a], c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
                    for (int l = 0; l < L; ++l)
                        tube[i][a][l] -= (c0 * x[0][l] + c1 * x[1][l]) + (c2 * x[2][l] + c3 * x[3][l]);
                }
            for (int r = 0; r < 4; ++r)
                for (int l = 0; l < L; ++l) total[r][l] = x[r][l];
        }
        for (int i = 0; i < count; ++i) {
            const R a = inverse[i][0][0], b = inverse[i][0][1], c = inverse[i][1][0], d = inverse[i][1][1];
            for (int l = 0; l < L; ++l) {
                const R m = tube[i][0][l], n = tube[i][1][l];
                tube[i][0][l] = a * m + b * n;
                tube[i][1][l] = c * m + d * n;
            }
        }
    }

  private:
    /// Forward and backward substitution.
    template <int L>
    TACTR_ANY void eliminated(R (&x)[4][L]) const {
        for (int r = 1; r < 4; ++r)
            for (int k = 0; k < r; ++k) {
                const R f = lu[r][k];
                for (int l = 0; l < L; ++l) x[r][l] -= f * x[k][l];
            }
        for (int r = 3; r >= 0; --r) {
            for (int k = r + 1; k < 4; ++k) {
                const R f = lu[r][k];
                for (int l = 0; l < L; ++l) x[r][l] -= f * x[k][l];
            }
            const R f = pivot[r];
            for (int l = 0; l < L; ++l) x[r][l] *= f;
        }
    }

    /// Gaussian elimination without pivoting: the matrix is positive definite up to strains of the order 1e-4.
    TACTR_ANY MaskOf<R> eliminate(R A[4][4]) {
        MaskOf<R> regular = true;
        for (int k = 0; k < 4; ++k) {
            regular = regular & (A[k][k] > 0.0);
            if (none(regular)) return regular;
            pivot[k] = 1.0 / A[k][k];
            for (int r = k + 1; r < 4; ++r) {
                const R f = A[r][k] * pivot[k];
                lu[r][k] = f;
                for (int c = k + 1; c < 4; ++c) A[r][c] -= f * A[k][c];
            }
            for (int c = k; c < 4; ++c) lu[k][c] = A[k][c];
        }
        return regular;
    }
};
using SectionFactor = SectionFactorOf<double>;

/// With parameters and strains held fixed in R_b, only psi moves a tube's N and M. They turn with it:
/// d(N, M)/dpsi = e3 x (N, M) - K (e3 x (v, u)).
template <class R>
TACTR_ANY inline void turning_rates(const TubeTangentOf<R>& K, const R N[3], const R M[3], const StrainsOf<R>& e, int slot, R rate[6]) {
    const R f = 1.0 + e.eta[slot];
    const R vx = -f * e.wy, vy = f * e.wx, ux = -e.ky, uy = e.kx;
    rate[0] = -N[1] - (K.vv[0] * vx + K.vv[1] * vy + K.vu[0][0] * ux + K.vu[0][1] * uy);
    rate[1] = N[0] - (K.vv[1] * vx + K.vv[3] * vy + K.vu[1][0] * ux + K.vu[1][1] * uy);
    rate[2] = -(K.vv[2] * vx + K.vv[4] * vy + K.vu[2][0] * ux + K.vu[2][1] * uy);
    rate[3] = -M[1] - (K.vu[0][0] * vx + K.vu[1][0] * vy + K.uu[0] * ux + K.uu[1] * uy);
    rate[4] = M[0] - (K.vu[0][1] * vx + K.vu[1][1] * vy + K.uu[1] * ux + K.uu[3] * uy);
    rate[5] = -(K.vu[0][2] * vx + K.vu[1][2] * vy + K.uu[2] * ux + K.uu[4] * uy);
}

/// Change of a tendon's |q| with a change of the strains, its tangent held.
template <class R>
TACTR_ANY inline R stretching(const TendonTangentOf<R>& tendon, const StrainsOf<R>& e, int slot, const R& kx, const R& ky,
                              const R& wx, const R& wy, const R& twist, const R& stretch) {
    const R f = 1.0 + e.eta[slot];
    const R x = f * wx + e.wx * stretch - twist * tendon.y;
    const R y = f * wy + e.wy * stretch + twist * tendon.x;
    const R z = stretch + kx * tendon.y - ky * tendon.x;
    return tendon.t[0] * x + tendon.t[1] * y + tendon.t[2] * z;
}

}  // namespace tactr
