// By how much log tension comes out different where it is moved onto the cone at places on the way, too.
#pragma once
#include <vector>

#include "friction_settled.hpp"

namespace tactr {

/// What one step from an equilibrium misses. The cone between the ends is estimated from curvatures of the tendons' paths and
/// tensions at the base that change linearly.
class FrictionHistory {
  public:
    static constexpr int LOOKS = 65;  // places along a tendon

    /// Of a tendon's path at places alike: its bend, and kinks since the place before, times the coefficient, by axis.
    struct Course {
        double bend[3][LOOKS], kink[3][LOOKS];
        bool kinked = false;

        explicit Course(const Wrap& wrap);
    };

    FrictionHistory(const std::vector<FrictionChannel>& channels, const FrictionSettled& before);

    /// Of log tension, the largest of all channels. wraps, tension (tendons,): after the step.
    double missed(const std::vector<Wrap>& wraps, const std::vector<double>& tension) const;

  private:
    struct Start {
        Course course;
        double y[LOOKS];  // log tension
    };
    const std::vector<FrictionChannel>& channels_;
    const std::vector<double>& tension_;
    std::vector<Start> starts_;

    /// from, to: tension at the base before and after.
    static double missed_by(const Start& start, const Course& after, double end, double from, double to);
};

}  // namespace tactr
