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
    /// By channel and watched place: length of the path from there on when the tendon last slid there, or where slip began to
    /// be watched, m; empty: not yet.
    std::vector<std::vector<double>> length_when_slid;
};

/// Of one step, by channel, J. The tendon's end does not slip; a place slips by what the path beyond it has become shorter.
/// Friction is the fall of tension along the tendon, of which its mean over the step goes with that slip, to second order also
/// where fronts come by: those come by their places at all times of the step. But where the tendon has begun to slide, the path
/// changes after the front has come by, and before that by all places nearer to the base: where friction there has turned
/// round, it is that after.
void friction_heat(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const FrictionSettled& after,
                   std::vector<double>& heat);

/// Where slip is watched: on disks, or evenly along a channel, ascending; not where there is no friction.
std::vector<double> watched_places(const FrictionChannel& channel);

/// By channel, m: the largest slip that has come together at a watched place since the tendon last slid there. after gets to
/// know where that was.
void friction_creep(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, FrictionSettled& after,
                    std::vector<double>& creep);

}  // namespace tactr
