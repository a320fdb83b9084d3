// Energies of a converged solution, and what its actuators hold: the derivatives of the total potential
//     E = strain energy + sum of tension * tendon length - loads * displacement
// with respect to base rotations and translations, at the equilibrium (so all else may be varied or not, as one likes).
//
// Rotation: d E / d alpha_i = -M_i3 at the proximal end.
// Translation: tube i slides along the common curve, all shapes over s kept. What it carries along (its ends, jumps of
// rest curvature, stiffness or routing, ends of tendons, loads) moves along s, and a moving jump at s_k costs the jump
// of the Hamiltonian H = sum of (N.v + M.u) - strain energy - sum of tension |q| (Weierstrass and Erdmann), beyond minus
// before; smooth variation of its stiffness and rest shape, its routing and its distributed loads add
//     -integral of d(strain energy)/d(sigma),    -integral of tension t.(u x r' + r'') + tension' |q|    and
//     -integral of f.v + tau.u.
// Behind the guide's exit nothing moves across and the exit itself holds p, so there H = M_3 tau - energies.
#pragma once
#include <vector>

#include "contact.hpp"
#include "section_ends.hpp"
#include "solution.hpp"

namespace tactr {

struct Energetics {
    std::vector<double> strain_energy;  // per tube, J
    double load_potential;              // of forces in world axes, J; p = 0 at the guide's exit
    std::vector<double> torque, force;  // per tube, N m about z, N along z, by the actuator on the tube
};

class EnergyReader : public EndsReader {
  public:
    using Stages = void;
    std::vector<double> stored, carried;  // per tube; stored: strain energy; carried: the integrals of the translation's derivative
    double pulled = 0.0;                         // integral of tension along the tendons, J
    double load_work = 0.0;                      // sum of force * position, in the march's axes
    double load_sum[3] = {0.0, 0.0, 0.0};        // of the forces outside the guide

    EnergyReader(const Robot& robot, const Layout<double>& layout, const Actuation<double>& actuation)
        : EndsReader(robot, layout), stored(robot.tube_count, 0.0), carried(robot.tube_count, 0.0), actuation_(actuation) {}

    template <class M>
    void stage(M& march, const Section<double>& section, int k, double s, double weight) {
        EndsReader::stage(march, section, k, s, weight);
        if (s == section.distal) take_point_loads(march, section, s);
        for (int a = 0; a < section.active_count; ++a) {
            stored[section.active[a]] += weight * energy_density(march, a);
            carried[section.active[a]] -= weight * stiffness_slope(march, section, a, s);
        }
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const int place = h - section.hosted.begin;
            pulled += weight * march.solver.tendons[place].tension / march.solver.tendon_tangents[place].inverse;
            carried[robot_.tendons[layout_.hosted[h].tendon].tube] -=
                weight * route_slope(march, layout_.hosted[h], place, s);
        }
        for (int d = section.distributed_loads.begin; d < section.distributed_loads.end; ++d)
            take_distributed_load(march, section, layout_.distributed_loads[d], s, weight);
    }

  private:
    const Actuation<double>& actuation_;

    /// d(strain energy per length)/d(sigma) at fixed strains, of a tube that varies along itself.
    template <class M>
    double stiffness_slope(const M& march, const Section<double>& section, int a, double s) const {
        const TubePiece& piece = robot_.pieces[section.piece[a]];
        if (piece.count == 1) return 0.0;
        Dual<1> sigma(s - actuation_.translation[section.active[a]]);
        sigma.d[0] = 1.0;
        const TubeState<Dual<1>> tube = tube_at(piece, sigma, actuation_.shape_scale);
        return strain_energy(tube, march.solver.cosine[a], march.solver.sine[a], march.solver.strains, a).d[0];
    }

    /// d(tension |q|)/d(sigma) at fixed strains: t.(u x r' + r'') times tension, and tension' |q|.
    template <class M>
    double route_slope(const M& march, const Hosted& hosted, int place, double s) const {
        Dual<1> sigma(s - actuation_.translation[robot_.tendons[hosted.tendon].tube]), r[2], dr[2];
        sigma.d[0] = 1.0;
        evaluate_routing(robot_.routing[hosted.routing], sigma, r, dr);
        const int a = hosted.slot;
        const double c = march.solver.cosine[a], sn = march.solver.sine[a];
        const double rx = c * dr[0].v - sn * dr[1].v, ry = sn * dr[0].v + c * dr[1].v;
        const Strains& e = march.solver.strains;
        const TendonTangent& tangent = march.solver.tendon_tangents[place];
        const double qx = c * dr[0].d[0] - sn * dr[1].d[0] - e.tau[a] * ry, qy = sn * dr[0].d[0] + c * dr[1].d[0] + e.tau[a] * rx;
        const double stretched = tangent.t[0] * qx + tangent.t[1] * qy + tangent.t[2] * (e.kx * ry - e.ky * rx);
        double slope = 0.0;
        if (hosted.profile >= 0) {
            const TensionPiece& piece = robot_.profiles[hosted.profile];
            double factor;
            evaluate_polynomial(piece.c, piece.count, sigma.v - piece.start, factor, slope);
            slope *= actuation_.tension[hosted.tendon];
        }
        return march.solver.tendons[place].tension * stretched + slope / tangent.inverse;
    }

    template <class M>
    void take_distributed_load(const M& march, const Section<double>& section, const SectionLoad& placed, double s, double weight) {
        const DistributedLoad& load = robot_.distributed_loads[placed.load];
        const Strains& e = march.solver.strains;
        const int a = placed.slot;
        const double* q = march.z + march.packing.frame;
        double f[3], m[3];
        load_in(load.force, load.body_axes, q, march.z[3 * a], f);
        load_in(load.moment, load.body_axes, q, march.z[3 * a], m);
        const double stretch = section.guided ? 1.0 : 1.0 + e.eta[0];  // the curve follows the outermost tube
        double power = stretch * f[2] + m[2] * e.tau[a];
        if (!section.guided) power += stretch * (f[0] * e.wx + f[1] * e.wy) + m[0] * e.kx + m[1] * e.ky;
        carried[section.active[a]] -= weight * power;
        if (!load.body_axes) move_load(march, section, load.force, s, weight);
    }

    template <class M>
    void take_point_loads(const M& march, const Section<double>& section, double s) {
        for (int p = section.point_loads.begin; p < section.point_loads.end; ++p) {
            const PointLoad& load = robot_.point_loads[layout_.point_loads[p].load];
            if (section.guided) carried[load.tube] -= load.force[2];
            if (!load.body_axes) move_load(march, section, load.force, s, 1.0);
        }
    }

    template <class M>
    void move_load(const M& march, const Section<double>& section, const double* force, double s, double weight) {
        if (section.guided) {
            load_work += weight * force[2] * s;
            return;
        }
        for (int c = 0; c < 3; ++c) {
            load_work += weight * force[c] * march.z[march.packing.path + c];
            load_sum[c] += weight * force[c];
        }
    }
};

/// The derivative of the total potential with respect to the tubes' translations.
class BaseForces {
  public:
    BaseForces(const Robot& robot, const Layout<double>& layout, const EnergyReader& reader, const double* translation)
        : robot_(robot), layout_(layout), reader_(reader), translation_(translation) {}

    /// entry: Hamiltonian of every tube just inside the guide, for those whose proximal end is at its exit.
    std::vector<double> find(const double* entry) const {
        std::vector<double> force = reader_.carried;
        const int count = static_cast<int>(layout_.sections.size());
        for (int i = 0; i < robot_.tube_count; ++i)
            if (translation_[i] > -BREAKPOINT_GAP) force[i] += entry[i];
        for (int k = 0; k < count; ++k) {
            const double s = layout_.sections[k].proximal;
            if (std::fabs(s) > BREAKPOINT_GAP) add_jump(k - 1, k, s, force);
        }
        add_jump(count - 1, count, layout_.sections[count - 1].distal, force);
        return force;
    }

  private:
    const Robot& robot_;
    const Layout<double>& layout_;
    const EnergyReader& reader_;
    const double* translation_;

    /// By the tube that carries them: energies counted with their tube, lengths with the tendon's own.
    void split(const Section<double>& section, const SectionEnd& end, double sign, double* by_tube) const {
        for (int a = 0; a < section.active_count; ++a) by_tube[section.active[a]] += sign * (end.power[a] - end.energy[a]);
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            by_tube[robot_.tendons[layout_.hosted[h].tendon].tube] -= sign * end.path[h - section.hosted.begin];
    }

    void add_jump(int before, int beyond, double s, std::vector<double>& force) const {
        double jump[MAX_TUBES] = {}, total = 0.0;
        if (before >= 0) split(layout_.sections[before], reader_.distal[before], -1.0, jump);
        if (beyond < static_cast<int>(layout_.sections.size())) split(layout_.sections[beyond], reader_.proximal[beyond], 1.0, jump);
        bool carries[MAX_TUBES];
        int carriers = 0;
        for (int i = 0; i < robot_.tube_count; ++i) {
            carries[i] = carries_jump(i, s);
            carriers += carries[i];
            total += jump[i];
        }
        // behind the exit tubes do not touch each other; outside, tubes that carry jumps to one place share them
        for (int i = 0; i < robot_.tube_count; ++i)
            if (carries[i]) force[i] += s < 0.0 && carriers > 1 ? jump[i] : total / carriers;
    }

    /// Ends of distributed loads and corners of tension profiles change H in no jump.
    bool carries_jump(int i, double s) const {
        const double sigma = s - translation_[i];
        const auto here = [sigma](double place) { return std::fabs(sigma - place) <= 2.0 * BREAKPOINT_GAP; };
        const Tube& tube = robot_.tubes[i];
        if (here(0.0) || here(tube.length)) return true;
        for (int k = tube.piece_begin + 1; k < tube.piece_end; ++k)
            if (here(robot_.pieces[k].start)) return true;
        for (int j = 0; j < robot_.tendon_count; ++j)
            if (robot_.tendons[j].tube == i && tendon_jumps(robot_.tendons[j], here)) return true;
        for (int l = 0; l < robot_.point_load_count; ++l)
            if (robot_.point_loads[l].tube == i && here(robot_.point_loads[l].at)) return true;
        return false;
    }

    template <class Here>
    bool tendon_jumps(const Tendon& tendon, const Here& here) const {
        if (here(tendon.end)) return true;
        for (int k = tendon.piece_begin + 1; k < tendon.piece_end; ++k)
            if (here(robot_.routing[k].start)) return true;
        return false;
    }
};

}  // namespace tactr
