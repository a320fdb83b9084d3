#include "joint.hpp"

#include <cmath>

#include "newton.hpp"

namespace tactr {

namespace {

/// Lanes first .. first + K - 1 of the inputs: free-end unknowns, then tensions.
template <int K>
bool march_lanes(const Robot& robot, int first, Solution& solution, JointMarch& out) {
    using D = Dual<K>;
    const Layout<double> plain = cut_into_sections(robot, solution.translation.data());
    const Shooting shooting(robot, plain);
    const int n = shooting.unknowns, inputs = n + robot.tendon_count;
    std::vector<D> tension, rotation, translation;
    for (int j = 0; j < robot.tendon_count; ++j) {
        tension.push_back(D(solution.tension[j]));
        const int lane = n + j - first;
        if (lane >= 0 && lane < K) tension.back().d[lane] = 1.0;
    }
    for (int i = 0; i < robot.tube_count; ++i) {
        rotation.push_back(D(solution.rotation[i]));
        translation.push_back(D(solution.translation[i]));
    }
    const Actuation<D> actuation{tension.data(), rotation.data(), translation.data(), 1.0, 1.0};
    const Layout<D> layout = cut_into_sections(robot, translation.data());
    March<D, D> march(robot, layout, actuation, {true, true, true});
    shooting.scale(march);
    march.lengths_move = true;
    if (first == 0 && n <= K) march.slope_lanes = n;
    FreeEnd<D> end;
    shooting.seed(solution.free_end, first, end);
    if (!march.run(end, solution.mesh)) return false;
    D r[MAX_UNKNOWNS];
    shooting.residual(march.base, rotation.data(), r);
    const auto keep = [&](int row, const D& x) {
        for (int l = 0; l < K && first + l < inputs; ++l) out.matrix[static_cast<size_t>(row) * inputs + first + l] = x.d[l];
    };
    for (int i = 0; i < n; ++i) {
        if (!std::isfinite(r[i].v)) return false;
        out.missed[i] = r[i].v;
        keep(i, r[i]);
    }
    for (int j = 0; j < robot.tendon_count; ++j) {
        solution.tendon_length[j] = march.moving_length[j].v;
        keep(n + j, march.moving_length[j]);
    }
    return true;
}

}  // namespace

bool joint_march(const Robot& robot, const std::vector<double>& step, const Settings& settings, Solution& solution, JointMarch& out) {
    constexpr int FEW = 6, MANY = 14;
    const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    NewtonSolver newton(robot, actuation, settings);
    const int n = newton.shooting.unknowns, inputs = n + robot.tendon_count;
    const FreeEnd<double> from = solution.free_end;
    newton.shooting.move(from, step.data(), 1.0, solution.free_end);
    if (solution.mesh.steps.size() != newton.layout.sections.size())
        newton.choose_mesh(solution);
    else
        newton.shooting.difference(from, solution.free_end, solution.mesh.shift);
    out.missed.assign(n, 0.0);
    out.matrix.assign(static_cast<size_t>(inputs) * inputs, 0.0);
    solution.tendon_length.assign(robot.tendon_count, 0.0);
    for (int first = 0; first < inputs || first == 0;) {
        const bool few = inputs - first <= FEW;
        solution.steps_marched += solution.mesh.total();
        ++solution.iterations;
        if (!(few ? march_lanes<FEW>(robot, first, solution, out) : march_lanes<MANY>(robot, first, solution, out))) return false;
        for (double& shift : solution.mesh.shift) shift = 0.0;
        first += few ? FEW : MANY;
    }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) solution.jacobian[i][j] = out.matrix[static_cast<size_t>(i) * inputs + j];
    return true;
}

}  // namespace tactr
