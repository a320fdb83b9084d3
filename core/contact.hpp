// What nested tubes exert on each other: they press without friction, so what a tube's own balance (theory sections 1
// and 2) leaves open across its axis comes from its neighbours, and of neighbours one is left when all further in are
// summed:  on all of j, j+1, ...:  sum of -(N' + u x N + f_ext),  sum of -(M' + u x M + v x N + tau_ext).
#pragma once
#include <cmath>
#include <vector>

#include "sample.hpp"
#include "section_ends.hpp"

namespace tactr {

/// On every tube present from its next outer neighbour, world axes, at one place: per length, or concentrated.
struct ContactRecord {
    double s;
    int outer[MAX_TUBES];  // the neighbour, -1: absent; the outermost: itself, and the wrench is what the guide exerts
    Wrench on[MAX_TUBES];
};

struct Contacts {
    std::vector<ContactRecord> along, points;
};

/// Sums what is exerted on each tube over it and all further in, and turns it from R_b to world axes.
inline void sum_from_inside(const Section<double>& section, const Wrench* exerted, const double* quaternion, ContactRecord& out) {
    for (int& outer : out.outer) outer = -1;
    double force[3] = {}, moment[3] = {};
    for (int a = section.active_count - 1; a >= 0; --a) {
        const int i = section.active[a];
        for (int c = 0; c < 3; ++c) {
            force[c] += exerted[a].force[c];
            moment[c] += exerted[a].moment[c];
        }
        out.outer[i] = section.active[a > 0 ? a - 1 : 0];
        to_world(quaternion, force, out.on[i].force);
        to_world(quaternion, moment, out.on[i].moment);
    }
}

/// A vector given in world axes or in those of a tube at angle psi, in R_b.
inline void load_in(const double v[3], bool body_axes, const double* quaternion, double psi, double out[3]) {
    if (!body_axes) return to_frame(quaternion, v, out);
    const double s = std::sin(psi), c = std::cos(psi);
    out[0] = c * v[0] - s * v[1];
    out[1] = s * v[0] + c * v[1];
    out[2] = v[2];
}

/// Distributed contact at the stations of samples. N', M' across the axis need the strains' derivatives along s: those
/// of the section's equilibrium, solved in dual numbers with the states seeded with their rates and s with 1.
class ContactReader {
  public:
    ContactReader(const Robot& robot, const Solution& solution, const Samples& samples, const std::vector<double>& stations)
        : ContactReader(robot, cut_into_sections(robot, solution.translation.data()), solution, samples, stations) {}

    ContactReader(const Robot& robot, const Layout<double>& layout, const Solution& solution, const Samples& samples,
                  const std::vector<double>& stations)
        : robot_(robot), samples_(samples), stations_(stations), layout_(layout),
          actuation_{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0},
          shooting_(robot, layout_), march_(robot, layout_, actuation_, {true, true, false}),
          tension_(solution.tension.begin(), solution.tension.end()),
          rotation_(solution.rotation.begin(), solution.rotation.end()),
          translation_(solution.translation.begin(), solution.translation.end()),
          dual_layout_(at_rest<D>(layout_)),
          dual_actuation_{tension_.data(), rotation_.data(), translation_.data(), 1.0, 1.0},
          dual_(robot, dual_layout_, dual_actuation_) {
        shooting_.scale(march_);
        march_.solver.precision = Precision::checked;
        dual_.moment_scale = shooting_.moment_scale;
        dual_.force_scale = shooting_.force_scale;
    }

    bool read(std::vector<ContactRecord>& out) {
        out.resize(stations_.size());
        for (size_t k = 0; k < stations_.size(); ++k)
            if (!read_station(stations_[k], samples_.stations[k], out[k])) return false;
        return true;
    }

    /// From packed states in section k at s, as a march with sums and frame carries them; e: start and result of the strains
    /// there; axes: R_b. end: what the tubes carry there, where wanted.
    bool read_states(int k, double s, const double* z, Strains& e, const double* axes, ContactRecord& out, SectionEnd* end = nullptr) {
        const Section<double>& section = layout_.sections[k];
        march_.packing.set(section.active, section.active_count, false, march_.options);
        double rate[STATES];
        if (!march_.derivative(section, s, z, rate, e)) return false;
        if (end) read_end(march_, section, z, *end);
        D seeded[STATES], place(s);
        place.d[0] = 1.0;
        for (int n = 0; n < march_.packing.count; ++n) {
            seeded[n] = D(z[n]);
            seeded[n].d[0] = rate[n];
        }
        if (!dual_.solve(dual_layout_.sections[k], place, seeded, march_.packing, e)) return false;
        Wrench exerted[MAX_TUBES];
        for (int a = 0; a < section.active_count; ++a) exerted[a] = open_balance(a, z);
        add_loads(section, z, exerted);
        out.s = s;
        sum_from_inside(section, exerted, axes, out);
        return true;
    }

  private:
    using D = Dual<1>;
    const Robot& robot_;
    const Samples& samples_;
    const std::vector<double>& stations_;
    const Layout<double> layout_;
    const Actuation<double> actuation_;
    const Shooting shooting_;
    March<double, double> march_;
    const std::vector<D> tension_, rotation_, translation_;
    const Layout<D> dual_layout_;
    const Actuation<D> dual_actuation_;
    SectionSolver<D, D> dual_;

    /// The sampler reads a breakpoint from its proximal side, and the guide's exit from outside.
    int section_at(double s) const {
        int k = 0;
        const int last = static_cast<int>(layout_.sections.size()) - 1;
        while (k < last && (layout_.sections[k].guided || layout_.sections[k].distal < s)) ++k;
        return k;
    }

    bool read_station(double s, const StationRecord& station, ContactRecord& out) {
        const int k = section_at(s);
        const Section<double>& section = layout_.sections[k];
        march_.packing.set(section.active, section.active_count, false, march_.options);
        double z[STATES];
        Strains e = strains_of(section, station);
        resultants_at(section, s, station, e, z);
        return read_states(k, s, z, e, station.quaternion, out);
    }

    static Strains strains_of(const Section<double>& section, const StationRecord& station) {
        Strains e{};
        const int first = section.active[0];
        const double c = std::cos(station.psi[first]), s = std::sin(station.psi[first]);
        const double *u = station.u[first], *v = station.v[first];
        e.kx = c * u[0] - s * u[1];
        e.ky = s * u[0] + c * u[1];
        e.wx = (c * v[0] - s * v[1]) / v[2];
        e.wy = (s * v[0] + c * v[1]) / v[2];
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = station.u[section.active[a]][2];
            e.eta[a] = station.v[section.active[a]][2] - 1.0;
        }
        return e;
    }

    /// Packed states from what was sampled: the elastic part turned to R_b, and the tendons' pull at the strains.
    void resultants_at(const Section<double>& section, double s, const StationRecord& station, const Strains& e, double* z) {
        double sine[MAX_TUBES], cosine[MAX_TUBES];
        double* sums = z + march_.packing.sums;
        for (int c = 0; c < 4; ++c) sums[c] = 0.0;
        const auto carry = [&](int a, const double* n, const double* m) {
            for (int c = 0; c < 2; ++c) {
                sums[c] += n[c];
                sums[2 + c] += m[c];
            }
            z[3 * a + 1] += n[2];
            z[3 * a + 2] += m[2];
        };
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            z[3 * a] = station.psi[i];
            z[3 * a + 1] = z[3 * a + 2] = 0.0;
            sine_cosine(z[3 * a], sine[a], cosine[a]);
            Wrench elastic;
            load_in(station.n[i], true, nullptr, station.psi[i], elastic.force);
            load_in(station.m[i], true, nullptr, station.psi[i], elastic.moment);
            carry(a, elastic.force, elastic.moment);
        }
        march_.solver.place_tendons(section, s);
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
            const TendonState<double>& tendon = march_.solver.tendons[h];
            double n[3] = {}, m[3] = {}, inverse, t[3], r[2];
            add_tendon(tendon, cosine[tendon.slot], sine[tendon.slot], e, n, m, inverse, t, r);
            carry(tendon.slot, n, m);
        }
        for (int c = 0; c < 4; ++c) z[march_.packing.frame + c] = station.quaternion[c];
    }

    /// -(N' + kappa x N), -(M' + kappa x M + v x N) across the axis, of the tube in a slot.
    Wrench open_balance(int a, const double* z) const {
        const auto& e = dual_.strains;
        const double kx = e.kx.v, ky = e.ky.v, wx = e.wx.v, wy = e.wy.v, stretch = 1.0 + e.eta[a].v;
        const D *n = dual_.N_xy[a], *m = dual_.M_xy[a];
        const double n3 = z[3 * a + 1], m3 = z[3 * a + 2];
        return {{-n[0].d[0] - ky * n3, -n[1].d[0] + kx * n3, 0.0},
                {-m[0].d[0] - ky * m3 - stretch * (wy * n3 - n[1].v), -m[1].d[0] + kx * m3 - stretch * (n[0].v - wx * n3), 0.0}};
    }

    void add_loads(const Section<double>& section, const double* z, Wrench* exerted) const {
        for (int d = section.distributed_loads.begin; d < section.distributed_loads.end; ++d) {
            const SectionLoad& placed = layout_.distributed_loads[d];
            const DistributedLoad& load = robot_.distributed_loads[placed.load];
            double force[3], moment[3];
            load_in(load.force, load.body_axes, z + march_.packing.frame, z[3 * placed.slot], force);
            load_in(load.moment, load.body_axes, z + march_.packing.frame, z[3 * placed.slot], moment);
            for (int c = 0; c < 2; ++c) {
                exerted[placed.slot].force[c] -= force[c];
                exerted[placed.slot].moment[c] -= moment[c];
            }
        }
    }
};

}  // namespace tactr
