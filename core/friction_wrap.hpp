// How much a tendon turns along its path, taken in space, times its coefficient of friction. Only what turns presses the
// tendon on its channel: on ds with tension lambda the channel bears lambda |dt/ds| ds, t the tendon's direction in world
// axes. Between disks the tendon runs straight, and a disk bears its turn from one span to the next.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "chebyshev.hpp"
#include "free_tube.hpp"
#include "newton.hpp"
#include "tendon_chords.hpp"
#include "tendon_directions.hpp"

namespace tactr {

/// Where one tendon rubs. pieces: (start, coefficient) of friction; contacts: sigma of its disks; cuts: places where its
/// routing has wound by so much that directions are fitted anew; watched: places whose slip is watched.
struct FrictionChannel {
    int tendon, tube;
    double end;
    std::vector<std::pair<double, double>> pieces;
    bool over_disks;
    std::vector<double> contacts, cuts, watched;

    /// At sigma; where it changes, the distal one.
    double coefficient(double sigma) const {
        double found = pieces.front().second;
        for (const auto& [start, value] : pieces)
            if (start <= sigma + 1e-12) found = value;
        return found;
    }

    /// Edges between which tension changes smoothly: ends of sections, pieces, disks; base: s of the tube's proximal end.
    std::vector<double> joints(const std::vector<double>& section_ends, double base) const {
        std::vector<double> all{0.0, end}, inside;
        if (over_disks) {
            inside = contacts;  // between disks the tension is the same
        } else {
            for (double s : section_ends) inside.push_back(s - base);
            for (const auto& piece : pieces) inside.push_back(piece.first);
        }
        add_inner(inside, end, all);
        return merged(all);
    }
};

/// Friction angle of one tendon from its proximal end on: rise, continuous, and jumps at its edges, which the rise leaves
/// out; both at least 0, rad times the coefficient. At the points of every panel: bend, dt/ds times the coefficient, world
/// axes, 1/m, and rate, the tendon's length per length of its tube. kinks: change of direction at the edges times the
/// coefficient.
struct Wrap {
    Curve rise;
    std::vector<double> jumps;
    std::vector<std::array<Triple, CURVE_POINTS>> bend;
    std::vector<Triple> kinks;
    std::vector<PointValues> rate;
    bool straight = false;  // but for its kinks

    double jump_at(double sigma) const {
        double sum = 0.0;
        for (size_t k = 0; k < jumps.size(); ++k)
            if (jumps[k] > 0.0 && std::fabs(rise.edges[k] - sigma) <= EDGE_GAP) sum += jumps[k];
        return sum;
    }
};

inline double angle_between(const Triple& a, const Triple& b) {
    const Triple c{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    return std::atan2(std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/// Fills the wraps of all channels from one march along a shape.
class WrapReader {
  public:
    using Joints = std::vector<std::vector<double>>;  // by channel

    /// section_tolerance: to which cross-sections are solved.
    WrapReader(const std::vector<FrictionChannel>& channels, const Joints& joints, double section_tolerance)
        : channels_(channels), joints_(joints), tolerance_(section_tolerance) {}

    /// The shape as the solver has it: its free end and mesh in the solution, which gets the residual there. False: it
    /// cannot be marched along.
    bool read(NewtonSolver& newton, Solution& solution, std::vector<Wrap>& wraps) {
        return bears_at_ends(newton) ? read_chords(newton, solution, wraps) : read_directions(newton, solution, wraps);
    }

    /// By how much a march on the mesh misses the tip at most, m, where that is known without one; infinite: it is not.
    double error() const { return error_; }

  private:
    static constexpr double SAME_DIRECTION = 1e-5;  // rad: but for the fit
    using Directions = std::array<Triple, CURVE_POINTS>;

    const std::vector<FrictionChannel>& channels_;
    const Joints& joints_;
    const double tolerance_;
    const ChebyshevRules& rules_ = ChebyshevRules::get();
    std::vector<double> edges_, places_;  // s of the panels' ends, and of all their points
    std::vector<Directions> directions_;  // of the channel, by panel
    double error_ = INFINITY;

    // --- chords between disks --------------------------------------------------------------------------------------

    /// Whether there is nothing but disks, all of them at ends of sections.
    bool bears_at_ends(const NewtonSolver& newton) const {
        const auto& sections = newton.layout.sections;
        for (const auto& section : sections)
            if (section.guided) return false;
        for (size_t c = 0; c < channels_.size(); ++c) {
            const FrictionChannel& channel = channels_[c];
            if (!channel.over_disks || (!channel.contacts.empty() && channel.contacts.front() <= EDGE_GAP)) return false;
            size_t k = 0;
            for (double joint : joints_[c]) {
                const double s = joint + newton.actuation.translation[channel.tube];
                while (k < sections.size() && sections[k].distal < s - EDGE_GAP) ++k;
                if (k == sections.size()) return false;
                if (std::fabs(sections[k].distal - s) > EDGE_GAP && std::fabs(sections[k].proximal - s) > EDGE_GAP) return false;
            }
        }
        return true;
    }

    bool read_chords(NewtonSolver& newton, Solution& solution, std::vector<Wrap>& wraps) {
        std::vector<TendonChord> chords;
        if (!find_chords(newton, solution, chords)) return false;
        wraps.resize(channels_.size());
        for (size_t c = 0; c < channels_.size(); ++c) {
            const FrictionChannel& channel = channels_[c];
            const double start = newton.actuation.translation[channel.tube];
            Wrap& wrap = wraps[c];
            clear(wrap);
            std::vector<Triple> chord;
            for (size_t k = 0; k < newton.layout.sections.size(); ++k) {
                const auto& section = newton.layout.sections[k];
                if (section.distal < start + EDGE_GAP || section.proximal > start + channel.end - EDGE_GAP) continue;
                const TendonChord& part = chords[k * newton.robot.tendon_count + channel.tendon];
                chord.push_back({part.distal[0] - part.proximal[0], part.distal[1] - part.proximal[1], part.distal[2] - part.proximal[2]});
                add_panel(section.distal - start, wrap);
                wrap.rate.back().fill(part.length / (section.distal - section.proximal));
            }
            finish(channel, wrap);
            note_disks(channel, chord, Triple{}, wrap);
        }
        return true;
    }

    /// In world axes, but for where they begin.
    bool find_chords(NewtonSolver& newton, Solution& solution, std::vector<TendonChord>& chords) {
        if (FreeTube::fits(newton)) {
            FreeTube tube(newton, tolerance_);
            if (!tube.read(chords)) return false;
            tube.note(solution);
            error_ = tube.error_on(solution.mesh);
            solution.tendon_length.assign(newton.robot.tendon_count, 0.0);
            for (size_t i = 0; i < chords.size(); ++i) solution.tendon_length[i % newton.robot.tendon_count] += chords[i].length;
            return true;
        }
        TendonChords seen(newton.robot, newton.layout);
        BaseState<double> base;
        if (!newton.watch(solution, seen, base, tolerance_)) return false;
        double turn[4];
        newton.shooting.world_turn(base, newton.actuation.rotation[0], turn);
        chords = std::move(seen.found);
        for (TendonChord& chord : chords)
            for (Triple* end : {&chord.distal, &chord.proximal}) to_world(turn, Triple(*end).data(), end->data());
        return true;
    }

    /// chord: of the panels; before: direction at the base.
    static void note_disks(const FrictionChannel& channel, const std::vector<Triple>& chord, Triple before, Wrap& wrap) {
        std::vector<double> starts{0.0};  // of the spans
        for (double contact : channel.contacts)
            if (contact > EDGE_GAP) starts.push_back(contact);
        std::vector<Triple> span(starts.size(), Triple{});
        for (size_t k = 0; k < chord.size(); ++k) {
            const double middle = 0.5 * (wrap.rise.edges[k] + wrap.rise.edges[k + 1]);
            const auto n = std::upper_bound(starts.begin(), starts.end(), middle) - starts.begin() - 1;
            for (int a = 0; a < 3; ++a) span[n][a] += chord[k][a];
        }
        const bool at_base = !channel.contacts.empty() && channel.contacts.front() <= EDGE_GAP;
        for (size_t n = 0; n < starts.size(); ++n) {
            const Triple after = unit(span[n]);
            if (n > 0 || at_base) note_disk(channel.coefficient(starts[n]), before, after, starts[n], wrap);
            before = after;
        }
    }

    static void note_disk(double mu, const Triple& before, const Triple& after, double contact, Wrap& wrap) {
        const auto& edges = wrap.rise.edges;
        const auto nearest = std::min_element(edges.begin(), edges.end(), [&](double x, double y) {
            return std::fabs(x - contact) < std::fabs(y - contact);
        });
        const size_t k = static_cast<size_t>(nearest - edges.begin());
        wrap.jumps[k] += mu * angle_between(before, after);
        for (int a = 0; a < 3; ++a) wrap.kinks[k][a] += mu * (after[a] - before[a]);
    }

    static void clear(Wrap& wrap) {
        wrap.rise.edges.assign(1, 0.0);
        wrap.rate.clear();
    }

    static void add_panel(double end, Wrap& wrap) {
        wrap.rise.edges.push_back(end);
        wrap.rate.emplace_back();
    }

    /// All panels are there: nothing turns yet.
    static void finish(const FrictionChannel& channel, Wrap& wrap) {
        const size_t panels = wrap.rate.size();
        wrap.rise.edges.back() = channel.end;
        wrap.rise.coefficients.assign(panels, PointValues{});
        wrap.jumps.assign(panels + 1, 0.0);
        wrap.bend.assign(panels, Directions{});
        wrap.kinks.assign(panels + 1, Triple{});
        wrap.straight = channel.over_disks;
    }

    // --- directions all along --------------------------------------------------------------------------------------

    bool read_directions(NewtonSolver& newton, Solution& solution, std::vector<Wrap>& wraps) {
        find_panels(newton.layout, newton.actuation.translation);
        std::vector<TendonDirection> tendons;
        if (!find_tendons(newton, solution, tendons)) return false;
        wraps.resize(channels_.size());
        for (size_t c = 0; c < channels_.size(); ++c) {
            const double start = newton.actuation.translation[channels_[c].tube];
            place(channels_[c], start, newton.robot.tendon_count, tendons, wraps[c]);
            if (channels_[c].over_disks) over_disks(channels_[c], wraps[c]);
            else along(channels_[c], wraps[c]);
        }
        return true;
    }

    /// At the points of all panels, in world axes.
    bool find_tendons(NewtonSolver& newton, Solution& solution, std::vector<TendonDirection>& tendons) {
        if (FreeTube::fits(newton)) {
            FreeTube tube(newton, tolerance_);
            if (!tube.read(edges_, tendons)) return false;
            tube.note(solution);
            return true;
        }
        TendonDirections seen(newton.robot, newton.layout, places_);
        BaseState<double> base;
        if (!newton.watch(solution, seen, base, tolerance_) || !seen.complete()) return false;
        double turn[4];
        newton.shooting.world_turn(base, newton.actuation.rotation[0], turn);
        seen.turn(turn);
        tendons = std::move(seen.found);
        return true;
    }

    /// In each of them all directions are smooth: sections, cut at joints and where a routing has wound by much.
    void find_panels(const Layout<double>& layout, const double* translation) {
        std::vector<double> all{layout.sections.front().proximal};
        for (const auto& section : layout.sections) all.push_back(section.distal);
        double first = all.back(), last = all.front();  // of what any channel takes up
        for (size_t c = 0; c < channels_.size(); ++c) {
            const double start = translation[channels_[c].tube];
            for (const auto* places : {&channels_[c].cuts, &joints_[c]})
                for (double place : *places) all.push_back(place + start);
            first = std::min(first, start);
            last = std::max(last, start + channels_[c].end);
        }
        edges_ = merged(all);
        const auto outside = [=](double s) { return s < first - EDGE_GAP || s > last + EDGE_GAP; };
        edges_.erase(std::remove_if(edges_.begin(), edges_.end(), outside), edges_.end());
        places_.clear();
        for (size_t k = 0; k + 1 < edges_.size(); ++k)
            for (double s : points_between(edges_[k], edges_[k + 1])) places_.push_back(s);
    }

    /// The channel's share of the panels, with its directions and rates; base: s of its tube's proximal end.
    void place(const FrictionChannel& channel, double base, int count, const std::vector<TendonDirection>& tendons, Wrap& wrap) {
        size_t k = 0;
        while (0.5 * (edges_[k] + edges_[k + 1]) < base) ++k;
        clear(wrap);
        directions_.clear();
        for (; k + 1 < edges_.size() && 0.5 * (edges_[k] + edges_[k + 1]) < base + channel.end; ++k) {
            add_panel(edges_[k + 1] - base, wrap);
            directions_.emplace_back();
            for (int p = 0; p < CURVE_POINTS; ++p) {
                const TendonDirection& tendon = tendons[(k * CURVE_POINTS + p) * count + channel.tendon];
                wrap.rate.back()[p] = tendon.rate;
                directions_.back()[p] = tendon.direction;
            }
        }
        finish(channel, wrap);
    }

    /// Direction of a panel at its proximal or distal end.
    Triple at_end(size_t panel, bool distal) const {
        Triple out{};
        const PointValues& weight = distal ? rules_.last : rules_.first;
        for (int p = 0; p < CURVE_POINTS; ++p)
            for (int a = 0; a < 3; ++a) out[a] += weight[p] * directions_[panel][p][a];
        return out;
    }

    void along(const FrictionChannel& channel, Wrap& wrap) const {
        double sofar = 0.0, mu_before = 0.0;
        Triple before{};
        for (size_t k = 0; k < directions_.size(); ++k) {
            const double start = wrap.rise.edges[k], length = wrap.rise.edges[k + 1] - start, mu = channel.coefficient(start);
            PointValues turning;
            for (int p = 0; p < CURVE_POINTS; ++p) {
                Triple& bend = wrap.bend[k][p];
                for (int q = 0; q < CURVE_POINTS; ++q)
                    for (int a = 0; a < 3; ++a) bend[a] += rules_.slope[p][q] * directions_[k][q][a];
                for (double& x : bend) x *= mu * 2.0 / length;
                turning[p] = std::sqrt(bend[0] * bend[0] + bend[1] * bend[1] + bend[2] * bend[2]);
            }
            PointValues& rise = wrap.rise.coefficients[k];
            rise = ChebyshevRules::times(rules_.integral, turning);
            for (double& c : rise) c *= 0.5 * length;
            rise[0] += sofar;
            sofar = 0.0;
            for (double c : rise) sofar += c;  // at the panel's end every polynomial is 1
            const double here = std::max(mu_before, mu);
            if (k > 0 && here > 0.0) note_kink(here, before, at_end(k, false), wrap.jumps[k], wrap.kinks[k]);
            before = at_end(k, true);
            mu_before = mu;
        }
    }

    static void note_kink(double mu, const Triple& before, const Triple& after, double& jump, Triple& kink) {
        const double angle = angle_between(before, after);
        if (angle < SAME_DIRECTION) return;
        jump += mu * angle;
        for (int a = 0; a < 3; ++a) kink[a] += mu * (after[a] - before[a]);
    }

    void over_disks(const FrictionChannel& channel, Wrap& wrap) const {
        std::vector<Triple> chord(directions_.size(), Triple{});
        for (size_t k = 0; k < directions_.size(); ++k) {
            const double half = 0.5 * (wrap.rise.edges[k + 1] - wrap.rise.edges[k]);
            for (int p = 0; p < CURVE_POINTS; ++p)
                for (int a = 0; a < 3; ++a) chord[k][a] += half * rules_.weight[p] * wrap.rate[k][p] * directions_[k][p][a];
        }
        note_disks(channel, chord, unit(at_end(0, false)), wrap);
    }

    static Triple unit(Triple v) {
        const double size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (double& x : v) x /= size;
        return v;
    }
};

}  // namespace tactr
