// What the tubes carry at both ends of every section: their resultants, their tendons' pulls and their energies.
#pragma once
#include <cmath>
#include <vector>

#include "march.hpp"

namespace tactr {

struct Wrench {
    double force[3], moment[3];
};

/// One end of a section. Wrenches in R_b; tubes by place among those present, tendons among those hosted.
struct SectionEnd {
    double quaternion[4];           // R_b
    double psi[MAX_TUBES];
    Wrench resultant[MAX_TUBES];    // N_i, M_i: elastic part and tendons
    std::vector<Wrench> pull;       // lambda t, lambda r x t
    std::vector<double> path;       // lambda |q|
    double power[MAX_TUBES];        // of the resultants on the strains: N.v + M.u, behind the exit M_3 tau alone
    double energy[MAX_TUBES];       // strain energy per length
};

/// Strain energy per length of one tube at the given strains, J/m.
template <class C>
C strain_energy(const TubeState<C>& tube, double c, double s, const Strains& e, int slot) {
    const double stretch = 1.0 + e.eta[slot];
    const C bx = c * e.kx + s * e.ky - tube.ustar[0], by = c * e.ky - s * e.kx - tube.ustar[1];
    const C twist = e.tau[slot] - tube.ustar[2];
    const C vx = stretch * (c * e.wx + s * e.wy) - tube.vstar[0], vy = stretch * (c * e.wy - s * e.wx) - tube.vstar[1];
    const C vz = e.eta[slot] - tube.vstar[2] + bx * tube.axis[1] - by * tube.axis[0];  // at the neutral axis
    return 0.5 * (tube.EIx * bx * bx + tube.EIy * by * by + tube.GJ * twist * twist + tube.EA * vz * vz +
                  tube.GA * (vx * vx + vy * vy));
}

/// The same for the tube in a slot of the section solved last.
template <class M>
double energy_density(const M& march, int a) {
    return strain_energy(march.solver.tubes[a], march.solver.cosine[a], march.solver.sine[a], march.solver.strains, a);
}

/// From the section solved last; state: its packed states.
template <class M>
void read_end(const M& march, const Section<double>& section, const double* state, SectionEnd& out) {
    const Strains& e = march.solver.strains;
    for (int c = 0; c < 4; ++c) out.quaternion[c] = state[march.packing.frame + c];
    for (int a = 0; a < section.active_count; ++a) {
        const double *n = march.solver.N_xy[a], *m = march.solver.M_xy[a], stretch = 1.0 + e.eta[a];
        out.psi[a] = state[3 * a];
        out.resultant[a] = {{n[0], n[1], state[3 * a + 1]}, {m[0], m[1], state[3 * a + 2]}};
        out.energy[a] = energy_density(march, a);
        out.power[a] = state[3 * a + 2] * e.tau[a];
        if (!section.guided)
            out.power[a] += m[0] * e.kx + m[1] * e.ky + stretch * (n[0] * e.wx + n[1] * e.wy + state[3 * a + 1]);
    }
    out.pull.clear();
    out.path.clear();
    for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
        const TendonState<double>& tendon = march.solver.tendons[h];
        double n[3] = {}, m[3] = {}, inverse, t[3], r[2];
        add_tendon(tendon, march.solver.cosine[tendon.slot], march.solver.sine[tendon.slot], e, n, m, inverse, t, r);
        out.pull.push_back({{n[0], n[1], n[2]}, {m[0], m[1], m[2]}});
        out.path.push_back(tendon.tension / inverse);
    }
}

/// By section.
struct SectionEnds {
    std::vector<SectionEnd> distal, proximal;

    explicit SectionEnds(size_t sections) : distal(sections), proximal(sections) {}
};

/// Watches a march and keeps both ends of every section.
class EndsReader : public SectionEnds {
  public:
    using Stages = void;

    EndsReader(const Robot& robot, const Layout<double>& layout)
        : SectionEnds(layout.sections.size()), robot_(robot), layout_(layout) {}

    template <class M>
    void stage(M& march, const Section<double>& section, int k, double s, double) {
        if (s == section.distal) read_end(march, section, march.z, distal[k]);
    }

    template <class M>
    void operator()(M& march, int k, const double*, double s, double h) {
        const Section<double>& section = layout_.sections[k];
        if (!ends_section(section, s + h)) return;
        Strains e = march.solver.strains;
        if (march.solver.solve(section, section.proximal, march.z, march.packing, e))
            read_end(march, section, march.z, proximal[k]);
    }

  protected:
    const Robot& robot_;
    const Layout<double>& layout_;
};

}  // namespace tactr
