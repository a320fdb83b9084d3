// Reads at many places where tendons run, in one march.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "dense_output.hpp"
#include "march.hpp"
#include "rotations.hpp"

namespace tactr {

using Triple = std::array<double, 3>;

/// Of a tendon at a place: its length per length of the robot, and its unit tangent.
struct TendonDirection {
    double rate = 0.0;
    Triple direction{};
};

/// Sees a march; afterwards holds the tendons at ascending places, place by place, in the axes in which it was marched.
class TendonDirections {
  public:
    std::vector<TendonDirection> found;

    TendonDirections(const Robot& robot, const Layout<double>& layout, const std::vector<double>& places)
        : found(places.size() * robot.tendon_count), layout_(layout), places_(places), tendons_(robot.tendon_count),
          next_(static_cast<int>(places.size()) - 1) {}

    template <class M>
    void operator()(M& march, int k, const double* before, double s, double h) {
        if (next_ < 0 || places_[next_] <= s + h) return;
        const Section<double>& section = layout_.sections[k];
        if (!dense_.prepare(march, section, before, s, h)) return;
        for (int read = 0; next_ >= 0 && places_[next_] > s + h; --next_, ++read) {
            const double x = (places_[next_] - s) / h;
            if (read > 1) carry_on(last_.strains, here_.strains, (x - last_.x) / (here_.x - last_.x), section.active_count, dense_.strains);
            solve(march, section, x);
            last_ = here_;
            here_ = {x, dense_.strains};
        }
    }

    /// Whether the march came by all places.
    bool complete() const { return next_ < 0; }

    /// Turns all to other axes.
    void turn(const double* quaternion) {
        for (TendonDirection& tendon : found) {
            double t[3];
            to_world(quaternion, tendon.direction.data(), t);
            std::copy(t, t + 3, tendon.direction.begin());
        }
    }

  private:
    struct Place {
        double x;  // share of the step
        Strains strains;
    };

    const Layout<double>& layout_;
    const std::vector<double>& places_;
    int tendons_, next_;
    DenseOutput<double> dense_;
    Place here_, last_;

    template <class M>
    void solve(M& march, const Section<double>& section, double x) {
        double packed[STATES];
        dense_.at(x, packed);
        if (!march.solver.solve(section, places_[next_], packed, march.packing, dense_.strains)) return;
        double q[4];
        const double* frame = march.packing.frame >= 0 ? packed + march.packing.frame : &march.y[QUAT];
        double norm = 0.0;
        for (int c = 0; c < 4; ++c) norm += frame[c] * frame[c];
        for (int c = 0; c < 4; ++c) q[c] = frame[c] / std::sqrt(norm);
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const TendonTangent& tangent = march.solver.tendon_tangents[h - section.hosted.begin];
            TendonDirection& tendon = found[static_cast<size_t>(next_) * tendons_ + layout_.hosted[h].tendon];
            double t[3];
            to_world(q, tangent.t, t);
            std::copy(t, t + 3, tendon.direction.begin());
            tendon.rate = 1.0 / tangent.inverse;
        }
    }
};

}  // namespace tactr
