// Exact derivatives of the tip with respect to tensions and rotations: dual parameters through one march, and the
// implicit function theorem at the base.
#pragma once
#include <vector>

#include "free_end.hpp"
#include "march.hpp"
#include "solution.hpp"

namespace tactr {

/// Columns: tensions, then rotations. Rows: tip position (m), small rotation of the tip about world axes (rad).
struct TipJacobian {
    int columns;
    std::vector<double> rows[6];
};

class Sensitivity {
  public:
    Sensitivity(const Robot& robot, const Solution& solution)
        : robot_(robot), solution_(solution), plain_(cut_into_sections(robot, solution.translation.data())), shooting_(robot, plain_) {}

    bool tip(TipJacobian& out) {
        const int n = shooting_.unknowns, m = robot_.tendon_count, inputs = n + m + robot_.tube_count;
        residual_.assign(static_cast<size_t>(MAX_UNKNOWNS) * inputs, 0.0);
        for (auto& row : tip_) row.assign(inputs, 0.0);
        for (int first = 0; first < inputs; first += LANES)
            if (!march_lanes(first, inputs)) return false;
        out.columns = inputs - n;
        for (int r = 0; r < 6; ++r) out.rows[r].assign(tip_[r].begin() + n, tip_[r].end());
        for (int c = 0; c < out.columns; ++c) {
            double A[MAX_UNKNOWNS][MAX_UNKNOWNS], shift[MAX_UNKNOWNS];
            for (int i = 0; i < n; ++i) {
                shift[i] = residual_[i * inputs + n + c];
                for (int j = 0; j < n; ++j) A[i][j] = residual_[i * inputs + j];
            }
            if (n > 0 && solve_dense(n, A, shift) == 0.0) return false;
            for (int r = 0; r < 6; ++r)
                for (int j = 0; j < n; ++j) out.rows[r][c] -= tip_[r][j] * shift[j];
        }
        return true;
    }

  private:
    static constexpr int LANES = 8;
    using D = Dual<LANES>;

    const Robot& robot_;
    const Solution& solution_;
    Layout<double> plain_;
    Shooting shooting_;
    std::vector<double> residual_;  // unknown-major
    std::vector<double> tip_[6];

    static D seeded(double v, int input, int first) {
        D d(v);
        if (input >= first && input < first + LANES) d.d[input - first] = 1.0;
        return d;
    }

    bool march_lanes(int first, int inputs) {
        const int n = shooting_.unknowns, m = robot_.tendon_count;
        std::vector<D> tension, rotation, translation;
        for (int j = 0; j < m; ++j) tension.push_back(seeded(solution_.tension[j], n + j, first));
        for (int i = 0; i < robot_.tube_count; ++i) {
            rotation.push_back(seeded(solution_.rotation[i], n + m + i, first));
            translation.push_back(D(solution_.translation[i]));
        }
        const Actuation<D> actuation{tension.data(), rotation.data(), translation.data(), 1.0, 1.0};
        const Layout<D> layout = cut_into_sections(robot_, translation.data());
        March<D, D> march(robot_, layout, actuation, shooting_.full_options());
        shooting_.scale(march);
        FreeEnd<D> end;
        shooting_.seed(solution_.free_end, first, end);
        Mesh mesh = solution_.mesh;
        mesh.unknowns = 0;
        if (!march.run(end, mesh)) return false;
        D r[MAX_UNKNOWNS], position[3], q[4];
        shooting_.residual(march.base, rotation.data(), r);
        shooting_.tip_pose(end, march.base, rotation[0], position, q);
        for (int l = 0; l < LANES && first + l < inputs; ++l) {
            for (int i = 0; i < n; ++i) residual_[i * inputs + first + l] = r[i].d[l];
            for (int a = 0; a < 3; ++a) tip_[a][first + l] = position[a].d[l];
            const double rate[4] = {q[0].d[l], q[1].d[l], q[2].d[l], q[3].d[l]};
            const double back[4] = {q[0].v, -q[1].v, -q[2].v, -q[3].v};
            double turn[4];
            multiply_quaternions(rate, back, turn);
            for (int a = 0; a < 3; ++a) tip_[3 + a][first + l] = 2.0 * turn[1 + a];
        }
        return true;
    }
};

}  // namespace tactr
