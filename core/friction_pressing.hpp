// By how much neighbouring tubes press on each other, lumped at the nodes where they rub.
//
// The cross-section as a rigid disk hands over forces f and couples m per length, split by the tubes' shear stiffness. Tubes
// can only press: a distributed couple is then a change of the force f + (e3 x m)', with forces e3 x m where it begins and
// ends. That is what tubes without shear exert on each other. A couple at one point stays, and needs a lever.
#pragma once
#include <cmath>
#include <vector>

#include "point_contact.hpp"
#include "rubbing_nodes.hpp"

namespace tactr {

/// Watches a march with the sums and the frame.
class PressingReader : public SectionEnds {
  public:
    using SkipsEven = void;  // behind the guide's exit
    std::vector<ContactRecord> distal_contact, proximal_contact;  // by section; axes of the march
    bool failed = false;

    PressingReader(const Robot& robot, const Layout<double>& layout, const Solution& solution)
        : SectionEnds(layout.sections.size()), distal_contact(layout.sections.size()), proximal_contact(layout.sections.size()),
          layout_(layout), along_(robot, layout, solution, none_, nowhere_), near_(2 * layout.sections.size()), known_(near_.size(), 0) {}

    template <class M>
    void operator()(M& march, int k, const typename M::State* before, double s, double h) {
        const Section<double>& section = layout_.sections[k];
        if (section.guided) return;
        if (s == section.distal) read(march, before, k, s, 2 * k + 1, distal[k], distal_contact[k]);
        if (!ends_section(section, s + h)) return;
        read(march, march.z, k, section.proximal, 2 * k, proximal[k], proximal_contact[k]);
    }

  private:
    static inline const Samples none_{};
    static inline const std::vector<double> nowhere_{};
    const Layout<double>& layout_;
    ContactReader along_;
    std::vector<Strains> near_;  // at the sections' ends, in the march before
    std::vector<char> known_;

    template <class M>
    void read(const M& march, const typename M::State* state, int k, double s, int place, SectionEnd& end, ContactRecord& contact) {
        if (!known_[place]) near_[place] = guess(march, k, place);
        double z[STATES];
        for (int n = 0; n < march.packing.count; ++n) z[n] = value(state[n]);
        failed = failed || !along_.read_states(k, s, z, near_[place], z + march.packing.frame, contact, &end);
        known_[place] = !failed;
    }

    /// Just beyond, or where the march is.
    template <class M>
    Strains guess(const M& march, int k, int place) const {
        const int count = layout_.sections[k].active_count;
        const bool distal_end = place == 2 * k + 1;
        if (distal_end && place + 1 < static_cast<int>(near_.size()) && known_[place + 1] && layout_.sections[k + 1].active_count == count)
            return near_[place + 1];
        const auto& near = march.solver.strains;
        Strains e{value(near.kx), value(near.ky), value(near.wx), value(near.wy), {}, {}};
        for (int a = 0; a < count; ++a) {
            e.tau[a] = value(near.tau[a]);
            e.eta[a] = value(near.eta[a]);
        }
        return e;
    }
};

/// Adds up what presses at every node, N: the share of a place between two nodes falls with its distance from them. Nodes
/// at the ends of an overlap bear what is concentrated, those inside what is distributed, too.
class Pressing {
  public:
    Pressing(const std::vector<RubbingNode>& nodes, const std::vector<char>& at_end, const Robot& robot, const Layout<double>& layout, const PressingReader& reader)
        : nodes_(nodes), at_end_(at_end), layout_(layout), reader_(reader) {
        const double upright[4] = {1.0, 0.0, 0.0, 0.0};
        PointContactReader(robot, layout, reader).read(upright, points_);
    }

    void add_to(std::vector<double>& pressing) {
        const int count = static_cast<int>(layout_.sections.size());
        size_t point = 0;
        for (int k = 0; k < count; ++k) {
            const Section<double>& section = layout_.sections[k];
            if (section.guided) continue;
            if (k == 0 || layout_.sections[k - 1].guided) add_point(points_[point++], nullptr, &reader_.proximal_contact[k], k, pressing);
            add_along(k, pressing);
            const ContactRecord* beyond = k + 1 < count ? &reader_.proximal_contact[k + 1] : nullptr;
            add_point(points_[point++], &reader_.distal_contact[k], beyond, k, pressing);
        }
    }

  private:
    const std::vector<RubbingNode>& nodes_;
    const std::vector<char>& at_end_;
    const Layout<double>& layout_;
    const PressingReader& reader_;
    std::vector<ContactRecord> points_;

    /// e3 x m.
    static void add_shifted(const Wrench& contact, const double* axis, double sign, double* force) {
        const double* m = contact.moment;
        force[0] += sign * (axis[1] * m[2] - axis[2] * m[1]);
        force[1] += sign * (axis[2] * m[0] - axis[0] * m[2]);
        force[2] += sign * (axis[0] * m[1] - axis[1] * m[0]);
    }

    static void axis_of(const SectionEnd& end, double* axis) {
        const double e3[3] = {0.0, 0.0, 1.0};
        to_world(end.quaternion, e3, axis);
    }

    static double length(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

    void add_along(int k, std::vector<double>& pressing) const {
        const Section<double>& section = layout_.sections[k];
        const ContactRecord &first = reader_.proximal_contact[k], &last = reader_.distal_contact[k];
        double axis_first[3], axis_last[3];
        axis_of(reader_.proximal[k], axis_first);
        axis_of(reader_.distal[k], axis_last);
        const double h = section.distal - section.proximal;
        for (int a = 1; a < section.active_count; ++a) {
            const int i = section.active[a];
            double force[3];
            for (int c = 0; c < 3; ++c) force[c] = 0.5 * h * (first.on[i].force[c] + last.on[i].force[c]);
            add_shifted(last.on[i], axis_last, 1.0, force);
            add_shifted(first.on[i], axis_first, -1.0, force);
            share(section.active[a - 1], i, 0.5 * (section.proximal + section.distal), force, nullptr, pressing);
        }
    }

    void add_point(const ContactRecord& point, const ContactRecord* before, const ContactRecord* beyond, int k,
                   std::vector<double>& pressing) const {
        const Section<double>& section = layout_.sections[k];
        double axis[3];
        axis_of(before ? reader_.distal[k] : reader_.proximal[k], axis);
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            if (a == 0 && before) continue;  // the guide holds at its exit alone
            double force[3], couple[3] = {0.0, 0.0, 0.0};
            for (int c = 0; c < 3; ++c) force[c] = point.on[i].force[c];
            if (before) add_shifted(before->on[i], axis, -1.0, force);
            if (beyond && beyond->outer[i] >= 0) add_shifted(beyond->on[i], axis, 1.0, force);
            add_shifted(point.on[i], axis, 1.0, couple);
            share(a > 0 ? section.active[a - 1] : -1, i, point.s, force, couple, pressing);
        }
    }

    /// A force and a couple M (given as e3 x M) at one point are two forces at the ends of the lever.
    static double pressing_of(const double* force, const double* couple, double lever) {
        if (!couple) return length(force);
        double one[3], other[3];
        for (int c = 0; c < 3; ++c) {
            one[c] = 0.5 * force[c] + couple[c] / lever;
            other[c] = 0.5 * force[c] - couple[c] / lever;
        }
        return length(one) + length(other);
    }

    /// couple: null for what is distributed.
    void share(int outer, int inner, double s, const double* force, const double* couple, std::vector<double>& pressing) const {
        int before = -1, beyond = -1;
        for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
            if (nodes_[k].outer != outer || nodes_[k].inner != inner || (!couple && at_end_[k])) continue;
            if (nodes_[k].s <= s + BREAKPOINT_GAP) before = k;
            if (nodes_[k].s >= s - BREAKPOINT_GAP && beyond < 0) beyond = k;
        }
        if (before < 0 && beyond < 0) return;  // without friction
        if (before < 0) before = beyond;
        if (beyond < 0) beyond = before;
        const double gap = nodes_[beyond].s - nodes_[before].s;
        const double part = gap > 2.0 * BREAKPOINT_GAP ? (s - nodes_[before].s) / gap : 0.0;
        const double size = pressing_of(force, couple, nodes_[before].lever);
        pressing[before] += (1.0 - part) * size;
        pressing[beyond] += part * size;
    }
};

}  // namespace tactr
