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

inline void sine_cosine(double x, double& s, double& c) {
    s = std::sin(x);
    c = std::cos(x);
}
template <int K> inline void sine_cosine(const Dual<K>& x, Dual<K>& s, Dual<K>& c) {
    s.v = std::sin(x.v);
    c.v = std::cos(x.v);
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
