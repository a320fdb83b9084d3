// Solves one cross-section during the march: strains in double by Newton, their derivatives by one dual Newton step.
#pragma once
#include <cmath>
#include <type_traits>
#include <vector>

#include "dual.hpp"
#include "robot.hpp"
#include "routing.hpp"
#include "section_equilibrium.hpp"
#include "sections.hpp"
#include "states.hpp"

namespace tactr {

template <class T, class P>
class SectionSolver {
  public:
    static constexpr int LANES = LaneCount<T>::value;
    static constexpr int WIDTH = LANES > 0 ? LANES : 1;

    double moment_scale = 1.0, force_scale = 1.0;  // of the residual
    bool strict = true;  // false: on the way to a strict march, sections may be solved roughly
    double worst_residual = 0.0;
    double least_stretch = 1.0;
    double shortest_tendon = 1.0;  // least |q| of a pulled tendon so far: 0 at a kink

    // The section at the last solve, by position among the tubes present.
    StrainsOf<T> strains;
    T cosine[MAX_TUBES], sine[MAX_TUBES];
    T N_xy[MAX_TUBES][2], M_xy[MAX_TUBES][2];
    std::vector<TendonState<P>> tendons;
    std::vector<TendonTangent> tendon_tangents;

    SectionSolver(const Robot& robot, const Layout<P>& layout, const Actuation<P>& actuation)
        : robot_(robot), layout_(layout), actuation_(actuation) {
        tendons.resize(layout.max_hosted + 1);
        tendon_tangents.resize(layout.max_hosted + 1);
    }

    /// From the packed states z at s to the strains, starting at e; false: none found.
    bool solve(const Section<P>& section, const P& s, const T* z, const Packing& packing, Strains& e) {
        place_tendons(section, s);
        for (int a = 0; a < section.active_count; ++a) sine_cosine(z[3 * a], sine[a], cosine[a]);
        if (!find_strains(section, z, packing, e)) return false;
        watch_tendons(section);
        for (int a = 0; a < section.active_count; ++a)
            if (1.0 + e.eta[a] < least_stretch) least_stretch = 1.0 + e.eta[a];
        carry(section, z, packing, e);
        return true;
    }

    /// Energy per length in the tubes, and that of the tendons' pull: tension times length.
    double stored(const Section<P>& section, const Strains& e) const {
        double sum = 0.0;
        for (int a = 0; a < section.active_count; ++a) {
            const TubePiece& tube = robot_.pieces[section.piece[a]];
            double n[3], m[3], ustar[3];
            rest_curvature(section, a, ustar);
            elastic_wrench(tube, ustar, value(cosine[a]), value(sine[a]), e, a, n, m);
            // half the product of stress and strain, in the tube's frame: u - u* from m
            const double c = value(cosine[a]), s = value(sine[a]);
            const double bx = c * m[0] + s * m[1], by = c * m[1] - s * m[0];
            sum += 0.5 * (bx * bx / tube.EIx + by * by / tube.EIy + m[2] * m[2] / tube.GJ + n[2] * n[2] / tube.EA +
                          (n[0] * n[0] + n[1] * n[1]) / tube.GA);
        }
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
            const TendonState<double> tendon = plain(tendons[h]);
            double n[3] = {}, m[3] = {}, speed, t[3], r[2];
            add_tendon(tendon, value(cosine[tendon.slot]), value(sine[tendon.slot]), e, n, m, speed, t, r);
            sum += tendon.tension * speed;
        }
        return sum;
    }

  private:
    // Of loose marches, which only lead to the strict one: below the first residual a linear step ends the solve,
    // below the second, without derivatives, no step is taken.
    static constexpr double LINEAR_ENOUGH = 1e-2, CLOSE_ENOUGH = 1e-4;

    const Robot& robot_;
    const Layout<P>& layout_;
    const Actuation<P>& actuation_;
    double N_[MAX_TUBES][3], M_[MAX_TUBES][3];
    TubeTangent tangent_[MAX_TUBES];
    TubeRows rows_[MAX_TUBES];
    SectionFactor factor_;

    void place_tendons(const Section<P>& section, const P& s) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout_.hosted[h];
            TendonState<P>& state = tendons[h - section.hosted.begin];
            const P sigma = s - actuation_.translation[robot_.tendons[hosted.tendon].tube];
            evaluate_routing(robot_.routing[hosted.routing], sigma, state.r, state.dr);
            state.tension = actuation_.tension[hosted.tendon] * actuation_.shape_scale;
            if (hosted.profile >= 0) {
                const TensionPiece& piece = robot_.profiles[hosted.profile];
                P factor, slope;
                evaluate_polynomial(piece.c, piece.count, P(sigma - piece.start), factor, slope);
                state.tension = state.tension * factor;
            }
            state.slot = hosted.slot;
        }
    }

    /// Keeps the least |q|, at solutions and on the way to slow ones: a tendon bent to no length stops everything.
    void watch_tendons(const Section<P>& section) {
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h)
            if (value(tendons[h].tension) > 0.0) shortest_tendon = smaller(shortest_tendon, tendon_tangents[h].speed);
    }

    static TendonState<double> plain(const TendonState<P>& t) {
        return {{value(t.r[0]), value(t.r[1])}, {value(t.dr[0]), value(t.dr[1])}, value(t.tension), t.slot};
    }

    /// u* of the tube in a slot of the section, in its own frame.
    void rest_curvature(const Section<P>& section, int a, double ustar[3]) const {
        for (int r = 0; r < 3; ++r) ustar[r] = actuation_.shape_scale * robot_.pieces[section.piece[a]].ustar[r];
    }

    void evaluate_wrenches(const Section<P>& section, const Strains& e) {
        for (int a = 0; a < section.active_count; ++a) {
            double ustar[3];
            rest_curvature(section, a, ustar);
            elastic_wrench(robot_.pieces[section.piece[a]], ustar, value(cosine[a]), value(sine[a]), e, a, N_[a], M_[a]);
        }
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) {
            const TendonState<double> tendon = plain(tendons[h]);
            const int a = tendon.slot;
            TendonTangent& tangent = tendon_tangents[h];
            double r[2];
            add_tendon(tendon, value(cosine[a]), value(sine[a]), e, N_[a], M_[a], tangent.speed, tangent.t, r);
            tangent.x = r[0];
            tangent.y = r[1];
            tangent.stiffness = tendon.tension / tangent.speed;
        }
    }

    bool factor_tangent(const Section<P>& section, const Strains& e) {
        for (int a = 0; a < section.active_count; ++a)
            elastic_tangent(robot_.pieces[section.piece[a]], value(cosine[a]), value(sine[a]), tangent_[a]);
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) add_tendon_tangent(tendon_tangents[h], tangent_[tendons[h].slot]);
        for (int a = 0; a < section.active_count; ++a) rows_[a].set(tangent_[a], e.wx, e.wy, e.eta[a]);
        return factor_.factor(rows_, section.active_count, section.guided);
    }

    /// Residual of the section's equations, as right-hand sides of the Newton step; returns the largest, scaled.
    double residual(const Section<P>& section, const T* z, const Packing& packing, double total[4][1],
                    double tube[MAX_TUBES][2][1]) const {
        double worst_force = 0.0, worst_moment = 0.0, forces = force_scale, moments = moment_scale;
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
        Strains from = e, step = e;
        double last = INFINITY, fraction = 1.0;
        for (int iteration = 0; iteration < SECTION_ITERATIONS; ++iteration) {
            evaluate_wrenches(section, e);
            const double worst = residual(section, z, packing, total, tube);
            if (LANES == 0 && !strict && worst < CLOSE_ENOUGH) return true;
            if (worst <= SECTION_TOLERANCE) {
                worst_residual = larger(worst_residual, worst);
                return finish(section, total, tube, e);
            }
            if (iteration > 2) watch_tendons(section);
            if (!(worst < last) && !(energy(section, z, packing, e) < energy(section, z, packing, from))) {
                if (fraction < 1e-7) return false;
                fraction *= 0.5;
                move_strains(section, from, step, fraction, e);
                continue;
            }
            if (!strict && worst < LINEAR_ENOUGH) return finish(section, total, tube, e);
            if (!factor_tangent(section, e)) return false;
            factor_.template solve<1>(total, tube);
            if (section.guided) total[0][0] = total[1][0] = total[2][0] = total[3][0] = 0.0;
            from = e;
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
    bool finish(const Section<P>& section, double total[4][1], double tube[MAX_TUBES][2][1], Strains& e) {
        if (!factor_tangent(section, e)) return false;
        factor_.template solve<1>(total, tube);
        if (section.guided) total[0][0] = total[1][0] = total[2][0] = total[3][0] = 0.0;
        step_linearly(section, total, tube, e);
        return true;
    }

    /// The convex function of the strains of which the section's equations are the stationarity (up to terms of the
    /// order of the stretch): it tells a good step where the residual, after a sharp turn of a tendon, does not.
    double energy(const Section<P>& section, const T* z, const Packing& packing, const Strains& e) const {
        double sum = stored(section, e);
        if (packing.sums >= 0) {
            const T* sums = z + packing.sums;
            sum -= value(sums[0]) * e.wx + value(sums[1]) * e.wy + value(sums[2]) * e.kx + value(sums[3]) * e.ky;
        }
        for (int a = 0; a < section.active_count; ++a)
            sum -= value(z[3 * a + 1]) * e.eta[a] + value(z[3 * a + 2]) * e.tau[a];
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

    // --- derivatives -----------------------------------------------------------------------------------------------

    /// Lanes of (N_x, N_y, N_3, M_x, M_y, M_3) of one tube.
    using WrenchLanes = double[6][WIDTH];

    /// Strains with their derivatives by the implicit function theorem, and N_xy, M_xy with them.
    void carry(const Section<P>& section, const T* z, const Packing& packing, const Strains& e) {
        if constexpr (LANES == 0) {
            strains = e;
            for (int a = 0; a < section.active_count; ++a)
                for (int r = 0; r < 2; ++r) {
                    N_xy[a][r] = N_[a][r];
                    M_xy[a][r] = M_[a][r];
                }
        } else {
            WrenchLanes fixed[MAX_TUBES];
            if constexpr (std::is_same_v<P, double>) {
                lanes_of_turning(section, z, e, fixed);
            } else {
                lanes_of_everything(section, e, fixed);
            }
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
        out.v = v;
        for (int l = 0; l < WIDTH; ++l)
            out.d[l] = fixed[l] + row[0] * total[0][l] + row[1] * total[1][l] + row[2] * total[2][l] +
                       row[3] * total[3][l] + row[4] * tube[0][l] + row[5] * tube[1][l];
    }

    /// With plain parameters and strains held fixed in R_b, only psi moves N and M. They turn with the tube:
    /// d(N, M)/dpsi = e3 x (N, M) - K (e3 x (v, u)).
    void lanes_of_turning(const Section<P>& section, const T* z, const Strains& e, WrenchLanes* fixed) const {
        for (int a = 0; a < section.active_count; ++a) {
            const TubeTangent& K = tangent_[a];
            const double f = 1.0 + e.eta[a];
            const double vx = -f * e.wy, vy = f * e.wx, ux = -e.ky, uy = e.kx;
            const double rate[6] = {-N_[a][1] - (K.vv[0] * vx + K.vv[1] * vy + K.vu[0][0] * ux + K.vu[0][1] * uy),
                                    N_[a][0] - (K.vv[1] * vx + K.vv[3] * vy + K.vu[1][0] * ux + K.vu[1][1] * uy),
                                    -(K.vv[2] * vx + K.vv[4] * vy + K.vu[2][0] * ux + K.vu[2][1] * uy),
                                    -M_[a][1] - (K.vu[0][0] * vx + K.vu[1][0] * vy + K.uu[0] * ux + K.uu[1] * uy),
                                    M_[a][0] - (K.vu[0][1] * vx + K.vu[1][1] * vy + K.uu[1] * ux + K.uu[3] * uy),
                                    -(K.vu[0][2] * vx + K.vu[1][2] * vy + K.uu[2] * ux + K.uu[4] * uy)};
            const T& psi = z[3 * a];
            for (int r = 0; r < 6; ++r)
                for (int l = 0; l < WIDTH; ++l) fixed[a][r][l] = rate[r] * psi.d[l];
        }
    }

    /// With parameters that carry derivatives too: N and M evaluated in dual numbers at fixed strains.
    void lanes_of_everything(const Section<P>& section, const Strains& e, WrenchLanes* fixed) const {
        T n[MAX_TUBES][3], m[MAX_TUBES][3];
        for (int a = 0; a < section.active_count; ++a) {
            double ustar[3];
            rest_curvature(section, a, ustar);
            elastic_wrench(robot_.pieces[section.piece[a]], ustar, cosine[a], sine[a], e, a, n[a], m[a]);
        }
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) {
            const int a = tendons[h].slot;
            T speed, t[3], r[2];
            add_tendon(tendons[h], cosine[a], sine[a], e, n[a], m[a], speed, t, r);
        }
        for (int a = 0; a < section.active_count; ++a)
            for (int r = 0; r < 3; ++r)
                for (int l = 0; l < WIDTH; ++l) {
                    fixed[a][r][l] = n[a][r].d[l];
                    fixed[a][3 + r][l] = m[a][r].d[l];
                }
    }
};

}  // namespace tactr
