// Marches the resultants and the tubes' angles from the free end to the base, section by section, with one or more
// eighth-order steps in each. T carries the states (double or dual), P the parameters (double, or T for sensitivities).
#pragma once
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "dual.hpp"
#include "host_changes.hpp"
#include "resultant_rates.hpp"
#include "robot.hpp"
#include "rotations.hpp"
#include "rubbing_nodes.hpp"
#include "section_solver.hpp"
#include "sections.hpp"
#include "stage_sums.hpp"
#include "states.hpp"

namespace tactr {

/// Called after every step; the default sees nothing.
struct NoObserver {
    using SkipsEven = void;
};

/// An observer that names a type SkipsEven has no use for even sections.
template <class Observer, class = void>
struct SkipsEven : std::false_type {};
template <class Observer>
struct SkipsEven<Observer, std::void_t<typename Observer::SkipsEven>> : std::true_type {};

/// An observer that names a type Stages is called after every stage too, with the stage's share of an integral along s.
template <class Observer, class = void>
struct SeesStages : std::false_type {};
template <class Observer>
struct SeesStages<Observer, std::void_t<typename Observer::Stages>> : std::true_type {};

template <class T, class P, class C = double>
class March {
  public:
    using State = T;
    using Parameter = P;
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
    RubbingNodes<T>* rubbing = nullptr;    // reads the angles where friction torques act
    int slope_lanes = 0;                   // > 0: lanes 0.. are the unknowns, keep the strains' slopes in the mesh

    // Results
    BaseState<T> base;
    std::vector<double> section_error;  // per section, metres at the tip
    std::vector<double> edge_error;     // of every section's first and last step
    std::vector<double> length_error;   // per section, m: the largest of its tendons', when options.path and error_weight
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

    /// The section's strains at s, from the full states.
    bool solve_at(const Section<P>& section, const P& s) {
        Strains e = last_;
        pack(section);
        return solver.solve(section, s, z, packing, e);
    }

  private:
    struct LengthEstimate {
        double fifth = 0.0, third = 0.0;
    };
    std::vector<LengthEstimate> length_estimate_;  // of one step, per tendon hosted
    Strains last_;  // strains of the nearest point solved so far

    void start(const FreeEnd<T>& free_end, int sections) {
        for (int c = 0; c < STATES; ++c) y[c] = T(0.0);
        for (int c = 0; c < 4; ++c) y[QUAT + c] = free_end.quaternion[c];
        for (int i = 0; i < robot.tube_count; ++i) base.psi[i] = free_end.psi[i];  // as long as the base is beyond its end
        last_ = Strains{};
        solver.begin();
        section_error.assign(sections, 0.0);
        edge_error.assign(2 * static_cast<size_t>(sections), 0.0);
        length_error.assign(sections, 0.0);
        if (options.path) tendon_length.assign(robot.tendon_count, 0.0);
        if (estimates_lengths()) length_estimate_.resize(layout.max_hosted);
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
        HostChanges<March> changes(*this);
        if (beyond && !changes.hand_over(section, *beyond)) return false;
        last_ = nearest;
        apply_point_loads(section);
        if constexpr (LANES > 0)
            if (k_section == probe_section) apply_probe(section);
        return changes.take_terminations(section, beyond);
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
            if (rubbing) rubbing->visit(layout.point_loads[p].load, y);
        }
    }

    /// A load at its tube's proximal end, where the section leaves the tube: the actuator bears its moment, through a spring
    /// if there is one, which it then turns.
    void apply_at_base(int which, const Section<P>& section, const Section<P>* before) {
        const PointLoadOf<C>& load = robot.point_loads[which];
        if (slot_of(section, load.tube) < 0 || (before && slot_of(*before, load.tube) >= 0)) return;
        T moment[3];
        load_in_frame(load.moment, load.body_axes, &y[QUAT], y[PSI + load.tube], moment);
        y[M3 + load.tube] += moment[2];
        if (rubbing && value(robot.tubes[load.tube].rotation_compliance) > 0.0) rubbing->visit(which, y);
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

    /// Of what turns tube i, whose proximal end is that of the section, through a spring there. A clamp elsewhere has none.
    T motor_angle(const Section<P>& section, int i) const {
        const bool there = std::fabs(value(section.proximal) - value(actuation.translation[i])) <= BREAKPOINT_GAP;
        return there ? y[PSI + i] - y[M3 + i] * robot.tubes[i].rotation_compliance : y[PSI + i];
    }

    void leave_section(int k_section) {
        const Section<P>& section = layout.sections[k_section];
        const Section<P>* before = k_section > 0 ? &layout.sections[k_section - 1] : nullptr;
        for (int load : layout.loads_at_base) apply_at_base(load, section, before);
        for (int a = 0; a < section.active_count; ++a)
            if (!before || slot_of(*before, section.active[a]) < 0) base.psi[section.active[a]] = motor_angle(section, section.active[a]);
        if (section.guided || (before && !before->guided)) return;
        for (int c = 0; c < 4; ++c) base.quaternion[c] = y[QUAT + c];
        for (int c = 0; c < 3; ++c) base.position[c] = y[POS + c];
    }

    // --- steps -----------------------------------------------------------------------------------------------------

    template <class Observer>
    bool march_section(const Section<P>& section, int k_section, Mesh& mesh, size_t first_stage, bool warm, Observer& observer) {
        if constexpr (SeesStages<Observer>::value) packing.fed_back = packing.count;  // p at the stages too
        if constexpr (SkipsEven<Observer>::value)
            if (section.even) return cross_evenly(section, k_section, mesh, first_stage, warm);
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
            if (estimates_lengths()) length_error[k_section] += largest_length_error(section, value(h));
            if (step == 0) edge_error[2 * k_section] = section_error[k_section] - error_before;
            if (step + 1 == steps) edge_error[2 * k_section + 1] = section_error[k_section] - error_before;
            if constexpr (!std::is_same_v<Observer, NoObserver>) observer(*this, k_section, before, s, h);
        }
        return true;
    }

    /// One stage serves an even section.
    bool cross_evenly(const Section<P>& section, int k_section, Mesh& mesh, size_t first, bool warm) {
        Strains& e = mesh.strains[first];
        if (!warm) {
            copy_strains(last_, section.active_count, e);
        } else if (mesh.unknowns > 0) {
            shift_strains(section, mesh, first, e);
        }
        if (!derivative(section, section.distal, z, k[0], e)) return false;
        const P h = section.proximal - section.distal;
        if (options.path) add_lengths(section, -value(h));
        if (lengths_move) add_moving_lengths(section, -h);
        for (int n = 0; n < packing.count; ++n) z[n] += k[0][n] * h;
        if constexpr (LANES > 0)
            if (slope_lanes > 0) keep_slopes(section, mesh, first);
        const size_t stages = static_cast<size_t>(mesh.steps[k_section]) * dp8::STAGES;
        for (size_t i = first + 1; i < first + stages; ++i) copy_strains(e, section.active_count, mesh.strains[i]);
        const size_t width = STRAINS * (slope_lanes > 0 ? slope_lanes : 0);
        for (size_t i = first + 1; width > 0 && i < first + stages; ++i)
            std::copy_n(&mesh.slopes[first * width], width, &mesh.slopes[i * width]);
        copy_strains(e, section.active_count, last_);
        return true;
    }

    bool march_adaptively(const Section<P>& section, int k_section, Mesh& mesh) {
        T saved[STATES];
        for (int n = 0; n < packing.count; ++n) saved[n] = z[n];
        const Strains saved_strains = last_;
        const std::vector<double> saved_length = tendon_length;
        NoObserver nobody;
        for (int attempt = 0;; ++attempt) {
            section_error[k_section] = length_error[k_section] = 0.0;
            mesh.strains.resize(static_cast<size_t>(mesh.steps[k_section]) * dp8::STAGES);
            const bool solved = march_section(section, k_section, mesh, 0, false, nobody);
            const double error = larger(section_error[k_section], length_error[k_section]);
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
            StageSums<T, P>::at(i, h, before, k, packing.fed_back, z);
            Strains& e = mesh.strains[first + i];
            if (!warm) {
                copy_strains(last_, section.active_count, e);
            } else if (mesh.unknowns > 0) {
                shift_strains(section, mesh, first + i, e);
            }
            if (!derivative(section, s + h * dp8::C[i], z, k[i], e)) return false;
            if (options.path) add_lengths(section, -value(h) * dp8::B[i]);
            if (estimates_lengths()) add_length_estimates(section, i);
            if (lengths_move) add_moving_lengths(section, h * -dp8::B[i]);
            if constexpr (SeesStages<Observer>::value)
                observer.stage(*this, section, k_section, value(s + h * dp8::C[i]), -value(h) * dp8::B[i]);
            if constexpr (LANES > 0)
                if (slope_lanes > 0) keep_slopes(section, mesh, first + i);
            if (!warm || i + 1 == dp8::STAGES) copy_strains(e, section.active_count, last_);
        }
        return true;
    }

    void advance(const P& h, const T* before, double& error) {
        StageSums<T, P>::at(dp8::STAGES, h, before, k, packing.count, z);
        if (error_weight) add_error(value(h), error);
        if (packing.frame >= 0 && packing.path >= 0) normalise(&z[packing.frame]);
    }

    static void normalise(T* q) {
        const T inverse = T(1.0) / square_root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int c = 0; c < 4; ++c) q[c] = q[c] * inverse;
    }

    /// From the squares of the estimates of order 5 and 3 to a factor on the former.
    static double damping_of(double square5, double square3) {
        const double size = square5 + 0.01 * square3;
        return size > 0.0 ? std::sqrt(square5 / size) : 0.0;
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
        const double damping = damping_of(norm5, norm3);
        total += std::fabs(h) * std::sqrt(norm5) * damping;
        if constexpr (LANES > 0)
            if (error_lane >= 0)
                for (int n = 0; n < packing.count; ++n) z[n].d[error_lane] += step_error[n] * damping;
    }

    void add_lengths(const Section<P>& section, double weight) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            tendon_length[layout.hosted[h].tendon] += weight / solver.tendon_tangents[h - section.hosted.begin].inverse;
    }

    /// A tendon's length is an integral that nothing else depends on: its error is not among those of the states.
    bool estimates_lengths() const { return options.path && error_weight; }

    void add_length_estimates(const Section<P>& section, int stage) {
        for (int h = 0; h < section.hosted.end - section.hosted.begin; ++h) {
            if (stage == 0) length_estimate_[h] = LengthEstimate{};
            const double rate = 1.0 / solver.tendon_tangents[h].inverse;
            length_estimate_[h].fifth += dp8::E5[stage] * rate;
            length_estimate_[h].third += dp8::E3[stage] * rate;
        }
    }

    double largest_length_error(const Section<P>& section, double h) const {
        double worst = 0.0;
        for (int j = 0; j < section.hosted.end - section.hosted.begin; ++j) {
            const double fifth = length_estimate_[j].fifth, third = length_estimate_[j].third;
            worst = larger(worst, std::fabs(h * fifth) * damping_of(fifth * fifth, third * third));
        }
        return worst;
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

    // --- the differential equations: resultant_rates.hpp -----------------------------------------------------------

    void equations(const Section<P>& section, const T* state, T* rate) {
        resultant_rates(section.active_count, section.guided != 0, packing, solver.strains, solver.N_xy, solver.M_xy, state, rate);
        if (section.distributed_loads.begin != section.distributed_loads.end) apply_distributed_loads(section, state, rate);
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
