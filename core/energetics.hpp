// Energies and generalised actuator forces of a converged solution, by one plain march.
#pragma once
#include "energy.hpp"
#include "free_end.hpp"

namespace tactr {

/// Hamiltonian of every tube just inside the guide, at what it carries outside; false: a section has no equilibrium.
template <class M>
bool entry_hamiltonian(M& march, const Robot& robot, const Layout<double>& layout, const EnergyReader& reader, double* entry) {
    size_t k = 0;
    while (layout.sections[k].guided) ++k;
    Section<double> inside = layout.sections[k];
    inside.guided = 1;
    const SectionEnd& outside = reader.proximal[k];
    march.packing.set(inside.active, inside.active_count, true, march.options);
    double z[STATES] = {};
    Strains e = march.solver.strains;
    e.kx = e.ky = e.wx = e.wy = 0.0;
    for (int a = 0; a < inside.active_count; ++a) {
        z[3 * a] = outside.psi[a];
        z[3 * a + 1] = outside.resultant[a].force[2];
        z[3 * a + 2] = outside.resultant[a].moment[2];
        e.tau[a] = e.eta[a] = 0.0;
    }
    if (!march.solver.solve(inside, 0.0, z, march.packing, e)) return false;
    SectionEnd end;
    read_end(march, inside, z, end);
    for (int i = 0; i < robot.tube_count; ++i) entry[i] = 0.0;
    for (int a = 0; a < inside.active_count; ++a) entry[inside.active[a]] += end.power[a] - end.energy[a];
    for (int h = inside.hosted.begin; h < inside.hosted.end; ++h)
        entry[robot.tendons[layout.hosted[h].tendon].tube] -= end.path[h - inside.hosted.begin];
    return true;
}

/// One plain march of a converged solution, watched by the reader.
struct EnergyMarch {
    const Layout<double> layout;
    const Actuation<double> actuation;
    const Shooting shooting;
    March<double, double> march;
    EnergyReader reader;

    EnergyMarch(const Robot& robot, const Solution& solution)
        : layout(cut_into_sections(robot, solution.translation.data())),
          actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0},
          shooting(robot, layout), march(robot, layout, actuation, shooting.full_options()), reader(robot, layout, actuation) {
        shooting.scale(march);
    }

    bool run(const Solution& solution) {
        Mesh mesh = solution.mesh;
        return march.run(solution.free_end, mesh, reader);
    }

    /// Of the springs that turn the tubes.
    double spring_energy() const {
        double sum = 0.0;
        for (int i = 0; i < march.robot.tube_count; ++i)
            sum += 0.5 * march.robot.tubes[i].rotation_compliance * march.y[M3 + i] * march.y[M3 + i];
        return sum;
    }

    double load_potential() const {
        double sum = -reader.load_work;
        for (int c = 0; c < 3; ++c) sum += reader.load_sum[c] * march.base.position[c];
        return sum;
    }
};

/// Strain energy, that of springs at the tubes, that of the tendons' pull (tension times length) and of dead forces, J; the
/// largest double where the march fails. Moments and loads in body axes have no potential and are left out.
inline double potential_energy(const Robot& robot, const Solution& solution) {
    EnergyMarch pass(robot, solution);
    if (!pass.run(solution)) return std::numeric_limits<double>::max();
    double sum = pass.reader.pulled + pass.load_potential() + pass.spring_energy();
    for (double energy : pass.reader.stored) sum += energy;
    return sum;
}

inline bool energetics(const Robot& robot, const Solution& solution, Energetics& out) {
    EnergyMarch pass(robot, solution);
    if (!pass.run(solution)) return false;
    out.strain_energy = pass.reader.stored;
    out.load_potential = pass.load_potential();
    out.torque.clear();
    for (int i = 0; i < robot.tube_count; ++i) out.torque.push_back(-pass.march.y[M3 + i]);
    double entry[MAX_TUBES];
    if (!entry_hamiltonian(pass.march, robot, pass.layout, pass.reader, entry)) return false;
    out.force = BaseForces(robot, pass.layout, pass.reader, solution.translation.data()).find(entry);
    return true;
}

}  // namespace tactr
