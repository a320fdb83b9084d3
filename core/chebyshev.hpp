// Functions of arc length, piece by piece polynomials through Chebyshev's points of the first kind: none of these lies at
// an end, where strains may jump.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "robot.hpp"

namespace tactr {

constexpr int CURVE_POINTS = MAX_TENSION_COEFFICIENTS;  // and coefficients, of one piece
using PointValues = std::array<double, CURVE_POINTS>;   // values at the points, or coefficients

/// From values at the points of [-1, 1] to what is wanted of them.
class ChebyshevRules {
  public:
    using Matrix = std::array<PointValues, CURVE_POINTS>;
    PointValues point, weight;          // ascending; of the integral over [-1, 1]
    PointValues first{}, last{};        // of the value at -1 and at 1
    Matrix fit, slope, integral, upto;  // to coefficients, slopes at the points, coefficients and values of the integral from -1
    Matrix powers;                      // from coefficients to those of powers of (x + 1) / 2

    static const ChebyshevRules& get() {
        static const ChebyshevRules rules;
        return rules;
    }

    static PointValues times(const Matrix& matrix, const PointValues& v) {
        PointValues out{};
        for (int i = 0; i < N; ++i)
            for (int j = 0; j < N; ++j) out[i] += matrix[i][j] * v[j];
        return out;
    }

  private:
    static constexpr int N = CURVE_POINTS;

    ChebyshevRules() {
        const double pi = std::acos(-1.0);
        double T[N][N + 1], U[N][N];  // of every point: T_k, and T_k' = k U_{k-1}
        for (int p = 0; p < N; ++p) {
            point[p] = -std::cos(pi * (p + 0.5) / N);
            for (int k = 0; k <= N; ++k) T[p][k] = k == 0 ? 1.0 : k == 1 ? point[p] : 2.0 * point[p] * T[p][k - 1] - T[p][k - 2];
            for (int k = 0; k < N; ++k) U[p][k] = k == 0 ? 1.0 : k == 1 ? 2.0 * point[p] : 2.0 * point[p] * U[p][k - 1] - U[p][k - 2];
        }
        for (int k = 0; k < N; ++k)
            for (int p = 0; p < N; ++p) fit[k][p] = (k == 0 ? 1.0 : 2.0) / N * T[p][k];
        weight = PointValues{};
        for (int p = 0; p < N; ++p) {
            for (int k = 0; k < N; ++k) {
                first[p] += (k % 2 == 0 ? 1.0 : -1.0) * fit[k][p];
                last[p] += fit[k][p];
            }
            for (int k = 0; k < N; k += 2) weight[p] += 2.0 / (1.0 - k * k) * fit[k][p];
            for (int q = 0; q < N; ++q) {
                slope[q][p] = 0.0;
                for (int k = 1; k < N; ++k) slope[q][p] += k * U[q][k - 1] * fit[k][p];
            }
            double rise[N + 1] = {};
            for (int k = 1; k <= N; ++k)
                rise[k] = ((k == 1 ? 2.0 : 1.0) * fit[k - 1][p] - (k + 1 < N ? fit[k + 1][p] : 0.0)) / (2.0 * k);
            for (int k = 1; k <= N; ++k) rise[0] -= (k % 2 == 0 ? 1.0 : -1.0) * rise[k];
            for (int k = 0; k < N; ++k) integral[k][p] = rise[k];
            for (int q = 0; q < N; ++q) {
                upto[q][p] = 0.0;
                for (int k = 0; k <= N; ++k) upto[q][p] += rise[k] * T[q][k];
            }
        }
        powers = Matrix{};
        powers[0][0] = 1.0;
        powers[0][1] = -1.0;
        powers[1][1] = 2.0;
        for (int k = 2; k < N; ++k)
            for (int i = 0; i < N; ++i)
                powers[i][k] = (i > 0 ? 4.0 * powers[i - 1][k - 1] : 0.0) - 2.0 * powers[i][k - 1] - powers[i][k - 2];
    }
};

inline PointValues points_between(double start, double end) {
    PointValues out;
    const auto& point = ChebyshevRules::get().point;
    for (int p = 0; p < CURVE_POINTS; ++p) out[p] = 0.5 * (start + end) + 0.5 * (end - start) * point[p];
    return out;
}

/// Coefficients at x in [-1, 1], by Clenshaw's rule.
inline double chebyshev_at(const PointValues& c, double x) {
    x = std::min(std::max(x, -1.0), 1.0);
    double b1 = 0.0, b2 = 0.0;
    for (int k = CURVE_POINTS - 1; k > 0; --k) {
        const double b = (c[k] - b2) + 2.0 * x * b1;
        b2 = b1;
        b1 = b;
    }
    return (c[0] - b2) + x * b1;
}

/// The same at many x, side by side; out may be x.
inline void chebyshev_at(const PointValues& c, const double* x, size_t count, double* out) {
    constexpr size_t WIDTH = 8;
    for (size_t first = 0; first < count; first += WIDTH) {
        double at[WIDTH], b1[WIDTH] = {}, b2[WIDTH] = {};
        for (size_t i = 0; i < WIDTH; ++i) at[i] = std::min(std::max(x[std::min(first + i, count - 1)], -1.0), 1.0);
        for (int k = CURVE_POINTS - 1; k > 0; --k)
            for (size_t i = 0; i < WIDTH; ++i) {
                const double b = (c[k] - b2[i]) + 2.0 * at[i] * b1[i];
                b2[i] = b1[i];
                b1[i] = b;
            }
        for (size_t i = 0; i < WIDTH && first + i < count; ++i) out[first + i] = (c[0] - b2[i]) + at[i] * b1[i];
    }
}

/// Smooth between its edges (one more than pieces, ascending), where it may jump.
struct Curve {
    std::vector<double> edges;
    std::vector<PointValues> coefficients;

    /// The piece that holds sigma; at an edge, the distal one.
    int piece(double sigma) const {
        const auto found = std::upper_bound(edges.begin(), edges.end(), sigma) - edges.begin() - 1;
        return static_cast<int>(std::clamp<long>(found, 0, static_cast<long>(coefficients.size()) - 1));
    }

    double on(int k, double sigma) const {
        return chebyshev_at(coefficients[k], (2.0 * sigma - (edges[k] + edges[k + 1])) / (edges[k + 1] - edges[k]));
    }

    double at(double sigma) const { return on(piece(sigma), sigma); }

    template <size_t M>
    std::array<double, M> on(int k, std::array<double, M> sigma) const {
        for (double& x : sigma) x = (2.0 * x - (edges[k] + edges[k + 1])) / (edges[k + 1] - edges[k]);
        chebyshev_at(coefficients[k], sigma.data(), M, sigma.data());
        return sigma;
    }

    /// At ascending places.
    PointValues at(PointValues sigma) const {
        const int first = piece(sigma.front());
        if (first == piece(sigma.back())) return on(first, sigma);
        for (double& x : sigma) x = at(x);
        return sigma;
    }

    /// Whether a piece is the same all along.
    bool is_even(int k) const {
        for (int i = 1; i < CURVE_POINTS; ++i)
            if (coefficients[k][i] != 0.0) return false;
        return true;
    }

    static Curve constant(double value, double end) {
        Curve curve{{0.0, end}, {PointValues{}}};
        curve.coefficients[0][0] = value;
        return curve;
    }
};

constexpr double EDGE_GAP = 1e-9;  // m; edges nearer to each other are one

/// Ascending; the end stays the end.
inline std::vector<double> merged(std::vector<double> all) {
    std::sort(all.begin(), all.end());
    std::vector<double> kept;
    for (size_t i = 0; i < all.size(); ++i)
        if (i == 0 || all[i] - all[i - 1] > EDGE_GAP) kept.push_back(all[i]);
    if (kept.back() != all.back()) kept.push_back(all.back());
    if (kept.size() > 2 && kept.back() - kept[kept.size() - 2] <= EDGE_GAP) kept.erase(kept.end() - 2);
    return kept;
}

/// Appends those strictly between 0 and the end.
inline void add_inner(const std::vector<double>& places, double end, std::vector<double>& out) {
    for (double place : places)
        if (place > EDGE_GAP && place < end - EDGE_GAP) out.push_back(place);
}

}  // namespace tactr
