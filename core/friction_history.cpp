#include "friction_history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactr {

namespace {

constexpr int STRETCHES = 32;   // of the length, at least, by which tendons are looked at
constexpr int BETWEEN = 4;      // of them at least from one edge to the next, but where tendons run straight from disk to disk
constexpr double APART = 1e-4;  // of the length: edges nearer to each other are one
constexpr int PARTS = 8, FINE_PARTS = 16;  // of the way
using Values = std::vector<double>;

// --- where to look ---------------------------------------------------------------------------------------------------

/// s, ascending, with all edges of profiles and wraps before and after: there fronts are, and they pass what is between them.
Values places_to_look(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const std::vector<Wrap>& wraps,
                      const std::vector<std::optional<FrictionProfile>>& profiles) {
    Values all, edges;
    bool straight = true;
    for (size_t c = 0; c < channels.size(); ++c) {
        straight = straight && wraps[c].straight;
        const double base = before.solution.translation[channels[c].tube];
        const auto add = [&](const Values& sigma) {
            for (double x : sigma) all.push_back(base + smaller(x, channels[c].end));
        };
        if (before.profiles[c]) add(before.profiles[c]->log.edges);
        if (profiles[c]) add(profiles[c]->log.edges);
        add(wraps[c].rise.edges);
    }
    std::sort(all.begin(), all.end());
    const double length = all.back() - all.front();
    for (double s : all)
        if (edges.empty() || s - edges.back() > APART * length) edges.push_back(s);
    edges.back() = all.back();
    Values out{edges.front()};
    for (size_t k = 0; k + 1 < edges.size(); ++k) {
        const double way = edges[k + 1] - edges[k];
        const int parts = straight ? 1 : std::max(BETWEEN, static_cast<int>(std::ceil(STRETCHES * way / length)));
        for (int i = 1; i <= parts; ++i) out.push_back(i == parts ? edges[k + 1] : edges[k] + way * i / parts);
    }
    return out;
}

/// Of one tendon: its bend in the middle between places, and kinks since the place before, times the coefficient, by axis.
struct Course {
    std::array<Values, 3> bend, kink;
    bool kinked = false;

    /// sigma: of the places.
    Course(const Wrap& wrap, const Values& sigma) {
        const auto& edges = wrap.rise.edges;
        const int stretches = static_cast<int>(sigma.size()) - 1, panels = wrap.straight ? 0 : static_cast<int>(wrap.bend.size());
        for (auto& values : bend) values.assign(stretches, 0.0);
        for (int k = 0, first = 0, last = 0; k < panels; ++k, first = last) {
            while (last < stretches && (k + 1 == panels || 0.5 * (sigma[last] + sigma[last + 1]) < edges[k + 1])) ++last;
            note_bend(wrap, k, first, last, sigma);
        }
        for (size_t k = 0; k < edges.size(); ++k) {
            if (!(wrap.jumps[k] > 0.0)) continue;
            if (!kinked)
                for (auto& values : kink) values.assign(sigma.size(), 0.0);
            kinked = true;
            const auto place = std::lower_bound(sigma.begin(), sigma.end(), edges[k] - 2.0 * EDGE_GAP);
            const auto at = std::min<std::ptrdiff_t>(stretches, place - sigma.begin());
            for (int a = 0; a < 3; ++a) kink[a][at] += wrap.kinks[k][a];
        }
    }

  private:
    void note_bend(const Wrap& wrap, int k, int first, int last, const Values& sigma) {
        const double start = wrap.rise.edges[k], end = wrap.rise.edges[k + 1];
        for (int a = 0; a < 3 && first < last; ++a) {
            PointValues values;
            for (int p = 0; p < CURVE_POINTS; ++p) values[p] = wrap.bend[k][p][a];
            const PointValues c = ChebyshevRules::times(ChebyshevRules::get().fit, values);
            for (int i = first; i < last; ++i) bend[a][i] = (sigma[i] + sigma[i + 1] - (start + end)) / (end - start);
            chebyshev_at(c, &bend[a][first], last - first, &bend[a][first]);
        }
    }
};

// --- one channel on the way of a step --------------------------------------------------------------------------------

struct Way {
    int first;                 // of the places, where it starts
    Values start, at_once, y;  // log tension at places before, by one step, and on the way
    Course before, after;
    double tension_before, tension;  // at the base
    Values stretch;                  // from place to place, m
    std::vector<char> joint;         // by place: curvature may jump there
    Values cone;                     // by how much log tension may fall or rise from the place before

    int places() const { return static_cast<int>(y.size()); }

    void begin() { y = start; }

    /// Curvatures at a part of the way.
    void turn(double part) {
        cone[0] = 0.0;
        const double *x = before.bend[0].data(), *y = before.bend[1].data(), *z = before.bend[2].data();
        const double *to_x = after.bend[0].data(), *to_y = after.bend[1].data(), *to_z = after.bend[2].data();
        for (int i = 0; i + 1 < places(); ++i) {
            const double a = x[i] + part * (to_x[i] - x[i]), b = y[i] + part * (to_y[i] - y[i]), c = z[i] + part * (to_z[i] - z[i]);
            cone[i + 1] = stretch[i] * std::sqrt(a * a + b * b + c * c);
        }
        for (int i = 0; i < places() && kinked(); ++i) add_kink(i, part);
    }

    /// Curvatures as in ByTension, by place of all.
    void turn(const Values& part_at, const Values& part_apart) {
        double changed[3] = {};
        cone[0] = 0.0;
        for (int i = places() - 2; i >= 0; --i) {  // from the end on
            const bool follows = i + 2 < places() && !joint[i + 1];
            const double part = follows ? part_apart[first + i + 1] : 0.5 * (part_at[first + i] + part_at[first + i + 1]);
            double square = 0.0;
            for (int a = 0; a < 3; ++a) {
                const double change = after.bend[a][i] - before.bend[a][i];
                if (follows) changed[a] += part * (change - (after.bend[a][i + 1] - before.bend[a][i + 1]));
                else changed[a] = part * change;
                const double x = before.bend[a][i] + changed[a];
                square += x * x;
            }
            cone[i + 1] = stretch[i] * std::sqrt(square);
        }
        for (int i = 0; i < places() && kinked(); ++i)
            add_kink(i, 0.5 * (part_at[first + std::max(i - 1, 0)] + part_at[first + i]));  // tensions on both sides bend it
    }

    bool kinked() const { return before.kinked || after.kinked; }

    void add_kink(int i, double part) {
        double square = 0.0;
        for (int a = 0; a < 3; ++a) {
            const double from = before.kinked ? before.kink[a][i] : 0.0, to = after.kinked ? after.kink[a][i] : 0.0;
            const double x = from + part * (to - from);
            square += x * x;
        }
        cone[i] += std::sqrt(square);
    }

    /// Onto the cone, from the base on, at a part of the way.
    void move(double along) {
        double base = std::log(larger((1.0 - along) * tension_before + along * tension, 1e-300));
        for (int i = 0; i < places(); ++i) base = y[i] = smaller(larger(y[i], base - cone[i]), base + cone[i]);
    }
};

/// By place: whether curvature may jump there, as it does at edges that stay.
std::vector<char> joints_at(const Values& sigma, const Wrap& before, const Wrap& after) {
    std::vector<char> out(sigma.size(), 0);
    const auto is_edge = [](double x, const Values& edges) {
        const auto next = std::lower_bound(edges.begin(), edges.end(), x - EDGE_GAP);
        return next != edges.end() && *next < x + EDGE_GAP;
    };
    for (size_t i = 0; i < sigma.size(); ++i) out[i] = is_edge(sigma[i], before.rise.edges) && is_edge(sigma[i], after.rise.edges);
    return out;
}

std::vector<Way> ways_of(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const std::vector<Wrap>& wraps,
                         const std::vector<double>& tension, const Values& places) {
    std::vector<Way> ways;
    for (size_t c = 0; c < channels.size(); ++c) {
        const auto& channel = channels[c];
        const auto& profile = before.profiles[c];
        if (!(tension[channel.tendon] > 0.0)) continue;
        const double base = before.solution.translation[channel.tube], near = APART * (places.back() - places.front());
        const auto from = std::lower_bound(places.begin(), places.end(), base - near);
        const auto to = std::upper_bound(from, places.end(), base + channel.end + near);
        Values sigma(from, to), start;
        for (double& x : sigma) x = smaller(larger(x - base, 0.0), channel.end);
        for (double x : sigma) start.push_back(profile ? profile->log.at(smaller(x, channel.end - 1e-12)) : NO_TENSION);
        Values stretch;
        for (size_t i = 0; i + 1 < sigma.size(); ++i) stretch.push_back(sigma[i + 1] - sigma[i]);
        Way way{static_cast<int>(from - places.begin()), start, {}, start, {before.wraps[c], sigma}, {wraps[c], sigma},
                before.solution.tension[channel.tendon], tension[channel.tendon], stretch, joints_at(sigma, before.wraps[c], wraps[c]),
                Values(sigma.size(), 0.0)};
        way.turn(1.0);
        way.move(1.0);
        way.at_once = way.y;
        ways.push_back(std::move(way));
    }
    return ways;
}

double largest_missed(const std::vector<Way>& ways) {
    double worst = 0.0;
    for (const Way& way : ways)
        for (int i = 0; i < way.places(); ++i) worst = larger(worst, std::fabs(way.y[i] - way.at_once[i]));
    return worst;
}

/// Curvatures that change linearly on the way.
double missed_linearly(std::vector<Way>& ways) {
    for (Way& way : ways) {
        way.begin();
        for (int k = 1; k <= PARTS; ++k) {
            way.turn(static_cast<double>(k) / PARTS);
            way.move(static_cast<double>(k) / PARTS);
        }
    }
    return largest_missed(ways);
}

/// Curvatures that follow the tensions. On each side of a place they change by other amounts; that difference comes about as the
/// one between the changes of tensions on its sides does, or linearly where these do not differ: so what torsion and what is
/// elsewhere change, as it is seen ahead of a front, is linear, and what the front brings waits for it. At a joint, where
/// curvature jumps, and at the end, the change itself goes with tensions there, as that of a kink does.
class ByTension {
  public:
    ByTension(std::vector<Way>& ways, const Values& places) : ways_(ways), places_(places) {
        for (const Way& way : ways) {
            pull_.emplace_back();
            for (double y : way.start) pull_.back().push_back(std::exp(y));
        }
        note(&Way::at_once, all_at_, all_apart_);
        const double most = *std::max_element(all_at_.begin(), all_at_.end()), length = places.back() - places.front();
        for (size_t i = 0; i < places.size(); ++i) {
            still_at_.push_back(STILL_AT * most + 1e-300);
            still_apart_.push_back(STILL * most * (places[std::min(i + 1, places.size() - 1)] - places[i]) / length + 1e-300);
        }
    }

    double missed() {
        std::vector<Values> from(ways_.size());
        for (Way& way : ways_) way.begin();
        for (int k = 1; k < FINE_PARTS; ++k) {
            const double along = static_cast<double>(k) / FINE_PARTS;
            for (size_t c = 0; c < ways_.size(); ++c) from[c] = ways_[c].y;
            for (int turn = 0; turn < TURNS; ++turn) {
                follow(along);
                for (size_t c = 0; c < ways_.size(); ++c) {
                    ways_[c].turn(part_at_, part_apart_);
                    ways_[c].y = from[c];
                    ways_[c].move(along);
                }
            }
        }
        for (Way& way : ways_) {
            way.turn(1.0);
            way.move(1.0);
        }
        return largest_missed(ways_);
    }

  private:
    static constexpr int TURNS = 2;  // of tensions and curvatures, which follow each other
    static constexpr double STILL_AT = 0.01, STILL = 0.1;  // of the largest change, at a place and over the length: tensions stay
    std::vector<Way>& ways_;
    const Values& places_;
    std::vector<Values> pull_;       // tensions before, by way
    Values all_at_, all_apart_;      // changes of tensions by one step: at a place, and by how much they differ on its sides
    Values still_at_, still_apart_;  // what counts as none
    Values part_at_, part_apart_;    // how far they are on the way

    void note(Values Way::*y, Values& at, Values& apart) const {
        at.assign(places_.size(), 0.0);
        apart.assign(places_.size(), 0.0);
        for (size_t c = 0; c < ways_.size(); ++c) {
            const Way& way = ways_[c];
            const Values& now = way.*y;
            double before = 0.0, here = 0.0;  // at the place before; in the stretch before
            for (int i = 0; i < way.places(); ++i) {
                const double change = pull_[c][i] * (now[i] - way.start[i]), stretch = 0.5 * (before + change);
                at[way.first + i] += std::fabs(change);
                if (i > 1) apart[way.first + i - 1] += std::fabs(stretch - here);
                before = change;
                here = stretch;
            }
            apart[way.first + way.places() - 1] += std::fabs(here);
        }
    }

    void follow(double along) {
        note(&Way::y, part_at_, part_apart_);
        for (size_t i = 0; i < places_.size(); ++i) {
            part_at_[i] = smaller(1.0, (part_at_[i] + along * still_at_[i]) / (all_at_[i] + still_at_[i]));
            part_apart_[i] = smaller(1.0, (part_apart_[i] + along * still_apart_[i]) / (all_apart_[i] + still_apart_[i]));
        }
    }
};

}  // namespace

double missed_of_history(const std::vector<FrictionChannel>& channels, const FrictionSettled& before, const std::vector<Wrap>& wraps,
                         const std::vector<std::optional<FrictionProfile>>& profiles, const std::vector<double>& tension, double enough) {
    if (channels.empty()) return 0.0;
    const Values places = places_to_look(channels, before, wraps, profiles);
    std::vector<Way> ways = ways_of(channels, before, wraps, tension, places);
    if (ways.empty()) return 0.0;
    const double linearly = missed_linearly(ways);
    return linearly > enough ? smaller(linearly, ByTension(ways, places).missed()) : linearly;
}

}  // namespace tactr
