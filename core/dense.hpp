// Small dense linear systems.
#pragma once
#include <cmath>
#include <utility>

namespace tactr {

/// Solves A x = b in place by Gaussian elimination with partial pivoting; returns the determinant (0: singular). A: rows, as
/// far apart in memory as the stride.
inline double solve_dense(int n, double* A, int stride, double* b) {
    const auto row = [=](int r) { return A + static_cast<long>(r) * stride; };
    double determinant = 1.0;
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int r = k + 1; r < n; ++r)
            if (std::fabs(row(r)[k]) > std::fabs(row(best)[k])) best = r;
        if (!(std::fabs(row(best)[k]) > 1e-300)) return 0.0;
        if (best != k) {
            for (int c = 0; c < n; ++c) std::swap(row(k)[c], row(best)[c]);
            std::swap(b[k], b[best]);
            determinant = -determinant;
        }
        determinant *= row(k)[k];
        for (int r = k + 1; r < n; ++r) {
            const double f = row(r)[k] / row(k)[k];
            if (f == 0.0) continue;
            for (int c = k; c < n; ++c) row(r)[c] -= f * row(k)[c];
            b[r] -= f * b[k];
        }
    }
    for (int r = n - 1; r >= 0; --r) {
        for (int c = r + 1; c < n; ++c) b[r] -= row(r)[c] * b[c];
        b[r] /= row(r)[r];
    }
    return determinant;
}

template <int N>
inline double solve_dense(int n, double (&A)[N][N], double (&b)[N]) {
    return solve_dense(n, &A[0][0], N, b);
}

/// The inverse of A by Gauss-Jordan elimination with partial pivoting; returns the determinant (0: singular).
template <int N>
inline double invert(int n, const double (&A)[N][N], double (&inverse)[N][N]) {
    double work[N][N], determinant = 1.0;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) {
            work[r][c] = A[r][c];
            inverse[r][c] = r == c;
        }
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int r = k + 1; r < n; ++r)
            if (std::fabs(work[r][k]) > std::fabs(work[best][k])) best = r;
        if (!(std::fabs(work[best][k]) > 1e-300)) return 0.0;
        if (best != k) {
            for (int c = 0; c < n; ++c) {
                std::swap(work[k][c], work[best][c]);
                std::swap(inverse[k][c], inverse[best][c]);
            }
            determinant = -determinant;
        }
        determinant *= work[k][k];
        const double pivot = 1.0 / work[k][k];
        for (int c = 0; c < n; ++c) {
            work[k][c] *= pivot;
            inverse[k][c] *= pivot;
        }
        for (int r = 0; r < n; ++r) {
            const double f = work[r][k];
            if (r == k || f == 0.0) continue;
            for (int c = 0; c < n; ++c) {
                work[r][c] -= f * work[k][c];
                inverse[r][c] -= f * inverse[k][c];
            }
        }
    }
    return determinant;
}

/// How many eigenvalues of A have a negative real part, n at most: the trace of sign(A) is the number of those with a
/// positive one less the number of those with a negative one. sign(A) by Newton's iteration X <- (X + X^-1)/2 with
/// scaling by the determinant (Higham, Functions of Matrices, section 5.5).
template <int N>
inline int eigenvalues_left(int n, double (&A)[N][N]) {
    double trace = n;
    for (int iteration = 0; iteration < 60; ++iteration) {
        double inverse[N][N], change = 0.0;
        const double determinant = std::fabs(invert(n, A, inverse));
        if (!(determinant > 0.0) || !std::isfinite(determinant)) break;
        const double scale = iteration < 8 ? std::pow(determinant, -1.0 / n) : 1.0;
        trace = 0.0;
        for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c) {
                const double next = 0.5 * (scale * A[r][c] + inverse[r][c] / scale);
                change = std::fmax(change, std::fabs(next - A[r][c]));
                A[r][c] = next;
                if (r == c) trace += next;
            }
        if (change < 1e-6) break;
    }
    const double count = std::round(0.5 * (n - trace));
    return count > 0.0 ? (count < n ? static_cast<int>(count) : n) : 0;
}

/// Right singular vectors of A, as the columns of V: the eigenvectors of its Gram matrix by Jacobi's cyclic rotations.
template <int N>
inline void right_singular_vectors(int n, const double (&A)[N][N], double (&V)[N][N]) {
    double S[N][N];
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) {
            S[r][c] = 0.0;
            for (int k = 0; k < n; ++k) S[r][c] += A[k][r] * A[k][c];
            V[r][c] = r == c;
        }
    for (int sweep = 0; sweep < 12; ++sweep)
        for (int p = 0; p < n; ++p)
            for (int q = p + 1; q < n; ++q) {
                const double angle = 0.5 * std::atan2(2.0 * S[p][q], S[q][q] - S[p][p]);
                const double c = std::cos(angle), s = std::sin(angle);
                for (int k = 0; k < n; ++k) {
                    const double a = S[k][p], b = S[k][q], v = V[k][p], w = V[k][q];
                    S[k][p] = c * a - s * b;
                    S[k][q] = s * a + c * b;
                    V[k][p] = c * v - s * w;
                    V[k][q] = s * v + c * w;
                }
                for (int k = 0; k < n; ++k) {
                    const double a = S[p][k], b = S[q][k];
                    S[p][k] = c * a - s * b;
                    S[q][k] = s * a + c * b;
                }
            }
}

}  // namespace tactr
