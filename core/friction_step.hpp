// One step of a way with friction of tendons: the next equilibrium, whether it may be reached in one, and what it costs.
#pragma once
#include <vector>

#include "tendon_friction.hpp"

namespace tactr {

/// Of a step that may be made shorter.
struct StepLimits {
    double missed;  // of log tension, of its history
    double turn;    // of the free end, rad
};

/// By channel: heat, J, and creep, m, as friction_heat and friction_creep give them.
struct FrictionSpent {
    std::vector<double> heat, creep;
};

/// Whether it is, as long as tensions stay; found out once. Where it is not known, it is not.
bool is_stable(const FrictionSettled& settled);

/// From an equilibrium, past: those before it, the latest first. limits: none where a step must be taken as it is. False: not
/// found, beyond the limits, or no longer stable.
bool friction_step(FrictionRounds& rounds, const std::vector<FrictionChannel>& channels, const FrictionSettled& near,
                   const std::vector<const FrictionSettled*>& past, const Settings& settings, const Solution& blank,
                   const StepLimits* limits, FrictionSettled& out, FrictionSpent& spent);

}  // namespace tactr
