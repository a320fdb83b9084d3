// Shape, tensions along the tendons and wrap angles that go together, from given profiles before.
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
    int rounds = 0;
    std::vector<RoundsPair> pairs;  // of the last rounds
};

/// A step is given up where it misses more of its history since the equilibrium near by: see friction_history_missed.
struct HistoryLimit {
    const FrictionSettled* near = nullptr;  // none: no limit
    double most = 0.0;                      // of log tension
};

/// A round: profiles from the wraps by the friction step, the shape at these profiles, the wraps in that shape. The map from
/// wraps to wraps contracts by about the friction angle; Anderson's mixing (1965) of the last rounds, those of the step
/// before among them, makes it converge in a few. Wraps are mixed as numbers: rises at points and jumps at joints.
class FrictionRounds {
  public:
    RobotTables<double> robot;  // with the profiles of the round
    std::vector<std::optional<FrictionProfile>> profiles;
    double missed = 0.0;
    int rounds = 0;

    /// plain: without profiles of friction; old: log tension before, none where there was no tension.
    FrictionRounds(const RobotTables<double>& plain, const std::vector<FrictionChannel>& channels,
                   std::vector<std::optional<Curve>> old, const std::vector<double>& translation);

    /// From the wraps in a shape without friction. False: it cannot be sampled.
    bool start(const Solution& solution);

    /// From those of the equilibrium before, carried on by so much of the way from the one before that; 0: as they are.
    void start(const FrictionSettled& near, const FrictionSettled* before, double ahead);

    /// Profiles at tensions at the base (tendons,).
    void profile(const std::vector<double>& tension);

    /// The wraps in the shape of the round. False: it cannot be sampled. shaped: the robot, maybe with more loads.
    bool measure(const RobotTables<double>& shaped, const Solution& solution);

    /// Wraps to go on with; and tensions, from those of this round and those to go on with (all over the scale).
    void mix(std::vector<double>& tension, const std::vector<double>& next);

    /// Rounds at given tensions, the first of them without solving for the shape anew: the free end follows by the
    /// neighbour's derivatives. False: not found, or beyond the limit.
    bool run(const Actuation<double>& actuation, const Settings& settings, const Solution& blank, const Solution& guess,
             const HistoryLimit& limit, FrictionSettled& out);

    void settle(const RobotTables<double>& shaped, const Solution& solution, FrictionSettled& out) const;

    /// Rates of a robot (still: of nothing) as the tension of channel c grows by 1 N: of what follows the base, or of all.
    RobotTables<double> rates(const RobotTables<double>& still, size_t channel, double tension, bool all) const;

  private:
    const RobotTables<double>& plain_;
    const std::vector<FrictionChannel>& channels_;
    const std::vector<std::optional<Curve>> old_;
    const std::vector<double> translation_;
    std::vector<std::vector<double>> joints_;
    std::vector<Wrap> wraps_, after_;      // of this round, and in its shape
    std::vector<double> own_, given_;      // both as numbers
    std::vector<double> last_missed_, last_given_;
    std::vector<RoundsPair> pairs_;

    /// Wraps in the shape at the round's profiles, without solving for it. rigid: no free end is unknown, only the
    /// discretisation error is; carried: the free end as the derivatives of the solution near by tell it, which is that of
    /// this settling; failed: neither, or too far from it; near is what was found.
    enum class Glance { failed, rigid, carried };
    Glance glance(const Robot& view, const Actuation<double>& actuation, const Settings& settings, const Solution& blank, bool solved,
                  Solution& near);

    bool read(const RobotTables<double>& shaped, const Solution& solution, std::vector<Wrap>& wraps) const;
    bool compare();
    void numbers_of(const std::vector<Wrap>& wraps, std::vector<double>& out) const;
    void add(const std::vector<double>& numbers, std::vector<Wrap>& wraps) const;
};

/// Of one step, by channel: heat, J, and the largest slip where the tendon counts as stuck, m. The tendon's end does not
/// slip; a place slips by what the path beyond it has become shorter. Friction is the fall of tension along the tendon: its
/// mean over the step where it points the same way before and after, otherwise that after, for it turns round before there
/// is slip.
void friction_heat(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const FrictionSettled& after,
                   std::vector<double>& heat, std::vector<double>& creep);

/// By how much log tension comes out different where it is moved onto the cone at places on the way, too; the largest of all
/// channels. The cone between the ends is estimated from curvatures of the tendons' paths and tensions at the base that
/// change linearly. wraps, tension (tendons,): after the step.
double friction_history_missed(const std::vector<FrictionChannel>& channels, const FrictionSettled& before,
                               const std::vector<Wrap>& wraps, const std::vector<double>& tension);

}  // namespace tactr
