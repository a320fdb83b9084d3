// A pack of numbers that go through the same steps side by side: every operation acts on each of them alone, so that what
// one comes to does not depend on its neighbours. Of doubles there are four, of single precision eight.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "dual.hpp"
#include "rough_real.hpp"

namespace tactr {

constexpr int PACK_BYTES = 32;

/// Whole numbers as wide as E, for truths.
template <class E>
using TruthOf = std::conditional_t<sizeof(E) == 8, std::int64_t, std::int32_t>;

#if defined(__GNUC__)
template <class E, int COUNT>
struct VectorOf {
    typedef E type __attribute__((vector_size(sizeof(E) * COUNT)));
};
template <class To, class From>
inline To converted(const From& x) { return __builtin_convertvector(x, To); }
template <class Reals, class E>
inline Reals spread(E x) { return x - Reals{}; }
#else
/// The same operations where the compiler has no vectors.
template <class E, int COUNT>
struct Elements {
    E e[COUNT];
    E& operator[](int i) { return e[i]; }
    const E& operator[](int i) const { return e[i]; }
#define TACTR_ELEMENTWISE(RESULT, OP, TO)                                 \
    friend RESULT operator OP(const Elements& a, const Elements& b) {     \
        RESULT r;                                                         \
        for (int i = 0; i < COUNT; ++i) r[i] = TO(a[i] OP b[i]);          \
        return r;                                                         \
    }
#define TACTR_TRUTH(x) ((x) ? -1 : 0)
    using Truths = Elements<TruthOf<E>, COUNT>;
    TACTR_ELEMENTWISE(Elements, +, )
    TACTR_ELEMENTWISE(Elements, -, )
    TACTR_ELEMENTWISE(Elements, *, )
    TACTR_ELEMENTWISE(Elements, /, )
    TACTR_ELEMENTWISE(Truths, <, TACTR_TRUTH)
    TACTR_ELEMENTWISE(Truths, <=, TACTR_TRUTH)
    TACTR_ELEMENTWISE(Truths, >, TACTR_TRUTH)
    TACTR_ELEMENTWISE(Truths, >=, TACTR_TRUTH)
#undef TACTR_ELEMENTWISE
#undef TACTR_TRUTH
    friend Elements operator-(Elements a) {
        for (int i = 0; i < COUNT; ++i) a[i] = -a[i];
        return a;
    }
    friend Elements operator&(Elements a, const Elements& b) {
        for (int i = 0; i < COUNT; ++i) a[i] = static_cast<E>(static_cast<TruthOf<E>>(a[i]) & static_cast<TruthOf<E>>(b[i]));
        return a;
    }
    friend Elements operator|(Elements a, const Elements& b) {
        for (int i = 0; i < COUNT; ++i) a[i] = static_cast<E>(static_cast<TruthOf<E>>(a[i]) | static_cast<TruthOf<E>>(b[i]));
        return a;
    }
    friend Elements operator~(Elements a) {
        for (int i = 0; i < COUNT; ++i) a[i] = static_cast<E>(~static_cast<TruthOf<E>>(a[i]));
        return a;
    }
};
template <class E, int COUNT>
struct VectorOf {
    using type = Elements<E, COUNT>;
};
template <class To, class From, int COUNT>
inline Elements<To, COUNT> each_converted(const Elements<From, COUNT>& x) {
    Elements<To, COUNT> r;
    for (int i = 0; i < COUNT; ++i) r[i] = static_cast<To>(x[i]);
    return r;
}
template <class To, class From>
inline To converted(const From& x) { return each_converted<std::decay_t<decltype(To{}[0])>>(x); }
template <class Reals, class E>
inline Reals spread(E x) {
    Reals r;
    for (E& element : r.e) element = x;
    return r;
}
#endif

/// One truth for each number of a pack of E.
template <class E>
struct MaskOfPack {
    static constexpr int COUNT = PACK_BYTES / sizeof(E);
    using Truths = typename VectorOf<TruthOf<E>, COUNT>::type;
    Truths v;
    MaskOfPack() = default;
    MaskOfPack(bool all) : v{} {
        if (all) v = ~v;
    }
    explicit MaskOfPack(const Truths& truths) : v(truths) {}
    friend MaskOfPack operator&(const MaskOfPack& a, const MaskOfPack& b) { return MaskOfPack(a.v & b.v); }
    friend MaskOfPack operator|(const MaskOfPack& a, const MaskOfPack& b) { return MaskOfPack(a.v | b.v); }
    friend MaskOfPack operator!(const MaskOfPack& a) { return MaskOfPack(~a.v); }
};

template <class E>
inline bool any(const MaskOfPack<E>& m) {
    std::int64_t found[PACK_BYTES / 8];
    std::memcpy(found, &m.v, PACK_BYTES);
    return (found[0] | found[1] | found[2] | found[3]) != 0;
}
template <class E>
inline bool none(const MaskOfPack<E>& m) { return !any(m); }

template <class E>
struct PackOf {
    static constexpr int COUNT = PACK_BYTES / sizeof(E);
    using Reals = typename VectorOf<E, COUNT>::type;
    using Mask = MaskOfPack<E>;
    Reals v;
    PackOf() = default;
    PackOf(double x) : v(spread<Reals>(static_cast<E>(x))) {}
    explicit PackOf(const Reals& x) : v(x) {}
    PackOf& operator+=(const PackOf& o) { v = v + o.v; return *this; }
    PackOf& operator-=(const PackOf& o) { v = v - o.v; return *this; }
    PackOf& operator*=(const PackOf& o) { v = v * o.v; return *this; }
    friend PackOf operator+(const PackOf& a, const PackOf& b) { return PackOf(a.v + b.v); }
    friend PackOf operator-(const PackOf& a, const PackOf& b) { return PackOf(a.v - b.v); }
    friend PackOf operator*(const PackOf& a, const PackOf& b) { return PackOf(a.v * b.v); }
    friend PackOf operator/(const PackOf& a, const PackOf& b) { return PackOf(a.v / b.v); }
    friend PackOf operator-(const PackOf& a) { return PackOf(-a.v); }
    friend Mask operator<(const PackOf& a, const PackOf& b) { return Mask(a.v < b.v); }
    friend Mask operator<=(const PackOf& a, const PackOf& b) { return Mask(a.v <= b.v); }
    friend Mask operator>(const PackOf& a, const PackOf& b) { return Mask(a.v > b.v); }
    friend Mask operator>=(const PackOf& a, const PackOf& b) { return Mask(a.v >= b.v); }

    friend PackOf select(const Mask& mask, const PackOf& yes, const PackOf& no) {
#if defined(__GNUC__)
        return PackOf(mask.v ? yes.v : no.v);
#else
        PackOf r;
        for (int i = 0; i < COUNT; ++i) r.v[i] = mask.v[i] ? yes.v[i] : no.v[i];
        return r;
#endif
    }
    friend PackOf value(const PackOf& x) { return x; }
    friend PackOf absolute(const PackOf& x) { return select(x < 0.0, -x, x); }
    friend PackOf larger(const PackOf& a, const PackOf& b) { return select(a < b, b, a); }
    friend PackOf smaller(const PackOf& a, const PackOf& b) { return select(b < a, b, a); }
    friend Mask is_finite(const PackOf& x) { return x - x <= 0.0; }
    friend PackOf square_root(const PackOf& x) {
        PackOf r;
        for (int i = 0; i < COUNT; ++i) r.v[i] = std::sqrt(x.v[i]);
        return r;
    }

    /// Rows of numbers in either precision.
    template <class A>
    friend void load(const A* from, PackOf& x) {
        typename VectorOf<A, COUNT>::type loaded;
        std::memcpy(&loaded, from, sizeof loaded);
        x.v = converted<Reals>(loaded);
    }
    template <class A>
    friend void store(const PackOf& x, A* to) {
        const auto stored = converted<typename VectorOf<A, COUNT>::type>(x.v);
        std::memcpy(to, &stored, sizeof stored);
    }
};

using Pack = PackOf<double>;
using RoughPack = PackOf<float>;

template <class E>
struct Compared<PackOf<E>> {
    using type = MaskOfPack<E>;
};

template <>
struct Reduction<Pack> : Reduction<double> {};
template <>
struct Reduction<RoughPack> : Reduction<RoughReal> {};

/// As for one number; of angles beyond the reduction's range NaN, which no check lets pass.
template <class E>
inline void sine_cosine(const PackOf<E>& x, PackOf<E>& s, PackOf<E>& c) {
    using P = PackOf<E>;
    using Of = Reduction<P>;
    P sine, cosine, turns;
    sine_cosine_of_rest(x, sine, cosine, turns);
    // quarter turns from 0 to 3: turns - 4 floor(turns / 4), by the same trick of rounding
    const P fours = (turns * 0.25 - 0.375 + Of::ROUNDER) - Of::ROUNDER, quarter = turns - fours * 4.0;
    const auto odd = (quarter > 0.5) & ((quarter < 1.5) | (quarter > 2.5)), back = quarter > 1.5, left = (quarter > 0.5) & (quarter < 2.5);
    s = select(odd, cosine, sine);
    c = select(odd, sine, cosine);
    s = select(back, -s, s);
    c = select(left, -c, c);
    const auto near = absolute(x) < Of::LARGEST;
    s = select(near, s, NAN);
    c = select(near, c, NAN);
}

}  // namespace tactr
