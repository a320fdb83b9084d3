// The quasi-static step of Coulomb friction along one tendon. With y = log(tension) and the friction angle Phi the cone
// |T'| <= mu T |dt/ds| is |y'| <= Phi'. From the base on, where y is given, y keeps the old profile where the cone allows
// it, and otherwise slides along the cone towards it. For an old profile inside the new cone that is its projection on
// [y0 - Phi, y0 + Phi], a play operator in y0; where the tendon has become straighter than the old profile needs, it
// slides as well.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "friction_wrap.hpp"

namespace tactr {

/// log tension along one tendon; slides: -1, 0 or 1 for every piece, towards the base, stuck, towards the end; driven:
/// whether the piece follows the tension at the base.
struct FrictionProfile {
    Curve log;
    std::vector<int> slides;
    std::vector<char> driven;
};

/// Stuck pieces side by side as one where one polynomial follows them to most_off: fronts that have passed by leave edges.
inline FrictionProfile thinned(const FrictionProfile& profile, double most_off) {
    const Curve& log = profile.log;
    const size_t count = profile.slides.size();
    FrictionProfile out;
    out.log.edges.push_back(log.edges.front());
    for (size_t k = 0; k < count; ++k) {
        const bool may = k > 0 && profile.slides[k] == 0 && out.slides.back() == 0 && profile.driven[k] == out.driven.back();
        PointValues c = log.coefficients[k];
        bool one = false;
        if (may) {
            const double start = out.log.edges[out.log.edges.size() - 2], end = log.edges[k + 1];
            c = ChebyshevRules::times(ChebyshevRules::get().fit, log.at(points_between(start, end)));
            const Curve merged{{start, end}, {c}};
            one = true;
            for (size_t i = k + 1; i-- > 0 && log.edges[i] >= start && one;) {
                const PointValues at = points_between(log.edges[i], log.edges[i + 1]), y = log.on(static_cast<int>(i), at), z = merged.on(0, at);
                for (int p = 0; p < CURVE_POINTS; ++p) one = one && std::fabs(y[p] - z[p]) <= most_off;
            }
        }
        if (one) {
            out.log.edges.back() = log.edges[k + 1];
            out.log.coefficients.back() = c;
            continue;
        }
        out.log.edges.push_back(log.edges[k + 1]);
        out.log.coefficients.push_back(log.coefficients[k]);
        out.slides.push_back(profile.slides[k]);
        out.driven.push_back(profile.driven[k]);
    }
    return out;
}

constexpr double NO_TENSION = -1e4;  // as a log tension: nothing comes down to it

/// From the base to the end, cell by cell between edges of the old profile and of the wrap.
class FrictionWalk {
  public:
    bool left;  // somewhere the old profile was found beyond the cone, now or before

    /// precision: rad, to which the wrap is known; strict: runs are not dropped for their being short, and what was left before
    /// is left wherever it is beyond the cone by more than noise.
    FrictionWalk(const Curve& old, const Wrap& wrap, double y0, double precision, bool strict = false, bool left_before = false)
        : left(left_before), noise_(NOISE * precision), most_beyond_(strict && left ? noise_ : MOST_BEYOND * precision), strict_(strict),
          precision_(precision), old_(old), wrap_(wrap), y_(y0) {
        std::vector<double> all = old_.edges;
        all.insert(all.end(), wrap_.rise.edges.begin(), wrap_.rise.edges.end());
        const std::vector<double> cells = merged(all);
        for (size_t k = 0; k + 1 < cells.size(); ++k) cross(cells[k], cells[k + 1]);
        drop_slivers(wrap_.rise.edges.back());
    }

    /// Where it begins to slide or to be stuck.
    std::vector<double> fronts() const {
        std::vector<double> out;
        for (const Run& run : runs_) out.push_back(run.start);
        return out;
    }

    /// Runs as polynomials: cut at joints and cusps where it slides, at the old edges where it is stuck. others: fronts of other
    /// tendons, at which a sliding piece is cut, too, where one polynomial does not follow it across them.
    FrictionProfile profile(const std::vector<double>& joints, const std::vector<double>& others) const {
        std::vector<double> cuts = joints;
        if (!wrap_.cusps.empty()) {
            cuts.insert(cuts.end(), wrap_.cusps.begin(), wrap_.cusps.end());
            cuts = merged(std::move(cuts));
        }
        FrictionProfile out;
        out.log.edges.push_back(runs_.front().start);
        for (size_t k = 0; k < runs_.size(); ++k) {
            const Run& run = runs_[k];
            const double stop = k + 1 < runs_.size() ? runs_[k + 1].start : joints.back();
            if (stop - run.start <= EDGE_GAP) continue;
            for (double edge : edges_between(run.start, stop, run.slide != 0 ? cuts : old_.edges)) {
                const double start = out.log.edges.back();
                const PointValues whole = piece(run, start, edge);
                if (run.slide == 0 || follows(run, start, edge, whole)) {
                    add(run, edge, whole, out);
                    continue;
                }
                for (double part : edges_between(start, edge, others)) add(run, part, piece(run, out.log.edges.back(), part), out);
            }
        }
        return out;
    }

  private:
    static constexpr double NOISE = 0.1;        // of the precision: log tensions that are the same
    static constexpr double MOST_BEYOND = 2.0;  // of the precision, by which a stuck tendon may be beyond the cone
    static constexpr int LOOKS = 33;       // places at which a cell is looked at

    struct Run {
        double start;
        int slide;
        double y;  // at the start
        bool driven;
    };

    const double noise_, most_beyond_;
    const bool strict_;
    const double precision_;
    const Curve& old_;
    const Wrap& wrap_;
    std::vector<Run> runs_;
    double y_;
    bool driven_ = true;
    int old_piece_ = 0, rise_piece_ = 0;  // of the cell

    double kept(double s) const { return old_.on(old_piece_, s); }
    double rise(double s) const { return wrap_.rise.on(rise_piece_, s); }
    using Looks = std::array<double, LOOKS>;
    static Looks looks(double a, double b) {
        Looks out;
        for (int i = 0; i < LOOKS; ++i) out[i] = a + (b - a) * i / (LOOKS - 1);
        out.back() = b;
        return out;
    }

    void begin(double place, int slide) {
        if (runs_.empty() || runs_.back().slide != slide) runs_.push_back({place, slide, y_, driven_});
    }

    void cross(double a, double b) {
        old_piece_ = old_.piece(0.5 * (a + b));
        rise_piece_ = wrap_.rise.piece(0.5 * (a + b));
        jump(a);
        double place = a;
        for (int turns = 0; turns < 8 && place < b; ++turns) {
            const double difference = y_ - kept(place);
            place = std::fabs(difference) <= noise_ ? stay(place, b) : slide(place, b, difference > 0.0 ? -1 : 1);
        }
        if (place >= b) return;
        driven_ = false;  // so many turns within one cell are noise
        y_ = kept(place);
        begin(place, 0);
        y_ = kept(b);
    }

    void jump(double a) {
        const double jump = wrap_.jump_at(a), before = y_, target = kept(a);
        if (!(jump > 0.0)) return;
        y_ = std::min(std::max(target, before - jump), before + jump);
        if (std::fabs(y_ - target) <= 1e-13) driven_ = false;
        runs_.push_back({a, driven_ ? (y_ > before) - (y_ < before) : 0, y_, driven_});
    }

    double slide(double a, double b, int way) {
        begin(a, way);
        if (old_.is_even(old_piece_) && wrap_.rise.is_even(rise_piece_)) return b;
        const double y = y_, start = rise(a);
        const auto beyond = [&](double s) { return way * (kept(s) - (y + way * (rise(s) - start))); };
        const Looks at = looks(a, b), aim = old_.on(old_piece_, at), phi = wrap_.rise.on(rise_piece_, at);
        for (int i = 1; i < LOOKS; ++i) {
            if (way * (aim[i] - (y + way * (phi[i] - start))) > 0.0) continue;
            const double x = root(beyond, at[i - 1], at[i]);
            y_ = kept(x);
            driven_ = false;
            if (b - x <= EDGE_GAP) {
                y_ = kept(b);
                return b;
            }
            begin(x, 0);
            return x;
        }
        y_ = y + way * (rise(b) - start);
        return b;
    }

    /// Up to b, or to where the old profile falls or rises faster than friction holds.
    double stay(double a, double b) {
        if (old_.is_even(old_piece_)) return hold(a, b);
        const Looks at = looks(a, b), y = old_.on(old_piece_, at), phi = wrap_.rise.on(rise_piece_, at);
        for (int way : {-1, 1}) {
            int least = 0;  // where way y - phi, which falls where the cone holds, is least so far
            for (int i = 1; i < LOOKS; ++i) {
                const double g = way * y[i] - phi[i], lowest = way * y[least] - phi[least];
                if (g < lowest) least = i;
                if (g - lowest > most_beyond_) return leave(a, b, way, at[std::max(least - 1, 0)], at[least + 1]);
            }
        }
        return hold(a, b);
    }

    double hold(double a, double b) {
        driven_ = false;
        begin(a, 0);
        y_ = kept(b);
        return b;
    }

    /// Where the old profile is least inside the cone, between first and last.
    double leave(double a, double b, int way, double first, double last) {
        const auto g = [&](double s) { return way * kept(s) - rise(s); };
        double x = std::max(a, least_of(g, first, last));
        driven_ = false;
        left = true;
        if (x > a + EDGE_GAP) begin(a, 0);
        else x = a;
        y_ = kept(x);
        return slip(x, b, way);
    }

    /// Sliding at the limit from where the old profile leaves the cone, until it is met again.
    double slip(double a, double b, int way) {
        begin(a, way);
        const double start = rise(a), y = y_;
        const auto ahead = [&](double s) { return way * (kept(s) - (y + way * (rise(s) - start))); };
        bool lost = false;
        const Looks at = looks(a, b), aim = old_.on(old_piece_, at), phi = wrap_.rise.on(rise_piece_, at);
        for (int i = 1; i < LOOKS; ++i) {
            const double here = way * (aim[i] - (y + way * (phi[i] - start)));
            if (here > 0.0 || !lost) {
                lost = lost || here > noise_;
                continue;
            }
            const double x = root(ahead, at[i - 1], at[i]);
            y_ = kept(x);
            if (x >= b - EDGE_GAP) return b;
            begin(x, 0);
            return x;
        }
        y_ = y + way * (rise(b) - start);
        return b;
    }

    /// Where f falls through 0 between a and b: regula falsi of the Illinois kind.
    template <class F>
    static double root(const F& f, double a, double b) {
        double fa = f(a), fb = f(b), x = a;
        if (fa <= 0.0) return a;
        for (int i = 0; i < 60; ++i) {
            x = (a * fb - b * fa) / (fb - fa);
            const double fx = f(x);
            if (std::fabs(fx) < 1e-14 || b - a < 1e-13) return x;
            if (fx > 0.0) {
                a = x;
                fa = fx;
                fb *= 0.5;
            } else {
                b = x;
                fb = fx;
                fa *= 0.5;
            }
        }
        return x;
    }

    /// Where f is least between a and b: golden sections.
    template <class F>
    static double least_of(const F& f, double a, double b) {
        const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
        for (int i = 0; i < 40; ++i) {
            const double c = b - ratio * (b - a), d = a + ratio * (b - a);
            if (f(c) < f(d)) b = d;
            else a = c;
        }
        return 0.5 * (a + b);
    }

    /// Short runs that hardly differ from what the next would be in their place go to it.
    void drop_slivers(double end) {
        constexpr double SLIVER = 1e-5, SHORT = 1e-2;  // of the tendon: whatever it holds, and at most
        for (size_t k = runs_.size() - 1; k-- > 0;) {
            Run& next = runs_[k + 1];
            const double start = runs_[k].start, length = next.start - start;
            if (length > SHORT * end) continue;
            const double y = next.slide == 0 ? old_.at(start + 1e-12) : next.y - next.slide * (wrap_.rise.at(next.start) - wrap_.rise.at(start));
            if (length > SLIVER * end && (strict_ || !(std::fabs(y - runs_[k].y) <= noise_))) continue;
            next.y = y;
            next.start = start;
            runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(k));
        }
    }

    /// Those inside, ascending, and the end.
    static std::vector<double> edges_between(double start, double end, const std::vector<double>& all) {
        std::vector<double> out;
        for (double edge : all)
            if (edge > (out.empty() ? start : out.back()) + EDGE_GAP && edge < end - EDGE_GAP) out.push_back(edge);
        out.push_back(end);
        return out;
    }

    static void add(const Run& run, double edge, const PointValues& coefficients, FrictionProfile& out) {
        out.log.edges.push_back(edge);
        out.log.coefficients.push_back(coefficients);
        out.slides.push_back(run.slide);
        out.driven.push_back(run.driven);
    }

    /// Whether a sliding piece is what it should be at its ends: there polynomials are furthest off, and from a front that moves
    /// on, what they are off is passed on to all beyond it, step by step.
    bool follows(const Run& run, double a, double b, const PointValues& c) const {
        if (wrap_.straight) return true;
        const double base = base_of(run);
        const auto off = [&](double x, double sigma) {
            return std::fabs(chebyshev_at(c, x) - (run.y + run.slide * (wrap_.rise.at(sigma) - base)));
        };
        return off(-1.0, a + 1e-12) <= precision_ && off(1.0, b - 1e-12) <= precision_;
    }

    /// The rise where a run starts.
    double base_of(const Run& run) const { return wrap_.rise.on(wrap_.rise.piece(run.start + 1e-12), run.start); }

    PointValues piece(const Run& run, double a, double b) const {
        if (run.slide != 0 && wrap_.straight) return Curve::constant(run.y, b).coefficients[0];
        PointValues y = points_between(a, b);
        if (run.slide == 0) {
            const int k = old_.piece(0.5 * (a + b));
            if (old_.is_even(k) || (old_.edges[k] == a && old_.edges[k + 1] == b)) return old_.coefficients[k];
            y = old_.on(k, y);
        } else {
            const double base = base_of(run);
            y = wrap_.rise.at(y);
            for (double& at : y) at = run.y + run.slide * (at - base);
        }
        return ChebyshevRules::times(ChebyshevRules::get().fit, y);
    }
};

}  // namespace tactr
