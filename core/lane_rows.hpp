// Rows of numbers by configuration: a pack's stand side by side, and so do those of a graphics processor's threads.
#pragma once
#include "dual.hpp"

namespace tactr {

template <class A>
TACTR_ANY inline void load(const A* from, double& x) { x = *from; }
template <class A>
TACTR_ANY inline void store(double x, A* to) { *to = static_cast<A>(x); }

/// R: what one row gives, one number or a pack. A: how it is stored. base: of the pack or thread; stride: from one row to
/// the next.
template <class R, class A>
struct LaneRows {
    A* base;
    long stride;
    TACTR_ANY R operator[](long row) const {
        R x;
        load(base + row * stride, x);
        return x;
    }
    TACTR_ANY void put(long row, const R& x) const { store(x, base + row * stride); }
};

/// What a configuration is given, what is found of it, and what one march tells the next: only where to start, so that
/// single precision serves.
template <class R>
using LaneNumbers = LaneRows<R, const double>;
template <class R>
using LaneOut = LaneRows<R, double>;
template <class R>
using LaneStore = LaneRows<R, float>;

}  // namespace tactr
