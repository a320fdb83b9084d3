// Solves one robot at one actuation: Newton from a guess or from the straight robot, continuation where that fails.
#pragma once
#include "continuation.hpp"
#include "newton.hpp"
#include "solution.hpp"

namespace tactr {

inline void solve_cold(NewtonSolver& newton, Solution& solution) {
    newton.start_straight(solution);
    if (newton.shooting.world) {
        newton.stand_up(solution);
    } else {
        newton.choose_mesh_and_wind(solution);
    }
    if (newton.polish(solution)) return;
    solution.used_continuation = true;
    const double missed = solution.base_residual;
    Continuation continuation(newton, solution);
    if (continuation.reach()) {
        newton.choose_mesh(solution);
        newton.polish(solution);
    } else {
        solution.base_residual = missed;  // not that of the last point on the way
        // a tendon at the centre of curvature stops the curve short
        if (solution.shortest_tendon < 0.1) solution.status = Status::no_equilibrium;
    }
}

/// guess: a neighbouring solution, or null.
inline void solve(const Robot& robot, const Actuation<double>& actuation, const Settings& settings, const Solution* guess,
                  Solution& solution) {
    NewtonSolver newton(robot, actuation, settings);
    if (guess && newton.start_from(*guess, solution) && newton.polish(solution, NewtonSolver::Kind::draft)) return;
    solve_cold(newton, solution);
}

}  // namespace tactr
