// What tendons hand over between tubes where their host changes or where they end (theory: "Transitions").
#pragma once
#include <cmath>

#include "dense.hpp"
#include "section_equilibrium.hpp"
#include "sections.hpp"
#include "states.hpp"

namespace tactr {

/// At a boundary of the march under way; acts on its states N_3 and M_3.
template <class M>
class HostChanges {
    using T = typename M::State;
    using P = typename M::Parameter;

  public:
    explicit HostChanges(M& march) : march_(march) {}

    /// Where a tendon's host changes its axial part moves to the new host.
    bool hand_over(const Section<P>& section, const Section<P>& beyond) {
        bool solved = false;
        for (int h = beyond.hosted.begin; h < beyond.hosted.end; ++h) {
            const int to = host_of(section, march_.layout.hosted[h].tendon);
            const int from = beyond.active[march_.layout.hosted[h].slot];
            if (to < 0 || to == from) continue;
            if (!solved && !march_.solve_at(beyond, beyond.proximal)) return false;
            solved = true;
            T force, moment;
            axial_part(march_.solver.tendons[h - beyond.hosted.begin], force, moment);
            move_axial(from, to, force, moment);
        }
        return true;
    }

    /// Where tendons end, their own tube takes the pull and their host had carried it. The pull depends on the strains
    /// behind the end, which depend on the pull: Newton on the transfers of all tubes together.
    bool take_terminations(const Section<P>& section, const Section<P>* beyond) {
        Transfer transfer[MAX_TUBES];
        const int pairs = list_transfers(section, beyond, transfer);
        if (pairs == 0) return true;
        constexpr int N = 2 * MAX_TUBES;
        double inverse[N][N];
        int settled = 0;
        for (int iteration = 0; iteration < 30 && settled < 3; ++iteration) {
            T gap[N];
            double worst;
            if (!transfer_gaps(section, beyond, transfer, pairs, gap, worst)) return false;
            if (worst <= SECTION_TOLERANCE) {
                // two more rounds carry the derivatives along
                if (++settled == 3) march_.solver.worst_residual = larger(march_.solver.worst_residual, worst);
            } else if (!invert_transfer_slopes(section, beyond, transfer, pairs, gap, inverse)) {
                return false;
            }
            if (iteration == 0 && settled == 1 && !invert_transfer_slopes(section, beyond, transfer, pairs, gap, inverse))
                return false;
            for (int i = 0; i < pairs; ++i)
                for (int j = 0; j < 2 * pairs; ++j) {
                    transfer[i].force += gap[j] * inverse[2 * i][j];
                    transfer[i].moment += gap[j] * inverse[2 * i + 1][j];
                }
        }
        for (int i = 0; i < pairs; ++i) move_axial(transfer[i].own, transfer[i].host, transfer[i].force, transfer[i].moment);
        return settled == 3;
    }

  private:
    M& march_;

    /// What tendons that end here on their own tube, led up to here by another's disks, hand over between the two.
    struct Transfer {
        int own, host;
        T force, moment;
    };

    /// lambda t_3 and lambda (r x t)_3 of a tendon in the section solved last.
    void axial_part(const TendonState<P>& tendon, T& force, T& moment) const {
        T n[3] = {T(0.0), T(0.0), T(0.0)}, m[3] = {T(0.0), T(0.0), T(0.0)}, inverse, t[3], r[2];
        add_tendon(tendon, march_.solver.cosine[tendon.slot], march_.solver.sine[tendon.slot], march_.solver.strains, n, m, inverse, t, r);
        force = n[2];
        moment = m[2];
    }

    void move_axial(int from, int to, const T& force, const T& moment) {
        march_.y[N3 + from] -= force;
        march_.y[M3 + from] -= moment;
        march_.y[N3 + to] += force;
        march_.y[M3 + to] += moment;
    }

    /// The tube that hosts a tendon in a section, -1 where the tendon does not run.
    int host_of(const Section<P>& section, int tendon) const {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            if (march_.layout.hosted[h].tendon == tendon) return section.active[march_.layout.hosted[h].slot];
        return -1;
    }

    bool ends_on_another(const Section<P>& section, const Section<P>* beyond, const Hosted& hosted) const {
        return section.active[hosted.slot] != march_.robot.tendons[hosted.tendon].tube &&
               !(beyond && host_of(*beyond, hosted.tendon) >= 0);
    }

    int list_transfers(const Section<P>& section, const Section<P>* beyond, Transfer* transfer) const {
        int pairs = 0;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = march_.layout.hosted[h];
            if (!ends_on_another(section, beyond, hosted)) continue;
            const int own = march_.robot.tendons[hosted.tendon].tube;
            int i = 0;
            while (i < pairs && transfer[i].own != own) ++i;
            if (i == pairs) transfer[pairs++] = {own, section.active[hosted.slot], T(0.0), T(0.0)};
        }
        return pairs;
    }

    /// How far the tendons' axial parts, at the strains that the transfers lead to, are from the transfers.
    bool transfer_gaps(const Section<P>& section, const Section<P>* beyond, const Transfer* transfer, int pairs, T* gap,
                       double& worst) {
        for (int i = 0; i < pairs; ++i) move_axial(transfer[i].own, transfer[i].host, transfer[i].force, transfer[i].moment);
        const bool found = march_.solve_at(section, section.distal);
        for (int i = 0; i < pairs; ++i) move_axial(transfer[i].host, transfer[i].own, transfer[i].force, transfer[i].moment);
        if (!found) return false;
        for (int i = 0; i < pairs; ++i) {
            gap[2 * i] = -transfer[i].force;
            gap[2 * i + 1] = -transfer[i].moment;
        }
        double forces = march_.solver.force_scale, moments = march_.solver.moment_scale;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = march_.layout.hosted[h];
            if (!ends_on_another(section, beyond, hosted)) continue;
            int i = 0;
            while (transfer[i].own != march_.robot.tendons[hosted.tendon].tube) ++i;
            T force, moment;
            axial_part(march_.solver.tendons[h - section.hosted.begin], force, moment);
            gap[2 * i] += force;
            gap[2 * i + 1] += moment;
            forces += std::fabs(value(force));
            moments += std::fabs(value(moment));
        }
        worst = 0.0;
        for (int i = 0; i < pairs; ++i)
            worst = larger(worst, larger(std::fabs(value(gap[2 * i])) / forces, std::fabs(value(gap[2 * i + 1])) / moments));
        return std::isfinite(worst);
    }

    /// inverse of -d(gap)/d(transfer), by differences.
    template <int N>
    bool invert_transfer_slopes(const Section<P>& section, const Section<P>* beyond, const Transfer* transfer, int pairs,
                                const T* gap, double (&inverse)[N][N]) {
        double slope[N][N];
        for (int j = 0; j < 2 * pairs; ++j) {
            Transfer moved[MAX_TUBES];
            for (int i = 0; i < pairs; ++i) moved[i] = transfer[i];
            const double h = 1e-5 * (j % 2 == 0 ? march_.solver.force_scale : march_.solver.moment_scale);
            (j % 2 == 0 ? moved[j / 2].force : moved[j / 2].moment) += h;
            T ahead[N];
            double worst;
            if (!transfer_gaps(section, beyond, moved, pairs, ahead, worst)) return false;
            for (int i = 0; i < 2 * pairs; ++i) slope[i][j] = (value(gap[i]) - value(ahead[i])) / h;
        }
        for (int j = 0; j < 2 * pairs; ++j) {
            double A[N][N], column[N];
            for (int i = 0; i < 2 * pairs; ++i) {
                column[i] = i == j;
                for (int c = 0; c < 2 * pairs; ++c) A[i][c] = slope[i][c];
            }
            if (solve_dense(2 * pairs, A, column) == 0.0) return false;
            for (int i = 0; i < 2 * pairs; ++i) inverse[i][j] = column[i];
        }
        return true;
    }
};

}  // namespace tactr
