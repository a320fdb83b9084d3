#include "friction_step.hpp"

#include "free_end.hpp"
#include "solve.hpp"
#include "starts.hpp"

namespace tactr {

bool is_stable(const FrictionSettled& settled) {
    if (!settled.stable) {
        StabilityReport report;
        settled.stable = stability_of(settled.robot.view(), settled.solution, 0, report) && report.stable;
        settled.proven = settled.solution.base_determinant;
    }
    return *settled.stable;
}

namespace {

void stay_stable(const FrictionSettled& near, const FrictionSettled& next) {
    constexpr double LEAST = 0.1, CHANGE = 2.0;
    if (next.stable || !near.stable || !*near.stable) return;
    if (!is_still_stable(next.solution.base_determinant, near.proven, LEAST, CHANGE)) return;
    next.stable = true;
    next.proven = near.proven;
}

bool goes_on(const FrictionSettled& near, const FrictionSettled& next, double turn) {
    stay_stable(near, next);
    return free_end_distance(near.robot.view(), near.solution, next.solution) <= turn && (is_stable(next) || !is_stable(near));
}

}  // namespace

bool friction_step(FrictionRounds& rounds, const std::vector<FrictionChannel>& channels, const FrictionSettled& near,
                   const std::vector<const FrictionSettled*>& past, const Settings& settings, const Solution& blank,
                   const StepLimits* limits, FrictionSettled& out, FrictionSpent& spent) {
    rounds.start(near, past);
    const HistoryLimit history{limits ? &near : nullptr, limits ? limits->missed : 0.0};
    if (!rounds.run(settings, blank, near.solution, history, out)) return false;
    if (limits && !goes_on(near, out, limits->turn)) {
        rounds.history_missed = 0.0;
        return false;
    }
    friction_heat(channels, near, out, spent.heat);
    friction_creep(channels, near, out, spent.creep);
    return true;
}

}  // namespace tactr
