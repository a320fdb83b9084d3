// One equilibrium with friction of tendons, and what a step between two of them costs.
#pragma once
#include <optional>
#include <vector>

#include "friction_project.hpp"
#include "robot_tables.hpp"
#include "solution.hpp"

namespace tactr {

/// One pair of Anderson's mixing: by how much what two rounds missed, and what they gave, differ.
struct RoundsPair {
    std::vector<double> missed, given;
};

/// One equilibrium with friction: the robot with its profiles, by channel (none where slack), and the wraps in its shape.
struct FrictionSettled {
    RobotTables<double> robot;
    Solution solution;
    std::vector<std::optional<FrictionProfile>> profiles;
    std::vector<Wrap> wraps;
    double missed = 0.0;  // rad, by how much wraps and profiles disagree
    double first_missed = 0.0;  // by the first of the rounds
    int rounds = 0;
    std::vector<RoundsPair> pairs;  // of the last rounds
    std::vector<double> at;         // all that its actuators pass on, to tell ways by
    mutable std::optional<bool> stable;  // where it was asked for
    mutable double proven = 0.0;         // determinant of d(base)/d(free end) where that was found out last, stable ever since
};

/// Of one step, by channel: heat, J, and the largest slip where the tendon counts as stuck, m. The tendon's end does not
/// slip; a place slips by what the path beyond it has become shorter. Friction is the fall of tension along the tendon: its
/// mean over the step where it points the same way before and after, otherwise that after, for it turns round before there
/// is slip.
void friction_heat(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const FrictionSettled& after,
                   std::vector<double>& heat, std::vector<double>& creep);

}  // namespace tactr
