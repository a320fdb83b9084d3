// Reads where tendons run at the ends of sections, in one march: all that disks ask for.
#pragma once
#include <cmath>
#include <vector>

#include "march.hpp"
#include "rotations.hpp"
#include "routing.hpp"
#include "tendon_directions.hpp"

namespace tactr {

/// Of a tendon in one section: where it is at both ends, and how long between.
struct TendonChord {
    Triple distal{}, proximal{};
    double length = 0.0;
};

/// Sees a march; afterwards holds the tendons section by section, in the axes in which it was marched. No section may be
/// guided: positions begin behind the guide.
class TendonChords {
  public:
    std::vector<TendonChord> found;

    TendonChords(const Robot& robot, const Layout<double>& layout)
        : found(layout.sections.size() * robot.tendon_count), robot_(robot), layout_(layout), beyond_(robot.tendon_count, 0.0) {}

    template <class M>
    void operator()(M& march, int k, const double* before, double s, double h) {
        const Section<double>& section = layout_.sections[k];
        const bool first = s >= section.distal, last = ends_section(section, s + h);
        if (!first && !last) return;
        for (int n = section.hosted.begin; n < section.hosted.end; ++n) {
            const Hosted& hosted = layout_.hosted[n];
            TendonChord& chord = found[static_cast<size_t>(k) * robot_.tendon_count + hosted.tendon];
            if (first) chord.distal = point(march, hosted, before, section.distal);
            if (!last) continue;
            chord.proximal = point(march, hosted, march.z, section.proximal);
            chord.length = march.tendon_length[hosted.tendon] - beyond_[hosted.tendon];
            beyond_[hosted.tendon] = march.tendon_length[hosted.tendon];
        }
    }

  private:
    const Robot& robot_;
    const Layout<double>& layout_;
    std::vector<double> beyond_;  // lengths of what the march has passed

    template <class M>
    Triple point(const M& march, const Hosted& hosted, const double* packed, double s) const {
        const double sigma = s - march.actuation.translation[robot_.tendons[hosted.tendon].tube];
        double r[2], dr[2];
        evaluate_routing(robot_.routing[hosted.routing], sigma, r, dr);
        const double psi = packed[3 * hosted.slot], c = std::cos(psi), n = std::sin(psi);
        const double* frame = march.packing.frame >= 0 ? packed + march.packing.frame : &march.y[QUAT];
        double norm = 0.0, q[4], out[3];
        for (int i = 0; i < 4; ++i) norm += frame[i] * frame[i];
        for (int i = 0; i < 4; ++i) q[i] = frame[i] / std::sqrt(norm);
        const double offset[3] = {c * r[0] - n * r[1], n * r[0] + c * r[1], 0.0};
        to_world(q, offset, out);
        const double* position = packed + march.packing.path;
        return {position[0] + out[0], position[1] + out[1], position[2] + out[2]};
    }
};

}  // namespace tactr
