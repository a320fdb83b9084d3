// Dual numbers: a value and K directional derivatives, for exact derivatives of the march. R, the real number, is double,
// or a pack of doubles that go through the same steps side by side (pack.hpp).
#pragma once
#include <cmath>
#include <type_traits>

#include "device.hpp"

namespace tactr {

template <int K, class R = double>
struct Dual {
    R v;
    R d[K];
    Dual() = default;
    TACTR_ANY Dual(const R& value) : v(value) {
        for (int k = 0; k < K; ++k) d[k] = R(0.0);
    }
    template <class N, class = std::enable_if_t<std::is_same_v<N, double> && !std::is_same_v<R, double>>>
    TACTR_ANY Dual(N value) : Dual(R(value)) {}
    TACTR_ANY Dual& operator+=(const Dual& o) {
        v += o.v;
        for (int k = 0; k < K; ++k) d[k] += o.d[k];
        return *this;
    }
    TACTR_ANY Dual& operator-=(const Dual& o) {
        v -= o.v;
        for (int k = 0; k < K; ++k) d[k] -= o.d[k];
        return *this;
    }
    TACTR_ANY Dual& operator+=(const R& o) { v += o; return *this; }
    TACTR_ANY Dual& operator-=(const R& o) { v -= o; return *this; }
    TACTR_ANY Dual& operator*=(const R& o) {
        v *= o;
        for (int k = 0; k < K; ++k) d[k] *= o;
        return *this;
    }
};

/// What comparing two real numbers gives: one truth, or one for each of a pack's.
template <class R>
struct Compared {
    using type = bool;
};
template <class R>
using MaskOf = typename Compared<R>::type;

TACTR_ANY inline bool none(bool mask) { return !mask; }
TACTR_ANY inline bool any(bool mask) { return mask; }
TACTR_ANY inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
TACTR_ANY inline bool is_finite(double x) { return std::isfinite(x); }
TACTR_ANY inline double absolute(double x) { return std::fabs(x); }

/// A real number beside a dual one: it does not decide which overload is meant.
template <class R>
struct Plain {
    using type = R;
};
template <class R>
using PlainOf = typename Plain<R>::type;

/// The real number under a dual one.
template <class T>
struct RealUnder {
    using type = T;
};
template <int K, class R>
struct RealUnder<Dual<K, R>> {
    using type = R;
};
template <class T>
using RealOf = typename RealUnder<T>::type;

template <int K, class R> TACTR_ANY inline Dual<K, R> operator-(const Dual<K, R>& a) {
    Dual<K, R> r;
    r.v = -a.v;
    for (int k = 0; k < K; ++k) r.d[k] = -a.d[k];
    return r;
}
template <int K, class R> TACTR_ANY inline Dual<K, R> operator+(Dual<K, R> a, const Dual<K, R>& b) { a += b; return a; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator-(Dual<K, R> a, const Dual<K, R>& b) { a -= b; return a; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator+(Dual<K, R> a, const PlainOf<R>& b) { a.v += b; return a; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator+(const PlainOf<R>& a, Dual<K, R> b) { b.v += a; return b; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator-(Dual<K, R> a, const PlainOf<R>& b) { a.v -= b; return a; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator-(const PlainOf<R>& a, const Dual<K, R>& b) { return a + (-b); }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator*(Dual<K, R> a, const PlainOf<R>& b) { a *= b; return a; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator*(const PlainOf<R>& a, Dual<K, R> b) { b *= a; return b; }
template <int K, class R> TACTR_ANY inline Dual<K, R> operator*(const Dual<K, R>& a, const Dual<K, R>& b) {
    Dual<K, R> r;
    r.v = a.v * b.v;
    for (int k = 0; k < K; ++k) r.d[k] = a.v * b.d[k] + b.v * a.d[k];
    return r;
}
template <int K, class R> TACTR_ANY inline Dual<K, R> operator/(const Dual<K, R>& a, const Dual<K, R>& b) {
    Dual<K, R> r;
    const R inv = 1.0 / b.v;
    r.v = a.v * inv;
    for (int k = 0; k < K; ++k) r.d[k] = (a.d[k] - r.v * b.d[k]) * inv;
    return r;
}
template <int K, class R> TACTR_ANY inline Dual<K, R> operator/(Dual<K, R> a, const PlainOf<R>& b) { a *= 1.0 / b; return a; }

TACTR_ANY inline double larger(double a, double b) { return a < b ? b : a; }
TACTR_ANY inline double smaller(double a, double b) { return b < a ? b : a; }

/// Whether two numbers move together.
inline bool same_derivatives(double, double) { return true; }
template <int K> inline bool same_derivatives(const Dual<K>& a, const Dual<K>& b) {
    for (int k = 0; k < K; ++k)
        if (std::fabs(a.d[k] - b.d[k]) > 1e-9 * (1.0 + std::fabs(a.d[k]))) return false;
    return true;
}

TACTR_ANY inline double value(double x) { return x; }
template <int K, class R> TACTR_ANY inline R value(const Dual<K, R>& x) { return x.v; }

TACTR_ANY inline double square_root(double x) { return std::sqrt(x); }
template <int K, class R> TACTR_ANY inline Dual<K, R> square_root(const Dual<K, R>& x) {
    Dual<K, R> r;
    r.v = square_root(x.v);
    const R g = 0.5 / r.v;
    for (int k = 0; k < K; ++k) r.d[k] = g * x.d[k];
    return r;
}

/// How angles are brought into [-pi/4, pi/4]: pi/2 in three parts, of which the first two have room for the number of
/// quarter turns, and the terms of the series that are then needed.
template <class R>
struct Reduction;
template <>
struct Reduction<double> {
    static constexpr double HALF_PI_HIGH = 0x1.921fb544p+0, HALF_PI_MIDDLE = 0x1.0b4611a6p-34, HALF_PI_LOW = 0x1.3198a2e037073p-69;
    static constexpr double ROUNDER = 0x1.8p52;  // adding and taking it away rounds to a whole number
    static constexpr double LARGEST = 1e5;       // angle for which this holds
    static constexpr int TERMS = 8;
};

/// Sine and cosine by reduction to [-pi/4, pi/4] and their Taylor series: to 2 units in the last place, the same bits
/// on every machine (the C library's own depend on the processor) and quicker for what the march needs. Here those of
/// the rest of x by quarter turns, and their number.
template <class R>
TACTR_ANY inline void sine_cosine_of_rest(const R& x, R& sine, R& cosine, R& turns) {
    using Of = Reduction<R>;
    constexpr double TWO_OVER_PI = 0.63661977236758134308;
    turns = (x * TWO_OVER_PI + Of::ROUNDER) - Of::ROUNDER;
    const R r = ((x - turns * Of::HALF_PI_HIGH) - turns * Of::HALF_PI_MIDDLE) - turns * Of::HALF_PI_LOW, z = r * r;
    constexpr double S[8] = {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800,
                             -1.0 / 1307674368000, 1.0 / 355687428096000};
    constexpr double C[8] = {-1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600,
                             -1.0 / 87178291200, 1.0 / 20922789888000};
    R p(S[Of::TERMS - 1]), q(C[Of::TERMS - 1]);
    for (int k = Of::TERMS - 2; k >= 0; --k) {
        p = p * z + S[k];
        q = q * z + C[k];
    }
    sine = r + r * z * p;
    cosine = 1.0 + z * q;
}

template <class R>
TACTR_ANY inline void turn_by_quarters(int quarter, const R& sine, const R& cosine, R& s, R& c) {
    s = quarter & 1 ? cosine : sine;
    c = quarter & 1 ? sine : cosine;
    if (quarter & 2) s = -s;
    if ((quarter + 1) & 2) c = -c;
}

TACTR_ANY inline void sine_cosine(double x, double& s, double& c) {
    if (!(std::fabs(x) < Reduction<double>::LARGEST)) {
        s = std::sin(x);
        c = std::cos(x);
        return;
    }
    double sine, cosine, turns;
    sine_cosine_of_rest(x, sine, cosine, turns);
    turn_by_quarters(static_cast<int>(turns) & 3, sine, cosine, s, c);
}
template <int K, class R> TACTR_ANY inline void sine_cosine(const Dual<K, R>& x, Dual<K, R>& s, Dual<K, R>& c) {
    sine_cosine(x.v, s.v, c.v);
    for (int k = 0; k < K; ++k) {
        s.d[k] = c.v * x.d[k];
        c.d[k] = -s.v * x.d[k];
    }
}

TACTR_ANY inline double arc_tangent2(double y, double x) { return std::atan2(y, x); }
template <int K, class R> TACTR_ANY inline Dual<K, R> arc_tangent2(const Dual<K, R>& y, const Dual<K, R>& x) {
    Dual<K, R> r;
    r.v = arc_tangent2(y.v, x.v);
    const R n = 1.0 / (x.v * x.v + y.v * y.v);
    for (int k = 0; k < K; ++k) r.d[k] = (x.v * y.d[k] - y.v * x.d[k]) * n;
    return r;
}

}  // namespace tactr
