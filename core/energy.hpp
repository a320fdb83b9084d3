// Potential energy of a solution: of the tubes, of the tendons' pull and of dead forces.
//
// A tendon of constant tension lambda gives lambda times its length. A dead force F at s_F does -F . p(s_F); summed over
// all forces that is -integral of N . p' ds, where N(s), the sum of the forces beyond s, is what the march carries. The
// positions are thus not needed. Moments and loads in body axes have no potential and are left out, as far as they do
// not show in N.
#pragma once
#include "dense_output.hpp"
#include "free_end.hpp"
#include "march.hpp"
#include "solution.hpp"

namespace tactr {

class EnergyMeter {
  public:
    double total = 0.0;  // J

    explicit EnergyMeter(const Layout<double>& layout) : layout_(layout) {}

    template <class M>
    void operator()(M& march, int k, const double* before, double s, double h) {
        // Gauss and Legendre, 5 points: order 10
        static constexpr double X[5] = {0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
        static constexpr double WEIGHT[5] = {0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                             0.118463442528095};
        const Section<double>& section = layout_.sections[k];
        if (!dense_.prepare(march, section, before, s, h)) return;
        for (int g = 0; g < 5; ++g) {
            double packed[STATES];
            dense_.at(X[g], packed);
            if (!march.solver.solve(section, s + h * X[g], packed, march.packing, dense_.strains)) return;
            total += WEIGHT[g] * std::fabs(h) * density(march, section, packed);
        }
    }

  private:
    const Layout<double>& layout_;
    DenseOutput<double> dense_;

    template <class M>
    double density(const M& march, const Section<double>& section, const double* packed) const {
        const Strains& e = dense_.strains;
        double along = 0.0;
        for (int a = 0; a < section.active_count; ++a) along += packed[3 * a + 1];
        if (march.packing.sums >= 0) along += packed[march.packing.sums] * e.wx + packed[march.packing.sums + 1] * e.wy;
        return march.solver.stored(section, e) - along * (1.0 + e.eta[0]);
    }
};

/// Potential energy of a converged solution, J, at its own actuation.
inline double energy_of(const Robot& robot, const Solution& solution) {
    const Layout<double> layout = cut_into_sections(robot, solution.translation.data());
    const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    const Shooting shooting(robot, layout);
    March<double, double> march(robot, layout, actuation, shooting.newton_options());
    shooting.scale(march);
    Mesh mesh = solution.mesh;
    mesh.unknowns = 0;
    EnergyMeter meter(layout);
    return march.run(solution.free_end, mesh, meter) ? meter.total : std::numeric_limits<double>::max();
}

}  // namespace tactr
