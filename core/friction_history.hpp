// By how much log tension comes out different where it is moved onto the cone at places on the way, too.
#pragma once
#include <optional>
#include <vector>

#include "friction_settled.hpp"

namespace tactr {

/// What one step from an equilibrium misses of log tension, the largest of all channels. The cone between the ends is estimated
/// from curvatures of the tendons' paths and tensions at the base that change linearly. That may say too much: curvatures change
/// as the tensions there do, which wait until a front comes by. Where it says more than enough they are followed in this way.
/// Places are dense where fronts pass, so that short steep stretches are not missed. wraps, profiles, tension (tendons,): after
/// the step.
double missed_of_history(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const std::vector<Wrap>& wraps,
                         const std::vector<std::optional<FrictionProfile>>& profiles, const std::vector<double>& tension, double enough);

}  // namespace tactr
