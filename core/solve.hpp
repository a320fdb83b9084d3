// Solves one robot at one actuation: Newton from a guess or from the straight robot, continuation where that fails.
#pragma once
#include <vector>

#include "solution.hpp"
#include "stability_report.hpp"

namespace tactr {

/// guess: a neighbouring solution, or null.
void solve(const Robot& robot, const Actuation<double>& actuation, const Settings& settings, const Solution* guess,
           Solution& solution);

/// All equilibria that a search over the free-end unknowns finds, stable ones first, then by energy.
std::vector<Solution> branches(const Robot& robot, const Actuation<double>& actuation, const Settings& given, int samples,
                               const Solution& blank);

/// Stability of a solution at its own actuation. False: its Jacobi field was not found.
bool stability_of(const Robot& robot, const Solution& solution, int samples, StabilityReport& report);

}  // namespace tactr
