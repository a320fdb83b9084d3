#include "solve.hpp"

#include <algorithm>
#include <utility>

#include "branches.hpp"
#include "continuation.hpp"
#include "growth.hpp"
#include "newton.hpp"

namespace tactr {

namespace {

/// Steps marched by each way from cold: about a second at most. More tubes make dearer steps.
long most_steps_of(const Robot& robot) { return Settings{}.max_steps / (1 + robot.tube_count); }

bool converge_straight(NewtonSolver& newton, Solution& solution) {
    newton.start_straight(solution);
    if (newton.shooting.world) {
        newton.stand_up(solution);
    } else {
        newton.choose_mesh_and_wind(solution);
        newton.strides = Stride::MOST;
    }
    const bool found = newton.polish(solution);
    newton.strides = 0;
    return found;
}

bool converge_growing(NewtonSolver& newton, Solution& solution) {
    if (!Growth(newton, solution).reach()) return false;
    if (newton.settings.fixed_steps > 0) newton.choose_mesh(solution);
    return newton.polish(solution);
}

bool converge_continued(NewtonSolver& newton, Solution& solution) {
    if (!Continuation(newton, solution).reach()) return false;
    newton.choose_mesh(solution);
    return newton.polish(solution);
}

constexpr double MOST_AMPLIFIED = 1e6;  // by a part of the robot; by the whole of it, what rounding is to the free end matters

/// By each way in turn, until one leads to a solution; each has its own bound on the steps marched.
bool converge_cold(NewtonSolver& newton, Solution& solution) {
    if (converge_straight(newton, solution)) return true;
    const double missed = solution.base_residual, shortest = solution.shortest_tendon;
    for (const auto way : {converge_growing, converge_continued}) {
        if (solution.steps_marched >= newton.settings.most_work) break;
        const long before = std::exchange(solution.steps_marched, 0);
        solution.used_continuation = true;
        solution.shortest_tendon = shortest;  // not that of what another way tried
        const bool found = way(newton, solution);
        solution.steps_marched += before;
        if (found) return true;
    }
    solution.base_residual = missed;  // not that of the last point on the way
    // a tendon at the centre of curvature stops the curve short
    if (solution.shortest_tendon < 0.1) solution.status = Status::no_equilibrium;
    if (solution.amplification > MOST_AMPLIFIED) solution.status = Status::too_sensitive;
    return false;
}

constexpr int MOST_NEARBY = 12;  // iterations on a neighbour's branch: where more are needed, it is none

void solve_cold(NewtonSolver& newton, Solution& solution) {
    converge_cold(newton, solution);
    Settler(newton, solution).settle();
}

/// From a neighbour's free end alone.
bool converge_near(NewtonSolver& newton, const Solution& guess, Solution& solution) {
    if (!newton.is_neighbour(guess)) return false;
    solution.free_end = guess.free_end;
    newton.choose_mesh(solution);
    return newton.polish(solution);
}

/// From a neighbour, on its branch.
bool converge_from(NewtonSolver& newton, const Solution& guess, Solution& solution) {
    const bool began = newton.start_from(guess, solution) || newton.carry_over(guess, solution);
    return (began && newton.polish(solution, NewtonSolver::Kind::draft)) || converge_near(newton, guess, solution);
}

}  // namespace

void solve(const Robot& robot, const Actuation<double>& actuation, const Settings& given, const Solution* guess,
                  Solution& solution) {
    Settings settings = given;
    settings.max_steps = std::min(most_steps_of(robot), given.most_work);
    if (guess && given.stay) settings.max_iterations = MOST_NEARBY;
    NewtonSolver newton(robot, actuation, settings);
    const bool near = guess && converge_from(newton, *guess, solution);
    if (!near && guess && settings.stay) {
        solution.status = Status::stalled;
        return;
    }
    if (!near) solve_cold(newton, solution);
    newton.note_edges(solution);
}

std::vector<Solution> branches(const Robot& robot, const Actuation<double>& actuation, const Settings& given, int samples,
                                      const Solution& blank) {
    NewtonSolver cold(robot, actuation, given);
    Solution first = blank;
    const bool converged = converge_cold(cold, first);
    NewtonSolver newton(robot, actuation, settings_of_one_start(given));
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
