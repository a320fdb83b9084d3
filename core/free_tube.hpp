// One tube that nothing loads but its own tendons: no resultants run through it (theory, section 2), so that its strains at
// a place follow from the tensions there alone, and its course from the strains: R' = R [u], p' = R v in its own frame.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "chebyshev.hpp"
#include "newton.hpp"
#include "routing.hpp"
#include "tendon_chords.hpp"
#include "tendon_directions.hpp"

namespace tactr {

class FreeTube {
  public:
    /// Whether the robot is such a tube, and none of it held straight.
    static bool fits(const NewtonSolver& newton) {
        if (newton.robot.tube_count != 1 || newton.shooting.sums) return false;
        for (const auto& section : newton.layout.sections)
            if (section.guided) return false;
        return true;
    }

    FreeTube(const NewtonSolver& newton, double section_tolerance)
        : robot_(newton.robot), layout_(newton.layout), at_(newton.actuation), solver_(newton.robot, newton.layout, newton.actuation) {
        solver_.moment_scale = newton.shooting.moment_scale;
        solver_.force_scale = newton.shooting.force_scale;
        solver_.precision = Precision::checked;
        solver_.tolerance = section_tolerance;
        packing_.set(layout_.sections.front().active, 1, false, {false, false, false});
        turn_about_z(at_.rotation[0], turn_);
    }

    /// Tendons at the points of panels between edges, from the base on, each within one section; world axes. False: a section
    /// has no equilibrium, or turns too far for its points.
    bool read(const std::vector<double>& edges, std::vector<TendonDirection>& found) {
        const size_t panel = static_cast<size_t>(CURVE_POINTS) * robot_.tendon_count;
        found.assign((edges.size() - 1) * panel, TendonDirection{});
        size_t section = 0;
        for (size_t k = 0; k + 1 < edges.size(); ++k) {
            while (layout_.sections[section].distal < 0.5 * (edges[k] + edges[k + 1])) ++section;
            if (!cross(layout_.sections[section], edges[k], edges[k + 1], &found[k * panel])) return false;
        }
        return true;
    }

    /// Tendons at both ends of all sections; world axes. False as above.
    bool read(std::vector<TendonChord>& found) {
        const int tendons = robot_.tendon_count;
        found.assign(layout_.sections.size() * tendons, TendonChord{});
        std::vector<TendonDirection> inside;
        for (size_t k = 0; k < layout_.sections.size(); ++k) {
            const Section<double>& section = layout_.sections[k];
            const double length = section.distal - section.proximal;
            TendonChord* chord = &found[k * tendons];
            note_ends(section, section.proximal, &TendonChord::proximal, chord);
            if (is_uniform(section)) {
                At here;
                if (!solve(section, section.proximal, here)) return false;
                for (int h = section.hosted.begin; h < section.hosted.end; ++h)
                    chord[layout_.hosted[h].tendon].length = length / tangent(section, h).inverse;
                advance(here, length);
            } else {
                inside.assign(static_cast<size_t>(CURVE_POINTS) * tendons, TendonDirection{});
                if (!cross(section, section.proximal, section.distal, inside.data())) return false;
                for (int p = 0; p < CURVE_POINTS; ++p)
                    for (int j = 0; j < tendons; ++j) chord[j].length += 0.5 * length * rules_.weight[p] * inside[p * tendons + j].rate;
            }
            note_ends(section, section.distal, &TendonChord::distal, chord);
        }
        return true;
    }

    /// What a march to the place where the last read ended would note.
    void note(Solution& solution) const {
        solution.shortest_tendon = solver_.shortest_tendon;
        solution.section_residual = solver_.worst_residual;
        solution.least_stretch = solver_.least_stretch;
        solution.base_residual = 0.0;
        solution.base_determinant = 1.0;
        std::copy(position_, position_ + 3, solution.tip_position);
        std::copy(turn_, turn_ + 4, solution.tip_quaternion);
    }

    /// By how much a march on a mesh misses the tip at most, m: what the exponential of a step's angle leaves after the eighth
    /// power, at the longest lever. Infinite where a section is not uniform.
    double error_on(const Mesh& mesh) const {
        constexpr double NINE = 362880.0, SAFETY = 10.0;  // 9!; of the rule's own coefficient
        double sum = 0.0;
        for (size_t k = 0; k < turns_.size(); ++k) {
            const int steps = mesh.steps[k];
            const double grade = mesh.grade_of(k);
            const double longest = larger(Mesh::share_before(1, steps, grade), 1.0 - Mesh::share_before(steps - 1, steps, grade));
            sum += steps * std::pow(turns_[k] * longest, 9.0) / NINE;
        }
        return SAFETY * sum * layout_.sections.back().distal;
    }

  private:
    struct At {
        double u[3], v[3];  // in the tube's own frame
    };
    using Quaternion = std::array<double, 4>;

    static constexpr int MOST_SWEEPS = 40;
    static constexpr double SETTLED = 1e-14;

    const Robot& robot_;
    const Layout<double>& layout_;
    const Actuation<double>& at_;
    const ChebyshevRules& rules_ = ChebyshevRules::get();
    SectionSolver<double, double> solver_;
    Packing packing_;
    Strains strains_{};
    double turn_[4], position_[3] = {0.0, 0.0, 0.0};
    std::vector<double> turns_;  // rad, by section

    bool is_uniform(const Section<double>& section) const {
        if (robot_.pieces[section.piece[0]].count > 1) return false;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout_.hosted[h];
            const RoutingPiece& routing = robot_.routing[hosted.routing];
            if (routing.count_a > 1 || routing.count_b > 1) return false;
            if (hosted.profile >= 0 && robot_.profiles[hosted.profile].count > 1) return false;
        }
        return true;
    }

    /// From the strains of the last place.
    bool solve(const Section<double>& section, double s, At& out) {
        const double nothing[3] = {0.0, 0.0, 0.0};
        if (!solver_.solve(section, s, nothing, packing_, strains_)) return false;
        const double stretch = 1.0 + strains_.eta[0];
        out = {{strains_.kx, strains_.ky, strains_.tau[0]}, {stretch * strains_.wx, stretch * strains_.wy, stretch}};
        return true;
    }

    const TendonTangent& tangent(const Section<double>& section, int h) const { return solver_.tendon_tangents[h - section.hosted.begin]; }

    void note_ends(const Section<double>& section, double s, Triple TendonChord::*end, TendonChord* chord) const {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout_.hosted[h];
            double r[2], dr[2], out[3];
            evaluate_routing(robot_.routing[hosted.routing], s - at_.translation[robot_.tendons[hosted.tendon].tube], r, dr);
            const double offset[3] = {r[0], r[1], 0.0};
            to_world(turn_, offset, out);
            for (int a = 0; a < 3; ++a) (chord[hosted.tendon].*end)[a] = position_[a] + out[a];
        }
    }

    static Quaternion turned(const double* from, const double (&by)[3]) {
        const double angle = std::sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
        const double f = angle > 1e-8 ? std::sin(0.5 * angle) / angle : 0.5;
        const double turn[4] = {std::cos(0.5 * angle), f * by[0], f * by[1], f * by[2]};
        Quaternion out;
        multiply_quaternions(from, turn, out.data());
        return out;
    }

    static void cross_product(const double* a, const double* b, double* out) {
        out[0] = a[1] * b[2] - a[2] * b[1];
        out[1] = a[2] * b[0] - a[0] * b[2];
        out[2] = a[0] * b[1] - a[1] * b[0];
    }

    /// Along a length of constant strains: the exponential of [u] (Murray, Li and Sastry 1994, section 2.3.2).
    void advance(const At& at, double length) {
        double turn[3], once[3], twice[3], moved[3], out[3], square = 0.0;
        for (int a = 0; a < 3; ++a) turn[a] = at.u[a] * length;
        for (double x : turn) square += x * x;
        const double angle = std::sqrt(square), half = std::sin(0.5 * angle);
        const double first = angle > 1e-8 ? 2.0 * half * half / square : 0.5;  // (1 - cos) / angle^2
        const double second = angle > 0.1 ? (angle - std::sin(angle)) / (square * angle)
                                          : 1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5040.0 - square / 362880.0));
        cross_product(turn, at.v, once);
        cross_product(turn, once, twice);
        for (int a = 0; a < 3; ++a) moved[a] = length * (at.v[a] + first * once[a] + second * twice[a]);
        to_world(turn_, moved, out);
        for (int a = 0; a < 3; ++a) position_[a] += out[a];
        const Quaternion q = turned(turn_, turn);
        std::copy(q.begin(), q.end(), turn_);
        turns_.push_back(angle);
    }

    /// Along a panel, which the read of its tendons at its points goes with.
    bool cross(const Section<double>& section, double from, double to, TendonDirection* found) {
        std::array<At, CURVE_POINTS> at;
        const PointValues places = points_between(from, to);
        Strains before = strains_;
        for (int p = 0; p < CURVE_POINTS; ++p) {
            const Strains here = strains_;
            if (p > 1) carry_on(before, here, (places[p] - places[p - 2]) / (places[p - 1] - places[p - 2]), 1, strains_);
            before = here;
            if (!solve(section, places[p], at[p])) return false;
            for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
                TendonDirection& tendon = found[p * robot_.tendon_count + layout_.hosted[h].tendon];
                std::copy(tangent(section, h).t, tangent(section, h).t + 3, tendon.direction.begin());
                tendon.rate = 1.0 / tangent(section, h).inverse;
            }
        }
        std::array<Quaternion, CURVE_POINTS> q;
        if (!turn_along(at, 0.5 * (to - from), q)) return false;
        for (int p = 0; p < CURVE_POINTS; ++p) {
            double v[3];
            to_world(q[p].data(), at[p].v, v);
            for (int a = 0; a < 3; ++a) position_[a] += 0.5 * (to - from) * rules_.weight[p] * v[a];
            for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
                TendonDirection& tendon = found[p * robot_.tendon_count + layout_.hosted[h].tendon];
                double t[3];
                to_world(q[p].data(), tendon.direction.data(), t);
                std::copy(t, t + 3, tendon.direction.begin());
            }
        }
        turns_.push_back(INFINITY);
        return true;
    }

    /// Frames at the points of a panel, and at its end: Picard's iteration on R' = R [u], from the exponential of the integral of
    /// u, which is all where the tube bends in one plane.
    bool turn_along(const std::array<At, CURVE_POINTS>& at, double half, std::array<Quaternion, CURVE_POINTS>& q) {
        std::array<PointValues, 3> turn;
        for (int a = 0; a < 3; ++a) {
            for (int p = 0; p < CURVE_POINTS; ++p) turn[a][p] = half * at[p].u[a];
            turn[a] = ChebyshevRules::times(rules_.upto, turn[a]);
        }
        for (int p = 0; p < CURVE_POINTS; ++p) q[p] = turned(turn_, {turn[0][p], turn[1][p], turn[2][p]});
        double change = INFINITY;
        Quaternion end{};
        for (int sweep = 0; sweep < MOST_SWEEPS && change > SETTLED; ++sweep) {
            std::array<PointValues, 4> rate;
            for (int p = 0; p < CURVE_POINTS; ++p) {
                const double spin[4] = {0.0, 0.5 * half * at[p].u[0], 0.5 * half * at[p].u[1], 0.5 * half * at[p].u[2]};
                double out[4];
                multiply_quaternions(q[p].data(), spin, out);
                for (int c = 0; c < 4; ++c) rate[c][p] = out[c];
            }
            change = 0.0;
            for (int c = 0; c < 4; ++c) {
                const PointValues gained = ChebyshevRules::times(rules_.upto, rate[c]);
                end[c] = turn_[c];
                for (int p = 0; p < CURVE_POINTS; ++p) {
                    change = larger(change, std::fabs(turn_[c] + gained[p] - q[p][c]));
                    q[p][c] = turn_[c] + gained[p];
                    end[c] += rules_.weight[p] * rate[c][p];
                }
            }
        }
        double size = 0.0;
        for (double c : end) size += c * c;
        for (int c = 0; c < 4; ++c) turn_[c] = end[c] / std::sqrt(size);
        return change <= SETTLED;
    }
};

}  // namespace tactr
