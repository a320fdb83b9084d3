// Marches the resultants and the tubes' angles from the free end to the base, section by section, with one or more
// eighth-order steps in each. T carries the states (double or dual), P the parameters (double, or T for sensitivities).
#pragma once
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "dense.hpp"
#include "dp8_tableau.hpp"
#include "dual.hpp"
#include "robot.hpp"
#include "rotations.hpp"
#include "section_solver.hpp"
#include "sections.hpp"
#include "states.hpp"

namespace tactr {

/// Called after every step; the default sees nothing.
struct NoObserver {};

/// An observer that names a type Stages is called after every stage too, with the stage's share of an integral along s.
template <class Observer, class = void>
struct SeesStages : std::false_type {};
template <class Observer>
struct SeesStages<Observer, std::void_t<typename Observer::Stages>> : std::true_type {};

/// The nonzero entries of one row of the Runge-Kutta tableau.
struct SparseRow {
    double weight[dp8::DENSE_STAGES];
    int stage[dp8::DENSE_STAGES];
    int count = 0;
    constexpr SparseRow(const double* row, int length) : weight{}, stage{} {
        for (int j = 0; j < length; ++j)
            if (row[j] != 0.0) {
                weight[count] = row[j];
                stage[count++] = j;
            }
    }
};

template <class T, class P, class C = double>
class March {
  public:
    static constexpr int LANES = LaneCount<T>::value;
    static constexpr int MAX_STEPS = 512;  // per section

    const RobotOf<C>& robot;
    const Layout<P>& layout;
    const Actuation<P>& actuation;
    MarchOptions options;
    SectionSolver<T, P, C> solver;

    const double* error_weight = nullptr;  // turns an error of a state into metres at the tip
    int error_lane = -1;                   // lane that carries the estimated discretisation error to the base
    double adapt_tolerance = 0.0;          // > 0: more steps in a section until its error is below
    int probe_section = -1, probe_lane = 0;  // lanes from probe_lane: a unit wrench in world axes at that section's end
    bool lengths_move = false;             // the tendons' lengths with their derivatives too
    int slope_lanes = 0;                   // > 0: lanes 0.. are the unknowns, keep the strains' slopes in the mesh

    // Results
    BaseState<T> base;
    std::vector<double> section_error;  // per section, metres at the tip
    std::vector<double> edge_error;     // of every section's first and last step
    std::vector<double> tendon_length;  // per tendon, when options.path
    std::vector<T> moving_length;       // the same, when lengths_move

    // The step under way, for observers.
    T y[STATES];                             // all states between sections
    T z[STATES];                             // the packed states of this section
    T k[dp8::DENSE_STAGES][STATES];          // packed rates at the stages
    Packing packing;

    March(const RobotOf<C>& robot_, const Layout<P>& layout_, const Actuation<P>& actuation_, MarchOptions options_)
        : robot(robot_), layout(layout_), actuation(actuation_), options(options_), solver(robot_, layout_, actuation_) {}

    /// Runs from the tip to the base. False: a section had no equilibrium.
    template <class Observer>
    bool run(const FreeEnd<T>& free_end, Mesh& mesh, Observer& observer) {
        const bool warm = mesh.warm;
        const int count = static_cast<int>(layout.sections.size());
        mesh.warm = false;
        if (slope_lanes > 0) mesh.slopes.resize(mesh.strains.size() * STRAINS * slope_lanes);
        start(free_end, count);
        size_t first_stage = mesh.strains.size();
        for (int k_section = count - 1; k_section >= 0; --k_section) {
            const Section<P>& section = layout.sections[k_section];
            if (!cross_boundary(free_end, k_section)) return false;
            pack(section);
            if (adapt_tolerance > 0.0) {
                if (!march_adaptively(section, k_section, mesh)) return false;
            } else {
                first_stage -= static_cast<size_t>(mesh.steps[k_section]) * dp8::STAGES;
                if (!march_section(section, k_section, mesh, first_stage, warm, observer)) return false;
            }
            unpack();
            leave_section(k_section);
        }
        mesh.warm = adapt_tolerance == 0.0;
        if (slope_lanes > 0) mesh.unknowns = slope_lanes;
        return true;
    }

    bool run(const FreeEnd<T>& free_end, Mesh& mesh) {
        NoObserver nobody;
        return run(free_end, mesh, nobody);
    }

    /// Packed rates of the packed states at s; e: start and result of the section's strains.
    bool derivative(const Section<P>& section, const P& s, const T* state, T* rate, Strains& e) {
        if (!solver.solve(section, s, state, packing, e)) return false;
        equations(section, state, rate);
        return true;
    }

  private:
    Strains last_;  // strains of the nearest point solved so far

    void start(const FreeEnd<T>& free_end, int sections) {
        for (int c = 0; c < STATES; ++c) y[c] = T(0.0);
        for (int c = 0; c < 4; ++c) y[QUAT + c] = free_end.quaternion[c];
        for (int i = 0; i < robot.tube_count; ++i) base.psi[i] = free_end.psi[i];  // as long as the base is beyond its end
        last_ = Strains{};
        solver.begin();
        section_error.assign(sections, 0.0);
        edge_error.assign(2 * static_cast<size_t>(sections), 0.0);
        if (options.path) tendon_length.assign(robot.tendon_count, 0.0);
        if (lengths_move) moving_length.assign(robot.tendon_count, T(0.0));
    }

    void pack(const Section<P>& section) {
        packing.set(section.active, section.active_count, section.guided, options);
        for (int n = 0; n < packing.count; ++n) z[n] = y[packing.index[n]];
    }

    void unpack() {
        for (int n = 0; n < packing.count; ++n) y[packing.index[n]] = z[n];
    }

    // --- boundaries between sections -------------------------------------------------------------------------------

    bool cross_boundary(const FreeEnd<T>& free_end, int k_section) {
        const Section<P>& section = layout.sections[k_section];
        const bool tip = k_section + 1 == static_cast<int>(layout.sections.size());
        const Section<P>* beyond = tip ? nullptr : &layout.sections[k_section + 1];
        const Strains nearest = nearest_strains(section, beyond);
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            if (beyond && slot_of(*beyond, i) >= 0) continue;
            y[PSI + i] = free_end.psi[i];
            y[N3 + i] = y[M3 + i] = T(0.0);
        }
        if (beyond && !change_hosts(section, *beyond)) return false;
        last_ = nearest;
        apply_point_loads(section);
        if constexpr (LANES > 0)
            if (k_section == probe_section) apply_probe(section);
        return take_terminations(section, beyond);
    }

    Strains nearest_strains(const Section<P>& section, const Section<P>* beyond) const {
        Strains e = last_;
        for (int a = 0; a < section.active_count; ++a) {
            const int b = beyond ? slot_of(*beyond, section.active[a]) : -1;
            e.tau[a] = b < 0 ? 0.0 : last_.tau[b];
            e.eta[a] = b < 0 ? 0.0 : last_.eta[b];
        }
        if (section.guided) e.kx = e.ky = e.wx = e.wy = 0.0;
        return e;
    }

    bool solve_at(const Section<P>& section, const P& s) {
        Strains e = last_;
        pack(section);
        return solver.solve(section, s, z, packing, e);
    }

    /// lambda t_3 and lambda (r x t)_3 of a tendon in the section solved last.
    void axial_part(const TendonState<P>& tendon, T& force, T& moment) const {
        T n[3] = {T(0.0), T(0.0), T(0.0)}, m[3] = {T(0.0), T(0.0), T(0.0)}, inverse, t[3], r[2];
        add_tendon(tendon, solver.cosine[tendon.slot], solver.sine[tendon.slot], solver.strains, n, m, inverse, t, r);
        force = n[2];
        moment = m[2];
    }

    void move_axial(int from, int to, const T& force, const T& moment) {
        y[N3 + from] -= force;
        y[M3 + from] -= moment;
        y[N3 + to] += force;
        y[M3 + to] += moment;
    }

    /// Theory, "Transitions": where a tendon's host changes its axial part moves to the new host.
    bool change_hosts(const Section<P>& section, const Section<P>& beyond) {
        bool solved = false;
        for (int h = beyond.hosted.begin; h < beyond.hosted.end; ++h) {
            const int to = host_of(section, layout.hosted[h].tendon);
            const int from = beyond.active[layout.hosted[h].slot];
            if (to < 0 || to == from) continue;
            if (!solved && !solve_at(beyond, beyond.proximal)) return false;
            solved = true;
            T force, moment;
            axial_part(solver.tendons[h - beyond.hosted.begin], force, moment);
            move_axial(from, to, force, moment);
        }
        return true;
    }

    /// The tube that hosts a tendon in a section, -1 where the tendon does not run.
    int host_of(const Section<P>& section, int tendon) const {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            if (layout.hosted[h].tendon == tendon) return section.active[layout.hosted[h].slot];
        return -1;
    }

    /// What tendons that end here on their own tube, led up to here by another's disks, hand over between the two.
    struct Transfer {
        int own, host;
        T force, moment;
    };

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
                if (++settled == 3) solver.worst_residual = larger(solver.worst_residual, worst);
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

    bool ends_on_another(const Section<P>& section, const Section<P>* beyond, const Hosted& hosted) const {
        return section.active[hosted.slot] != robot.tendons[hosted.tendon].tube &&
               !(beyond && host_of(*beyond, hosted.tendon) >= 0);
    }

    int list_transfers(const Section<P>& section, const Section<P>* beyond, Transfer* transfer) const {
        int pairs = 0;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout.hosted[h];
            if (!ends_on_another(section, beyond, hosted)) continue;
            const int own = robot.tendons[hosted.tendon].tube;
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
        const bool found = solve_at(section, section.distal);
        for (int i = 0; i < pairs; ++i) move_axial(transfer[i].host, transfer[i].own, transfer[i].force, transfer[i].moment);
        if (!found) return false;
        for (int i = 0; i < pairs; ++i) {
            gap[2 * i] = -transfer[i].force;
            gap[2 * i + 1] = -transfer[i].moment;
        }
        double forces = solver.force_scale, moments = solver.moment_scale;
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout.hosted[h];
            if (!ends_on_another(section, beyond, hosted)) continue;
            int i = 0;
            while (transfer[i].own != robot.tendons[hosted.tendon].tube) ++i;
            T force, moment;
            axial_part(solver.tendons[h - section.hosted.begin], force, moment);
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
            const double h = 1e-5 * (j % 2 == 0 ? solver.force_scale : solver.moment_scale);
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

    /// A load given in world or body axes, in R_b; q: R_b, psi: angle of the loaded tube.
    void load_in_frame(const C v[3], bool body_axes, const T* q, const T& psi, T out[3]) const {
        if (!body_axes) {
            to_frame(q, v, out);
        } else {
            T s, c;
            sine_cosine(psi, s, c);
            out[0] = c * v[0] - s * v[1];
            out[1] = s * v[0] + c * v[1];
            out[2] = T(v[2]);
        }
        for (int a = 0; a < 3; ++a) out[a] *= actuation.load_scale;
    }

    void apply_point_loads(const Section<P>& section) {
        for (int p = section.point_loads.begin; p < section.point_loads.end; ++p) {
            const PointLoadOf<C>& load = robot.point_loads[layout.point_loads[p].load];
            T force[3], moment[3];
            load_in_frame(load.force, load.body_axes, &y[QUAT], y[PSI + load.tube], force);
            load_in_frame(load.moment, load.body_axes, &y[QUAT], y[PSI + load.tube], moment);
            for (int a = 0; a < 2; ++a) {
                y[SUM_N + a] += force[a];
                y[SUM_M + a] += moment[a];
            }
            y[N3 + load.tube] += force[2];
            y[M3 + load.tube] += moment[2];
        }
    }

    /// Unit forces and moments along the world axes, as rates only; borne by the innermost tube.
    void apply_probe(const Section<P>& section) {
        const int tube = section.active[section.active_count - 1];
        const double q[4] = {value(y[QUAT]), value(y[QUAT + 1]), value(y[QUAT + 2]), value(y[QUAT + 3])};
        for (int axis = 0; axis < 3; ++axis) {
            const double unit[3] = {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
            double v[3];
            to_frame(q, unit, v);
            add_probe(probe_lane + axis, y[SUM_N], y[SUM_N + 1], y[N3 + tube], v);
            add_probe(probe_lane + 3 + axis, y[SUM_M], y[SUM_M + 1], y[M3 + tube], v);
        }
    }

    static void add_probe(int lane, T& x, T& y, T& z, const double* v) {
        if (lane < 0 || lane >= LANES) return;
        x.d[lane] += v[0];
        y.d[lane] += v[1];
        z.d[lane] += v[2];
    }

    void leave_section(int k_section) {
        const Section<P>& section = layout.sections[k_section];
        const Section<P>* before = k_section > 0 ? &layout.sections[k_section - 1] : nullptr;
        for (int a = 0; a < section.active_count; ++a)
            if (!before || slot_of(*before, section.active[a]) < 0)
                base.psi[section.active[a]] = y[PSI + section.active[a]];
        if (section.guided || (before && !before->guided)) return;
        for (int c = 0; c < 4; ++c) base.quaternion[c] = y[QUAT + c];
        for (int c = 0; c < 3; ++c) base.position[c] = y[POS + c];
    }

    // --- steps -----------------------------------------------------------------------------------------------------

    template <class Observer>
    bool march_section(const Section<P>& section, int k_section, Mesh& mesh, size_t first_stage, bool warm, Observer& observer) {
        if constexpr (SeesStages<Observer>::value) packing.fed_back = packing.count;  // p at the stages too
        const int steps = mesh.steps[k_section];
        const double grade = mesh.grade_of(k_section);
        const P length = section.proximal - section.distal;
        for (int step = 0; step < steps; ++step) {
            const double share = Mesh::share_before(step, steps, grade);
            const P s = section.distal + length * share, h = length * (Mesh::share_before(step + 1, steps, grade) - share);
            T before[STATES];
            for (int n = 0; n < packing.count; ++n) before[n] = z[n];
            const size_t stage = first_stage + static_cast<size_t>(steps - 1 - step) * dp8::STAGES;
            if (!run_stages(section, k_section, s, h, before, mesh, stage, warm, observer)) return false;
            const double error_before = section_error[k_section];
            advance(h, before, section_error[k_section]);
            if (step == 0) edge_error[2 * k_section] = section_error[k_section] - error_before;
            if (step + 1 == steps) edge_error[2 * k_section + 1] = section_error[k_section] - error_before;
            if constexpr (!std::is_same_v<Observer, NoObserver>) observer(*this, k_section, before, s, h);
        }
        return true;
    }

    bool march_adaptively(const Section<P>& section, int k_section, Mesh& mesh) {
        T saved[STATES];
        for (int n = 0; n < packing.count; ++n) saved[n] = z[n];
        const Strains saved_strains = last_;
        const std::vector<double> saved_length = tendon_length;
        NoObserver nobody;
        for (int attempt = 0;; ++attempt) {
            section_error[k_section] = 0.0;
            mesh.strains.resize(static_cast<size_t>(mesh.steps[k_section]) * dp8::STAGES);
            const bool solved = march_section(section, k_section, mesh, 0, false, nobody);
            const double error = section_error[k_section];
            if (solved && error <= adapt_tolerance) return true;
            if (attempt == 6 || mesh.steps[k_section] >= MAX_STEPS) return solved;
            double factor = solved && std::isfinite(error) ? std::ceil(1.1 * std::pow(error / adapt_tolerance, 0.125)) : 4.0;
            factor = larger(2.0, smaller(factor, 4.0));
            const int finer = static_cast<int>(mesh.steps[k_section] * factor);
            if (solved) mesh.grade[k_section] = mesh.even_grade(k_section, finer, edge_error[2 * k_section], edge_error[2 * k_section + 1]);
            mesh.steps[k_section] = finer;
            for (int n = 0; n < packing.count; ++n) z[n] = saved[n];
            last_ = saved_strains;
            tendon_length = saved_length;
        }
    }

    template <class Observer>
    bool run_stages(const Section<P>& section, int k_section, const P& s, const P& h, const T* before, Mesh& mesh,
                    size_t first, bool warm, Observer& observer) {
        for (int i = 0; i < dp8::STAGES; ++i) {
            to_stage(i, h, before);
            Strains& e = mesh.strains[first + i];
            if (!warm) {
                copy_strains(last_, section.active_count, e);
            } else if (mesh.unknowns > 0) {
                shift_strains(section, mesh, first + i, e);
            }
            if (!derivative(section, s + h * dp8::C[i], z, k[i], e)) return false;
            if (options.path) add_lengths(section, -value(h) * dp8::B[i]);
            if (lengths_move) add_moving_lengths(section, h * -dp8::B[i]);
            if constexpr (SeesStages<Observer>::value)
                observer.stage(*this, section, k_section, value(s + h * dp8::C[i]), -value(h) * dp8::B[i]);
            if constexpr (LANES > 0)
                if (slope_lanes > 0) keep_slopes(section, mesh, first + i);
            if (!warm || i + 1 == dp8::STAGES) copy_strains(e, section.active_count, last_);
        }
        return true;
    }

    /// z at stage i (the step's end: i = STAGES) from the rates at the stages before.
    void to_stage(int i, const P& h, const T* before) {
        switch (i) {
            case 1: return add_rates<1>(h, before);
            case 2: return add_rates<2>(h, before);
            case 3: return add_rates<3>(h, before);
            case 4: return add_rates<4>(h, before);
            case 5: return add_rates<5>(h, before);
            case 6: return add_rates<6>(h, before);
            case 7: return add_rates<7>(h, before);
            case 8: return add_rates<8>(h, before);
            case 9: return add_rates<9>(h, before);
            case 10: return add_rates<10>(h, before);
            case 11: return add_rates<11>(h, before);
            case dp8::STAGES: return add_rates<dp8::STAGES>(h, before);
            default: return;
        }
    }

    /// z = before + h * sum of weight * k, unrolled over the nonzero weights.
    template <int I>
    void add_rates(const P& h, const T* before) {
        static constexpr SparseRow ROW(I == dp8::STAGES ? dp8::B : dp8::A[I], I);
        const int count = I < dp8::STAGES ? packing.fed_back : packing.count;
        add_rates_of<ROW>(h, before, count, std::make_integer_sequence<int, ROW.count>());
    }

    template <const SparseRow& ROW, int... J>
    void add_rates_of(const P& h, const T* before, int count, std::integer_sequence<int, J...>) {
        if constexpr (std::is_same_v<P, double>) {
            const int width = count * (LANES + 1);
            const double* from = reinterpret_cast<const double*>(before);
            double* to = reinterpret_cast<double*>(z);
            const double* rates = reinterpret_cast<const double*>(k);
            constexpr int STRIDE = STATES * (LANES + 1);
            for (int n = 0; n < width; ++n) to[n] = from[n] + h * ((rates[ROW.stage[J] * STRIDE + n] * ROW.weight[J]) + ...);
        } else {
            for (int n = 0; n < count; ++n) z[n] = before[n] + ((k[ROW.stage[J]][n] * ROW.weight[J]) + ...) * h;
        }
    }

    void advance(const P& h, const T* before, double& error) {
        to_stage(dp8::STAGES, h, before);
        if (error_weight) add_error(value(h), error);
        if (packing.frame >= 0 && packing.path >= 0) normalise(&z[packing.frame]);
    }

    static void normalise(T* q) {
        const T inverse = T(1.0) / square_root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int c = 0; c < 4; ++c) q[c] = q[c] * inverse;
    }

    /// Embedded estimates of order 5 and 3, combined to one of about order 8 (Hairer et al., section II.10).
    void add_error(double h, double& total) {
        static constexpr SparseRow FIFTH(dp8::E5, dp8::STAGES), THIRD(dp8::E3, dp8::STAGES);
        double step_error[STATES], norm5 = 0.0, norm3 = 0.0;
        for (int n = 0; n < packing.count; ++n) {
            double e5 = 0.0, e3 = 0.0;
            for (int j = 0; j < FIFTH.count; ++j) e5 += FIFTH.weight[j] * value(k[FIFTH.stage[j]][n]);
            for (int j = 0; j < THIRD.count; ++j) e3 += THIRD.weight[j] * value(k[THIRD.stage[j]][n]);
            step_error[n] = e5 * h;
            const double weight = error_weight[packing.index[n]], w5 = e5 * weight, w3 = e3 * weight;
            norm5 += w5 * w5;
            norm3 += w3 * w3;
        }
        const double size = norm5 + 0.01 * norm3;
        const double damping = size > 0.0 ? std::sqrt(norm5 / size) : 0.0;
        total += std::fabs(h) * std::sqrt(norm5) * damping;
        if constexpr (LANES > 0)
            if (error_lane >= 0)
                for (int n = 0; n < packing.count; ++n) z[n].d[error_lane] += step_error[n] * damping;
    }

    void add_lengths(const Section<P>& section, double weight) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            tendon_length[layout.hosted[h].tendon] += weight / solver.tendon_tangents[h - section.hosted.begin].inverse;
    }

    void add_moving_lengths(const Section<P>& section, const P& weight) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const TendonState<P>& tendon = solver.tendons[h - section.hosted.begin];
            T n[3] = {T(0.0), T(0.0), T(0.0)}, m[3] = {T(0.0), T(0.0), T(0.0)}, inverse, t[3], r[2];
            add_tendon(tendon, solver.cosine[tendon.slot], solver.sine[tendon.slot], solver.strains, n, m, inverse, t, r);
            moving_length[layout.hosted[h].tendon] += T(weight) / inverse;
        }
    }

    void shift_strains(const Section<P>& section, const Mesh& mesh, size_t stage, Strains& e) const {
        const double* slope = &mesh.slopes[stage * STRAINS * mesh.unknowns];
        const auto shifted = [&](double& strain) {
            for (int l = 0; l < mesh.unknowns; ++l) strain += slope[l] * mesh.shift[l];
            slope += mesh.unknowns;
        };
        shifted(e.kx);
        shifted(e.ky);
        shifted(e.wx);
        shifted(e.wy);
        for (int a = 0; a < section.active_count; ++a) {
            shifted(e.tau[a]);
            shifted(e.eta[a]);
        }
    }

    void keep_slopes(const Section<P>& section, Mesh& mesh, size_t stage) const {
        double* slope = &mesh.slopes[stage * STRAINS * slope_lanes];
        const StrainsOf<T>& e = solver.strains;
        const auto keep = [&](const T& strain) {
            for (int l = 0; l < slope_lanes; ++l) *slope++ = strain.d[l];
        };
        keep(e.kx);
        keep(e.ky);
        keep(e.wx);
        keep(e.wy);
        for (int a = 0; a < section.active_count; ++a) {
            keep(e.tau[a]);
            keep(e.eta[a]);
        }
    }

    // --- the differential equations of theory section 2 ------------------------------------------------------------

    void equations(const Section<P>& section, const T* state, T* rate) {
        const StrainsOf<T>& e = solver.strains;
        T sum_n3(0.0), sum_m3(0.0), stretched[3] = {T(0.0), T(0.0), T(0.0)};
        for (int a = 0; a < section.active_count; ++a) {
            const T *n = solver.N_xy[a], *m = solver.M_xy[a];
            const T stretch = 1.0 + e.eta[a], nx = stretch * n[0], ny = stretch * n[1];
            rate[3 * a] = e.tau[a];
            rate[3 * a + 1] = e.ky * n[0] - e.kx * n[1];
            rate[3 * a + 2] = e.ky * m[0] - e.kx * m[1] + e.wy * nx - e.wx * ny;
            if (packing.sums < 0) continue;
            sum_n3 += state[3 * a + 1];
            sum_m3 += state[3 * a + 2];
            stretched[0] += nx;
            stretched[1] += ny;
            stretched[2] += stretch * state[3 * a + 1];
        }
        if (packing.sums >= 0) {
            T* sums = rate + packing.sums;
            sums[0] = -(e.ky * sum_n3);
            sums[1] = e.kx * sum_n3;
            sums[2] = stretched[1] - e.ky * sum_m3 - e.wy * stretched[2];
            sums[3] = e.kx * sum_m3 - stretched[0] + e.wx * stretched[2];
        }
        if (packing.frame >= 0) turn_frame(&state[packing.frame], rate + packing.frame, section.guided);
        if (packing.path >= 0) {
            const T stretch = 1.0 + e.eta[0];
            const T v[3] = {stretch * e.wx, stretch * e.wy, stretch};
            to_world(&state[packing.frame], v, rate + packing.path);
        }
        if (section.distributed_loads.begin != section.distributed_loads.end) apply_distributed_loads(section, state, rate);
    }

    /// R_b' = R_b [kappa], kappa = (kx, ky, 0).
    void turn_frame(const T* q, T* rate, bool guided) const {
        if (guided) {
            for (int c = 0; c < 4; ++c) rate[c] = T(0.0);
            return;
        }
        const T hx = solver.strains.kx * 0.5, hy = solver.strains.ky * 0.5;
        rate[0] = -(q[1] * hx) - q[2] * hy;
        rate[1] = q[0] * hx - q[3] * hy;
        rate[2] = q[0] * hy + q[3] * hx;
        rate[3] = q[1] * hy - q[2] * hx;
    }

    void apply_distributed_loads(const Section<P>& section, const T* state, T* rate) const {
        for (int d = section.distributed_loads.begin; d < section.distributed_loads.end; ++d) {
            const SectionLoad& placed = layout.distributed_loads[d];
            const DistributedLoadOf<C>& load = robot.distributed_loads[placed.load];
            const int a = placed.slot;
            T force[3], moment[3];
            load_in_frame(load.force, load.body_axes, state + packing.frame, state[3 * a], force);
            load_in_frame(load.moment, load.body_axes, state + packing.frame, state[3 * a], moment);
            rate[3 * a + 1] -= force[2];
            rate[3 * a + 2] -= moment[2];
            if (packing.sums < 0) continue;
            for (int r = 0; r < 2; ++r) {
                rate[packing.sums + r] -= force[r];
                rate[packing.sums + 2 + r] -= moment[r];
            }
        }
    }
};

}  // namespace tactr
