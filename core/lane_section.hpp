// Solves one cross-section for all configurations of a pack side by side: strains by Newton, their derivatives by one dual
// Newton step. A configuration that is done waits, unchanged, for the others.
#pragma once
#include "bare_section.hpp"
#include "lane_plan.hpp"
#include "lane_rows.hpp"
#include "routing.hpp"
#include "section_equilibrium.hpp"
#include "states.hpp"

namespace tactr {

/// K: directional derivatives that the states carry, 0 for none.
template <class R, int K>
struct LaneState {
    using type = Dual<K, R>;
};
template <class R>
struct LaneState<R, 0> {
    using type = R;
};

template <class R, int K>
class LaneSectionSolver {
  public:
    using T = typename LaneState<R, K>::type;
    static constexpr int WIDTH = K > 0 ? K : 1;

    R moment_scale, force_scale;  // of the residual
    double enough;                // residual from which no more than a linear step is needed
    bool last_step;               // whether that step is made
    R worst_residual, least_stretch;

    StrainsOf<T> strains;
    T cosine[LANE_TUBES], sine[LANE_TUBES];
    T N_xy[LANE_TUBES][2], M_xy[LANE_TUBES][2];
    TubeState<R> tubes[LANE_TUBES];
    TendonState<R> tendons[LANE_HOSTED];
    TendonTangentOf<R> tendon_tangents[LANE_HOSTED];

    TACTR_ANY LaneSectionSolver(const LanePlan& plan, const LaneNumbers<R>& numbers) : plan_(plan), numbers_(numbers) {}

    TACTR_ANY void begin() {
        section_ = nullptr;
        worst_residual = R(0.0);
        least_stretch = R(1.0);
        moment_scale = numbers_[plan_.moment_scale];
        force_scale = numbers_[plan_.force_scale];
    }

    /// From the packed states z at s to the strains, starting at e. Where false, none were found.
    TACTR_APART MaskOf<R> solve(const LaneSection& section, const R& s, const T* z, const Packing& packing, StrainsOf<R>& e) {
        if (section_ != &section) enter(section);
        place(section, s);
        for (int a = 0; a < section.active_count; ++a) sine_cosine(z[3 * a], sine[a], cosine[a]);
        MaskOf<R> found;
        if (section.bare) {
            const T* sums = packing.sums < 0 ? nullptr : z + packing.sums;
            found = solve_bare_section(tubes, section.active_count, section.guided != 0, cosine, sine, z, sums, strains, N_xy, M_xy);
            read_values(section, e);
        } else {
            found = find_strains(section, z, packing, e);
            carry(section, z, packing, e);
        }
        for (int a = 0; a < section.active_count; ++a)
            least_stretch = smaller(least_stretch, 1.0 + e.eta[a] - tubes[a].vstar[2]);
        return found;
    }

    /// lambda t_3 and lambda (r x t)_3 of a tendon in the section solved last.
    TACTR_ANY void axial_part(int hosted, T& force, T& moment) const {
        const TendonState<R>& tendon = tendons[hosted];
        T n[3] = {T(0.0), T(0.0), T(0.0)}, m[3] = {T(0.0), T(0.0), T(0.0)}, inverse, t[3], r[2];
        add_tendon(tendon, cosine[tendon.slot], sine[tendon.slot], strains, n, m, inverse, t, r);
        force = n[2];
        moment = m[2];
    }

  private:
    static constexpr int MOST_STEPS = 12;

    const LanePlan& plan_;
    const LaneNumbers<R>& numbers_;
    const LaneSection* section_ = nullptr;
    TubePieceOf<R> piece_[LANE_TUBES];
    RoutingPieceOf<R> routing_[LANE_HOSTED];
    R pull_, pull_moment_;
    R N_[LANE_TUBES][3], M_[LANE_TUBES][3];
    TubeTangentOf<R> tangent_[LANE_TUBES];
    TubeRowsOf<R> rows_[LANE_TUBES];
    SectionFactorOf<R> factor_;

    TACTR_APART void enter(const LaneSection& section) {
        section_ = &section;
        for (int a = 0; a < section.active_count; ++a) {
            long n = section.piece[a].first;
            TubePieceOf<R>& piece = piece_[a];
            piece.count = section.piece[a].count;
            piece.plain = section.piece[a].plain;
            piece.start = numbers_[n++];
            for (int k = 0; k < piece.count; ++k)
                for (int q = 0; q < QUANTITIES; ++q) piece.c[k][q] = numbers_[n++];
            if (piece.count == 1) tubes[a] = tube_at(piece, piece.start, 1.0);
        }
        for (int h = 0; h < section.hosted_count; ++h) {
            const LaneHosted& hosted = section.hosted[h];
            long n = hosted.first;
            RoutingPieceOf<R>& routing = routing_[h];
            routing.polar = hosted.polar;
            routing.count_a = hosted.count_a;
            routing.count_b = hosted.count_b;
            routing.start = numbers_[n++];
            for (int c = 0; c < hosted.count_a; ++c) routing.a[c] = numbers_[n++];
            for (int c = 0; c < hosted.count_b; ++c) routing.b[c] = numbers_[n++];
            tendons[h].slot = hosted.slot;
            tendons[h].tension = numbers_[plan_.tension + hosted.tendon];
            if (is_straight(hosted)) evaluate_routing(routing, routing.start, tendons[h].r, tendons[h].dr);
        }
    }

    TACTR_ANY static bool is_straight(const LaneHosted& hosted) { return hosted.count_a == 1 && hosted.count_b == 1; }

    TACTR_ANY void place(const LaneSection& section, const R& s) {
        for (int a = 0; a < section.active_count; ++a)
            if (piece_[a].count > 1) tubes[a] = tube_at(piece_[a], R(s - numbers_[plan_.translation + section.active[a]]), 1.0);
        pull_ = pull_moment_ = R(0.0);
        for (int h = 0; h < section.hosted_count; ++h) {
            TendonState<R>& tendon = tendons[h];
            if (!is_straight(section.hosted[h]))
                evaluate_routing(routing_[h], R(s - numbers_[section.hosted[h].base]), tendon.r, tendon.dr);
            pull_ += tendon.tension;
            pull_moment_ += tendon.tension * (absolute(tendon.r[0]) + absolute(tendon.r[1]));
        }
    }

    TACTR_ANY void read_values(const LaneSection& section, StrainsOf<R>& e) const {
        e.kx = value(strains.kx);
        e.ky = value(strains.ky);
        e.wx = value(strains.wx);
        e.wy = value(strains.wy);
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = value(strains.tau[a]);
            e.eta[a] = value(strains.eta[a]);
        }
    }

    TACTR_APART void evaluate_wrenches(const LaneSection& section, const StrainsOf<R>& e) {
        for (int a = 0; a < section.active_count; ++a)
            elastic_wrench(tubes[a], value(cosine[a]), value(sine[a]), e, a, N_[a], M_[a]);
        for (int h = 0; h < section.hosted_count; ++h) {
            const int a = tendons[h].slot;
            TendonTangentOf<R>& tangent = tendon_tangents[h];
            R r[2];
            add_tendon(tendons[h], value(cosine[a]), value(sine[a]), e, N_[a], M_[a], tangent.inverse, tangent.t, r);
            tangent.x = r[0];
            tangent.y = r[1];
            tangent.stiffness = tendons[h].tension * tangent.inverse;
        }
    }

    TACTR_ANY MaskOf<R> factor_tangent(const LaneSection& section, const StrainsOf<R>& e) {
        for (int a = 0; a < section.active_count; ++a) {
            TubeTangentOf<R>& tangent = tangent_[a];
            elastic_tangent(tubes[a], value(cosine[a]), value(sine[a]), tangent);
            for (int h = 0; h < section.hosted_count; ++h)
                if (tendons[h].slot == a) add_tendon_tangent(tendon_tangents[h], tangent);
            rows_[a].set(tangent, e.wx, e.wy, e.eta[a]);
        }
        return factor_.factor(rows_, section.active_count, section.guided != 0);
    }

    /// Residual of the section's equations, as right-hand sides of the Newton step; returns the largest, scaled.
    TACTR_ANY R residual(const LaneSection& section, const T* z, const Packing& packing, R (&total)[4][1], R (&tube)[LANE_TUBES][2][1]) const {
        R worst_force(0.0), worst_moment(0.0), forces = force_scale + pull_, moments = moment_scale + pull_moment_, check(0.0);
        for (int r = 0; r < 2; ++r) {
            total[r][0] = packing.sums < 0 ? R(0.0) : value(z[packing.sums + 2 + r]);
            total[r + 2][0] = packing.sums < 0 ? R(0.0) : value(z[packing.sums + r]);
            moments += absolute(total[r][0]);
            forces += absolute(total[r + 2][0]);
        }
        for (int a = 0; a < section.active_count; ++a) {
            for (int r = 0; r < 2; ++r) {
                total[r][0] -= M_[a][r];
                total[r + 2][0] -= N_[a][r];
            }
            const R n = value(z[3 * a + 1]), m = value(z[3 * a + 2]);
            tube[a][0][0] = m - M_[a][2];
            tube[a][1][0] = n - N_[a][2];
            forces += absolute(n);
            moments += absolute(m);
            worst_moment = larger(worst_moment, absolute(tube[a][0][0]));
            worst_force = larger(worst_force, absolute(tube[a][1][0]));
            check += tube[a][0][0] + tube[a][1][0];
        }
        if (!section.guided)
            for (int r = 0; r < 2; ++r) {
                worst_moment = larger(worst_moment, absolute(total[r][0]));
                worst_force = larger(worst_force, absolute(total[r + 2][0]));
                check += total[r][0] + total[r + 2][0];
            }
        return select(is_finite(check), larger(worst_moment / moments, worst_force / forces), R(HUGE_VAL));
    }

    /// Newton's full steps: near a solution, or far from any trouble. What needs more care is not for packs.
    TACTR_APART MaskOf<R> find_strains(const LaneSection& section, const T* z, const Packing& packing, StrainsOf<R>& e) {
        R total[4][1], tube[LANE_TUBES][2][1];
        MaskOf<R> found = true;
        for (int step = 0;; ++step) {
            evaluate_wrenches(section, e);
            const R worst = residual(section, z, packing, total, tube);
            const MaskOf<R> done = worst <= enough, pending = found & !done;
            if (none(pending) || step == MOST_STEPS) {
                worst_residual = larger(worst_residual, worst);
                found = found & done;
                break;
            }
            found = found & (factor_tangent(section, e) | done);
            factor_.template solve<1>(total, tube);
            move_strains(section, pending, total, tube, e);
        }
        if (last_step) {
            found = found & factor_tangent(section, e);
            factor_.template solve<1>(total, tube);
            if (section.guided) total[0][0] = total[1][0] = total[2][0] = total[3][0] = R(0.0);
            step_linearly(section, total, tube, e);
        }
        return found;
    }

    TACTR_ANY static void move_strains(const LaneSection& section, const MaskOf<R>& pending, const R (&total)[4][1],
                                       const R (&tube)[LANE_TUBES][2][1], StrainsOf<R>& e) {
        const R none(0.0);
        if (!section.guided) {
            e.kx += select(pending, total[0][0], none);
            e.ky += select(pending, total[1][0], none);
            e.wx += select(pending, total[2][0], none);
            e.wy += select(pending, total[3][0], none);
        }
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] += select(pending, tube[a][0][0], none);
            e.eta[a] += select(pending, tube[a][1][0], none);
        }
    }

    TACTR_ANY static R along(const R* row, const R (&total)[4][1], const R (&tube)[2][1]) {
        return row[0] * total[0][0] + row[1] * total[1][0] + row[2] * total[2][0] + row[3] * total[3][0] + row[4] * tube[0][0] +
               row[5] * tube[1][0];
    }

    /// Takes the Newton step in the strains and, to first order, in N, M and |q|, without evaluating them again.
    TACTR_ANY void step_linearly(const LaneSection& section, const R (&total)[4][1], const R (&tube)[LANE_TUBES][2][1], StrainsOf<R>& e) {
        for (int h = 0; h < section.hosted_count; ++h) {
            const int a = tendons[h].slot;
            const R longer = stretching(tendon_tangents[h], e, a, total[0][0], total[1][0], total[2][0], total[3][0], tube[a][0][0], tube[a][1][0]);
            tendon_tangents[h].inverse = tendon_tangents[h].inverse / (1.0 + longer * tendon_tangents[h].inverse);
        }
        e.kx += total[0][0];
        e.ky += total[1][0];
        e.wx += total[2][0];
        e.wy += total[3][0];
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] += tube[a][0][0];
            e.eta[a] += tube[a][1][0];
            N_[a][0] += along(rows_[a].Nx, total, tube[a]);
            N_[a][1] += along(rows_[a].Ny, total, tube[a]);
            N_[a][2] += along(rows_[a].N3, total, tube[a]);
            M_[a][0] += along(rows_[a].Mx, total, tube[a]);
            M_[a][1] += along(rows_[a].My, total, tube[a]);
            M_[a][2] += along(rows_[a].M3, total, tube[a]);
        }
    }

    /// Strains with their derivatives by the implicit function theorem, and N_xy, M_xy with them.
    TACTR_APART void carry(const LaneSection& section, const T* z, const Packing& packing, const StrainsOf<R>& e) {
        if constexpr (K == 0) {
            copy_strains(e, section.active_count, strains);
            for (int a = 0; a < section.active_count; ++a)
                for (int r = 0; r < 2; ++r) {
                    N_xy[a][r] = N_[a][r];
                    M_xy[a][r] = M_[a][r];
                }
        } else {
            R rate[LANE_TUBES][6], total[4][WIDTH], tube[LANE_TUBES][2][WIDTH];
            for (int r = 0; r < 2; ++r)
                for (int l = 0; l < WIDTH; ++l) {
                    total[r][l] = packing.sums < 0 ? R(0.0) : z[packing.sums + 2 + r].d[l];
                    total[r + 2][l] = packing.sums < 0 ? R(0.0) : z[packing.sums + r].d[l];
                }
            for (int a = 0; a < section.active_count; ++a) {
                turning_rates(tangent_[a], N_[a], M_[a], e, a, rate[a]);
                for (int l = 0; l < WIDTH; ++l) {
                    const R turn = z[3 * a].d[l];
                    for (int r = 0; r < 2; ++r) {
                        total[r][l] -= rate[a][3 + r] * turn;
                        total[r + 2][l] -= rate[a][r] * turn;
                    }
                    tube[a][0][l] = z[3 * a + 2].d[l] - rate[a][5] * turn;
                    tube[a][1][l] = z[3 * a + 1].d[l] - rate[a][2] * turn;
                }
            }
            factor_.template solve<WIDTH>(total, tube);
            if (section.guided)
                for (int r = 0; r < 4; ++r)
                    for (int l = 0; l < WIDTH; ++l) total[r][l] = R(0.0);
            write_strains(section, e, total, tube);
            for (int a = 0; a < section.active_count; ++a) {
                write_lanes(N_xy[a][0], N_[a][0], rate[a][0], z[3 * a], rows_[a].Nx, total, tube[a]);
                write_lanes(N_xy[a][1], N_[a][1], rate[a][1], z[3 * a], rows_[a].Ny, total, tube[a]);
                write_lanes(M_xy[a][0], M_[a][0], rate[a][3], z[3 * a], rows_[a].Mx, total, tube[a]);
                write_lanes(M_xy[a][1], M_[a][1], rate[a][4], z[3 * a], rows_[a].My, total, tube[a]);
            }
        }
    }

    TACTR_ANY void write_strains(const LaneSection& section, const StrainsOf<R>& e, const R (&total)[4][WIDTH],
                                 const R (&tube)[LANE_TUBES][2][WIDTH]) {
        const R values[4] = {e.kx, e.ky, e.wx, e.wy};
        T* shared[4] = {&strains.kx, &strains.ky, &strains.wx, &strains.wy};
        for (int r = 0; r < 4; ++r) {
            shared[r]->v = values[r];
            for (int l = 0; l < WIDTH; ++l) shared[r]->d[l] = total[r][l];
        }
        for (int a = 0; a < section.active_count; ++a) {
            strains.tau[a].v = e.tau[a];
            strains.eta[a].v = e.eta[a];
            for (int l = 0; l < WIDTH; ++l) {
                strains.tau[a].d[l] = tube[a][0][l];
                strains.eta[a].d[l] = tube[a][1][l];
            }
        }
    }

    TACTR_ANY static void write_lanes(T& out, const R& v, const R& rate, const T& psi, const R* row, const R (&total)[4][WIDTH],
                                      const R (&tube)[2][WIDTH]) {
        out.v = v;
        for (int l = 0; l < WIDTH; ++l)
            out.d[l] = rate * psi.d[l] + ((row[0] * total[0][l] + row[1] * total[1][l]) + (row[2] * total[2][l] + row[3] * total[3][l])) +
                       (row[4] * tube[0][l] + row[5] * tube[1][l]);
    }
};

}  // namespace tactr
