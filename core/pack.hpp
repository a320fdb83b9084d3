// A pack of doubles that go through the same steps side by side: every operation acts on each of them alone, so that what
// one comes to does not depend on its neighbours.
#pragma once
#include "dual.hpp"

namespace tactr {

constexpr int PACKED = 4;

#if defined(__GNUC__)
using PackedReals = double __attribute__((vector_size(8 * PACKED)));
using PackedTruths = long long __attribute__((vector_size(8 * PACKED)));
#else
/// The same operations where the compiler has no vectors.
template <class E>
struct Elements {
    E e[PACKED];
    E& operator[](int i) { return e[i]; }
    const E& operator[](int i) const { return e[i]; }
};
using PackedReals = Elements<double>;
using PackedTruths = Elements<long long>;
#define TACTR_ELEMENTWISE(RESULT, OP, TO)                                       \
    inline RESULT operator OP(const PackedReals& a, const PackedReals& b) {     \
        RESULT r;                                                               \
        for (int i = 0; i < PACKED; ++i) r[i] = TO(a[i] OP b[i]);               \
        return r;                                                               \
    }
#define TACTR_TRUTH(x) ((x) ? -1LL : 0LL)
TACTR_ELEMENTWISE(PackedReals, +, )
TACTR_ELEMENTWISE(PackedReals, -, )
TACTR_ELEMENTWISE(PackedReals, *, )
TACTR_ELEMENTWISE(PackedReals, /, )
TACTR_ELEMENTWISE(PackedTruths, <, TACTR_TRUTH)
TACTR_ELEMENTWISE(PackedTruths, <=, TACTR_TRUTH)
TACTR_ELEMENTWISE(PackedTruths, >, TACTR_TRUTH)
TACTR_ELEMENTWISE(PackedTruths, >=, TACTR_TRUTH)
#undef TACTR_ELEMENTWISE
#undef TACTR_TRUTH
inline PackedReals operator-(const PackedReals& a) {
    PackedReals r;
    for (int i = 0; i < PACKED; ++i) r[i] = -a[i];
    return r;
}
#define TACTR_ELEMENTWISE(OP)                                                    \
    inline PackedTruths operator OP(const PackedTruths& a, const PackedTruths& b) { \
        PackedTruths r;                                                          \
        for (int i = 0; i < PACKED; ++i) r[i] = a[i] OP b[i];                    \
        return r;                                                                \
    }
TACTR_ELEMENTWISE(&)
TACTR_ELEMENTWISE(|)
#undef TACTR_ELEMENTWISE
inline PackedTruths operator~(const PackedTruths& a) {
    PackedTruths r;
    for (int i = 0; i < PACKED; ++i) r[i] = ~a[i];
    return r;
}
#endif

/// One truth for each number of a pack.
struct Mask {
    PackedTruths v;
    Mask() = default;
    Mask(bool all) : v{} {
        if (all) v = ~v;
    }
    explicit Mask(const PackedTruths& truths) : v(truths) {}
    friend Mask operator&(const Mask& a, const Mask& b) { return Mask(a.v & b.v); }
    friend Mask operator|(const Mask& a, const Mask& b) { return Mask(a.v | b.v); }
    friend Mask operator!(const Mask& a) { return Mask(~a.v); }
};

inline bool any(const Mask& m) {
    long long found = 0;
    for (int i = 0; i < PACKED; ++i) found |= m.v[i];
    return found != 0;
}
inline bool none(const Mask& m) { return !any(m); }

struct Pack {
    PackedReals v;
    Pack() = default;
    Pack(double x) : v{x, x, x, x} {}
    explicit Pack(const PackedReals& x) : v(x) {}
    Pack& operator+=(const Pack& o) { v = v + o.v; return *this; }
    Pack& operator-=(const Pack& o) { v = v - o.v; return *this; }
    Pack& operator*=(const Pack& o) { v = v * o.v; return *this; }
    friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.v + b.v); }
    friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.v - b.v); }
    friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.v * b.v); }
    friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }
    friend Pack operator-(const Pack& a) { return Pack(-a.v); }
    friend Mask operator<(const Pack& a, const Pack& b) { return Mask(a.v < b.v); }
    friend Mask operator<=(const Pack& a, const Pack& b) { return Mask(a.v <= b.v); }
    friend Mask operator>(const Pack& a, const Pack& b) { return Mask(a.v > b.v); }
    friend Mask operator>=(const Pack& a, const Pack& b) { return Mask(a.v >= b.v); }
};

template <>
struct Compared<Pack> {
    using type = Mask;
};

inline Pack select(const Mask& mask, const Pack& yes, const Pack& no) {
#if defined(__GNUC__)
    return Pack(mask.v ? yes.v : no.v);
#else
    Pack r;
    for (int i = 0; i < PACKED; ++i) r.v[i] = mask.v[i] ? yes.v[i] : no.v[i];
    return r;
#endif
}

inline Pack value(const Pack& x) { return x; }
inline Pack absolute(const Pack& x) { return select(x < 0.0, -x, x); }
inline Pack larger(const Pack& a, const Pack& b) { return select(a < b, b, a); }
inline Pack smaller(const Pack& a, const Pack& b) { return select(b < a, b, a); }
inline Mask is_finite(const Pack& x) { return absolute(x) <= 1.7976931348623157e308; }

inline Pack square_root(const Pack& x) {
    Pack r;
    for (int i = 0; i < PACKED; ++i) r.v[i] = std::sqrt(x.v[i]);
    return r;
}

/// As for doubles; of angles beyond the reduction's range NaN, which no check lets pass.
inline void sine_cosine(const Pack& x, Pack& s, Pack& c) {
    Pack sine, cosine, shifted;
    sine_cosine_of_rest(x, sine, cosine, shifted);
    const Pack turns = shifted - 0x1.8p52;
    // quarter turns from 0 to 3: turns - 4 floor(turns / 4), by the same trick of rounding
    const Pack fours = (turns * 0.25 - 0.375 + 0x1.8p52) - 0x1.8p52, quarter = turns - fours * 4.0;
    const Mask odd = (quarter > 0.5) & ((quarter < 1.5) | (quarter > 2.5)), back = quarter > 1.5, left = (quarter > 0.5) & (quarter < 2.5);
    s = select(odd, cosine, sine);
    c = select(odd, sine, cosine);
    s = select(back, -s, s);
    c = select(left, -c, c);
    const Mask near = absolute(x) < LARGEST_ANGLE;
    s = select(near, s, 0.0 / Pack(0.0));
    c = select(near, c, 0.0 / Pack(0.0));
}

}  // namespace tactr
