// Rows of numbers by configuration: a pack's stand side by side, and so do those of a graphics processor's threads.
#pragma once
#include "dual.hpp"

namespace tactr {

/// base: of the pack or thread; stride: from one row to the next.
template <class R>
struct LaneRows {
    R* base;
    long stride;
    TACTR_ANY R& operator[](long row) const { return base[row * stride]; }
};

}  // namespace tactr
