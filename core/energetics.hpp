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
    read_end(march, robot, inside, z, end);
    for (int i = 0; i < robot.tube_count; ++i) entry[i] = 0.0;
    for (int a = 0; a < inside.active_count; ++a) entry[inside.active[a]] += end.power[a] - end.energy[a];
    for (int h = inside.hosted.begin; h < inside.hosted.end; ++h)
        entry[robot.tendons[layout.hosted[h].tendon].tube] -= end.path[h - inside.hosted.begin];
    return true;
}

inline bool energetics(const Robot& robot, const Solution& solution, Energetics& out) {
    const Layout<double> layout = cut_into_sections(robot, solution.translation.data());
    const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    const Shooting shooting(robot, layout);
    March<double, double> march(robot, layout, actuation, shooting.full_options());
    shooting.scale(march);
    Mesh mesh = solution.mesh;
    EnergyReader reader(robot, layout, actuation);
    if (!march.run(solution.free_end, mesh, reader)) return false;
    out.strain_energy = reader.stored;
    out.load_potential = -reader.load_work;
    for (int c = 0; c < 3; ++c) out.load_potential += reader.load_sum[c] * march.base.position[c];
    out.torque.clear();
    for (int i = 0; i < robot.tube_count; ++i) out.torque.push_back(-march.y[M3 + i]);
    double entry[MAX_TUBES];
    if (!entry_hamiltonian(march, robot, layout, reader, entry)) return false;
    out.force = BaseForces(robot, layout, reader, solution.translation.data()).find(entry);
    return true;
}

}  // namespace tactr
