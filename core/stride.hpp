// When Newton is not to be followed, far from a solution, and where to go instead.
#pragma once

namespace tactr {

/// Newton's steps go uphill in energy where a stable equilibrium lies the other way. Turning the free ends against what
/// they miss the base goes downhill.
struct Stride {
    static constexpr double LENGTH = 0.5;  // rad
    static constexpr double LIKELY = 4.0;  // rad, of Newton's step: beyond, its derivatives are all but singular
    static constexpr int MOST = 12;
};

}  // namespace tactr
