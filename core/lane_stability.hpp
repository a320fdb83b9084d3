// Whether conjugate points can have been passed (conjugate.hpp), as a cheap test that errs on the safe side: where the
// Jacobi field changes little from one step to the next, none has; elsewhere a closer look has to decide. Angles count from
// the first tube, whichever is the last: that changes D by a constant factor, and D_k+1 D_k^-1 to a similar matrix.
#pragma once
#include "dual.hpp"
#include "lane_plan.hpp"
#include "states.hpp"

namespace tactr {

/// Eliminates without pivoting, for all configurations alike: A becomes its factors; returns the determinant.
template <class R, int N>
TACTR_ANY inline R factor_lanes(int n, R (&A)[N][N]) {
    R determinant(1.0);
    for (int k = 0; k < n; ++k) {
        determinant *= A[k][k];
        const R inverse = 1.0 / A[k][k];
        for (int r = k + 1; r < n; ++r) {
            A[r][k] *= inverse;
            for (int c = k + 1; c < n; ++c) A[r][c] -= A[r][k] * A[k][c];
        }
    }
    return determinant;
}

/// Solves with the factors, in place.
template <class R, int N>
TACTR_ANY inline void solve_lanes(int n, const R (&A)[N][N], R* b) {
    for (int r = 1; r < n; ++r)
        for (int c = 0; c < r; ++c) b[r] -= A[r][c] * b[c];
    for (int r = n - 1; r >= 0; --r) {
        for (int c = r + 1; c < n; ++c) b[r] -= A[r][c] * b[c];
        b[r] = b[r] / A[r][r];
    }
}

template <class R>
class LaneStability {
  public:
    static constexpr int N = LANE_UNKNOWNS > 0 ? LANE_UNKNOWNS : 1;

    R farthest = R(0.0);  // |D_k+1 D_k^-1 - I|^2, the largest so far; below 1, no eigenvalue has changed its sign

    /// First at the tip. y holds psi of every tube where the march is, or at its distal end where it is still to come.
    template <class T>
    TACTR_ANY void read(const LanePlan& plan, const T* y) {
        const int n = plan.tubes - 1;
        if (n == 0) return;
        R D[N][N];
        for (int i = 1; i < plan.tubes; ++i)
            for (int l = 0; l < n; ++l) D[i - 1][l] = y[PSI + i].d[l] - y[PSI].d[l];
        if (started_) compare(n, D);
        R factors[N][N];
        for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c) factors[r][c] = D[r][c];
        factor_lanes(n, factors);
        for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c) last_[r][c] = factors[r][c];
        started_ = true;
    }

  private:
    R last_[N][N];  // factors of the last D
    bool started_ = false;

    /// D_k+1 D_k^-1 - I = (D_k+1 - D_k) D_k^-1; row by row, x D_k = d has D_k's transposed factors.
    TACTR_ANY void compare(int n, const R (&D)[N][N]) {
        R away(0.0);
        for (int r = 0; r < n; ++r) {
            R x[N];
            for (int c = 0; c < n; ++c) x[c] = D[r][c];
            // x L U = d: first x' U = d, then x L = x'
            for (int c = 0; c < n; ++c) {
                for (int k = 0; k < c; ++k) x[c] -= x[k] * last_[k][c];
                x[c] = x[c] / last_[c][c];
            }
            for (int c = n - 2; c >= 0; --c)
                for (int k = c + 1; k < n; ++k) x[c] -= x[k] * last_[k][c];
            for (int c = 0; c < n; ++c) {
                const R difference = x[c] - (r == c ? 1.0 : 0.0);
                away += difference * difference;
            }
        }
        farthest = select(is_finite(away), larger(farthest, away), R(HUGE_VAL));
    }
};

}  // namespace tactr
