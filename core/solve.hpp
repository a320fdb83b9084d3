// Finds the free-end unknowns that meet the base: Newton with exact derivatives, load continuation as the fallback.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "free_end.hpp"
#include "march.hpp"

namespace tactr {

enum class Status { converged = 0, no_equilibrium = 1, stalled = 2, too_coarse = 3, collapsed = 4 };

struct Settings {
    double tolerance = 1e-6;           // discretisation error at the tip, m
    double residual_tolerance = 1e-9;  // rad at the base
    int fixed_steps = 0;               // > 0: steps in every section, without error control
    int max_iterations = 60;           // of one Newton run
    int max_passes = 3000;             // of the whole solve
};

struct Solution {
    Status status = Status::stalled;
    int iterations = 0;  // marches with derivatives
    double base_residual = std::numeric_limits<double>::max();
    double section_residual = std::numeric_limits<double>::max();
    double discretisation_error = std::numeric_limits<double>::max();
    double least_stretch = 1.0;
    double base_determinant = 0.0;  // of d(base)/d(free end)
    bool used_continuation = false;
    double jacobian[MAX_UNKNOWNS][MAX_UNKNOWNS];  // d(base)/d(free end), last computed
    FreeEnd<double> free_end;
    Mesh mesh;
    std::vector<double> tension, rotation, translation, tendon_length;
    double tip_position[3] = {}, tip_quaternion[4] = {1, 0, 0, 0};
};

/// Solves A x = b in place by Gaussian elimination with partial pivoting; returns the determinant (0: singular).
inline double solve_dense(int n, double A[MAX_UNKNOWNS][MAX_UNKNOWNS], double b[MAX_UNKNOWNS]) {
    double determinant = 1.0;
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int r = k + 1; r < n; ++r)
            if (std::fabs(A[r][k]) > std::fabs(A[best][k])) best = r;
        if (!(std::fabs(A[best][k]) > 1e-300)) return 0.0;
        if (best != k) {
            for (int c = 0; c < n; ++c) std::swap(A[k][c], A[best][c]);
            std::swap(b[k], b[best]);
            determinant = -determinant;
        }
        determinant *= A[k][k];
        for (int r = k + 1; r < n; ++r) {
            const double f = A[r][k] / A[k][k];
            if (f == 0.0) continue;
            for (int c = k; c < n; ++c) A[r][c] -= f * A[k][c];
            b[r] -= f * b[k];
        }
    }
    for (int r = n - 1; r >= 0; --r) {
        for (int c = r + 1; c < n; ++c) b[r] -= A[r][c] * b[c];
        b[r] /= A[r][r];
    }
    return determinant;
}

class Solver {
  public:
    Solver(const Robot& robot, const Actuation<double>& actuation, const Settings& settings)
        : robot_(robot), actuation_(actuation), settings_(settings),
          layout_(cut_into_sections(robot, actuation.translation)), shooting_(robot, layout_) {}

    /// From a previous solution: its free end, its mesh.
    void solve_from(const Solution& guess, Solution& solution) {
        solution.free_end = guess.free_end;
        solution.mesh = guess.mesh;
        if (solution.mesh.steps.size() != layout_.sections.size()) solution.mesh.steps.assign(layout_.sections.size(), 1);
        if (solution.mesh.strains.size() != static_cast<size_t>(solution.mesh.total()) * dp8::STAGES) solution.mesh.fit();
        solution.mesh.warm = guess.mesh.warm && guess.mesh.strains.size() == solution.mesh.strains.size();
        marched_ = guess.free_end;
        std::copy(&guess.jacobian[0][0], &guess.jacobian[0][0] + MAX_UNKNOWNS * MAX_UNKNOWNS, &solution.jacobian[0][0]);
        if (shooting_.unknowns > 0 && guess.status == Status::converged) chord_step(solution);
        if (!polish(solution)) solve_cold(solution);
    }

    void solve_cold(Solution& solution) {
        start_straight(solution);
        choose_mesh(solution, shooting_.world);
        if (polish(solution)) return;
        solution.used_continuation = true;
        const Status first = solution.status;
        if (continue_in_scale(solution) && polish(solution)) return;
        if (!shooting_.world && search_angles(solution)) return;
        if (solution.status == Status::converged) solution.status = first;
    }

  private:
    const Robot& robot_;
    Actuation<double> actuation_;
    Settings settings_;
    Layout<double> layout_;
    Shooting shooting_;
    double residual_[MAX_UNKNOWNS];
    FreeEnd<double> marched_;  // free end of the last march that filled the mesh
    bool full_ = false, strict_ = false;  // how the last march was made

    double norm(const double* r) const {
        double worst = 0.0;
        for (int i = 0; i < shooting_.unknowns; ++i) worst = larger(worst, std::fabs(r[i]));
        return worst;
    }

    void start_straight(Solution& solution) const {
        for (int i = 0; i < robot_.tube_count; ++i) solution.free_end.psi[i] = actuation_.rotation[i];
        for (int c = 0; c < 4; ++c) solution.free_end.quaternion[c] = c == 0;
        solution.mesh.steps.assign(layout_.sections.size(), 1);
    }

    static constexpr double MESH_SLACK = 5.0;  // the sum over a section's states overrates its effect on the tip

    /// One plain march chooses the steps; with loads in world axes it also turns the unloaded robot's base upright.
    void choose_mesh(Solution& solution, bool unloaded) {
        Actuation<double> actuation = actuation_;
        if (unloaded) actuation.load_scale = 0.0;
        solution.mesh.steps.assign(layout_.sections.size(), settings_.fixed_steps > 0 ? settings_.fixed_steps : 1);
        March<double, double> march(robot_, layout_, actuation, shooting_.full_options());
        shooting_.scale(march);
        march.error_weight = shooting_.error_weight;
        march.adapt_tolerance = MESH_SLACK * (settings_.fixed_steps > 0 ? 1e300 : settings_.tolerance);
        const bool found = march.run(solution.free_end, solution.mesh);
        if (found && unloaded) shooting_.upright(march.base, actuation_.rotation[0], solution.free_end);
        solution.mesh.fit();
    }

    /// One march with derivatives at the given free end. full: with path and error estimate. strict: every section to
    /// its tolerance.
    bool evaluate(Solution& solution, bool full, bool strict) {
        ++solution.iterations;
        full_ = full;
        strict_ = strict;
        return with_lanes(shooting_.unknowns + (full ? 1 : 0), [&](auto lanes) { return evaluate_lanes<decltype(lanes)::value>(solution, full, strict); });
    }

    void tell_shift(Solution& solution) {
        shooting_.difference(marched_, solution.free_end, solution.mesh.shift);
        marched_ = solution.free_end;
    }

    /// A step with the neighbour's derivatives: one march without any.
    void chord_step(Solution& solution) {
        March<double, double> march(robot_, layout_, actuation_, shooting_.newton_options());
        shooting_.scale(march);
        march.solver.strict = false;
        const FreeEnd<double> from = solution.free_end;
        tell_shift(solution);
        if (!march.run(from, solution.mesh)) return;
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS], step[MAX_UNKNOWNS];
        shooting_.residual(march.base, actuation_.rotation, step);
        for (int i = 0; i < shooting_.unknowns; ++i)
            for (int j = 0; j < shooting_.unknowns; ++j) A[i][j] = solution.jacobian[i][j];
        if (solve_dense(shooting_.unknowns, A, step) == 0.0) return;
        const double longest = norm(step);
        if (longest < LONGEST_CHORD) shooting_.move(from, step, -1.0, solution.free_end);
    }

    static constexpr double LONGEST_CHORD = 0.5;  // rad

    template <int K>
    bool evaluate_lanes(Solution& solution, bool full, bool strict) {
        using T = Dual<K>;
        const MarchOptions options = full ? shooting_.full_options() : shooting_.newton_options();
        March<T, double> march(robot_, layout_, actuation_, options);
        shooting_.scale(march);
        FreeEnd<T> end;
        shooting_.seed(solution.free_end, 0, end);
        if (full) {
            march.error_weight = shooting_.error_weight;
            march.error_lane = shooting_.unknowns;
        }
        march.solver.strict = strict;
        march.slope_lanes = shooting_.unknowns;
        tell_shift(solution);
        if (!march.run(end, solution.mesh)) return false;
        T r[MAX_UNKNOWNS];
        shooting_.residual(march.base, actuation_.rotation, r);
        for (int i = 0; i < shooting_.unknowns; ++i) {
            residual_[i] = r[i].v;
            if (!std::isfinite(r[i].v)) return false;
            for (int j = 0; j < shooting_.unknowns; ++j) {
                solution.jacobian[i][j] = r[i].d[j];
                if (!std::isfinite(r[i].d[j])) return false;
            }
        }
        solution.base_residual = norm(residual_);
        solution.section_residual = march.solver.worst_residual;
        solution.least_stretch = march.solver.least_stretch;
        if (full) read_tip(solution, march, end, r);
        return true;
    }

    template <class M, class T>
    void read_tip(Solution& solution, const M& march, const FreeEnd<T>& end, const T* r) {
        T position[3], quaternion[4];
        shooting_.tip_pose(end, march.base, actuation_.rotation[0], position, quaternion);
        const int e = shooting_.unknowns;
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS], shift[MAX_UNKNOWNS];
        for (int i = 0; i < e; ++i) {
            shift[i] = r[i].d[e];
            for (int j = 0; j < e; ++j) A[i][j] = solution.jacobian[i][j];
        }
        solution.base_determinant = solve_dense(e, A, shift);
        double error = 0.0;
        for (int a = 0; a < 3; ++a) {
            double d = position[a].d[e];
            for (int j = 0; j < e; ++j) d -= position[a].d[j] * shift[j];
            error += d * d;
            solution.tip_position[a] = position[a].v;
        }
        for (int a = 0; a < 4; ++a) solution.tip_quaternion[a] = quaternion[a].v;
        solution.discretisation_error = ERROR_SAFETY * std::sqrt(error);
        section_error_ = march.section_error;
        solution.tendon_length = march.tendon_length;
    }

    static constexpr double ERROR_SAFETY = 2.0;  // the embedded estimate, carried to the tip, underrates the coarsest meshes

    std::vector<double> section_error_;

    /// Newton with backtracking on the largest residual. True: below tolerance, with path and error estimate read.
    bool newton(Solution& solution, double tolerance, bool full_at_end) {
        const bool at_once = full_at_end && shooting_.unknowns == 0;
        if (!evaluate(solution, at_once, at_once)) return fail(solution, Status::no_equilibrium);
        for (int iteration = 0; iteration < settings_.max_iterations; ++iteration) {
            const double size = solution.base_residual;
            if (size <= tolerance) {
                if (!full_at_end || (full_ && strict_)) return true;
                if (!evaluate(solution, true, true)) return fail(solution, Status::no_equilibrium);
                continue;
            }
            if (solution.iterations > settings_.max_passes) break;
            double A[MAX_UNKNOWNS][MAX_UNKNOWNS], step[MAX_UNKNOWNS];
            for (int i = 0; i < shooting_.unknowns; ++i) {
                step[i] = -residual_[i];
                for (int j = 0; j < shooting_.unknowns; ++j) A[i][j] = solution.jacobian[i][j];
            }
            if (solve_dense(shooting_.unknowns, A, step) == 0.0) break;
            if (!backtrack(solution, step, size, full_at_end)) break;
        }
        return fail(solution, Status::stalled);
    }

    static bool fail(Solution& solution, Status status) {
        solution.status = status;
        return false;
    }

    bool backtrack(Solution& solution, double* step, double size, bool full_at_end) {
        constexpr double LONGEST = 1.0;  // rad: beyond, the linear model says nothing
        const FreeEnd<double> from = solution.free_end;
        const double longest = norm(step);
        double fraction = longest > LONGEST ? LONGEST / longest : 1.0;
        for (int attempt = 0; attempt < 10; ++attempt, fraction *= 0.4) {
            shooting_.move(from, step, fraction, solution.free_end);
            const bool near = full_at_end && size < 1e-4 && fraction == 1.0;  // Newton squares it: the last march
            if (evaluate(solution, near, near) && (solution.base_residual < (1.0 - 0.1 * fraction) * size)) return true;
            // at the rounding floor no further decrease can be asked for
            if (size < 10.0 * settings_.residual_tolerance && solution.base_residual <= settings_.residual_tolerance) return true;
        }
        solution.free_end = from;
        return false;
    }

    /// Newton, then finer steps until the discretisation error is below tolerance.
    bool polish(Solution& solution) {
        for (int round = 0; round < 8; ++round) {
            if (!newton(solution, settings_.residual_tolerance, true)) return false;
            if (solution.discretisation_error <= settings_.tolerance || settings_.fixed_steps > 0) {
                if (solution.least_stretch < LEAST_STRETCH) return fail(solution, Status::collapsed);
                solution.status = Status::converged;
                return true;
            }
            if (!refine(solution)) break;
        }
        return fail(solution, Status::too_coarse);
    }

    static constexpr double LEAST_STRETCH = 0.2;  // linear elasticity means nothing at such compression

    /// More steps where the error comes from, as many as an eighth-order rule needs to bring the tip below tolerance.
    bool refine(Solution& solution) {
        double largest = 0.0;
        for (double error : section_error_) largest = larger(largest, error);
        const double ratio = solution.discretisation_error / (0.5 * settings_.tolerance);
        bool finer = false;
        for (size_t k = 0; k < section_error_.size(); ++k) {
            const double excess = ratio * section_error_[k] / largest;
            if (!(excess > 0.5)) continue;
            const double factor = smaller(3.0, std::pow(excess, 0.125));
            const int most = March<double, double>::MAX_STEPS, now = solution.mesh.steps[k];
            const int steps = std::min(most, std::max(now + 1, static_cast<int>(std::ceil(factor * now))));
            finer = finer || steps > now;
            solution.mesh.steps[k] = steps;
        }
        solution.mesh.fit();
        return finer;
    }

    /// Grows rest curvature, tension and loads together from the straight, unloaded robot, whose free end is known.
    bool continue_in_scale(Solution& solution) {
        const Actuation<double> target = actuation_;
        start_straight(solution);
        FreeEnd<double> before = solution.free_end, here = solution.free_end;
        double done = 0.0, previous = 0.0, step = 0.2;
        while (done < 1.0 && step > 1e-4 && solution.iterations < settings_.max_passes) {
            const double next = smaller(1.0, done + step);
            actuation_.shape_scale = target.shape_scale * next;
            actuation_.load_scale = target.load_scale * next;
            if (done > previous)
                shooting_.extrapolate(before, here, (next - done) / (done - previous), solution.free_end);
            choose_mesh(solution, false);
            if (newton(solution, 1e-7, false) && shooting_.distance(here, solution.free_end) < 1.5) {
                before = here;
                here = solution.free_end;
                previous = done;
                done = next;
                step *= 1.7;
            } else {
                step *= 0.4;
                solution.free_end = here;
            }
        }
        actuation_ = target;
        if (done >= 1.0) choose_mesh(solution, false);
        return done >= 1.0;
    }

    /// Starts from angles spread evenly over the torus: without world loads the unknowns are only angles.
    bool search_angles(Solution& solution) {
        constexpr double TURN = 6.283185307179586;
        const int n = robot_.tube_count;
        for (int attempt = 1; attempt <= 64; ++attempt) {
            start_straight(solution);
            double fraction = 0.0;
            for (int i = 1; i < n; ++i) {
                fraction = std::fmod(attempt * std::sqrt(static_cast<double>(2 * i + 1)), 1.0);  // Kronecker sequence
                solution.free_end.psi[i] += TURN * (fraction - 0.5);
            }
            choose_mesh(solution, false);
            if (polish(solution)) return true;
            if (solution.iterations > settings_.max_passes) break;
        }
        return false;
    }
};

}  // namespace tactr
