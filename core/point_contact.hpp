// Concentrated contact where the resultants of single tubes jump: at the guide's exit, at ends of tubes, and where rest
// curvature or stiffness change.
#pragma once
#include <vector>

#include "contact.hpp"
#include "section_ends.hpp"

namespace tactr {

/// At a breakpoint a tube needs N(before) - N(beyond) - loads from its neighbours, and the same of M. Tendons that change
/// their host there, or end on another tube, hand their pull over; only what crosses the axis is contact.
class PointContactReader {
  public:
    PointContactReader(const Robot& robot, const Layout<double>& layout, const SectionEnds& ends)
        : robot_(robot), layout_(layout), ends_(ends) {}

    /// turn: from the march's axes to the world's.
    void read(const double* turn, std::vector<ContactRecord>& out) const {
        const int count = static_cast<int>(layout_.sections.size());
        for (int k = 0; k < count; ++k) {
            if (layout_.sections[k].guided) continue;
            if (k == 0 || layout_.sections[k - 1].guided) out.push_back(hold_at_exit(k, turn));
            out.push_back(beyond(k, turn));
        }
    }

  private:
    const Robot& robot_;
    const Layout<double>& layout_;
    const SectionEnds& ends_;

    /// Across the axis all that holds the tubes outside: in the guide as a whole, and at its exit.
    ContactRecord hold_at_exit(int k, const double* turn) const {
        const Section<double>& section = layout_.sections[k];
        Wrench exerted[MAX_TUBES] = {};
        for (int a = 0; a < section.active_count; ++a) add(exerted[a], ends_.proximal[k].resultant[a], -1.0);
        return record(section, exerted, ends_.proximal[k], turn, 0.0);
    }

    ContactRecord beyond(int k, const double* turn) const {
        const Section<double>& section = layout_.sections[k];
        const SectionEnd& here = ends_.distal[k];
        Wrench exerted[MAX_TUBES] = {};
        for (int a = 0; a < section.active_count; ++a) add(exerted[a], here.resultant[a], 1.0);
        if (k + 1 < static_cast<int>(layout_.sections.size())) {
            const Section<double>& next = layout_.sections[k + 1];
            for (int b = 0; b < next.active_count; ++b)
                add(exerted[slot_of(section, next.active[b])], ends_.proximal[k + 1].resultant[b], -1.0);
            hand_over(section, next, ends_.proximal[k + 1], exerted);
        }
        end_tendons(k, exerted);
        take_loads(section, here, exerted);
        return record(section, exerted, here, turn, section.distal);
    }

    void hand_over(const Section<double>& section, const Section<double>& next, const SectionEnd& end, Wrench* exerted) const {
        for (int h = next.hosted.begin; h < next.hosted.end; ++h) {
            const Wrench& pull = end.pull[h - next.hosted.begin];
            const int from = slot_of(section, next.active[layout_.hosted[h].slot]), to = host_of(section, layout_.hosted[h].tendon);
            if (to < 0 || from == to) continue;
            add(exerted[from], pull, 1.0);
            add(exerted[to], pull, -1.0);
        }
    }

    void end_tendons(int k, Wrench* exerted) const {
        const Section<double>& section = layout_.sections[k];
        const bool tip = k + 1 == static_cast<int>(layout_.sections.size());
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout_.hosted[h];
            if (!tip && host_of(layout_.sections[k + 1], hosted.tendon) >= 0) continue;
            const int own = slot_of(section, robot_.tendons[hosted.tendon].tube);
            const Wrench& pull = ends_.distal[k].pull[h - section.hosted.begin];
            add(exerted[own], pull, 1.0);
            add(exerted[hosted.slot], pull, -1.0);
        }
    }

    void take_loads(const Section<double>& section, const SectionEnd& here, Wrench* exerted) const {
        for (int p = section.point_loads.begin; p < section.point_loads.end; ++p) {
            const SectionLoad& placed = layout_.point_loads[p];
            const PointLoad& load = robot_.point_loads[placed.load];
            Wrench acting;
            load_in(load.force, load.body_axes, here.quaternion, here.psi[placed.slot], acting.force);
            load_in(load.moment, load.body_axes, here.quaternion, here.psi[placed.slot], acting.moment);
            add(exerted[placed.slot], acting, -1.0);
        }
    }

    /// The place of a tendon's host in a section, -1 where the tendon does not run.
    int host_of(const Section<double>& section, int tendon) const {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            if (layout_.hosted[h].tendon == tendon) return layout_.hosted[h].slot;
        return -1;
    }

    static void add(Wrench& to, const Wrench& what, double sign) {
        for (int c = 0; c < 3; ++c) {
            to.force[c] += sign * what.force[c];
            to.moment[c] += sign * what.moment[c];
        }
    }

    static ContactRecord record(const Section<double>& section, Wrench* exerted, const SectionEnd& end, const double* turn, double s) {
        for (int a = 0; a < section.active_count; ++a) exerted[a].force[2] = exerted[a].moment[2] = 0.0;
        double q[4];
        multiply_quaternions(turn, end.quaternion, q);
        ContactRecord out{};
        out.s = s;
        sum_from_inside(section, exerted, q, out);
        return out;
    }
};

/// Contact of a converged solution: along the stations, and at points.
inline bool contacts(const Robot& robot, const Solution& solution, const std::vector<double>& stations, Contacts& out) {
    Samples samples;
    if (!sample(robot, solution, stations, samples)) return false;
    if (!ContactReader(robot, solution, samples, stations).read(out.along)) return false;
    const Layout<double> layout = cut_into_sections(robot, solution.translation.data());
    const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    const Shooting shooting(robot, layout);
    March<double, double> march(robot, layout, actuation, shooting.full_options());
    shooting.scale(march);
    Mesh mesh = solution.mesh;
    EndsReader ends(robot, layout);
    if (!march.run(solution.free_end, mesh, ends)) return false;
    double turn[4];
    shooting.world_turn(march.base, solution.rotation[0], turn);
    PointContactReader(robot, layout, ends).read(turn, out.points);
    return true;
}

}  // namespace tactr
