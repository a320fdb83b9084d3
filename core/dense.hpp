// Small dense linear systems.
#pragma once
#include <cmath>
#include <utility>

namespace tactr {

/// Solves A x = b in place by Gaussian elimination with partial pivoting; returns the determinant (0: singular).
template <int N>
inline double solve_dense(int n, double (&A)[N][N], double (&b)[N]) {
    double determinant = 1.0;
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int r = k + 1; r < n; ++r)
            if (std::fabs(A[r][k]) > std::fabs(A[best][k])) best = r;
        if (!(std::fabs(A[best][k]) > 1e-300)) return 0.0;
        if (best != k) {
            for (int c = 0; c < n; ++c) std::swap(A[k][c], A[best][c]);
            std::swap(b[k], b[best]);
            determinant = -determinant;
        }
        determinant *= A[k][k];
        for (int r = k + 1; r < n; ++r) {
            const double f = A[r][k] / A[k][k];
            if (f == 0.0) continue;
            for (int c = k; c < n; ++c) A[r][c] -= f * A[k][c];
            b[r] -= f * b[k];
        }
    }
    for (int r = n - 1; r >= 0; --r) {
        for (int c = r + 1; c < n; ++c) b[r] -= A[r][c] * b[c];
        b[r] /= A[r][r];
    }
    return determinant;
}

}  // namespace tactr
