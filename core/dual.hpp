// Dual numbers: a value and K directional derivatives, for exact derivatives of the march.
#pragma once
#include <cmath>

namespace tactr {

template <int K>
struct Dual {
    double v;
    double d[K];
    Dual() = default;
    Dual(double value) : v(value) {
        for (int k = 0; k < K; ++k) d[k] = 0.0;
    }
    Dual& operator+=(const Dual& o) {
        v += o.v;
        for (int k = 0; k < K; ++k) d[k] += o.d[k];
        return *this;
    }
    Dual& operator-=(const Dual& o) {
        v -= o.v;
        for (int k = 0; k < K; ++k) d[k] -= o.d[k];
        return *this;
    }
    Dual& operator+=(double o) { v += o; return *this; }
    Dual& operator-=(double o) { v -= o; return *this; }
    Dual& operator*=(double o) {
        v *= o;
        for (int k = 0; k < K; ++k) d[k] *= o;
        return *this;
    }
};

template <int K> inline Dual<K> operator-(const Dual<K>& a) {
    Dual<K> r;
    r.v = -a.v;
    for (int k = 0; k < K; ++k) r.d[k] = -a.d[k];
    return r;
}
template <int K> inline Dual<K> operator+(Dual<K> a, const Dual<K>& b) { a += b; return a; }
template <int K> inline Dual<K> operator-(Dual<K> a, const Dual<K>& b) { a -= b; return a; }
template <int K> inline Dual<K> operator+(Dual<K> a, double b) { a.v += b; return a; }
template <int K> inline Dual<K> operator+(double a, Dual<K> b) { b.v += a; return b; }
template <int K> inline Dual<K> operator-(Dual<K> a, double b) { a.v -= b; return a; }
template <int K> inline Dual<K> operator-(double a, const Dual<K>& b) { return a + (-b); }
template <int K> inline Dual<K> operator*(Dual<K> a, double b) { a *= b; return a; }
template <int K> inline Dual<K> operator*(double a, Dual<K> b) { b *= a; return b; }
template <int K> inline Dual<K> operator*(const Dual<K>& a, const Dual<K>& b) {
    Dual<K> r;
    r.v = a.v * b.v;
    for (int k = 0; k < K; ++k) r.d[k] = a.v * b.d[k] + b.v * a.d[k];
    return r;
}
template <int K> inline Dual<K> operator/(const Dual<K>& a, const Dual<K>& b) {
    Dual<K> r;
    const double inv = 1.0 / b.v;
    r.v = a.v * inv;
    for (int k = 0; k < K; ++k) r.d[k] = (a.d[k] - r.v * b.d[k]) * inv;
    return r;
}
template <int K> inline Dual<K> operator/(Dual<K> a, double b) { a *= 1.0 / b; return a; }

inline double larger(double a, double b) { return a < b ? b : a; }
inline double smaller(double a, double b) { return b < a ? b : a; }

/// Whether two numbers move together.
inline bool same_derivatives(double, double) { return true; }
template <int K> inline bool same_derivatives(const Dual<K>& a, const Dual<K>& b) {
    for (int k = 0; k < K; ++k)
        if (std::fabs(a.d[k] - b.d[k]) > 1e-9 * (1.0 + std::fabs(a.d[k]))) return false;
    return true;
}

inline double value(double x) { return x; }
template <int K> inline double value(const Dual<K>& x) { return x.v; }

inline double square_root(double x) { return std::sqrt(x); }
template <int K> inline Dual<K> square_root(const Dual<K>& x) {
    Dual<K> r;
    r.v = std::sqrt(x.v);
    const double g = 0.5 / r.v;
    for (int k = 0; k < K; ++k) r.d[k] = g * x.d[k];
    return r;
}

/// Sine and cosine by reduction to [-pi/4, pi/4] and their Taylor series: to 2 units in the last place, the same bits
/// on every machine (the C library's own depend on the processor) and quicker for what the march needs.
inline void sine_cosine(double x, double& s, double& c) {
    constexpr double TWO_OVER_PI = 0.63661977236758134308, LARGEST = 1e5;
    constexpr double HALF_PI_HIGH = 0x1.921fb544p+0, HALF_PI_MIDDLE = 0x1.0b4611a6p-34, HALF_PI_LOW = 0x1.3198a2e037073p-69;
    constexpr double ROUNDER = 0x1.8p52;  // adding and taking it away rounds to a whole number
    if (!(std::fabs(x) < LARGEST)) {
        s = std::sin(x);
        c = std::cos(x);
        return;
    }
    const double shifted = x * TWO_OVER_PI + ROUNDER, turns = shifted - ROUNDER;
    const double r = ((x - turns * HALF_PI_HIGH) - turns * HALF_PI_MIDDLE) - turns * HALF_PI_LOW, z = r * r;
    constexpr double S[8] = {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800,
                             -1.0 / 1307674368000, 1.0 / 355687428096000};
    constexpr double C[8] = {-1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600,
                             -1.0 / 87178291200, 1.0 / 20922789888000};
    double p = S[7], q = C[7];
    for (int k = 6; k >= 0; --k) {
        p = p * z + S[k];
        q = q * z + C[k];
    }
    const double sine = r + r * z * p, cosine = 1.0 + z * q;
    const int quarter = static_cast<int>(turns) & 3;
    s = quarter & 1 ? cosine : sine;
    c = quarter & 1 ? sine : cosine;
    if (quarter & 2) s = -s;
    if ((quarter + 1) & 2) c = -c;
}
template <int K> inline void sine_cosine(const Dual<K>& x, Dual<K>& s, Dual<K>& c) {
    sine_cosine(x.v, s.v, c.v);
    for (int k = 0; k < K; ++k) {
        s.d[k] = c.v * x.d[k];
        c.d[k] = -s.v * x.d[k];
    }
}

inline double arc_tangent2(double y, double x) { return std::atan2(y, x); }
template <int K> inline Dual<K> arc_tangent2(const Dual<K>& y, const Dual<K>& x) {
    Dual<K> r;
    r.v = std::atan2(y.v, x.v);
    const double n = 1.0 / (x.v * x.v + y.v * y.v);
    for (int k = 0; k < K; ++k) r.d[k] = (x.v * y.d[k] - y.v * x.d[k]) * n;
    return r;
}

}  // namespace tactr
