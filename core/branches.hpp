// All equilibria: Newton from starts spread over the free-end unknowns, which are angles and hence bounded.
//
// The map from the free end to the base is smooth, and at zero rest curvature, tension and load one to one, so its degree
// is 1: over all regular solutions the signs of det D add up to 1. Where those found add up to something else, some are
// missing, and the search goes on from more starts.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "energetics.hpp"
#include "growth.hpp"
#include "newton.hpp"
#include "solution.hpp"
#include "stability.hpp"
#include "starts.hpp"

namespace tactr {

constexpr long MOST_OF_ONE_START = 2000;  // steps marched: a start that needs more is better left for the next

inline Settings settings_of_one_start(Settings settings) {
    settings.max_iterations = 25;
    settings.max_steps = MOST_OF_ONE_START;
    return settings;
}

class BranchFinder {
  public:
    std::vector<Solution> found;

    /// like: any converged or failed solution at this actuation, for its mesh and the first tube's angle.
    BranchFinder(NewtonSolver& newton, const Solution& like)
        : newton_(newton), like_(like), n_(newton.shooting.unknowns), tubes_(newton.robot.tube_count), world_(newton.shooting.world) {}

    /// samples: starts, or points of the grid, at first; 0: chosen by the number of unknowns.
    void search(int samples) {
        if (samples <= 0) samples = default_samples();
        if (!found.empty() && (n_ > 1 || world_)) start_beside(Solution(found.front()), false);
        start_unloaded();
        for (int round = 0; round < ROUNDS; ++round, samples *= 2) {
            search_once(samples, false);
            if (degree_ == 1 || families_) return;
        }
    }

    /// As search, but only until a stable solution is found, or so many steps are marched.
    bool search_stable(long most_work) {
        if (has_stable()) return true;
        work_ = 0;
        most_work_ = most_work;
        if (n_ > 1 || world_) start_beside(Solution(found.empty() ? like_ : found.front()), true);
        if (!has_stable()) start_unloaded();
        if (!has_stable() && n_ == 2 && !world_) search_once(100, true);
        if (!has_stable()) search_once(default_samples(), true);
        return has_stable();
    }

    long work() const { return work_; }  // steps marched

    bool has_stable() const {
        return std::any_of(found.begin(), found.end(),
                           [](const Solution& s) { return s.stability == StabilityFound::stable; });
    }

    /// Newton from one start; what it finds is kept unless it is known already.
    void try_from(FreeEnd<double> start) {
        if (work_ > most_work_) return;
        Solution trial = fresh();
        trial.free_end = start;
        work_ += trial.mesh.total();
        double r[MAX_UNKNOWNS];
        Mesh mesh = trial.mesh;
        if (!newton_.plain_residual(start, mesh, r)) return;
        unwind(r, trial.free_end);
        const bool met = newton_.newton(trial, ROUGH, NewtonSolver::Kind::rough) && !known(trial) && newton_.polish(trial);
        work_ += trial.steps_marched;
        if (met && !of_known_family(trial)) keep(trial);
    }

    /// Adds a converged solution, with its stability and energy.
    void keep(Solution& solution) {
        if (known(solution)) return;
        StabilityReport report;
        StabilityPass pass(newton_.robot, newton_.actuation, newton_.layout, newton_.shooting);
        const bool read = pass.run(solution, 0, report);
        solution.stability = read && report.stable ? StabilityFound::stable : StabilityFound::unstable;
        solution.energy = potential_energy(newton_.robot, solution);
        found.push_back(solution);
        families_ = families_ || is_neutral(solution);
        degree_ += report.conjugate_count % 2 == 0 ? 1 : -1;
    }

    /// Stable ones first, then by energy; ties, as of mirrored shapes, by the second tube's angle.
    void sort() {
        std::stable_sort(found.begin(), found.end(), [this](const Solution& a, const Solution& b) {
            if (a.stability != b.stability) return a.stability == StabilityFound::stable;
            const double gap = a.energy - b.energy;
            if (std::fabs(gap) > 1e-9 * (std::fabs(a.energy) + std::fabs(b.energy)) || tubes_ < 2) return gap < 0.0;
            return a.free_end.psi[1] < b.free_end.psi[1];
        });
    }

  private:
    static constexpr int ROUNDS = 3, BATCH = 16;
    static constexpr long WORK = 150000;       // steps marched in all: seconds
    static constexpr double ROUGH = 1e-6;      // rad, at the base: enough to tell solutions apart
    static constexpr double SAME = 1e-4;       // rad, at the free end
    static constexpr double FAITHFUL = 0.02;   // rad: how well cubics have to follow a sweep
    static constexpr double OUTSIDE = -0.2;    // how far out of a simplex its linear root may lie

    NewtonSolver& newton_;
    const Solution& like_;
    const int n_, tubes_;
    const bool world_;
    int degree_ = 0;
    long work_ = 0, most_work_ = WORK;
    bool families_ = false;  // found any solution that is not isolated

    int default_samples() const {
        if (world_ || n_ > 3) return 60 * n_;
        return n_ == 1 ? 48 : n_ == 2 ? 400 : 1000;
    }

    Solution fresh() const {
        Solution s;
        s.tension = like_.tension;
        s.rotation = like_.rotation;
        s.translation = like_.translation;
        s.free_end = like_.free_end;
        s.mesh.steps = like_.mesh.steps;
        s.mesh.grade = like_.mesh.grade;
        s.mesh.fit();
        return s;
    }

    bool known(const Solution& solution) const {
        for (const Solution& other : found)
            if (newton_.shooting.distance(other.free_end, solution.free_end) < SAME) return true;
        return false;
    }

    /// A base missed by whole turns of a tube is met: turning the tube back at the free end turns it back everywhere.
    void unwind(const double* r, FreeEnd<double>& end) const {
        for (int i = 1; i < tubes_; ++i) {
            const double relative = world_ ? r[2 + i] - r[2] : r[i - 1];
            end.psi[i] -= FULL_TURN * std::round(relative / FULL_TURN);
        }
    }

    static constexpr double NEUTRAL = 1e-3;  // determinant at the base

    bool is_neutral(const Solution& solution) const {
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS], inverse[MAX_UNKNOWNS][MAX_UNKNOWNS];
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j) A[i][j] = solution.jacobian[i][j];
        return std::fabs(invert(n_, A, inverse)) < NEUTRAL;
    }

    /// Shapes that turn into each other at no cost, as a buckled round rod about the guide, are one solution.
    bool of_known_family(const Solution& solution) const {
        if (!families_ || !is_neutral(solution)) return false;
        const double energy = potential_energy(newton_.robot, solution);
        for (const Solution& other : found)
            if (is_neutral(other) && std::fabs(other.energy - energy) < SAME * newton_.shooting.moment_scale) return true;
        return false;
    }

    void search_once(int samples, bool until_stable) {
        if (world_ || n_ > 3) {
            for (int k = 0; k < samples; ++k) {
                if (until_stable && k % BATCH == 0 && has_stable()) return;
                try_from(scattered_start(like_.free_end, tubes_, world_, k));
            }
        } else if (n_ == 1) {
            sweep(samples);
        } else {
            search_grid(std::max(3, static_cast<int>(std::ceil(std::pow(samples, 1.0 / n_)))));
        }
    }

    /// Starts on both sides of a solution along the principal directions of its derivatives. They turn and mirror with the
    /// robot, so that what is found does, too.
    void start_beside(const Solution& from, bool until_stable) {
        double V[MAX_UNKNOWNS][MAX_UNKNOWNS];
        right_singular_vectors(n_, from.jacobian, V);
        for (double distance : {0.5, 1.0, 1.6, 2.3, 3.1}) {
            if (until_stable && has_stable()) return;
            for (int k = 0; k < n_; ++k)
                for (double side : {distance, -distance}) {
                    double step[MAX_UNKNOWNS];
                    for (int i = 0; i < n_; ++i) step[i] = V[i][k];
                    FreeEnd<double> start;
                    newton_.shooting.move(from.free_end, step, side, start);
                    try_from(start);
                }
        }
    }

    /// With loads in world axes and several tubes: starts from all solutions without external loads, of which there are
    /// fewer unknowns, turned upright.
    void start_unloaded() {
        if (!world_ || tubes_ < 2) return;
        Robot bare = newton_.robot;
        bare.point_load_count = bare.distributed_load_count = 0;
        Settings settings = newton_.settings;
        settings.tolerance = std::max(settings.tolerance, 1e-5);
        NewtonSolver newton(bare, newton_.actuation, settings);
        Solution like = like_;
        newton.start_straight(like);
        newton.choose_mesh(like);
        BranchFinder finder(newton, like);
        finder.most_work_ = most_work_ / 4;
        finder.search(0);
        work_ += finder.work_;
        for (const Solution& solution : finder.found) {
            Solution trial = fresh();
            for (int i = 0; i < tubes_; ++i)
                trial.free_end.psi[i] = solution.free_end.psi[i] - solution.free_end.psi[0] + like_.free_end.psi[0];
            for (int c = 0; c < 4; ++c) trial.free_end.quaternion[c] = c == 0;
            newton_.stand_up(trial);
            try_from(trial.free_end);
        }
    }

    // --- one unknown: a sweep whose cubics follow it, so that no root is missed -------------------------------------

    struct Node {
        double x, r, slope;
        bool valid;
    };

    Node node(double x) {
        Solution at = fresh();
        at.free_end.psi[1] = like_.free_end.psi[0] + x;
        const bool valid = newton_.evaluate(at, NewtonSolver::Kind::firm);
        return {x, newton_.residual[0], at.jacobian[0][0], valid};
    }

    static double cubic(const Node& a, const Node& b, double t) {
        const double h = b.x - a.x, u = 1.0 - t;
        return u * u * (1.0 + 2.0 * t) * a.r + t * t * (3.0 - 2.0 * t) * b.r + h * t * u * (u * a.slope - t * b.slope);
    }

    void sweep(int samples) {
        Node last = node(0.0);
        for (int k = 1; k <= samples; ++k) {
            const Node next = node(FULL_TURN * k / samples);
            between(last, next, 12);
            last = next;
        }
    }

    void between(const Node& a, const Node& b, int depth) {
        const Node middle = node(0.5 * (a.x + b.x));
        if (!a.valid && !b.valid && !middle.valid) return;
        const bool known_there = a.valid && b.valid && middle.valid;
        if (depth > 0 && !(known_there && std::fabs(cubic(a, b, 0.5) - middle.r) < FAITHFUL)) {
            between(a, middle, depth - 1);
            between(middle, b, depth - 1);
        } else if (known_there) {
            roots(a, middle);
            roots(middle, b);
        }
    }

    /// Starts where the cubic crosses a whole number of turns, or comes so near to it that the sweep itself may.
    void roots(const Node& a, const Node& b) {
        constexpr int PARTS = 8;
        const auto turns = [&](int part) { return cubic(a, b, static_cast<double>(part) / PARTS) / FULL_TURN; };
        double before = turns(0), last = before;
        for (int part = 1; part <= PARTS; ++part) {
            const double next = turns(part);
            const double low = std::min(last, next), high = std::max(last, next);
            const double level = std::ceil(low);
            if (level <= high) start_at(a, b, (part - 1 + (level - last) / (next - last + 1e-300)) / PARTS);
            const double nearest = std::round(last);
            const bool turned = (last - before) * (next - last) <= 0.0;
            if (turned && std::fabs(last - nearest) < FAITHFUL) {
                start_at(a, b, (part - 1.5) / PARTS);
                start_at(a, b, (part - 0.5) / PARTS);
            }
            before = last;
            last = next;
        }
    }

    void start_at(const Node& a, const Node& b, double t) {
        FreeEnd<double> end = like_.free_end;
        end.psi[1] = like_.free_end.psi[0] + a.x + (b.x - a.x) * t;
        try_from(end);
    }

    // --- two or three unknowns: linear roots in the simplices of a grid ---------------------------------------------

    void search_grid(int g) {
        int total = 1;
        for (int i = 0; i < n_; ++i) total *= g;
        std::vector<double> values(static_cast<size_t>(total) * n_);
        for (int p = 0; p < total; ++p) {
            FreeEnd<double> end = like_.free_end;
            for (int i = 0, rest = p; i < n_; ++i, rest /= g) end.psi[1 + i] = like_.free_end.psi[0] + FULL_TURN * (rest % g) / g;
            if (work_ > most_work_) return;
            work_ += like_.mesh.total();
            Mesh mesh = like_.mesh;
            mesh.warm = false;
            double r[MAX_UNKNOWNS];
            const bool valid = newton_.plain_residual(end, mesh, r);
            for (int i = 0; i < n_; ++i) values[p * n_ + i] = valid ? r[i] : NAN;
        }
        for (int p = 0; p < total; ++p) search_cube(values, g, p);
    }

    /// The cube at a grid point falls into simplices, one for each order in which its edges can be walked (Kuhn).
    void search_cube(const std::vector<double>& values, int g, int p) {
        int corner[3], order[3] = {0, 1, 2};
        for (int i = 0, rest = p; i < n_; ++i, rest /= g) corner[i] = rest % g;
        do {
            double x[4][3], r[4][3];
            int at[3] = {corner[0], n_ > 1 ? corner[1] : 0, n_ > 2 ? corner[2] : 0};
            for (int v = 0; v <= n_; ++v) {
                if (v > 0) ++at[order[v - 1]];
                int index = 0;
                for (int i = n_ - 1; i >= 0; --i) index = index * g + at[i] % g;
                for (int i = 0; i < n_; ++i) {
                    x[v][i] = FULL_TURN * at[i] / g;
                    r[v][i] = values[index * n_ + i] + FULL_TURN * (at[i] / g);  // a whole turn at the tip is one at the base
                }
            }
            search_simplex(x, r);
        } while (std::next_permutation(order, order + n_));
    }

    void search_simplex(const double (&x)[4][3], const double (&r)[4][3]) {
        int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
        for (int i = 0; i < n_; ++i) {
            double least = r[0][i], most = r[0][i];
            for (int v = 0; v <= n_; ++v) {
                if (!std::isfinite(r[v][i])) return;
                least = std::min(least, r[v][i]);
                most = std::max(most, r[v][i]);
            }
            const double slack = 0.2 * (most - least);
            low[i] = static_cast<int>(std::ceil((least - slack) / FULL_TURN));
            high[i] = static_cast<int>(std::floor((most + slack) / FULL_TURN));
        }
        int m[3];
        for (m[0] = low[0]; m[0] <= high[0]; ++m[0])
            for (m[1] = low[1]; m[1] <= high[1]; ++m[1])
                for (m[2] = low[2]; m[2] <= high[2]; ++m[2]) linear_root(x, r, m);
    }

    void linear_root(const double (&x)[4][3], const double (&r)[4][3], const int (&turns)[3]) {
        double A[3][3], share[3];
        for (int i = 0; i < n_; ++i) {
            share[i] = FULL_TURN * turns[i] - r[0][i];
            for (int v = 1; v <= n_; ++v) A[i][v - 1] = r[v][i] - r[0][i];
        }
        if (solve_dense(n_, A, share) == 0.0) return;
        double first = 1.0;
        for (int v = 0; v < n_; ++v) {
            if (!(share[v] > OUTSIDE)) return;
            first -= share[v];
        }
        if (!(first > OUTSIDE)) return;
        FreeEnd<double> end = like_.free_end;
        for (int i = 0; i < n_; ++i) {
            double place = x[0][i];
            for (int v = 1; v <= n_; ++v) place += share[v - 1] * (x[v][i] - x[0][i]);
            end.psi[1 + i] = like_.free_end.psi[0] + place;
        }
        try_from(end);
    }
};

/// After a cold start: keeps a stable solution; in place of an unstable one, or of none, takes the stable one of least
/// energy that it finds. Of none: an unstable one, too, where no stable one is found.
class Settler {
  public:
    Settler(const NewtonSolver& cold, Solution& solution)
        : cold_(cold), solution_(solution), one_start_(settings_of_one_start(cold.settings)),
          newton_(cold.robot, cold.actuation, one_start_) {}

    void settle() {
        if (is_stable() || cold_.settings.fixed_steps > 0) return;
        const bool met = solution_.status == Status::converged;
        if (met) solution_.stability = StabilityFound::unstable;
        Solution first = solution_;
        if (!met) {
            newton_.start_straight(first);
            newton_.choose_mesh(first);
        }
        BranchFinder finder(newton_, first);
        if (met) finder.keep(first);
        if (met && !solution_.used_continuation) grow(finder);
        const long most = met ? std::min(cold_.settings.max_steps, cold_.settings.most_work - solution_.steps_marched)
                              : cold_.settings.max_steps * cold_.settings.patience;
        const bool stable = finder.search_stable(most);
        solution_.steps_marched += finder.work();
        if (finder.found.empty() || (met && !stable)) return;
        finder.sort();
        take(finder.found.front(), met);
    }

  private:
    const NewtonSolver& cold_;
    Solution& solution_;
    const Settings one_start_;
    NewtonSolver newton_;

    bool is_stable() {
        if (solution_.status != Status::converged) return cold_.shooting.unknowns == 0;
        StabilityReport report;
        StabilityPass pass(cold_.robot, cold_.actuation, cold_.layout, cold_.shooting);
        if (cold_.shooting.unknowns > 0 && !(pass.run(solution_, 0, report) && report.stable)) return false;
        solution_.stability = StabilityFound::stable;
        return true;
    }

    void grow(BranchFinder& finder) {
        Solution grown = solution_;
        grown.iterations = 0;
        grown.steps_marched = 0;
        NewtonSolver newton(cold_.robot, cold_.actuation, cold_.settings);
        if (Growth(newton, grown).reach() && newton.polish(grown)) finder.keep(grown);
        solution_.iterations += grown.iterations;
        solution_.steps_marched += grown.steps_marched;
    }

    void take(const Solution& found, bool met) {
        const int iterations = solution_.iterations;
        const long steps_marched = solution_.steps_marched;
        const bool continued = solution_.used_continuation;
        solution_ = found;
        solution_.iterations += iterations;
        solution_.steps_marched = steps_marched;
        solution_.used_continuation = continued;
        solution_.switched = met;
    }
};

}  // namespace tactr
