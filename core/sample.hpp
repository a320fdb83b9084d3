// Reads a converged solution at any stations: one plain march with the dense output of the eighth-order rule.
#pragma once
#include <cmath>
#include <vector>

#include "dense_output.hpp"
#include "free_end.hpp"
#include "march.hpp"
#include "solution.hpp"

namespace tactr {

/// Everything at one station. Tube data in the tube's own material frame; p and R_b in world axes.
struct StationRecord {
    double position[3], quaternion[4];  // quaternion of R_b
    int present[MAX_TUBES];
    double psi[MAX_TUBES];
    double u[MAX_TUBES][3], v[MAX_TUBES][3], n[MAX_TUBES][3], m[MAX_TUBES][3];
};

struct TendonRecord {
    int host;  // tube, -1: absent at this station
    double r[2], tension;
    double rate, direction[3];  // its length per length of the robot, and its unit tangent in world axes
};

struct Samples {
    int tubes, tendons;
    std::vector<StationRecord> stations;
    std::vector<TendonRecord> tendon;  // station-major
};

class Sampler {
  public:
    Sampler(const Robot& robot, const Layout<double>& layout, const std::vector<double>& stations, Samples& samples)
        : robot_(robot), layout_(layout), stations_(stations), samples_(samples), next_(static_cast<int>(stations.size()) - 1) {
        samples.tubes = robot.tube_count;
        samples.tendons = robot.tendon_count;
        samples.stations.resize(stations.size());
        samples.tendon.resize(stations.size() * robot.tendon_count);
    }

    template <class M>
    void operator()(M& march, int k, const double* before, double s, double h) {
        const Section<double>& section = layout_.sections[k];
        const bool first = k == 0 || (!section.guided && layout_.sections[k - 1].guided);
        const double end = s + h;
        const bool last_step = ends_section(section, end);
        if (next_ < 0 || (stations_[next_] <= end && !(first && last_step))) return;
        if (!dense_.prepare(march, section, before, s, h)) return;
        while (next_ >= 0 && (stations_[next_] > end || (first && last_step && stations_[next_] >= end - 1e-12))) {
            read(march, section, s, h, next_);
            --next_;
        }
    }

  private:
    const Robot& robot_;
    const Layout<double>& layout_;
    const std::vector<double>& stations_;
    Samples& samples_;
    int next_;
    DenseOutput<double> dense_;

    template <class M>
    void read(M& march, const Section<double>& section, double s, double h, int station) {
        double packed[STATES], state[STATES];
        std::copy(march.y, march.y + STATES, state);
        dense_.at((stations_[station] - s) / h, packed);
        for (int n = 0; n < march.packing.count; ++n) state[march.packing.index[n]] = packed[n];
        march.solver.solve(section, stations_[station], packed, march.packing, dense_.strains);
        record(march, section, state, samples_.stations[station]);
        record_tendons(march, section, station);
    }

    template <class M>
    void record(M& march, const Section<double>& section, const double* state, StationRecord& out) const {
        out = StationRecord{};
        const Strains& e = dense_.strains;
        double norm = 0.0;
        for (int c = 0; c < 4; ++c) norm += state[QUAT + c] * state[QUAT + c];
        for (int c = 0; c < 4; ++c) out.quaternion[c] = state[QUAT + c] / std::sqrt(norm);
        for (int c = 0; c < 3; ++c) out.position[c] = state[POS + c];
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            const TubeState<double>& tube = march.solver.tubes[a];
            const double c = march.solver.cosine[a], s = march.solver.sine[a], stretch = 1.0 + e.eta[a];
            out.present[i] = 1;
            out.psi[i] = state[PSI + i];
            const double u[3] = {c * e.kx + s * e.ky, c * e.ky - s * e.kx, e.tau[a]};
            const double v[2] = {stretch * (c * e.wx + s * e.wy), stretch * (c * e.wy - s * e.wx)};
            std::copy(u, u + 3, out.u[i]);
            std::copy(v, v + 2, out.v[i]);
            out.v[i][2] = stretch;
            double n[3], m[3];
            elastic_wrench(tube, c, s, e, a, n, m);
            turn_back(c, s, n, out.n[i]);
            turn_back(c, s, m, out.m[i]);
        }
    }

    /// From R_b to a tube's own frame.
    static void turn_back(double c, double s, const double a[3], double out[3]) {
        out[0] = c * a[0] + s * a[1];
        out[1] = c * a[1] - s * a[0];
        out[2] = a[2];
    }

    template <class M>
    void record_tendons(M& march, const Section<double>& section, int station) {
        for (int j = 0; j < robot_.tendon_count; ++j) samples_.tendon[station * robot_.tendon_count + j] = TendonRecord{-1, {0, 0}, 0, 0, {0, 0, 0}};
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const TendonState<double>& tendon = march.solver.tendons[h - section.hosted.begin];
            double n[3] = {}, m[3] = {}, inverse, t[3], r[2];
            add_tendon(tendon, march.solver.cosine[tendon.slot], march.solver.sine[tendon.slot], dense_.strains, n, m, inverse, t, r);
            samples_.tendon[station * robot_.tendon_count + layout_.hosted[h].tendon] = TendonRecord{
                section.active[tendon.slot], {tendon.r[0], tendon.r[1]}, tendon.tension, 1.0 / inverse, {t[0], t[1], t[2]}};
        }
    }
};

/// Turns the records, marched from the tip, to world axes with the base at the origin.
inline void place_in_world(const Shooting& shooting, const BaseState<double>& base, double alpha, Samples& samples) {
    double turn[4];
    shooting.world_turn(base, alpha, turn);
    for (StationRecord& station : samples.stations) {
        double q[4], p[3];
        const double relative[3] = {station.position[0] - base.position[0], station.position[1] - base.position[1],
                                    station.position[2] - base.position[2]};
        multiply_quaternions(turn, station.quaternion, q);
        to_world(turn, relative, p);
        std::copy(q, q + 4, station.quaternion);
        std::copy(p, p + 3, station.position);
        for (int j = 0; j < samples.tendons; ++j) {
            double t[3];
            TendonRecord& tendon = samples.tendon[(&station - samples.stations.data()) * samples.tendons + j];
            to_world(station.quaternion, tendon.direction, t);
            std::copy(t, t + 3, tendon.direction);
        }
    }
}

/// Samples a solution at ascending stations in [smallest translation, tip].
inline bool sample(const Robot& robot, const Solution& solution, const std::vector<double>& stations, Samples& samples) {
    const Layout<double> layout = cut_into_sections(robot, solution.translation.data());
    const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    const Shooting shooting(robot, layout);
    March<double, double> march(robot, layout, actuation, shooting.full_options());
    shooting.scale(march);
    Mesh mesh = solution.mesh;
    Sampler sampler(robot, layout, stations, samples);
    if (!march.run(solution.free_end, mesh, sampler)) return false;
    place_in_world(shooting, march.base, solution.rotation[0], samples);
    return true;
}

}  // namespace tactr
