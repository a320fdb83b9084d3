// A real number of single precision, which is enough to come near a solution: twice as many go side by side. Unlike a float
// it does not become a double where it meets one, so that one alone comes to the same bits as one of a pack.
#pragma once
#include <cmath>

#include "dual.hpp"

namespace tactr {

struct RoughReal {
    float v;
    RoughReal() = default;
    TACTR_ANY RoughReal(double x) : v(static_cast<float>(x)) {}
    TACTR_ANY static RoughReal of(float x) {
        RoughReal r;
        r.v = x;
        return r;
    }
    TACTR_ANY RoughReal& operator+=(const RoughReal& o) { v += o.v; return *this; }
    TACTR_ANY RoughReal& operator-=(const RoughReal& o) { v -= o.v; return *this; }
    TACTR_ANY RoughReal& operator*=(const RoughReal& o) { v *= o.v; return *this; }
    TACTR_ANY friend RoughReal operator+(const RoughReal& a, const RoughReal& b) { return of(a.v + b.v); }
    TACTR_ANY friend RoughReal operator-(const RoughReal& a, const RoughReal& b) { return of(a.v - b.v); }
    TACTR_ANY friend RoughReal operator*(const RoughReal& a, const RoughReal& b) { return of(a.v * b.v); }
    TACTR_ANY friend RoughReal operator/(const RoughReal& a, const RoughReal& b) { return of(a.v / b.v); }
    TACTR_ANY friend RoughReal operator-(const RoughReal& a) { return of(-a.v); }
    TACTR_ANY friend bool operator<(const RoughReal& a, const RoughReal& b) { return a.v < b.v; }
    TACTR_ANY friend bool operator<=(const RoughReal& a, const RoughReal& b) { return a.v <= b.v; }
    TACTR_ANY friend bool operator>(const RoughReal& a, const RoughReal& b) { return a.v > b.v; }
    TACTR_ANY friend bool operator>=(const RoughReal& a, const RoughReal& b) { return a.v >= b.v; }
};

TACTR_ANY inline RoughReal select(bool mask, const RoughReal& yes, const RoughReal& no) { return mask ? yes : no; }
TACTR_ANY inline RoughReal value(const RoughReal& x) { return x; }
TACTR_ANY inline RoughReal absolute(const RoughReal& x) { return RoughReal::of(std::fabs(x.v)); }
TACTR_ANY inline RoughReal larger(const RoughReal& a, const RoughReal& b) { return a < b ? b : a; }
TACTR_ANY inline RoughReal smaller(const RoughReal& a, const RoughReal& b) { return b < a ? b : a; }
TACTR_ANY inline bool is_finite(const RoughReal& x) { return std::isfinite(x.v); }
TACTR_ANY inline RoughReal square_root(const RoughReal& x) { return RoughReal::of(std::sqrt(x.v)); }

TACTR_ANY inline void load(const float* from, RoughReal& x) { x.v = *from; }
TACTR_ANY inline void load(const double* from, RoughReal& x) { x.v = static_cast<float>(*from); }
TACTR_ANY inline void store(const RoughReal& x, float* to) { *to = x.v; }
TACTR_ANY inline void store(const RoughReal& x, double* to) { *to = x.v; }

/// As for doubles; beyond the angles for which single precision serves, NaN.
template <>
struct Reduction<RoughReal> {
    static constexpr double HALF_PI_HIGH = 0x1.92p+0, HALF_PI_MIDDLE = 0x1.fbp-12, HALF_PI_LOW = 0x1.5110b4p-22;
    static constexpr double ROUNDER = 0x1.8p23, LARGEST = 1e3;
    static constexpr int TERMS = 4;
};

TACTR_ANY inline void sine_cosine(const RoughReal& x, RoughReal& s, RoughReal& c) {
    if (!(std::fabs(x.v) < Reduction<RoughReal>::LARGEST)) {
        s.v = c.v = NAN;
        return;
    }
    RoughReal sine, cosine, turns;
    sine_cosine_of_rest(x, sine, cosine, turns);
    turn_by_quarters(static_cast<int>(turns.v) & 3, sine, cosine, s, c);
}

}  // namespace tactr
