// Shape, tensions along the tendons and wrap angles that go together, from given profiles before.
#pragma once
#include <cmath>
#include <optional>
#include <vector>

#include "friction_history.hpp"
#include "friction_settled.hpp"

namespace tactr {

/// A step is given up where it misses more of its history since the equilibrium near by: see missed_of_history.
struct HistoryLimit {
    const FrictionSettled* near = nullptr;  // none: no limit
    double most = 0.0;                      // of log tension
};

/// A round: profiles from the wraps by the friction step, the shape at these profiles, the wraps in that shape. The map from
/// wraps to wraps contracts by about the friction angle; Anderson's mixing (1965) of the last rounds, those of the step
/// before among them, makes it converge in a few. Wraps are mixed as numbers: rises at points and jumps at joints. The free
/// end is found in the same rounds, mixed with them: each is one march, and the last has measured what is left of both.
class FrictionRounds {
  public:
    RobotTables<double> robot;  // with the profiles of the round
    std::vector<std::optional<FrictionProfile>> profiles;
    double missed = 0.0;
    double history_missed = 0.0;  // by the step, where there is a limit to it
    int rounds = 0;

    /// plain: without profiles of friction; old: log tension before, none where there was no tension; at: what the actuators
    /// pass on; precision: rad, to which shapes are found.
    FrictionRounds(const RobotTables<double>& plain, const std::vector<FrictionChannel>& channels,
                   std::vector<std::optional<Curve>> old, std::vector<double> at, const std::vector<double>& translation, double precision);

    /// From the wraps in a shape without friction. False: it cannot be sampled.
    bool start(const Solution& solution);

    /// From those of the equilibrium before, carried on from those before it, the latest first, as far back as they lie on one
    /// straight way.
    void start(const FrictionSettled& near, const std::vector<const FrictionSettled*>& past);

    const std::vector<double>& place() const { return at_; }

    /// Profiles at tensions at the base (tendons,).
    void profile(const std::vector<double>& tension);

    /// The wraps in the shape of the round. False: it cannot be sampled. shaped: the robot, maybe with more loads.
    bool measure(const RobotTables<double>& shaped, const Solution& solution);

    /// Wraps to go on with; and tensions, from those of this round and those to go on with (all over the scale).
    void mix_pulls(std::vector<double>& tension, const std::vector<double>& next);

    /// Rounds at the tensions of the blank solution, the first of them without solving for the shape anew: the free end follows
    /// by the neighbour's derivatives. False: not found, or beyond the limit.
    bool run(const Settings& settings, const Solution& blank, const Solution& guess, const HistoryLimit& limit, FrictionSettled& out);

    /// What was found; the rounds are over.
    void settle(RobotTables<double>&& shaped, Solution&& solution, FrictionSettled& out);

    /// Rates of a robot (still: of nothing) as the tension of channel c grows by 1 N: of what follows the base, or of all.
    RobotTables<double> rates(const RobotTables<double>& still, size_t channel, double tension, bool all) const;

  private:
    const RobotTables<double>& plain_;
    const std::vector<FrictionChannel>& channels_;
    const std::vector<std::optional<Curve>> old_;
    const std::vector<double> at_, translation_;
    const double precision_;
    std::vector<char> left_;  // by channel, whether its old profile was found beyond the cone in any round
    std::vector<std::vector<double>> joints_, last_edges_;  // last_edges_: of the profiles of the round before
    std::vector<Wrap> wraps_, after_;      // of this round, and in its shape
    std::vector<double> own_, given_;      // both as numbers
    std::optional<FreeEnd<double>> ahead_;  // where the free end goes on to
    std::vector<double> step_;              // that the last march says is left for it
    double first_missed_ = 0.0;  // by the first round, of the step before until there is one
    double section_tolerance_ = SECTION_TOLERANCE;  // of the last round
    double mesh_error_ = INFINITY;          // of the last march's mesh, m, where it is known without derivatives
    std::vector<double> last_missed_, last_given_;
    std::vector<RoundsPair> pairs_;

    /// Wraps in a shape at the round's profiles, without solving for it, and how far its free end is from the solution: in one
    /// march, after one with derivatives where it starts from a neighbour. False: that is too far.
    bool glance(NewtonSolver& newton, const Solution* from, Solution& near);

    double section_tolerance(double still_missed) const;
    static bool lead(NewtonSolver& newton, const Solution& from, const FreeEnd<double>* ahead, Solution& near);

    /// Wraps to go on with, and others from those of this round and those to go on with.
    void mix(std::vector<double>& others, const std::vector<double>& next);

    bool read(const RobotTables<double>& shaped, const Solution& solution, std::vector<Wrap>& wraps) const;
    bool compare();
    void cut_alike();
    void numbers_of(const std::vector<Wrap>& wraps, std::vector<double>& out) const;
    void add(const std::vector<double>& numbers, std::vector<Wrap>& wraps) const;
};

}  // namespace tactr
