// By how much log tension comes out different where it is moved onto the cone at places on the way, too.
#pragma once
#include <vector>

#include "friction_settled.hpp"

namespace tactr {

/// What one step from an equilibrium misses. The cone between the ends is estimated from curvatures of the tendons' paths and
/// tensions at the base that change linearly. Of a lone tube that may say too much: curvatures change as the tensions there do,
/// which wait until a front comes by. Where it matters they are followed in this way. Several tubes twist each other, which
/// changes curvature elsewhere: tensions at the place then say too little.
class FrictionHistory {
  public:
    static constexpr int LOOKS = 65;  // places along a tendon
    using Places = double[LOOKS];

    /// Of a tendon's path at places alike: its bend, and kinks since the place before, times the coefficient, by axis.
    struct Course {
        Places bend[3], kink[3];
        bool kinked = false;

        explicit Course(const Wrap& wrap);
    };

    struct Start {
        Course course;
        Places y;           // log tension
        double base, end;   // s of the tube's proximal end, and the tendon's end from there
        double tension;     // at the base
    };

    FrictionHistory(const std::vector<FrictionChannel>& channels, const FrictionSettled& before);

    /// Of log tension, the largest of all channels. wraps, tension (tendons,): after the step. enough: what is more is looked
    /// at closer.
    double missed(const std::vector<Wrap>& wraps, const std::vector<double>& tension, double enough) const;

  private:
    const std::vector<FrictionChannel>& channels_;
    const bool local_;  // one tube: its curvature follows the tensions at its place
    std::vector<Start> starts_;
};

}  // namespace tactr
