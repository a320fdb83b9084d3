#include "friction_history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactr {

namespace {

constexpr int LOOKS = FrictionHistory::LOOKS, PARTS = 8, FINE_PARTS = 16;
using Course = FrictionHistory::Course;
using Places = FrictionHistory::Places;
using Start = FrictionHistory::Start;

/// part: of the way from a to b, by place.
void sizes_between(const Places (&a)[3], const Places (&b)[3], const Places& part, Places& out) {
    for (int i = 0; i < LOOKS; ++i) {
        const double f = part[i];
        const double x = a[0][i] + f * (b[0][i] - a[0][i]), y = a[1][i] + f * (b[1][i] - a[1][i]), z = a[2][i] + f * (b[2][i] - a[2][i]);
        out[i] = std::sqrt(x * x + y * y + z * z);
    }
}

/// By how much log tension may fall or rise from the place before, at a part of the way.
void cone_between(const Course& before, const Course& after, const Places& part, double spacing, Places& out) {
    Places bend;
    sizes_between(before.bend, after.bend, part, bend);
    if (before.kinked || after.kinked) sizes_between(before.kink, after.kink, part, out);
    else std::fill(out, out + LOOKS, 0.0);
    for (int i = 1; i < LOOKS; ++i) out[i] += 0.5 * (bend[i - 1] + bend[i]) * spacing;
}

/// y onto the cone, from the base on.
void move_on(const Places& cone, double base, Places& y) {
    for (int i = 0; i < LOOKS; ++i) base = y[i] = smaller(larger(y[i], base - cone[i]), base + cone[i]);
}

/// One channel on the way of a step.
struct Way {
    const Start& start;
    const Course after;
    const double tension;  // at the base, after
    Places at_once, y;     // log tension by one step, and on the way
    Places part;           // of the change of curvatures

    Way(const Start& from, const Wrap& wrap, double to) : start(from), after(wrap), tension(to) {
        begin();
        std::fill(part, part + LOOKS, 1.0);
        move(1.0);
        std::copy(y, y + LOOKS, at_once);
    }

    void begin() { std::copy(start.y, start.y + LOOKS, y); }

    /// Onto the cone at part.
    void move(double along) {
        Places cone;
        cone_between(start.course, after, part, start.end / (LOOKS - 1), cone);
        move_on(cone, std::log(larger((1.0 - along) * start.tension + along * tension, 1e-300)), y);
    }
};

double largest_missed(const std::vector<Way>& ways) {
    double worst = 0.0;
    for (const Way& way : ways)
        for (int i = 0; i < LOOKS; ++i) worst = larger(worst, std::fabs(way.y[i] - way.at_once[i]));
    return worst;
}

/// Curvatures that change linearly on the way.
double missed_linearly(std::vector<Way>& ways) {
    for (Way& way : ways) {
        way.begin();
        for (int k = 1; k <= PARTS; ++k) {
            const double along = static_cast<double>(k) / PARTS;
            std::fill(way.part, way.part + LOOKS, along);
            way.move(along);
        }
    }
    return largest_missed(ways);
}

/// Curvatures that change as far as the tensions at their place have; linearly where these do not change.
class ByTension {
  public:
    explicit ByTension(std::vector<Way>& ways) : ways_(ways), pull_(ways.size()) {
        for (size_t c = 0; c < ways.size(); ++c)
            for (int i = 0; i < LOOKS; ++i) pull_[c][i] = std::exp(ways[c].start.y[i]);
        for (const Way& way : ways)
            for (const Way& other : ways)
                for (int i = 0; i < LOOKS; ++i) {
                    const double s = way.start.base + way.start.end * i / (LOOKS - 1);
                    const double x = (s - other.start.base) / other.start.end * (LOOKS - 1);
                    beside_.push_back(x > -0.5 && x < LOOKS - 0.5 ? static_cast<int>(std::lround(x)) : -1);
                }
    }

    double missed() {
        std::vector<std::array<double, LOOKS>> from(ways_.size());
        for (Way& way : ways_) way.begin();
        for (int k = 1; k < FINE_PARTS; ++k) {
            const double along = static_cast<double>(k) / FINE_PARTS;
            for (size_t c = 0; c < ways_.size(); ++c) std::copy(ways_[c].y, ways_[c].y + LOOKS, from[c].begin());
            for (int turn = 0; turn < TURNS; ++turn) {
                follow(along);
                for (size_t c = 0; c < ways_.size(); ++c) {
                    std::copy(from[c].begin(), from[c].end(), ways_[c].y);
                    ways_[c].move(along);
                }
            }
        }
        for (Way& way : ways_) {
            std::fill(way.part, way.part + LOOKS, 1.0);
            way.move(1.0);
        }
        return largest_missed(ways_);
    }

  private:
    static constexpr int TURNS = 2;  // of tensions and curvatures, which follow each other
    std::vector<Way>& ways_;
    std::vector<std::array<double, LOOKS>> pull_;  // tensions before
    std::vector<int> beside_;                      // by way, other way and place: the place beside it, -1: none

    void follow(double along) {
        for (size_t c = 0; c < ways_.size(); ++c) {
            Way& way = ways_[c];
            for (int i = 0; i < LOOKS; ++i) {
                double change = 0.0, sofar = 0.0;
                for (size_t d = 0; d < ways_.size(); ++d) {
                    const int at = beside_[(c * ways_.size() + d) * LOOKS + i];
                    if (at < 0) continue;
                    const Way& other = ways_[d];
                    change += pull_[d][at] * std::fabs(other.at_once[at] - other.start.y[at]);
                    sofar += pull_[d][at] * std::fabs(other.y[at] - other.start.y[at]);
                }
                way.part[i] = change > 0.0 ? smaller(1.0, sofar / change) : along;
            }
        }
    }
};

/// Of panel k, at the places from first to before the last, x in the panel.
void note_bend(const Wrap& wrap, int k, int first, int last, const Places& x, Places (&bend)[3]) {
    constexpr int WIDTH = 8;
    for (int a = 0; a < 3; ++a) {
        PointValues values;
        for (int p = 0; p < CURVE_POINTS; ++p) values[p] = wrap.bend[k][p][a];
        const PointValues c = ChebyshevRules::times(ChebyshevRules::get().fit, values);
        for (int i = first; i < last; i += WIDTH) {
            std::array<double, WIDTH> at;
            for (int n = 0; n < WIDTH; ++n) at[n] = x[std::min(i + n, last - 1)];
            at = chebyshev_at(c, at);
            std::copy(at.begin(), at.begin() + std::min(WIDTH, last - i), bend[a] + i);
        }
    }
}

}  // namespace

FrictionHistory::Course::Course(const Wrap& wrap) : bend{}, kink{} {
    const auto& edges = wrap.rise.edges;
    const double end = edges.back();
    const int panels = wrap.straight ? 0 : static_cast<int>(wrap.bend.size());
    for (int k = 0, first = 0, last = 0; k < panels; ++k, first = last) {
        Places x;
        for (; last < LOOKS && (k + 1 == panels || end * last / (LOOKS - 1) < edges[k + 1]); ++last)
            x[last] = (2.0 * end * last / (LOOKS - 1) - (edges[k] + edges[k + 1])) / (edges[k + 1] - edges[k]);
        note_bend(wrap, k, first, last, x, bend);
    }
    for (size_t k = 0; k < edges.size(); ++k) {
        if (!(wrap.jumps[k] > 0.0)) continue;
        const int i = std::min(LOOKS - 1, static_cast<int>(std::ceil(edges[k] / end * (LOOKS - 1) - 1e-9)));  // not before the edge
        for (int a = 0; a < 3; ++a) kink[a][i] += wrap.kinks[k][a];
        kinked = true;
    }
}

FrictionHistory::FrictionHistory(const std::vector<FrictionChannel>& channels, const FrictionSettled& before)
    : channels_(channels), local_(before.robot.tubes.size() == 1) {
    for (size_t c = 0; c < channels.size(); ++c) {
        const auto& profile = before.profiles[c];
        const double end = channels[c].end;
        Start start{Course(before.wraps[c]), {}, before.solution.translation[channels[c].tube], end, before.solution.tension[channels[c].tendon]};
        for (int i = 0; i < LOOKS; ++i)
            start.y[i] = profile ? profile->log.at(smaller(end * i / (LOOKS - 1), end - 1e-12)) : NO_TENSION;
        starts_.push_back(start);
    }
}

double FrictionHistory::missed(const std::vector<Wrap>& wraps, const std::vector<double>& tension, double enough) const {
    std::vector<Way> ways;
    for (size_t c = 0; c < channels_.size(); ++c) {
        const double pull = tension[channels_[c].tendon];
        if (pull > 0.0) ways.emplace_back(starts_[c], wraps[c], pull);
    }
    const double linearly = missed_linearly(ways);
    return local_ && linearly > enough ? smaller(linearly, ByTension(ways).missed()) : linearly;
}

}  // namespace tactr
