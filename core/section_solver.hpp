// Solves one cross-section during the march: strains in double by Newton, their derivatives by one dual Newton step.
#pragma once
#include <cmath>
#include <type_traits>
#include <vector>

#include "bare_section.hpp"
#include "dual.hpp"
#include "robot.hpp"
#include "routing.hpp"
#include "section_equilibrium.hpp"
#include "sections.hpp"
#include "states.hpp"

namespace tactr {

/// How well a march solves its sections. rough: only to lead to a better march. full: to tolerance, and a linear step
/// beyond, which keeps the march smooth in its unknowns. checked: to tolerance.
enum class Precision { rough, checked, full };

/// T: states, P: actuation, C: the robot's own constants; each double or a dual number.
template <class T, class P, class C = double>
class SectionSolver {
  public:
    static constexpr int LANES = LaneCount<T>::value;
    static constexpr int WIDTH = LANES > 0 ? LANES : 1;

    double moment_scale = 1.0, force_scale = 1.0;  // of the residual
    Precision precision = Precision::full;
    double tolerance = SECTION_TOLERANCE;  // of the residual
    double worst_residual = 0.0;
    double least_stretch = 1.0;    // beyond the rest stretch
    double shortest_tendon = 1.0;  // least |q| of a pulled tendon so far: 0 at a kink

    // The section at the last solve, by position among the tubes present.
    StrainsOf<T> strains;
    T cosine[MAX_TUBES], sine[MAX_TUBES];
    T N_xy[MAX_TUBES][2], M_xy[MAX_TUBES][2];
    TubeState<double> tubes[MAX_TUBES];
    std::vector<TendonState<P>> tendons;
    std::vector<TendonTangent> tendon_tangents;

    SectionSolver(const RobotOf<C>& robot, const Layout<P>& layout, const Actuation<P>& actuation)
        : robot_(robot), layout_(layout), actuation_(actuation) {
        tendons.resize(layout.max_hosted + 1);
        tendon_tangents.resize(layout.max_hosted + 1);
        if (SLIM) slim_.resize(layout.max_hosted + 1);
    }

    /// Forgets the section before, as a march begins: robot and actuation may have changed.
    void begin() { section_ = nullptr; }

    /// From the packed states z at s to the strains, starting at e; false: none found.
    bool solve(const Section<P>& section, const P& s, const T* z, const Packing& packing, Strains& e) {
        place_tubes(section, s);
        place_tendons(section, s);
        for (int a = 0; a < section.active_count; ++a) sine_cosine(z[3 * a], sine[a], cosine[a]);
        if (bare_) {
            if (!solve_bare(section, z, packing, e)) return false;
        } else {
            if (!find_strains(section, z, packing, e)) return false;
            watch_tendons(section);
            carry(section, z, packing, e);
        }
        for (int a = 0; a < section.active_count; ++a)
            least_stretch = smaller(least_stretch, 1.0 + e.eta[a] - tubes[a].vstar[2]);
        return true;
    }

    /// Where the section's tendons run at s, and their tension.
    void place_tendons(const Section<P>& section, const P& s) {
        pull_ = pull_moment_ = 0.0;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout_.hosted[h];
            TendonState<P>& state = tendons[h - section.hosted.begin];
            const P sigma = s - actuation_.translation[robot_.tendons[hosted.tendon].tube];
            const P tension = actuation_.tension[hosted.tendon] * actuation_.shape_scale;
            if constexpr (SLIM) {
                Slim& slim = slim_[h - section.hosted.begin];
                Dual<2> along(value(sigma)), pull(value(tension));
                along.d[0] = pull.d[1] = 1.0;
                slim.sigma = sigma;
                slim.tension = tension;
                slim.state.slot = hosted.slot;
                place_tendon(hosted, along, pull, slim.state);
                for (int r = 0; r < 2; ++r) {
                    state.r[r] = slim.widen(slim.state.r[r]);
                    state.dr[r] = slim.widen(slim.state.dr[r]);
                }
                state.tension = slim.widen(slim.state.tension);
            } else {
                place_tendon(hosted, sigma, tension, state);
            }
            state.slot = hosted.slot;
            pull_ += value(state.tension);
            pull_moment_ += value(state.tension) * (std::fabs(value(state.r[0])) + std::fabs(value(state.r[1])));
        }
    }

  private:
    // Where only the actuation carries derivatives, a tendon moves with its place sigma and its tension alone: two lanes
    // stand for all.
    static constexpr bool SLIM = std::is_same_v<C, double> && !std::is_same_v<P, double>;
    struct Slim {
        TendonState<Dual<2>> state;
        P sigma, tension;

        P widen(const Dual<2>& x) const {
            P wide(x.v);
            if constexpr (SLIM)
                for (int l = 0; l < LANES; ++l) wide.d[l] = x.d[0] * sigma.d[l] + x.d[1] * tension.d[l];
            return wide;
        }
    };
    std::vector<Slim> slim_;

    // Of rough marches: below the first residual a linear step ends the solve, below the second, without derivatives, no
    // step is taken.
    static constexpr double LINEAR_ENOUGH = LANES == 0 ? 0.1 : 1e-2, CLOSE_ENOUGH = 1e-5;
    static constexpr double SAME_TANGENT = 1e-5;  // a step from so small a residual does not change the tangent

    const RobotOf<C>& robot_;
    const Layout<P>& layout_;
    const Actuation<P>& actuation_;
    double pull_ = 0.0, pull_moment_ = 0.0;  // tensions, and with their offsets, of all tendons here
    const Section<P>* section_ = nullptr;  // whose constant tubes are in place
    int varying_[MAX_TUBES], varying_count_ = 0;  // slots of the tubes that vary along the section
    bool bare_ = false;                           // the section has a closed form
    TubeState<P> exact_[MAX_TUBES];  // where P carries derivatives
    bool moves_[MAX_TUBES];          // whether a tube's has any
    double N_[MAX_TUBES][3], M_[MAX_TUBES][3];
    TubeTangent tangent_[MAX_TUBES];
    TubeRows rows_[MAX_TUBES];
    SectionFactor factor_;

    template <class D>
    void place_tendon(const Hosted& hosted, const D& sigma, const D& tension, TendonState<D>& state) const {
        evaluate_routing(robot_.routing[hosted.routing], sigma, state.r, state.dr);
        state.tension = tension;
        if (hosted.profile < 0) return;
        const TensionPieceOf<C>& piece = robot_.profiles[hosted.profile];
        D factor, slope;
        evaluate_polynomial(piece.c, piece.count, D(sigma - piece.start), factor, slope);
        state.tension = state.tension * factor;
    }

    void place_tubes(const Section<P>& section, const P& s) {
        if (section_ != &section) enter(section);
        for (int k = 0; k < varying_count_; ++k) {
            const int a = varying_[k];
            place_tube(section, a, s - actuation_.translation[section.active[a]]);
        }
    }

    void enter(const Section<P>& section) {
        section_ = &section;
        varying_count_ = 0;
        bare_ = std::is_same_v<C, double> && section.hosted.begin == section.hosted.end;
        for (int a = 0; a < section.active_count; ++a) {
            const TubePieceOf<C>& piece = robot_.pieces[section.piece[a]];
            if constexpr (std::is_same_v<C, double>) bare_ = bare_ && bends_alike(piece);
            if (piece.count > 1) varying_[varying_count_++] = a;
            place_tube(section, a, P(piece.start));
        }
    }

    void place_tube(const Section<P>& section, int a, const P& sigma) {
        const TubePieceOf<C>& piece = robot_.pieces[section.piece[a]];
        if constexpr (std::is_same_v<P, double>) {
            tubes[a] = tube_at(piece, sigma, actuation_.shape_scale);
        } else {
            exact_[a] = tube_at(piece, sigma, actuation_.shape_scale);
            moves_[a] = !std::is_same_v<C, double> || piece.count > 1;
            tubes[a] = values_of(exact_[a]);
        }
    }

    bool solve_bare(const Section<P>& section, const T* z, const Packing& packing, Strains& e) {
        const T* sums = packing.sums < 0 ? nullptr : z + packing.sums;
        bool moving = false;
        if constexpr (!std::is_same_v<P, double>)
            for (int a = 0; a < section.active_count; ++a) moving = moving || moves_[a];
        bool found;
        if (moving)
            found = solve_bare_section(exact_, section.active_count, section.guided, cosine, sine, z, sums, strains, N_xy, M_xy);
        else
            found = solve_bare_section(tubes, section.active_count, section.guided, cosine, sine, z, sums, strains, N_xy, M_xy);
        e.kx = value(strains.kx);
        e.ky = value(strains.ky);
        e.wx = value(strains.wx);
        e.wy = value(strains.wy);
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = value(strains.tau[a]);
            e.eta[a] = value(strains.eta[a]);
        }
        return found;
    }

    /// Keeps the least |q|, at solutions and on the way to slow ones: a tendon bent to no length stops everything.
    void watch_tendons(const Section<P>& section) {
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h)
            if (value(tendons[h].tension) > 0.0) shortest_tendon = smaller(shortest_tendon, 1.0 / tendon_tangents[h].inverse);
    }

    static TendonState<double> plain(const TendonState<P>& t) {
        return {{value(t.r[0]), value(t.r[1])}, {value(t.dr[0]), value(t.dr[1])}, value(t.tension), t.slot};
    }

    void evaluate_wrenches(const Section<P>& section, const Strains& e) {
        for (int a = 0; a < section.active_count; ++a)
            elastic_wrench(tubes[a], value(cosine[a]), value(sine[a]), e, a, N_[a], M_[a]);
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) {
            const TendonState<double> tendon = plain(tendons[h]);
            const int a = tendon.slot;
            TendonTangent& tangent = tendon_tangents[h];
            double r[2];
            add_tendon(tendon, value(cosine[a]), value(sine[a]), e, N_[a], M_[a], tangent.inverse, tangent.t, r);
            tangent.x = r[0];
            tangent.y = r[1];
            tangent.stiffness = tendon.tension * tangent.inverse;
        }
    }

    bool factor_tangent(const Section<P>& section, const Strains& e) {
        const int count = section.hosted.end - section.hosted.begin;
        for (int a = 0; a < section.active_count; ++a) {
            TubeTangent K;
            elastic_tangent(tubes[a], value(cosine[a]), value(sine[a]), K);
            for (int h = 0; h < count; ++h)
                if (tendons[h].slot == a) add_tendon_tangent(tendon_tangents[h], K);
            rows_[a].set(K, e.wx, e.wy, e.eta[a]);
            tangent_[a] = K;
        }
        return factor_.factor(rows_, section.active_count, section.guided);
    }

    /// Residual of the section's equations, as right-hand sides of the Newton step; returns the largest, scaled.
    double residual(const Section<P>& section, const T* z, const Packing& packing, double total[4][1],
                    double tube[MAX_TUBES][2][1]) const {
        double worst_force = 0.0, worst_moment = 0.0, forces = force_scale + pull_, moments = moment_scale + pull_moment_;
        for (int r = 0; r < 2; ++r) {
            total[r][0] = packing.sums < 0 ? 0.0 : value(z[packing.sums + 2 + r]);
            total[r + 2][0] = packing.sums < 0 ? 0.0 : value(z[packing.sums + r]);
            moments += std::fabs(total[r][0]);
            forces += std::fabs(total[r + 2][0]);
        }
        double check = 0.0;
        for (int a = 0; a < section.active_count; ++a) {
            for (int r = 0; r < 2; ++r) {
                total[r][0] -= M_[a][r];
                total[r + 2][0] -= N_[a][r];
            }
            const double n = value(z[3 * a + 1]), m = value(z[3 * a + 2]);
            tube[a][0][0] = m - M_[a][2];
            tube[a][1][0] = n - N_[a][2];
            forces += std::fabs(n);
            moments += std::fabs(m);
            worst_moment = larger(worst_moment, std::fabs(tube[a][0][0]));
            worst_force = larger(worst_force, std::fabs(tube[a][1][0]));
            check += tube[a][0][0] + tube[a][1][0];
        }
        if (!section.guided)
            for (int r = 0; r < 2; ++r) {
                worst_moment = larger(worst_moment, std::fabs(total[r][0]));
                worst_force = larger(worst_force, std::fabs(total[r + 2][0]));
                check += total[r][0] + total[r + 2][0];
            }
        return std::isfinite(check) ? larger(worst_moment / moments, worst_force / forces) : INFINITY;
    }

    bool find_strains(const Section<P>& section, const T* z, const Packing& packing, Strains& e) {
        double total[4][1], tube[MAX_TUBES][2][1];
        Strains from, step;
        double last = INFINITY, fraction = 1.0;
        for (int iteration = 0; iteration < SECTION_ITERATIONS; ++iteration) {
            evaluate_wrenches(section, e);
            const double worst = residual(section, z, packing, total, tube);
            if (iteration == 0 && !std::isfinite(worst)) return false;  // there is nothing yet to go back to
            if (LANES == 0 && precision == Precision::rough && worst < CLOSE_ENOUGH) return true;
            if (worst <= tolerance) {
                worst_residual = larger(worst_residual, worst);
                if (LANES == 0 && precision == Precision::checked) return true;
                return finish(section, total, tube, e, LANES == 0 && last < SAME_TANGENT);
            }
            if (iteration > 2) watch_tendons(section);
            if (!(worst < last) && !(energy(section, z, packing, e) < energy(section, z, packing, from))) {
                if (fraction < 1e-7) return false;
                fraction *= 0.5;
                move_strains(section, from, step, fraction, e);
                continue;
            }
            if (precision == Precision::rough && worst < LINEAR_ENOUGH) return finish(section, total, tube, e, false);
            if (!factor_tangent(section, e)) return false;
            factor_.template solve<1>(total, tube);
            if (section.guided) total[0][0] = total[1][0] = total[2][0] = total[3][0] = 0.0;
            copy_strains(e, section.active_count, from);
            step.kx = total[0][0];
            step.ky = total[1][0];
            step.wx = total[2][0];
            step.wy = total[3][0];
            for (int a = 0; a < section.active_count; ++a) {
                step.tau[a] = tube[a][0][0];
                step.eta[a] = tube[a][1][0];
            }
            last = worst;
            fraction = 1.0;
            move_strains(section, from, step, fraction, e);
        }
        return false;
    }

    /// Ends on a linear step: it squares a residual that is small already, and keeps the march smooth in its unknowns.
    bool finish(const Section<P>& section, double total[4][1], double tube[MAX_TUBES][2][1], Strains& e, bool factored) {
        if (!factored && !factor_tangent(section, e)) return false;
        factor_.template solve<1>(total, tube);
        if (section.guided) total[0][0] = total[1][0] = total[2][0] = total[3][0] = 0.0;
        step_linearly(section, total, tube, e);
        return true;
    }

    /// The convex function of the strains of which the section's equations are the stationarity (up to terms of the
    /// order of the stretch): it tells a good step where the residual, after a sharp turn of a tendon, does not.
    double energy(const Section<P>& section, const T* z, const Packing& packing, const Strains& e) const {
        double sum = 0.0;
        if (packing.sums >= 0) {
            const T* sums = z + packing.sums;
            sum -= value(sums[0]) * e.wx + value(sums[1]) * e.wy + value(sums[2]) * e.kx + value(sums[3]) * e.ky;
        }
        for (int a = 0; a < section.active_count; ++a) {
            const double c = value(cosine[a]), s = value(sine[a]);
            double n[3], m[3];
            elastic_wrench(tubes[a], c, s, e, a, n, m);
            sum += 0.5 * elastic_energy(tubes[a], c, s, n, m);
            sum -= value(z[3 * a + 1]) * e.eta[a] + value(z[3 * a + 2]) * e.tau[a];
        }
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
            const TendonState<double> tendon = plain(tendons[h]);
            double n[3] = {}, m[3] = {}, inverse, t[3], r[2];
            add_tendon(tendon, value(cosine[tendon.slot]), value(sine[tendon.slot]), e, n, m, inverse, t, r);
            sum += tendon.tension / inverse;
        }
        return std::isfinite(sum) ? sum : INFINITY;
    }

    static void move_strains(const Section<P>& section, const Strains& from, const Strains& step, double f, Strains& e) {
        e.kx = from.kx + f * step.kx;
        e.ky = from.ky + f * step.ky;
        e.wx = from.wx + f * step.wx;
        e.wy = from.wy + f * step.wy;
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = from.tau[a] + f * step.tau[a];
            e.eta[a] = from.eta[a] + f * step.eta[a];
        }
    }

    /// d(row of the tube's Jacobian) times a change of the strains.
    static double along(const double* row, const double total[4][1], const double tube[2][1]) {
        return row[0] * total[0][0] + row[1] * total[1][0] + row[2] * total[2][0] + row[3] * total[3][0] +
               row[4] * tube[0][0] + row[5] * tube[1][0];
    }

    /// Takes the Newton step in the strains and, to first order, in N and M, without evaluating them again.
    void step_linearly(const Section<P>& section, const double total[4][1], const double tube[MAX_TUBES][2][1], Strains& e) {
        stretch_tendons(section, total, tube, e);
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

    /// Of the tendons' tangents only |q| is taken along: their lengths are read from it.
    void stretch_tendons(const Section<P>& section, const double total[4][1], const double tube[MAX_TUBES][2][1], const Strains& e) {
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
            TendonTangent& tendon = tendon_tangents[h];
            const int a = tendons[h].slot;
            const double longer = stretching(tendon, e, a, total[0][0], total[1][0], total[2][0], total[3][0], tube[a][0][0], tube[a][1][0]);
            tendon.inverse /= 1.0 + longer * tendon.inverse;
        }
    }

    // --- derivatives -----------------------------------------------------------------------------------------------

    /// Lanes of (N_x, N_y, N_3, M_x, M_y, M_3) of one tube.
    using WrenchLanes = double[6][WIDTH];

    /// Strains with their derivatives by the implicit function theorem, and N_xy, M_xy with them.
    void carry(const Section<P>& section, const T* z, const Packing& packing, const Strains& e) {
        if constexpr (LANES == 0) {
            copy_strains(e, section.active_count, strains);
            for (int a = 0; a < section.active_count; ++a)
                for (int r = 0; r < 2; ++r) {
                    N_xy[a][r] = N_[a][r];
                    M_xy[a][r] = M_[a][r];
                }
        } else {
            WrenchLanes fixed[MAX_TUBES];
            lanes_of_turning(section, z, e, fixed);
            if constexpr (!std::is_same_v<P, double>) add_lanes_of_parameters(section, e, fixed);
            double total[4][WIDTH], tube[MAX_TUBES][2][WIDTH];
            strain_lanes(section, z, packing, fixed, total, tube);
            write_strains(section, e, total, tube);
            for (int a = 0; a < section.active_count; ++a) {
                write_lanes(N_xy[a][0], N_[a][0], fixed[a][0], rows_[a].Nx, total, tube[a]);
                write_lanes(N_xy[a][1], N_[a][1], fixed[a][1], rows_[a].Ny, total, tube[a]);
                write_lanes(M_xy[a][0], M_[a][0], fixed[a][3], rows_[a].Mx, total, tube[a]);
                write_lanes(M_xy[a][1], M_[a][1], fixed[a][4], rows_[a].My, total, tube[a]);
            }
        }
    }

    void strain_lanes(const Section<P>& section, const T* z, const Packing& packing, const WrenchLanes* fixed,
                      double total[4][WIDTH], double tube[MAX_TUBES][2][WIDTH]) const {
        for (int r = 0; r < 2; ++r)
            for (int l = 0; l < WIDTH; ++l) {
                total[r][l] = packing.sums < 0 ? 0.0 : z[packing.sums + 2 + r].d[l];
                total[r + 2][l] = packing.sums < 0 ? 0.0 : z[packing.sums + r].d[l];
            }
        for (int a = 0; a < section.active_count; ++a)
            for (int l = 0; l < WIDTH; ++l) {
                for (int r = 0; r < 2; ++r) {
                    total[r][l] -= fixed[a][3 + r][l];
                    total[r + 2][l] -= fixed[a][r][l];
                }
                tube[a][0][l] = z[3 * a + 2].d[l] - fixed[a][5][l];
                tube[a][1][l] = z[3 * a + 1].d[l] - fixed[a][2][l];
            }
        factor_.template solve<WIDTH>(total, tube);
        if (!section.guided) return;
        for (int r = 0; r < 4; ++r)
            for (int l = 0; l < WIDTH; ++l) total[r][l] = 0.0;
    }

    void write_strains(const Section<P>& section, const Strains& e, const double total[4][WIDTH],
                       const double tube[MAX_TUBES][2][WIDTH]) {
        const double values[4] = {e.kx, e.ky, e.wx, e.wy};
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

    static void write_lanes(T& out, double v, const double* fixed, const double* row, const double total[4][WIDTH],
                            const double tube[2][WIDTH]) {
        const double a = row[0], b = row[1], c = row[2], d = row[3], f = row[4], g = row[5];
        double rate[WIDTH];
        for (int l = 0; l < WIDTH; ++l)
            rate[l] = fixed[l] + ((a * total[0][l] + b * total[1][l]) + (c * total[2][l] + d * total[3][l])) +
                      (f * tube[0][l] + g * tube[1][l]);
        out.v = v;
        for (int l = 0; l < WIDTH; ++l) out.d[l] = rate[l];
    }

    /// What only psi moves, see turning_rates.
    void lanes_of_turning(const Section<P>& section, const T* z, const Strains& e, WrenchLanes* fixed) const {
        for (int a = 0; a < section.active_count; ++a) {
            double rate[6];
            turning_rates(tangent_[a], N_[a], M_[a], e, a, rate);
            const T psi = z[3 * a];
            for (int r = 0; r < 6; ++r)
                for (int l = 0; l < WIDTH; ++l) fixed[a][r][l] = rate[r] * psi.d[l];
        }
    }

    /// With strains and psi held fixed, N and M move with the parameters.
    void add_lanes_of_parameters(const Section<P>& section, const Strains& e, WrenchLanes* fixed) const {
        for (int a = 0; a < section.active_count; ++a) {
            if (!moves_[a]) continue;
            P n[3], m[3];
            elastic_wrench(exact_[a], value(cosine[a]), value(sine[a]), e, a, n, m);
            add_lanes(n, m, fixed[a]);
        }
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
            const int a = tendons[h].slot;
            const double c = value(cosine[a]), s = value(sine[a]);
            if constexpr (SLIM) {
                using D = Dual<2>;
                D n[3] = {D(0.0), D(0.0), D(0.0)}, m[3] = {D(0.0), D(0.0), D(0.0)}, inverse, t[3], r[2];
                add_tendon(slim_[h].state, c, s, e, n, m, inverse, t, r);
                add_slim_lanes(slim_[h], n, fixed[a]);
                add_slim_lanes(slim_[h], m, fixed[a] + 3);
            } else {
                P n[3] = {P(0.0), P(0.0), P(0.0)}, m[3] = {P(0.0), P(0.0), P(0.0)}, inverse, t[3], r[2];
                add_tendon(tendons[h], c, s, e, n, m, inverse, t, r);
                add_lanes(n, m, fixed[a]);
            }
        }
    }

    static void add_slim_lanes(const Slim& slim, const Dual<2> (&wrench)[3], double (*fixed)[WIDTH]) {
        for (int r = 0; r < 3; ++r) {
            const double along = wrench[r].d[0], pull = wrench[r].d[1];
            for (int l = 0; l < WIDTH; ++l) fixed[r][l] += along * slim.sigma.d[l] + pull * slim.tension.d[l];
        }
    }

    static void add_lanes(const P (&n)[3], const P (&m)[3], WrenchLanes& fixed) {
        for (int r = 0; r < 3; ++r)
            for (int l = 0; l < WIDTH; ++l) {
                fixed[r][l] += n[r].d[l];
                fixed[3 + r][l] += m[r].d[l];
            }
    }
};

}  // namespace tactr
