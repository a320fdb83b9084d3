#include "solve.hpp"

#include "branches.hpp"
#include "continuation.hpp"
#include "newton.hpp"

namespace tactr {

namespace {

bool converge_cold(NewtonSolver& newton, Solution& solution) {
    newton.start_straight(solution);
    if (newton.shooting.world) {
        newton.stand_up(solution);
    } else {
        newton.choose_mesh_and_wind(solution);
    }
    if (newton.polish(solution)) return true;
    solution.used_continuation = true;
    const double missed = solution.base_residual;
    Continuation continuation(newton, solution);
    if (continuation.reach()) {
        newton.choose_mesh(solution);
        return newton.polish(solution);
    }
    solution.base_residual = missed;  // not that of the last point on the way
    // a tendon at the centre of curvature stops the curve short
    if (solution.shortest_tendon < 0.1) solution.status = Status::no_equilibrium;
    return false;
}

constexpr int MOST_NEARBY = 12;  // iterations on a neighbour's branch: where more are needed, it is none

void solve_cold(NewtonSolver& newton, Solution& solution) {
    if (converge_cold(newton, solution)) settle(newton, solution);
}

/// From a neighbour's free end alone, where the robot is now cut into other sections: a tube's end has passed another's.
/// The free end goes on smoothly there, only the mesh does not fit.
bool carry_over(NewtonSolver& newton, const Solution& guess, Solution& solution) {
    if (guess.status != Status::converged || guess.mesh.unknowns != newton.shooting.unknowns ||
        static_cast<int>(guess.rotation.size()) != newton.robot.tube_count)
        return false;
    solution.free_end = guess.free_end;
    newton.choose_mesh(solution);
    return newton.polish(solution);
}

}  // namespace

void solve(const Robot& robot, const Actuation<double>& actuation, const Settings& given, const Solution* guess,
                  Solution& solution) {
    Settings settings = given;
    if (guess && given.stay) settings.max_iterations = MOST_NEARBY;
    NewtonSolver newton(robot, actuation, settings);
    if (guess && ((newton.start_from(*guess, solution) && newton.polish(solution, NewtonSolver::Kind::draft)) ||
                  carry_over(newton, *guess, solution)))
        return;
    if (guess && settings.stay) {
        solution.status = Status::stalled;
        return;
    }
    solve_cold(newton, solution);
}

std::vector<Solution> branches(const Robot& robot, const Actuation<double>& actuation, const Settings& given, int samples,
                                      const Solution& blank) {
    NewtonSolver cold(robot, actuation, given);
    Solution first = blank;
    const bool converged = converge_cold(cold, first);
    Settings settings = given;
    settings.max_iterations = 25;
    settings.max_steps = MOST_OF_ONE_START;
    NewtonSolver newton(robot, actuation, settings);
    if (!converged) {
        newton.start_straight(first);
        newton.choose_mesh(first);
    }
    const Solution like = first;
    BranchFinder finder(newton, like);
    if (converged) finder.keep(first);
    if (newton.shooting.unknowns > 0) finder.search(samples);
    finder.sort();
    return finder.found;
}

bool stability_of(const Robot& robot, const Solution& solution, int samples, StabilityReport& report) {
    const Layout<double> layout = cut_into_sections(robot, solution.translation.data());
    const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    const Shooting shooting(robot, layout);
    return StabilityPass(robot, actuation, layout, shooting).run(solution, samples, report);
}

}  // namespace tactr
