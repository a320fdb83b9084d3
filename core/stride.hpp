// When Newton is not to be followed, far from a solution, and where to go instead.
#pragma once
#include "dual.hpp"

namespace tactr {

/// Newton's steps go uphill in energy where a stable equilibrium lies the other way. Turning the free ends against what
/// they miss the base goes downhill.
struct Stride {
    static constexpr double LENGTH = 0.5;  // rad
    static constexpr double LIKELY = 4.0;  // rad, of Newton's step: beyond, its derivatives are all but singular
    static constexpr double CLOSE = 1e-2;  // rad, missed: from here Newton squares the residual, wherever it leads
    static constexpr int MOST = 12;

    /// longest and size: largest of step and of missed, each of n.
    template <class R>
    TACTR_ANY static MaskOf<R> is_due(int n, const R* step, const R& longest, const R* missed, const R& size) {
        R ahead(0.0);
        for (int i = 0; i < n; ++i) ahead -= step[i] * missed[i];
        return (size > CLOSE) & ((ahead < 0.0) | (longest > LIKELY));
    }
};

}  // namespace tactr
