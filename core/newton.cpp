// The marches of Newton's iteration, in a translation unit of their own: compilers inline less in large ones.
#include "newton.hpp"

#include "friction_pressing.hpp"
#include "stability.hpp"

namespace tactr {

namespace {

/// An observer, and another where there is one.
template <class A, class B>
struct Beside {
    A& one;
    B* other;

    template <class M>
    void operator()(M& march, int k, const typename M::State* before, double s, double h) {
        one(march, k, before, s, h);
        if (other) (*other)(march, k, before, s, h);
    }
};

}  // namespace

template <class M, class T>
void NewtonSolver::read_tip(Solution& solution, const M& march, const FreeEnd<T>& end, const T* r) {
    T position[3], quaternion[4];
    shooting.tip_pose(end, march.base, actuation.rotation[0], position, quaternion);
    const int e = shooting.unknowns;
    double A[MAX_UNKNOWNS][MAX_UNKNOWNS], shift[MAX_UNKNOWNS];
    for (int i = 0; i < e; ++i) {
        shift[i] = r[i].d[e];
        for (int j = 0; j < e; ++j) A[i][j] = solution.jacobian[i][j];
    }
    solution.base_determinant = solve_dense(e, A, shift);
    const bool regular = solution.base_determinant != 0.0;
    double error = 0.0;
    for (int a = 0; a < 3; ++a) {
        double d = position[a].d[e];
        for (int j = 0; j < e; ++j) d -= position[a].d[j] * shift[j];
        error += d * d;
        solution.tip_position[a] = position[a].v;
    }
    for (int a = 0; a < 4; ++a) solution.tip_quaternion[a] = quaternion[a].v;
    solution.discretisation_error = regular && std::isfinite(error) ? ERROR_SAFETY * std::sqrt(error) : UNKNOWN_ERROR;
    section_error_ = march.section_error;
    edge_error_ = march.edge_error;
    length_error_ = march.length_error;
    solution.length_error = 0.0;
    for (double error_here : length_error_) solution.length_error += ERROR_SAFETY * error_here;
    solution.tendon_length = march.tendon_length;
    note_excess(solution);
}

template <int K>
bool NewtonSolver::evaluate_lanes(Solution& solution, Kind kind) {
    using T = Dual<K>;
    const bool full = has_path(kind);
    const MarchOptions options = full ? shooting.full_options() : shooting.newton_options();
    March<T, double> march(robot, layout, actuation, options);
    shooting.scale(march);
    FreeEnd<T> end;
    shooting.seed(solution.free_end, 0, end);
    if (full) {
        march.error_weight = shooting.error_weight;
        march.error_lane = shooting.unknowns;
    }
    if (!is_firm(kind)) march.solver.precision = Precision::rough;
    march.slope_lanes = shooting.unknowns;
    tell_shift(solution);
    std::optional<RubbingNodes<T>> rubbing;
    if (rubbed && full) march.rubbing = &rubbing.emplace(rubbed->nodes, rubbed->first_load, MAX_UNKNOWNS + 1);  // their torques stand still
    const auto run = [&] {
        if (!watches_stability || !full) return march.run(end, solution.mesh);
        StabilityReport report;
        JacobiObserver<K> observer(layout, shooting, end, robot.tube_count, 0, report);
        Beside<JacobiObserver<K>, PressingReader> both{observer, pressing};
        if (!march.run(end, solution.mesh, both)) return false;
        surely_stable = report.conjugate_count == 0 && report.margin > SURE_MARGIN;
        for (double error : observer.section_error) surely_stable = surely_stable && error < StabilityPass::ROUGH_TOLERANCE;
        return true;
    };
    if (!run()) {
        solution.shortest_tendon = smaller(solution.shortest_tendon, march.solver.shortest_tendon);
        return false;
    }
    note(solution, march);
    if (rubbing) rubbed->take(*rubbing, march.base, actuation.rotation, shooting.unknowns);
    T r[MAX_UNKNOWNS];
    shooting.residual(march.base, actuation.rotation, r);
    for (int i = 0; i < shooting.unknowns; ++i) {
        residual[i] = r[i].v;
        if (!std::isfinite(r[i].v)) return false;
        for (int j = 0; j < shooting.unknowns; ++j) {
            solution.jacobian[i][j] = r[i].d[j];
            if (!std::isfinite(r[i].d[j])) return false;
        }
    }
    solution.base_residual = norm(residual);
    if (full) read_tip(solution, march, end, r);
    return true;
}

bool NewtonSolver::evaluate(Solution& solution, Kind kind) {
    solution.steps_marched += solution.mesh.total();
    ++solution.iterations;
    kind_ = kind;
    if (has_path(kind)) estimate_ = kind;
    if (kind == Kind::check) {
        NoObserver nobody;
        BaseState<double> base;
        return watch(solution, nobody, base);
    }
    const int lanes = shooting.unknowns + (has_path(kind) ? 1 : 0);
    return with_lanes(lanes, [&](auto count) { return evaluate_lanes<decltype(count)::value>(solution, kind); });
}

bool NewtonSolver::plain_residual(const FreeEnd<double>& end, Mesh& mesh, double* r) const {
    March<double, double> march(robot, layout, actuation, shooting.newton_options());
    shooting.scale(march);
    if (!march.run(end, mesh)) return false;
    shooting.residual(march.base, actuation.rotation, r);
    return std::isfinite(norm(r));
}

bool NewtonSolver::plain_march(Solution& solution, const Actuation<double>& at, BaseState<double>& base) {
    March<double, double> march(robot, layout, at, shooting.full_options());
    shooting.scale(march);
    march.error_weight = shooting.error_weight;
    march.adapt_tolerance = MESH_SLACK * (settings.fixed_steps > 0 ? 1e300 : settings.tolerance);
    const bool found = march.run(solution.free_end, solution.mesh);
    solution.mesh.fit();
    base = march.base;
    return found;
}

bool NewtonSolver::step_by_derivatives(Solution& solution, double section_tolerance) {
    March<double, double> march(robot, layout, actuation, shooting.newton_options());
    shooting.scale(march);
    march.solver.precision = Precision::checked;
    march.solver.tolerance = section_tolerance;
    tell_shift(solution);
    if (!march.run(solution.free_end, solution.mesh)) return false;
    double missed[MAX_UNKNOWNS];
    shooting.residual(march.base, actuation.rotation, missed);
    if (!std::isfinite(norm(missed))) return false;
    step_with_neighbour(missed, solution);
    return true;
}

void NewtonSolver::approach(const Solution& guess, Solution& solution) {
    double missed[MAX_UNKNOWNS];
    missed_at(guess, missed);
    step_with_neighbour(missed, solution);

    March<double, double> march(robot, layout, actuation, shooting.newton_options());
    shooting.scale(march);
    march.solver.precision = Precision::rough;
    tell_shift(solution);
    if (!march.run(solution.free_end, solution.mesh)) return;
    shooting.residual(march.base, actuation.rotation, missed);
    step_with_neighbour(missed, solution);
}

}  // namespace tactr
