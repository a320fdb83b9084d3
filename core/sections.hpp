// Cuts the robot into sections between sorted breakpoints: inside a section everything is smooth.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "dual.hpp"
#include "robot.hpp"

namespace tactr {

/// A tendon as seen by one section.
struct Hosted {
    int tendon;
    int slot;     // position of its host in Section::active
    int routing;  // index of the routing piece
    int profile;  // index of the tension piece, -1: constant
};

/// A point load that acts at the distal end of a section, or a distributed one inside it.
struct SectionLoad {
    int load;  // index into the robot's loads
    int slot;  // position of the loaded tube in Section::active
};

struct Range {
    int begin, end;
};

template <class P>
struct Section {
    P proximal, distal;  // s
    int guided;          // 1: behind the guide exit, held straight
    int even;            // 1: all rates are the same along it, or it has no length
    double winding;      // largest angle by which a tendon's routing winds along it, rad
    int active_count;
    int active[MAX_TUBES];  // tubes present, outermost first
    int piece[MAX_TUBES];   // their current TubePiece
    Range hosted, point_loads, distributed_loads;
};

/// Whether the step of a march that ends at s is the section's last, but for rounding, which counts where it is short.
inline bool ends_section(const Section<double>& section, double s) {
    return s - section.proximal <= 1e-9 * (section.distal - section.proximal) + 1e-15;
}

template <class P>
struct Layout {
    std::vector<Section<P>> sections;  // from base to tip
    std::vector<Hosted> hosted;
    std::vector<SectionLoad> point_loads, distributed_loads;
    std::vector<int> loads_at_base;  // point loads at the proximal ends of their tubes
    int max_hosted = 0;
};

constexpr double BREAKPOINT_GAP = 1e-12;  // m; breakpoints closer than this are one

template <class P>
int slot_of(const Section<P>& section, int tube) {
    for (int a = 0; a < section.active_count; ++a)
        if (section.active[a] == tube) return a;
    return -1;
}

/// Sorted breakpoints, those at one place as one; but where two at one place move apart they stay two, and between them
/// lies a section of no length, which counts in the derivatives. Ends of tendons at one place stay together: what they
/// hand over depends on who else ends there.
template <class P>
class Breakpoints {
  public:
    std::vector<P> s;

    void add(const P& place, bool tendon_end = false) { all_.push_back({place, tendon_end}); }

    void settle() {
        std::stable_sort(all_.begin(), all_.end(), [](const Mark& a, const Mark& b) { return value(a.s) < value(b.s); });
        size_t kept = 0;
        for (size_t i = 0; i < all_.size(); ++i)
            if (find(all_[i], kept) < 0) all_[kept++] = all_[i];
        all_.resize(kept);
        for (const Mark& mark : all_) s.push_back(mark.s);
    }

    /// Index of a place that was added; -1 before all of them, their number beyond.
    int at(const P& place, bool tendon_end = false) const {
        const int found = find({place, tendon_end}, all_.size());
        return found >= 0 ? found : value(place) < value(s.front()) ? -1 : static_cast<int>(s.size());
    }

  private:
    struct Mark {
        P s;
        bool tendon_end;
    };
    std::vector<Mark> all_;

    int find(const Mark& mark, size_t count) const {
        int together = -1;
        for (size_t k = 0; k < count; ++k) {
            if (!(std::fabs(value(mark.s) - value(all_[k].s)) <= BREAKPOINT_GAP)) continue;
            if (same_derivatives(mark.s, all_[k].s)) return static_cast<int>(k);
            if (mark.tendon_end && all_[k].tendon_end) together = static_cast<int>(k);
        }
        return together;
    }
};

/// Cuts one robot; tube ends, ends and starts of tendons and pieces, and loads are found by the index of their place, so
/// that it does not matter how near to each other they are.
template <class P, class C>
class Cutter {
  public:
    Cutter(const RobotOf<C>& robot, const P* translation, const P* probe, int withdrawn) : robot_(robot), translation_(translation) {
        add_ends(withdrawn);
        add_tendons();
        add_loads();
        if (probe) breaks_.add(*probe);
        breaks_.settle();
    }

    Layout<P> cut() {
        Layout<P> layout;
        for (int l = 0; l < robot_.point_load_count; ++l)
            load_at_.push_back(breaks_.at(translation_[robot_.point_loads[l].tube] + robot_.point_loads[l].at));
        for (int l = 0; l < robot_.point_load_count; ++l)
            if (load_at_[l] == breaks_.at(translation_[robot_.point_loads[l].tube])) layout.loads_at_base.push_back(l);
        int first = breaks_.at(translation_[0]), last = 0;
        for (int i = 0; i < robot_.tube_count; ++i) {
            first = std::min(first, breaks_.at(translation_[i]));
            last = std::max(last, breaks_.at(tip(i)));
        }
        const int exit = breaks_.at(P(0.0));
        layout.sections.reserve(last - first);
        for (int k = first; k < last; ++k) {
            Section<P> section;
            section.proximal = breaks_.s[k];
            section.distal = breaks_.s[k + 1];
            section.guided = k < exit;
            place_tubes(k, section);
            place_tendons(k, section, layout);
            place_loads(k, section, layout);
            section.even = is_even(section, layout);
            layout.sections.push_back(section);
        }
        return layout;
    }

  private:
    const RobotOf<C>& robot_;
    const P* translation_;
    Breakpoints<P> breaks_;
    std::vector<int> load_at_;  // the breakpoint of every point load

    P tip(int i) const { return translation_[i] + robot_.tubes[i].length; }

    /// Behind the guide nothing bends, and what turns about the axis makes no difference: tubes and tendons only have to
    /// stay as they are up to a turn.
    bool is_even(const Section<P>& section, const Layout<P>& layout) const {
        if (!(value(section.distal) - value(section.proximal) > BREAKPOINT_GAP)) return true;
        if (!section.guided || section.distributed_loads.begin != section.distributed_loads.end) return false;
        for (int a = 0; a < section.active_count; ++a)
            if (robot_.pieces[section.piece[a]].count > 1) return false;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout.hosted[h];
            const RoutingPieceOf<C>& routing = robot_.routing[hosted.routing];
            if (routing.count_a > 1 || routing.count_b > (routing.polar ? 2 : 1)) return false;
            if (hosted.profile >= 0 && robot_.profiles[hosted.profile].count > 1) return false;
        }
        return true;
    }

    /// Proximal ends before the guide's exit: where they are at one place, they can only move back from it.
    void add_ends(int withdrawn) {
        if (withdrawn >= 0) breaks_.add(translation_[withdrawn]);
        for (int i = 0; i < robot_.tube_count; ++i) breaks_.add(translation_[i]);
        breaks_.add(P(0.0));
        for (int i = 0; i < robot_.tube_count; ++i) {
            const TubeOf<C>& tube = robot_.tubes[i];
            breaks_.add(tip(i));
            for (int k = tube.piece_begin + 1; k < tube.piece_end; ++k) breaks_.add(translation_[i] + robot_.pieces[k].start);
        }
    }

    void add_tendons() {
        for (int j = 0; j < robot_.tendon_count; ++j) {
            const TendonOf<C>& tendon = robot_.tendons[j];
            const P& base = translation_[tendon.tube];
            breaks_.add(base + tendon.end, true);
            for (int k = tendon.piece_begin + 1; k < tendon.piece_end; ++k)
                if (value(robot_.routing[k].start) < value(tendon.end)) breaks_.add(base + robot_.routing[k].start);
            for (int k = tendon.profile_begin + 1; k < tendon.profile_end; ++k)
                if (value(robot_.profiles[k].start) < value(tendon.end)) breaks_.add(base + robot_.profiles[k].start);
        }
    }

    void add_loads() {
        for (int l = 0; l < robot_.point_load_count; ++l)
            breaks_.add(translation_[robot_.point_loads[l].tube] + robot_.point_loads[l].at);
        for (int l = 0; l < robot_.distributed_load_count; ++l) {
            const DistributedLoadOf<C>& load = robot_.distributed_loads[l];
            breaks_.add(base_of(load) + load.start);
            breaks_.add(base_of(load) + load.end);
        }
    }

    P base_of(const DistributedLoadOf<C>& load) const { return load.tube < 0 ? P(0.0) : translation_[load.tube]; }

    bool covers(int k, const P& begin, const P& end) const { return breaks_.at(begin) <= k && breaks_.at(end) > k; }

    /// The last of the pieces from begin that starts not beyond breakpoint k.
    template <class Piece>
    int piece_at(const Piece* pieces, int begin, int end, const P& base, int k) const {
        int found = begin;
        for (int i = begin + 1; i < end; ++i)
            if (breaks_.at(base + pieces[i].start) <= k) found = i;
        return found;
    }

    void place_tubes(int k, Section<P>& section) const {
        section.active_count = 0;
        for (int i = 0; i < robot_.tube_count; ++i) {
            if (!covers(k, translation_[i], tip(i))) continue;
            const TubeOf<C>& tube = robot_.tubes[i];
            section.active[section.active_count] = i;
            section.piece[section.active_count++] = piece_at(robot_.pieces, tube.piece_begin, tube.piece_end, translation_[i], k);
        }
    }

    void place_tendons(int k, Section<P>& section, Layout<P>& layout) const {
        section.hosted.begin = static_cast<int>(layout.hosted.size());
        section.winding = 0.0;
        for (int j = 0; j < robot_.tendon_count; ++j) {
            const TendonOf<C>& tendon = robot_.tendons[j];
            const P& base = translation_[tendon.tube];
            if (!(breaks_.at(base) <= k && breaks_.at(base + tendon.end, true) > k)) continue;
            Hosted hosted;
            hosted.tendon = j;
            hosted.slot = tendon.outermost ? 0 : slot_of(section, tendon.tube);
            hosted.routing = piece_at(robot_.routing, tendon.piece_begin, tendon.piece_end, base, k);
            hosted.profile = tendon.profile_begin == tendon.profile_end
                                 ? -1
                                 : piece_at(robot_.profiles, tendon.profile_begin, tendon.profile_end, base, k);
            layout.hosted.push_back(hosted);
            section.winding = larger(section.winding, winding(robot_.routing[hosted.routing], value(breaks_.s[k] - base),
                                                              value(breaks_.s[k + 1] - base)));
        }
        section.hosted.end = static_cast<int>(layout.hosted.size());
        layout.max_hosted = std::max(layout.max_hosted, section.hosted.end - section.hosted.begin);
    }

    static double winding(const RoutingPieceOf<C>& routing, double begin, double end) {
        if (!routing.polar) return 0.0;
        const auto angle = [&](double sigma) {
            double sum = 0.0;
            for (int i = routing.count_b - 1; i >= 0; --i) sum = sum * (sigma - value(routing.start)) + value(routing.b[i]);
            return sum;
        };
        return std::fabs(angle(end) - angle(begin));
    }

    void place_loads(int k, Section<P>& section, Layout<P>& layout) const {
        section.distributed_loads.begin = static_cast<int>(layout.distributed_loads.size());
        for (int l = 0; l < robot_.distributed_load_count; ++l) {
            const DistributedLoadOf<C>& load = robot_.distributed_loads[l];
            if (!covers(k, base_of(load) + load.start, base_of(load) + load.end)) continue;
            const int slot = load.tube < 0 ? 0 : slot_of(section, load.tube);
            if (slot >= 0) layout.distributed_loads.push_back({l, slot});
        }
        section.distributed_loads.end = static_cast<int>(layout.distributed_loads.size());
        section.point_loads.begin = static_cast<int>(layout.point_loads.size());
        for (int l = 0; l < robot_.point_load_count; ++l) {
            if (load_at_[l] != k + 1) continue;
            const int slot = slot_of(section, robot_.point_loads[l].tube);
            if (slot >= 0) layout.point_loads.push_back({l, slot});
        }
        section.point_loads.end = static_cast<int>(layout.point_loads.size());
    }
};

/// The same sections in other numbers, of which none moves.
template <class D>
Layout<D> at_rest(const Layout<double>& layout) {
    Layout<D> out;
    out.hosted = layout.hosted;
    out.point_loads = layout.point_loads;
    out.distributed_loads = layout.distributed_loads;
    out.loads_at_base = layout.loads_at_base;
    out.max_hosted = layout.max_hosted;
    for (const Section<double>& from : layout.sections) {
        Section<D> to{D(from.proximal), D(from.distal), from.guided, from.even, from.winding, from.active_count, {}, {},
                      from.hosted, from.point_loads, from.distributed_loads};
        std::copy(from.active, from.active + MAX_TUBES, to.active);
        std::copy(from.piece, from.piece + MAX_TUBES, to.piece);
        out.sections.push_back(to);
    }
    return out;
}

/// probe: one more breakpoint, where wanted. withdrawn: a tube whose proximal end counts as further back than others at
/// its place.
template <class P, class C>
Layout<P> cut_into_sections(const RobotOf<C>& robot, const P* translation, const P* probe = nullptr, int withdrawn = -1) {
    return Cutter<P, C>(robot, translation, probe, withdrawn).cut();
}

/// Leaves away what lies before a place, short of the robot's end: there, a clamp holds the tubes from then on.
inline Layout<double> clamped_at(double clamp, Layout<double> layout) {
    size_t first = 0;
    while (layout.sections[first].distal <= clamp + BREAKPOINT_GAP) ++first;
    layout.sections.erase(layout.sections.begin(), layout.sections.begin() + first);
    if (layout.sections.front().proximal < clamp) layout.sections.front().proximal = clamp;
    return layout;
}

}  // namespace tactr
