// Finds the free-end unknowns that meet the base: Newton with exact derivatives.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "dense.hpp"
#include "free_end.hpp"
#include "march.hpp"
#include "rubbing_nodes.hpp"
#include "solution.hpp"
#include "stride.hpp"

namespace tactr {

class PressingReader;

/// Newton on the base residual, on a mesh of steps that keeps the discretisation error below tolerance.
class NewtonSolver {
  public:
    Actuation<double> actuation;
    const Robot& robot;
    const Settings settings;
    const Layout<double> layout;
    const Shooting shooting;
    int strides = 0;                // left, where Newton leads away from stable equilibria
    double residual[MAX_UNKNOWNS];  // at the last evaluation; its derivatives are in the solution
    RubbedNodes* rubbed = nullptr;        // read in marches with the path, where tubes rub
    PressingReader* pressing = nullptr;   // and in those of them that have derivatives
    bool watches_stability = false;       // in marches with path and derivatives
    bool surely_stable = false;           // the last of them saw that it is stable, and far from the limit
    bool bounds_error = false;            // marches without derivatives, too, tell how much they err, at the most

    /// clamp: where the base is, and the tubes' rotations hold; what lies before it is left away.
    NewtonSolver(const Robot& robot_, const Actuation<double>& actuation_, const Settings& settings_,
                 double clamp = -std::numeric_limits<double>::max())
        : actuation(actuation_), robot(robot_), settings(settings_),
          layout(clamped_at(clamp, cut_into_sections(robot_, actuation_.translation))), shooting(robot_, layout) {}

    void start_straight(Solution& solution) const {
        for (int i = 0; i < robot.tube_count; ++i) solution.free_end.psi[i] = actuation.rotation[i];
        for (int c = 0; c < 4; ++c) solution.free_end.quaternion[c] = c == 0;
        cut_mesh(solution);
        solution.mesh.fit();
    }

    /// The coarsest mesh: one step a section, but no step along which a tendon winds so far that the errors' estimates miss it.
    void cut_mesh(Solution& solution) const {
        constexpr double MOST_WINDING = 4.0;  // rad
        solution.mesh.cut(layout.sections.size(), settings.fixed_steps > 0 ? settings.fixed_steps : 1);
        for (size_t k = 0; k < layout.sections.size() && settings.fixed_steps == 0; ++k)
            solution.mesh.steps[k] = std::max(1, static_cast<int>(std::ceil(layout.sections[k].winding / MOST_WINDING)));
    }

    /// Whether a solution is one of such a robot.
    bool is_neighbour(const Solution& guess) const {
        return guess.status == Status::converged && guess.mesh.unknowns == shooting.unknowns &&
               static_cast<int>(guess.rotation.size()) == robot.tube_count;
    }

    /// Takes over a neighbour's free end, mesh and derivatives; ahead: where the free end is thought to be. False: it is no
    /// neighbour.
    bool start_from(const Solution& guess, Solution& solution, const FreeEnd<double>* ahead = nullptr) {
        if (!take_over(guess, solution)) return false;
        go_near(guess, ahead, solution);
        return true;
    }

    /// The same, and stays there.
    bool take_over(const Solution& guess, Solution& solution) const {
        if (!is_neighbour(guess) || guess.mesh.steps.size() != layout.sections.size()) return false;
        solution.free_end = guess.free_end;
        solution.mesh = guess.mesh;
        solution.mesh.marched = guess.free_end;
        std::copy(&guess.jacobian[0][0], &guess.jacobian[0][0] + MAX_UNKNOWNS * MAX_UNKNOWNS, &solution.jacobian[0][0]);
        return true;
    }

    /// From a neighbour's free end and derivatives where the robot is now cut into other sections: a tube's end has passed
    /// another's, a tendon's tension changes its course elsewhere. They go on smoothly there, only the mesh does not fit:
    /// steps are as long as the longest of the neighbour's, or as its errors allow. ahead as above. False: it is no neighbour.
    bool carry_over(const Solution& guess, Solution& solution, const FreeEnd<double>* ahead = nullptr) {
        if (!is_neighbour(guess) || settings.fixed_steps > 0 || guess.mesh.edges.size() != guess.mesh.steps.size() + 1) return false;
        solution.free_end = guess.free_end;
        std::copy(&guess.jacobian[0][0], &guess.jacobian[0][0] + MAX_UNKNOWNS * MAX_UNKNOWNS, &solution.jacobian[0][0]);
        cut_mesh(solution);
        for (size_t k = 0; k < layout.sections.size(); ++k) {
            const int needed = guess.mesh.steps_needed(layout.sections[k].proximal, layout.sections[k].distal);
            solution.mesh.steps[k] = std::clamp(needed, solution.mesh.steps[k], March<double, double>::MAX_STEPS);
        }
        solution.mesh.fit();
        go_near(guess, ahead, solution);
        return true;
    }

    void note_edges(Solution& solution) const {
        auto& edges = solution.mesh.edges;
        edges.assign(1, layout.sections.front().proximal);
        for (const auto& section : layout.sections) edges.push_back(section.distal);
    }

    /// From a neighbour to a free end that a check is to follow at: one march with derivatives, and a step by these. False: no
    /// neighbour, or too far from one, or too coarse a mesh.
    bool lead(const Solution& guess, Solution& solution, const FreeEnd<double>* ahead) {
        if (!start_from(guess, solution, ahead) && !carry_over(guess, solution, ahead)) return false;
        if (!evaluate_finely(solution, Kind::draft, Stride::CLOSE)) return false;
        double missed[MAX_UNKNOWNS];
        std::copy(residual, residual + shooting.unknowns, missed);
        step_with_neighbour(missed, solution);
        return true;
    }

    /// By the derivatives that the solution has to where they meet the base. section_tolerance: of the march that it takes. False:
    /// a section had no equilibrium.
    bool step_by_derivatives(Solution& solution, double section_tolerance);

    /// The step that the solution's derivatives ask for at the last residual. False: there is none.
    bool chord(const Solution& solution, double (&step)[MAX_UNKNOWNS]) const {
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS];
        for (int i = 0; i < shooting.unknowns; ++i) {
            step[i] = -residual[i];
            for (int j = 0; j < shooting.unknowns; ++j) A[i][j] = solution.jacobian[i][j];
        }
        return solve_dense(shooting.unknowns, A, step) != 0.0;
    }

    /// A check, its steps seen by an observer, its sections solved to a tolerance. False: a section had no equilibrium.
    template <class Observer>
    bool watch(Solution& solution, Observer& observer, BaseState<double>& base, double section_tolerance = SECTION_TOLERANCE) {
        March<double, double> march(robot, layout, actuation, shooting.full_options());
        shooting.scale(march);
        march.solver.precision = Precision::checked;
        march.solver.tolerance = section_tolerance;
        if (bounds_error) march.error_weight = shooting.error_weight;
        tell_shift(solution);
        std::optional<RubbingNodes<double>> rubbing;
        if (rubbed) march.rubbing = &rubbing.emplace(rubbed->nodes, rubbed->first_load, 0);
        if (!march.run(solution.free_end, solution.mesh, observer)) return false;
        base = march.base;
        if (rubbed) rubbed->take(*rubbing, base, actuation.rotation, 0);
        shooting.residual(base, actuation.rotation, residual);
        solution.base_residual = norm(residual);
        if (!std::isfinite(solution.base_residual)) return false;
        note(solution, march);
        if (bounds_error) bound_error(solution, march);
        shooting.tip_pose(solution.free_end, base, actuation.rotation[0], solution.tip_position, solution.tip_quaternion);
        solution.tendon_length = march.tendon_length;
        return true;
    }

    /// One plain march chooses the steps, starting from one a section.
    void choose_mesh(Solution& solution) {
        cut_mesh(solution);
        add_steps(solution);
    }

    /// One plain march adds steps to the mesh where its error asks for them. False: it found no end to them, far from
    /// any solution perhaps; the mesh is then left as it was.
    bool add_steps(Solution& solution) {
        const std::vector<int> before = solution.mesh.steps;
        const std::vector<double> grade = solution.mesh.grade;
        const int most = MOST_GROWTH * (solution.mesh.total() + 8);
        BaseState<double> base;
        if (plain_march(solution, actuation, base) && solution.mesh.total() <= most) return true;
        solution.mesh.steps = before;
        solution.mesh.grade = grade;
        solution.mesh.fit();
        return false;
    }

    /// As choose_mesh; then moves the free end by the angles at which that march missed the base.
    void choose_mesh_and_wind(Solution& solution) {
        BaseState<double> base;
        cut_mesh(solution);
        if (!plain_march(solution, actuation, base)) return;
        double missed[MAX_UNKNOWNS];
        shooting.residual(base, actuation.rotation, missed);
        if (norm(missed) < LONGEST_CHORD) shooting.move(FreeEnd<double>(solution.free_end), missed, -1.0, solution.free_end);
    }

    /// As choose_mesh, but without external loads; turns the tip so that the unloaded robot's base stands upright.
    void stand_up(Solution& solution) {
        Actuation<double> unloaded = actuation;
        unloaded.load_scale = 0.0;
        BaseState<double> base;
        cut_mesh(solution);
        if (plain_march(solution, unloaded, base)) shooting.upright(base, actuation.rotation[0], solution.free_end);
    }

    /// How a march is made. rough: derivatives, sections solved roughly. firm: derivatives, every section to its
    /// tolerance. draft: as rough, with path and error estimate too. exact: as firm, with path and error estimate.
    /// check: as exact but without derivatives; those of the last draft or exact march, close by, are kept.
    enum class Kind { rough, firm, draft, exact, check };

    bool evaluate(Solution& solution, Kind kind);

    /// A march with path and derivatives, on a mesh fine enough. False: the base is missed by more than close, or no mesh is.
    bool evaluate_finely(Solution& solution, Kind kind, double close) {
        for (int more = MOST_REFINED;; --more) {
            if (!evaluate(solution, kind) || !(solution.base_residual < close)) return false;
            if (is_fine(solution)) return true;
            if (more == 0 || !refine(solution, allowed_error(solution))) return false;
        }
    }

    /// By how much the base of a neighbour misses the rotations as they are now.
    void missed_at(const Solution& guess, double* missed) const {
        BaseState<double> met;  // the base the neighbour met: its own rotations, upright
        for (int i = 0; i < robot.tube_count; ++i) met.psi[i] = guess.rotation[i];
        for (int c = 0; c < 4; ++c) met.quaternion[c] = c == 0;
        shooting.residual(met, actuation.rotation, missed);
    }

    /// Newton with backtracking on the largest residual. first: kind of the first march; the last is exact or a check.
    /// True: below tolerance.
    bool newton(Solution& solution, double tolerance, Kind first) {
        if (shooting.unknowns == 0) first = Kind::exact;
        careful_ = false;
        if (!evaluate(solution, first)) return fail(solution, Status::no_equilibrium);
        for (int iteration = 0; iteration < settings.max_iterations; ++iteration) {
            const double size = solution.base_residual;
            if (size <= tolerance) {
                if (kind_ == Kind::exact || kind_ == Kind::check) return true;
                if (!evaluate(solution, kind_ == Kind::draft ? Kind::check : Kind::exact))
                    return fail(solution, Status::no_equilibrium);
                continue;
            }
            if (solution.steps_marched > settings.max_steps) break;
            double step[MAX_UNKNOWNS];
            if (!chord(solution, step)) break;
            if (strides > 0 && Stride::is_due(shooting.unknowns, step, norm(step), residual, size)) {
                --strides;
                shooting.move(FreeEnd<double>(solution.free_end), residual, -Stride::LENGTH / size, solution.free_end);
                if (!evaluate(solution, Kind::rough)) return fail(solution, Status::no_equilibrium);
                continue;
            }
            if (backtrack(solution, step, size)) continue;
            if (careful_) break;
            careful_ = true;  // rough marches, each from other strains, may miss what is less than their own error
            if (!evaluate(solution, Kind::firm)) break;
        }
        return fail(solution, Status::stalled);
    }

    /// Newton, then finer steps until the discretisation error is below tolerance.
    bool polish(Solution& solution, Kind first = Kind::rough) {
        for (int round = 0; round < 12; ++round) {
            if (!newton(solution, settings.residual_tolerance, first)) return false;
            if (is_fine(solution) || settings.fixed_steps > 0) return succeed(solution);
            // the estimate of a rough march holds what is left of its sections' equations too, which no finer steps lower
            const bool exactly = round >= 3;
            if (!(exactly && estimate_ == Kind::draft) && !refine(solution, allowed_error(solution))) break;
            first = exactly ? Kind::exact : Kind::rough;
        }
        return fail(solution, Status::too_coarse);
    }

    bool is_fine(const Solution& solution) const {
        return solution.discretisation_error <= allowed_error(solution) && solution.length_error <= settings.tolerance;
    }

    static bool succeed(Solution& solution) {
        if (solution.least_stretch < LEAST_STRETCH) return fail(solution, Status::collapsed);
        solution.status = Status::converged;
        return true;
    }

    /// The base residual at a free end, without derivatives.
    bool plain_residual(const FreeEnd<double>& end, Mesh& mesh, double* r) const;

    double norm(const double* r) const {
        double worst = 0.0;
        for (int i = 0; i < shooting.unknowns; ++i) worst = std::isfinite(r[i]) ? larger(worst, std::fabs(r[i])) : INFINITY;
        return worst;
    }

    static bool fail(Solution& solution, Status status) {
        solution.status = status;
        return false;
    }

  private:
    Kind kind_ = Kind::rough;         // of the last march
    Kind estimate_ = Kind::exact;     // of the march that estimated the discretisation error
    bool careful_ = false;            // no more rough marches
    double since_derivatives_ = 0.0;  // rad: way from the last march with path and derivatives

    static bool has_path(Kind kind) { return kind == Kind::draft || kind == Kind::exact; }
    static bool is_firm(Kind kind) { return kind == Kind::firm || kind == Kind::exact || kind == Kind::check; }

    static constexpr int MOST_GROWTH = 8;
    static constexpr double MESH_SLACK = 5.0;  // the sum over a section's states overrates its effect on the tip

    static constexpr double LEAST_STRETCH = 0.2;  // linear elasticity means nothing at such compression

    bool plain_march(Solution& solution, const Actuation<double>& at, BaseState<double>& base);

    void tell_shift(Solution& solution) {
        shooting.difference(solution.mesh.marched, solution.free_end, solution.mesh.shift);
        solution.mesh.marched = solution.free_end;
    }

    void go_near(const Solution& guess, const FreeEnd<double>* ahead, Solution& solution) {
        if (ahead) solution.free_end = *ahead;
        else if (shooting.unknowns > 0) approach(guess, solution);
    }

    /// Steps with the neighbour's derivatives: for the change of the rotations, which needs no march, then for what one
    /// rough march without derivatives still misses.
    void approach(const Solution& guess, Solution& solution);

    void step_with_neighbour(double (&missed)[MAX_UNKNOWNS], Solution& solution) const {
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS];
        for (int i = 0; i < shooting.unknowns; ++i)
            for (int j = 0; j < shooting.unknowns; ++j) A[i][j] = solution.jacobian[i][j];
        if (solve_dense(shooting.unknowns, A, missed) == 0.0 || !(norm(missed) < LONGEST_CHORD)) return;
        shooting.move(FreeEnd<double>(solution.free_end), missed, -1.0, solution.free_end);
    }

    static constexpr double SURE_MARGIN = 0.1;

    static constexpr double LONGEST_CHORD = 1.0;  // rad: of a step without derivatives of its own

    template <int K>
    bool evaluate_lanes(Solution& solution, Kind kind);

    template <class M>
    static void note(Solution& solution, const M& march) {
        solution.shortest_tendon = march.solver.shortest_tendon;
        solution.section_residual = march.solver.worst_residual;
        solution.least_stretch = march.solver.least_stretch;
    }

    /// As if all errors of all sections moved the tip the same way.
    template <class M>
    void bound_error(Solution& solution, const M& march) {
        section_error_ = march.section_error;
        edge_error_ = march.edge_error;
        length_error_ = march.length_error;
        solution.discretisation_error = solution.length_error = 0.0;
        for (double error_here : section_error_) solution.discretisation_error += ERROR_SAFETY * error_here;
        for (double error_here : length_error_) solution.length_error += ERROR_SAFETY * error_here;
        note_excess(solution);
    }

    template <class M, class T>
    void read_tip(Solution& solution, const M& march, const FreeEnd<T>& end, const T* r);

    static constexpr double UNKNOWN_ERROR = 1e300;
    static constexpr double ERROR_SAFETY = 2.0;  // the embedded estimate, carried to the tip, underrates the coarsest meshes

    std::vector<double> section_error_, edge_error_, length_error_;

    bool backtrack(Solution& solution, double* step, double size) {
        constexpr double LONGEST = 1.0;  // rad: beyond, the linear model says nothing
        constexpr double ROUGH = 1e-3;   // rad
        constexpr int MOST_ROUGH = 3;    // attempts; then it may be their own error that does not fall
        const FreeEnd<double> from = solution.free_end;
        const bool rough_before = !is_firm(kind_);
        const double longest = norm(step);
        double fraction = longest > LONGEST ? LONGEST / longest : 1.0;
        for (int attempt = 0; attempt < 10; ++attempt, fraction *= 0.4) {
            shooting.move(from, step, fraction, solution.free_end);
            const Kind kind = next_kind(fraction, size, longest);
            if (kind == Kind::rough && attempt >= MOST_ROUGH) break;
            if (!evaluate(solution, kind)) continue;
            if (solution.base_residual < (1.0 - 0.1 * fraction) * size) return true;
            // the residual before was only roughly known
            if (is_firm(kind) && rough_before && solution.base_residual < ROUGH) return true;
            // at the rounding floor no further decrease can be asked for
            if (size < 10.0 * settings.residual_tolerance && solution.base_residual <= settings.residual_tolerance) return true;
        }
        solution.free_end = from;
        return false;
    }

    /// Newton squares the residual: where it leads close, derivatives serve as they are from then on.
    Kind next_kind(double fraction, double size, double step) {
        if (has_path(kind_)) since_derivatives_ = 0.0;
        since_derivatives_ += step;
        if ((has_path(kind_) || kind_ == Kind::check) && since_derivatives_ < Stride::CLOSE) return Kind::check;
        if (careful_) return Kind::firm;
        return fraction == 1.0 && size < Stride::CLOSE ? Kind::draft : Kind::rough;
    }

    /// The embedded estimate is trusted less where a section that matters has a single step. Under large loads that of a
    /// single step fell short of the error by a factor of up to 20, in sections that seemed to matter little, too.
    double allowed_error(const Solution& solution) const {
        for (size_t k = 0; k < section_error_.size(); ++k)
            if (is_doubtful(solution, k)) return (shooting.loaded ? LOADED_SHARE : SINGLE_STEP_SHARE) * settings.tolerance;
        return settings.tolerance;
    }

    static constexpr double SINGLE_STEP_SHARE = 0.15, LOADED_SHARE = 0.03;
    static constexpr int MOST_REFINED = 2;  // times, before a neighbour leads nowhere

    bool is_doubtful(const Solution& solution, size_t k) const {
        const double largest = *std::max_element(section_error_.begin(), section_error_.end());
        return solution.mesh.steps[k] == 1 && section_error_[k] > (shooting.loaded ? 0.01 : 0.3) * largest;
    }

    /// More steps, or better graded ones, where the error comes from: as many as an eighth-order rule needs to bring the
    /// tip and the tendons' lengths below tolerance.
    bool refine(Solution& solution, double allowed) {
        const double relief = allowed / larger(allowed, SINGLE_STEP_SHARE * settings.tolerance);  // two steps are trusted again
        bool finer = false;
        for (size_t k = 0; k < section_error_.size(); ++k) {
            const double excess = excess_of(solution, k, allowed);
            const bool doubtful = allowed < settings.tolerance && is_doubtful(solution, k);
            if (!(excess > 0.5) && !doubtful) continue;
            const int most = March<double, double>::MAX_STEPS, now = solution.mesh.steps[k];
            const double first = edge_error_[2 * k], last = edge_error_[2 * k + 1];
            const double grade = solution.mesh.even_grade(k, now, first, last);
            const double left = excess * relief * error_left(now, solution.mesh.grade_of(k), grade, first, last);
            int steps = now;
            if (doubtful || !(left < 0.7)) steps = std::min(most, std::max(now + 1, static_cast<int>(std::ceil(smaller(3.0, std::pow(left, 0.125)) * now))));
            finer = finer || steps > now || grade != solution.mesh.grade_of(k);
            solution.mesh.grade[k] = solution.mesh.even_grade(k, steps, first, last);
            solution.mesh.steps[k] = steps;
        }
        solution.mesh.fit();
        return finer;
    }

    /// A section's error over what it may be.
    double excess_of(const Solution& solution, size_t k, double allowed) const {
        const auto share = [k](const std::vector<double>& errors, double sum) {
            const double largest = *std::max_element(errors.begin(), errors.end());
            return largest > 0.0 ? sum * errors[k] / largest : 0.0;
        };
        return larger(share(section_error_, solution.discretisation_error / (0.5 * allowed)),
                      share(length_error_, solution.length_error / (0.5 * settings.tolerance)));
    }

    void note_excess(Solution& solution) const {
        const double allowed = (shooting.loaded ? LOADED_SHARE : SINGLE_STEP_SHARE) * settings.tolerance;
        solution.mesh.excess.resize(section_error_.size());
        for (size_t k = 0; k < section_error_.size(); ++k) solution.mesh.excess[k] = excess_of(solution, k, allowed);
    }

    /// Share of a section's error that would be left with another grade, its density changing geometrically along it.
    static double error_left(int n, double before, double after, double first, double last) {
        if (n < 2 || before == after || !(first > 0.0) || !(last > 0.0)) return 1.0;
        double old = 0.0, regraded = 0.0;
        const auto length = [n](int i, double g) { return Mesh::share_before(i + 1, n, g) - Mesh::share_before(i, n, g); };
        for (int i = 0; i < n; ++i) {
            const double error = first * std::pow(last / first, static_cast<double>(i) / (n - 1));
            old += error;
            regraded += error * std::pow(length(i, after) / length(i, before), 9.0);
        }
        return regraded / old;
    }
};

}  // namespace tactr
