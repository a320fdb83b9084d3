// Cuts the robot into sections between sorted breakpoints: inside a section everything is smooth.
#pragma once
#include <algorithm>
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
    int active_count;
    int active[MAX_TUBES];  // tubes present, outermost first
    int piece[MAX_TUBES];   // their current TubePiece
    Range hosted, point_loads, distributed_loads;
};

template <class P>
struct Layout {
    std::vector<Section<P>> sections;  // from base to tip
    std::vector<Hosted> hosted;
    std::vector<SectionLoad> point_loads, distributed_loads;
    int max_hosted = 0;
};

constexpr double BREAKPOINT_GAP = 1e-12;  // m; breakpoints closer than this are one

/// Last index in [begin, end) whose start is not beyond sigma.
template <class Piece>
inline int piece_at(const Piece* pieces, int begin, int end, double sigma) {
    int found = begin;
    for (int i = begin + 1; i < end; ++i)
        if (pieces[i].start <= sigma) found = i;
    return found;
}

template <class P>
std::vector<P> breakpoints(const Robot& robot, const P* translation) {
    std::vector<P> all;
    all.reserve(32);
    all.push_back(P(0.0));
    for (int i = 0; i < robot.tube_count; ++i) {
        const Tube& tube = robot.tubes[i];
        all.push_back(translation[i]);
        all.push_back(translation[i] + tube.length);
        for (int k = tube.piece_begin + 1; k < tube.piece_end; ++k)
            all.push_back(translation[i] + robot.pieces[k].start);
    }
    for (int j = 0; j < robot.tendon_count; ++j) {
        const Tendon& tendon = robot.tendons[j];
        const P& base = translation[tendon.tube];
        all.push_back(base + tendon.end);
        for (int k = tendon.piece_begin + 1; k < tendon.piece_end; ++k)
            if (robot.routing[k].start < tendon.end) all.push_back(base + robot.routing[k].start);
        for (int k = tendon.profile_begin + 1; k < tendon.profile_end; ++k)
            if (robot.profiles[k].start < tendon.end) all.push_back(base + robot.profiles[k].start);
    }
    for (int l = 0; l < robot.point_load_count; ++l)
        all.push_back(translation[robot.point_loads[l].tube] + robot.point_loads[l].at);
    for (int l = 0; l < robot.distributed_load_count; ++l) {
        const DistributedLoad& load = robot.distributed_loads[l];
        const P base = load.tube < 0 ? P(0.0) : translation[load.tube];
        all.push_back(base + load.start);
        all.push_back(base + load.end);
    }
    std::sort(all.begin(), all.end(), [](const P& a, const P& b) { return value(a) < value(b); });
    return all;
}

template <class P>
void place_tubes(const Robot& robot, const P* translation, double middle, Section<P>& section) {
    section.active_count = 0;
    for (int i = 0; i < robot.tube_count; ++i) {
        const Tube& tube = robot.tubes[i];
        const double sigma = middle - value(translation[i]);
        if (sigma <= 0.0 || sigma >= tube.length) continue;
        section.active[section.active_count] = i;
        section.piece[section.active_count++] = piece_at(robot.pieces, tube.piece_begin, tube.piece_end, sigma);
    }
}

template <class P>
int slot_of(const Section<P>& section, int tube) {
    for (int a = 0; a < section.active_count; ++a)
        if (section.active[a] == tube) return a;
    return -1;
}

template <class P>
void place_tendons(const Robot& robot, const P* translation, double middle, Section<P>& section, Layout<P>& layout) {
    section.hosted.begin = static_cast<int>(layout.hosted.size());
    for (int j = 0; j < robot.tendon_count; ++j) {
        const Tendon& tendon = robot.tendons[j];
        const double sigma = middle - value(translation[tendon.tube]);
        if (sigma <= 0.0 || sigma >= tendon.end) continue;
        Hosted hosted;
        hosted.tendon = j;
        hosted.slot = tendon.outermost ? 0 : slot_of(section, tendon.tube);
        hosted.routing = piece_at(robot.routing, tendon.piece_begin, tendon.piece_end, sigma);
        hosted.profile = tendon.profile_begin == tendon.profile_end
                             ? -1
                             : piece_at(robot.profiles, tendon.profile_begin, tendon.profile_end, sigma);
        layout.hosted.push_back(hosted);
    }
    section.hosted.end = static_cast<int>(layout.hosted.size());
    layout.max_hosted = std::max(layout.max_hosted, section.hosted.end - section.hosted.begin);
}

template <class P>
void place_loads(const Robot& robot, const P* translation, double middle, Section<P>& section, Layout<P>& layout) {
    section.distributed_loads.begin = static_cast<int>(layout.distributed_loads.size());
    for (int l = 0; l < robot.distributed_load_count; ++l) {
        const DistributedLoad& load = robot.distributed_loads[l];
        const double base = load.tube < 0 ? 0.0 : value(translation[load.tube]);
        if (middle <= base + load.start || middle >= base + load.end) continue;
        const int slot = load.tube < 0 ? 0 : slot_of(section, load.tube);
        if (slot >= 0) layout.distributed_loads.push_back({l, slot});
    }
    section.distributed_loads.end = static_cast<int>(layout.distributed_loads.size());
    section.point_loads.begin = static_cast<int>(layout.point_loads.size());
    for (int l = 0; l < robot.point_load_count; ++l) {
        const PointLoad& load = robot.point_loads[l];
        const double s = value(translation[load.tube]) + load.at;
        if (std::fabs(s - value(section.distal)) > BREAKPOINT_GAP) continue;
        const int slot = slot_of(section, load.tube);
        if (slot >= 0) layout.point_loads.push_back({l, slot});
    }
    section.point_loads.end = static_cast<int>(layout.point_loads.size());
}

template <class P>
Layout<P> cut_into_sections(const Robot& robot, const P* translation) {
    Layout<P> layout;
    const std::vector<P> all = breakpoints(robot, translation);
    double last = value(translation[0]), first = value(translation[0]);
    for (int i = 0; i < robot.tube_count; ++i) {
        first = std::min(first, value(translation[i]));
        last = std::max(last, value(translation[i]) + robot.tubes[i].length);
    }
    const P* proximal = nullptr;
    for (const P& s : all) {
        if (value(s) < first || value(s) > last + BREAKPOINT_GAP) continue;
        if (proximal && value(s) - value(*proximal) > BREAKPOINT_GAP) {
            Section<P> section;
            section.proximal = *proximal;
            section.distal = s;
            const double middle = 0.5 * (value(*proximal) + value(s));
            section.guided = middle < 0.0;
            place_tubes(robot, translation, middle, section);
            place_tendons(robot, translation, middle, section, layout);
            place_loads(robot, translation, middle, section, layout);
            layout.sections.push_back(section);
            proximal = &s;
        }
        if (!proximal) proximal = &s;
    }
    return layout;
}

}  // namespace tactr
