// Marches the resultants and the tubes' angles from the free end to the base, section by section, with one or more
// eighth-order steps in each. T carries the states (double or dual), P the parameters (double, or T for sensitivities).
#pragma once
#include <type_traits>
#include <vector>

#include "dp8_tableau.hpp"
#include "dual.hpp"
#include "robot.hpp"
#include "section_equilibrium.hpp"
#include "sections.hpp"

namespace tactr {

// Where each state stands in the state vector.
constexpr int PSI = 0;                 // angle of tube i's material frame from R_b
constexpr int N3 = MAX_TUBES;          // axial resultant of tube i
constexpr int M3 = 2 * MAX_TUBES;      // torsional resultant of tube i
constexpr int SUM_N = 3 * MAX_TUBES;   // (S_x, S_y): transverse resultant of all tubes, in R_b
constexpr int SUM_M = SUM_N + 2;       // (Q_x, Q_y)
constexpr int QUAT = SUM_M + 2;        // R_b as a quaternion w, x, y, z
constexpr int POS = QUAT + 4;          // p
constexpr int STATES = POS + 3;

template <class T>
using LaneCount = std::conditional_t<std::is_same_v<T, double>, std::integral_constant<int, 0>,
                                     std::integral_constant<int, (sizeof(T) / sizeof(double)) - 1>>;

/// Which states the march carries beside the tubes' own.
struct MarchOptions {
    bool sums;   // transverse resultants summed over the tubes: zero for one tube without external loads
    bool frame;  // R_b: for loads in world axes, and for the path
    bool path;   // p, and the lengths of the tendons
};

/// Free-end unknowns: angle of every tube at its distal end, and R_b at the tip.
template <class T>
struct FreeEnd {
    T psi[MAX_TUBES];
    T quaternion[4];
};

/// What the march finds at the base.
template <class T>
struct BaseState {
    T psi[MAX_TUBES];  // at each tube's own proximal end
    T quaternion[4];   // R_b at the guide exit
    T position[3];     // p at the guide exit (p = 0 at the tip)
};

template <class T, class P>
struct Workspace {
    T k[dp8::DENSE_STAGES][STATES];
    TubeTangent tangent[MAX_TUBES];
    std::vector<TendonState<P>> tendons;
    std::vector<TendonTangent> tendon_tangents;
    void reserve(int hosted) {
        tendons.resize(hosted > 0 ? hosted : 1);
        tendon_tangents.resize(hosted > 0 ? hosted : 1);
    }
};

/// Steps per section, and the strains found at every stage: the start for the next march.
struct Mesh {
    std::vector<int> steps;
    std::vector<Strains> strains;
    bool warm = false;

    int total() const {
        int sum = 0;
        for (int n : steps) sum += n;
        return sum;
    }
    void fit() {
        strains.resize(static_cast<size_t>(total()) * dp8::STAGES);
        warm = false;
    }
};

/// Called after every step; the default sees nothing.
struct NoObserver {
    template <class M> void operator()(M&, int, const double*, double, double) {}
};

template <class P>
inline void evaluate_polynomial(const double* c, int count, const P& d, P& f, P& df) {
    f = P(c[count - 1]);
    df = P(0.0);
    for (int i = count - 2; i >= 0; --i) {
        df = df * d + f;
        f = f * d + c[i];
    }
}

template <class P>
inline void evaluate_routing(const RoutingPiece& piece, const P& sigma, P r[2], P dr[2]) {
    const P d = sigma - piece.start;
    P a, da, b, db;
    evaluate_polynomial(piece.a, piece.count_a, d, a, da);
    evaluate_polynomial(piece.b, piece.count_b, d, b, db);
    if (!piece.polar) {
        r[0] = a;
        r[1] = b;
        dr[0] = da;
        dr[1] = db;
        return;
    }
    P s, c;
    sine_cosine(b, s, c);
    r[0] = a * c;
    r[1] = a * s;
    dr[0] = da * c - db * r[1];
    dr[1] = da * s + db * r[0];
}

/// v in the axes of the frame with quaternion q (q of unit length), from world axes.
template <class T>
inline void to_frame(const T* q, const double v[3], T out[3]) {
    const T& w = q[0];
    const T tx = (q[2] * v[2] - q[3] * v[1]) * 2.0, ty = (q[3] * v[0] - q[1] * v[2]) * 2.0,
            tz = (q[1] * v[1] - q[2] * v[0]) * 2.0;
    out[0] = v[0] - w * tx + (q[2] * tz - q[3] * ty);
    out[1] = v[1] - w * ty + (q[3] * tx - q[1] * tz);
    out[2] = v[2] - w * tz + (q[1] * ty - q[2] * tx);
}

/// v in world axes, from the axes of the frame with quaternion q.
template <class T>
inline void to_world(const T* q, const T v[3], T* out) {
    const T& w = q[0];
    const T tx = (q[2] * v[2] - q[3] * v[1]) * 2.0, ty = (q[3] * v[0] - q[1] * v[2]) * 2.0,
            tz = (q[1] * v[1] - q[2] * v[0]) * 2.0;
    out[0] = v[0] + w * tx + (q[2] * tz - q[3] * ty);
    out[1] = v[1] + w * ty + (q[3] * tx - q[1] * tz);
    out[2] = v[2] + w * tz + (q[1] * ty - q[2] * tx);
}

template <class T, class P>
class March {
  public:
    static constexpr int LANES = LaneCount<T>::value;
    static constexpr int WIDTH = LANES > 0 ? LANES : 1;

    const Robot& robot;
    const Layout<P>& layout;
    const Actuation<P>& actuation;
    Workspace<T, P>& work;
    MarchOptions options;

    double moment_scale = 1.0, force_scale = 1.0;  // of the section's residual
    const double* error_weight = nullptr;  // turns an error of a state into metres at the tip
    int error_lane = -1;                   // lane that carries the estimated discretisation error to the base
    double adapt_tolerance = 0.0;          // > 0: double the steps of a section until its error is below

    // Results
    BaseState<T> base;
    T y[STATES];
    double worst_section_residual = 0.0;
    double least_stretch = 1.0;
    std::vector<double> section_error;  // per section, metres at the tip
    std::vector<double> tendon_length;  // per tendon, when options.path
    long evaluations = 0;

    // The section's state at the last evaluation.
    StrainsOf<T> strains;
    T cosine[MAX_TUBES], sine[MAX_TUBES];
    double N[MAX_TUBES][3], M[MAX_TUBES][3];

    March(const Robot& robot_, const Layout<P>& layout_, const Actuation<P>& actuation_, Workspace<T, P>& work_,
          MarchOptions options_)
        : robot(robot_), layout(layout_), actuation(actuation_), work(work_), options(options_) {
        work.reserve(layout.max_hosted);
    }

    /// Runs from the tip to the base. False: a section had no equilibrium.
    template <class Observer = NoObserver>
    bool run(const FreeEnd<T>& free_end, Mesh& mesh, Observer&& observer = Observer()) {
        const bool warm = mesh.warm;
        mesh.warm = false;
        const int count = static_cast<int>(layout.sections.size());
        start(free_end, count);
        size_t first_stage = mesh.strains.size();
        for (int k = count - 1; k >= 0; --k) {
            const Section<P>& section = layout.sections[k];
            if (!cross_boundary(free_end, k)) return false;
            list_states(section);
            if (adapt_tolerance > 0.0) {
                if (!march_adaptively(section, k, mesh)) return false;
            } else {
                first_stage -= static_cast<size_t>(mesh.steps[k]) * dp8::STAGES;
                if (!march_section(section, k, mesh.steps[k], &mesh.strains[first_stage], warm, observer)) return false;
            }
            leave_section(k);
        }
        mesh.warm = adapt_tolerance == 0.0;
        return true;
    }

    /// Solves the section at arc length s for the given states; fills strains, N, M.
    bool solve_section(const Section<P>& section, const P& s, const T* state, Strains& e) {
        ++evaluations;
        place_tendons_at(section, s);
        for (int a = 0; a < section.active_count; ++a)
            sine_cosine(state[PSI + section.active[a]], sine[a], cosine[a]);
        if (!solve_strains(section, state, e)) return false;
        for (int a = 0; a < section.active_count; ++a)
            if (1.0 + e.eta[a] < least_stretch) least_stretch = 1.0 + e.eta[a];
        carry_tangents(section, state, e);
        return true;
    }

    const std::vector<TendonTangent>& tendon_tangents() const { return work.tendon_tangents; }

    bool derivative(const Section<P>& section, const P& s, const T* state, T* rate, Strains& e) {
        if (!solve_section(section, s, state, e)) return false;
        equations(section, state, rate);
        return true;
    }

    int state_index[STATES], state_count = 0;

  private:
    T N_xy[MAX_TUBES][2], M_xy[MAX_TUBES][2];
    SectionFactor factor_;
    Strains last_;  // strains of the nearest point solved so far

    void start(const FreeEnd<T>& free_end, int sections) {
        for (int c = 0; c < STATES; ++c) y[c] = T(0.0);
        for (int c = 0; c < 4; ++c) y[QUAT + c] = free_end.quaternion[c];
        last_ = Strains{};
        worst_section_residual = 0.0;
        least_stretch = 1.0;
        section_error.assign(sections, 0.0);
        if (options.path) tendon_length.assign(robot.tendon_count, 0.0);
    }

    void list_states(const Section<P>& section) {
        state_count = 0;
        for (int a = 0; a < section.active_count; ++a) {
            state_index[state_count++] = PSI + section.active[a];
            state_index[state_count++] = N3 + section.active[a];
            state_index[state_count++] = M3 + section.active[a];
        }
        if (section.guided) return;
        if (options.sums)
            for (int c = 0; c < 4; ++c) state_index[state_count++] = SUM_N + c;
        if (options.frame)
            for (int c = 0; c < 4; ++c) state_index[state_count++] = QUAT + c;
        if (options.path)
            for (int c = 0; c < 3; ++c) state_index[state_count++] = POS + c;
    }

    // --- boundaries between sections -------------------------------------------------------------------------------

    bool cross_boundary(const FreeEnd<T>& free_end, int k) {
        const Section<P>& section = layout.sections[k];
        const bool tip = k + 1 == static_cast<int>(layout.sections.size());
        const Section<P>* beyond = tip ? nullptr : &layout.sections[k + 1];
        const Strains nearest = map_strains(section, beyond);
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            if (beyond && slot_of(*beyond, i) >= 0) continue;
            y[PSI + i] = free_end.psi[i];
            y[N3 + i] = y[M3 + i] = T(0.0);
        }
        if (beyond && !change_hosts(section, *beyond)) return false;
        last_ = nearest;
        apply_point_loads(section);
        return take_terminations(section, beyond);
    }

    Strains map_strains(const Section<P>& section, const Section<P>* beyond) const {
        Strains e = last_;
        for (int a = 0; a < section.active_count; ++a) {
            const int b = beyond ? slot_of(*beyond, section.active[a]) : -1;
            e.tau[a] = b < 0 ? 0.0 : last_.tau[b];
            e.eta[a] = b < 0 ? 0.0 : last_.eta[b];
        }
        if (section.guided) e.kx = e.ky = e.wx = e.wy = 0.0;
        return e;
    }

    /// lambda t_3 and lambda (r x t)_3 of a tendon in the given section.
    void axial_part(const TendonState<P>& tendon, T& force, T& moment) const {
        T n[3] = {T(0.0), T(0.0), T(0.0)}, m[3] = {T(0.0), T(0.0), T(0.0)}, speed, t[3], r[2];
        add_tendon(tendon, cosine[tendon.slot], sine[tendon.slot], strains, n, m, speed, t, r);
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
            if (!solved) {
                Strains e = last_;
                if (!solve_section(beyond, beyond.proximal, y, e)) return false;
                solved = true;
            }
            T force, moment;
            axial_part(work.tendons[h - beyond.hosted.begin], force, moment);
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

    /// A tendon fixed to its own tube but led by another's disks: its end pulls on its own tube.
    bool take_terminations(const Section<P>& section, const Section<P>* beyond) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout.hosted[h];
            const int host = section.active[hosted.slot], own = robot.tendons[hosted.tendon].tube;
            if (host == own || (beyond && host_of(*beyond, hosted.tendon) >= 0)) continue;
            T force(0.0), moment(0.0);
            for (int pass = 0; pass < 12; ++pass) {
                Strains e = last_;
                move_axial(own, host, force, moment);
                const bool found = solve_section(section, section.distal, y, e);
                move_axial(host, own, force, moment);
                if (!found) return false;
                axial_part(work.tendons[h - section.hosted.begin], force, moment);
            }
            move_axial(own, host, force, moment);
        }
        return true;
    }

    /// A load given in world or body axes, in R_b.
    void load_in_frame(const double v[3], bool body_axes, int tube, const T* state, T out[3]) const {
        if (!body_axes) {
            to_frame(&state[QUAT], v, out);
        } else {
            T s, c;
            sine_cosine(state[PSI + tube], s, c);
            out[0] = c * v[0] - s * v[1];
            out[1] = s * v[0] + c * v[1];
            out[2] = T(v[2]);
        }
        for (int a = 0; a < 3; ++a) out[a] *= actuation.load_scale;
    }

    void apply_point_loads(const Section<P>& section) {
        for (int p = section.point_loads.begin; p < section.point_loads.end; ++p) {
            const PointLoad& load = robot.point_loads[layout.point_loads[p].load];
            T force[3], moment[3];
            load_in_frame(load.force, load.body_axes, load.tube, y, force);
            load_in_frame(load.moment, load.body_axes, load.tube, y, moment);
            for (int a = 0; a < 2; ++a) {
                y[SUM_N + a] += force[a];
                y[SUM_M + a] += moment[a];
            }
            y[N3 + load.tube] += force[2];
            y[M3 + load.tube] += moment[2];
        }
    }

    void leave_section(int k) {
        const Section<P>& section = layout.sections[k];
        const Section<P>* before = k > 0 ? &layout.sections[k - 1] : nullptr;
        for (int a = 0; a < section.active_count; ++a)
            if (!before || slot_of(*before, section.active[a]) < 0)
                base.psi[section.active[a]] = y[PSI + section.active[a]];
        if (section.guided || (before && !before->guided)) return;
        for (int c = 0; c < 4; ++c) base.quaternion[c] = y[QUAT + c];
        for (int c = 0; c < 3; ++c) base.position[c] = y[POS + c];
    }

    // --- steps -----------------------------------------------------------------------------------------------------

    template <class Observer>
    bool march_section(const Section<P>& section, int k, int steps, Strains* history, bool warm, Observer& observer) {
        const P h = (section.proximal - section.distal) * (1.0 / steps);
        for (int step = 0; step < steps; ++step) {
            const P s = section.distal + h * static_cast<double>(step);
            Strains* stages = history + static_cast<size_t>(steps - 1 - step) * dp8::STAGES;
            double before[STATES];
            if constexpr (!std::is_same_v<std::decay_t<Observer>, NoObserver>)
                for (int c = 0; c < STATES; ++c) before[c] = value(y[c]);
            if (!step_dp8(section, s, h, stages, warm)) return false;
            if (error_weight) estimate_error(section_error[k], h);
            advance(h);
            if constexpr (!std::is_same_v<std::decay_t<Observer>, NoObserver>)
                observer(*this, k, before, value(s), value(h));
        }
        return true;
    }

    bool march_adaptively(const Section<P>& section, int k, Mesh& mesh) {
        T saved[STATES];
        for (int c = 0; c < STATES; ++c) saved[c] = y[c];
        const Strains saved_strains = last_;
        std::vector<double> saved_length = tendon_length;
        NoObserver nobody;
        for (int attempt = 0;; ++attempt) {
            section_error[k] = 0.0;
            scratch_.resize(static_cast<size_t>(mesh.steps[k]) * dp8::STAGES);
            const bool solved = march_section(section, k, mesh.steps[k], scratch_.data(), false, nobody);
            const double error = section_error[k];
            if (solved && error <= adapt_tolerance) return true;
            if (attempt == 6 || mesh.steps[k] >= MAX_STEPS) return solved;
            double factor = solved && std::isfinite(error) ? std::ceil(1.1 * std::pow(error / adapt_tolerance, 0.125)) : 4.0;
            factor = factor < 2.0 ? 2.0 : (factor > 4.0 ? 4.0 : factor);
            mesh.steps[k] = static_cast<int>(mesh.steps[k] * factor);
            for (int c = 0; c < STATES; ++c) y[c] = saved[c];
            last_ = saved_strains;
            tendon_length = saved_length;
        }
    }

    std::vector<Strains> scratch_;

  public:
    static constexpr int MAX_STEPS = 512;  // per section

  private:
    bool step_dp8(const Section<P>& section, const P& s, const P& h, Strains* stages, bool warm) {
        T stage_state[STATES];
        for (int c = 0; c < STATES; ++c) stage_state[c] = y[c];
        for (int i = 0; i < dp8::STAGES; ++i) {
            if (i > 0) combine(i, h, stage_state);
            if (!warm) stages[i] = last_;
            if (!derivative(section, s + h * dp8::C[i], stage_state, work.k[i], stages[i])) return false;
            if (options.path) add_lengths(section, -value(h) * dp8::B[i]);
            last_ = stages[i];
        }
        return true;
    }

    void combine(int i, const P& h, T* out) const {
        double weight[dp8::DENSE_STAGES];
        int used[dp8::DENSE_STAGES], count = 0;
        for (int j = 0; j < i; ++j)
            if (dp8::A[i][j] != 0.0) {
                weight[count] = dp8::A[i][j];
                used[count++] = j;
            }
        weighted_sum(count, used, weight, h, out);
    }

    /// out = y + h * sum of weight * k over the states that change.
    void weighted_sum(int count, const int* used, const double* weight, const P& h, T* out) const {
        for (int n = 0; n < state_count; ++n) {
            const int c = state_index[n];
            T sum(0.0);
            for (int j = 0; j < count; ++j) add_scaled(sum, weight[j], work.k[used[j]][c]);
            out[c] = y[c] + sum * h;
        }
    }

    void advance(const P& h) {
        double weight[dp8::STAGES];
        int used[dp8::STAGES], count = 0;
        for (int j = 0; j < dp8::STAGES; ++j)
            if (dp8::B[j] != 0.0) {
                weight[count] = dp8::B[j];
                used[count++] = j;
            }
        weighted_sum(count, used, weight, h, y);
        if constexpr (LANES > 0)
            if (error_lane >= 0)
                for (int n = 0; n < state_count; ++n) y[state_index[n]].d[error_lane] += step_error_[state_index[n]];
        if (options.frame) normalise();
    }

    void normalise() {
        T norm2 = y[QUAT] * y[QUAT];
        for (int c = 1; c < 4; ++c) norm2 += y[QUAT + c] * y[QUAT + c];
        const T inverse = T(1.0) / square_root(norm2);
        for (int c = 0; c < 4; ++c) y[QUAT + c] = y[QUAT + c] * inverse;
    }

    double step_error_[STATES];

    /// Embedded estimates of order 5 and 3, combined to one of about order 8 (Hairer et al., section II.10).
    void estimate_error(double& total, const P& step) {
        const double h = value(step);
        double norm5 = 0.0, norm3 = 0.0;
        for (int n = 0; n < state_count; ++n) {
            const int c = state_index[n];
            double e5 = 0.0, e3 = 0.0;
            for (int j = 0; j < dp8::STAGES; ++j) {
                const double k = value(work.k[j][c]);
                e5 += dp8::E5[j] * k;
                e3 += dp8::E3[j] * k;
            }
            step_error_[c] = e5 * h;
            const double w5 = e5 * error_weight[c], w3 = e3 * error_weight[c];
            norm5 += w5 * w5;
            norm3 += w3 * w3;
        }
        const double size = norm5 + 0.01 * norm3;
        const double damping = size > 0.0 ? std::sqrt(norm5 / size) : 0.0;
        for (int n = 0; n < state_count; ++n) step_error_[state_index[n]] *= damping;
        total += std::fabs(h) * std::sqrt(norm5) * damping;
    }

    void add_lengths(const Section<P>& section, double weight) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            tendon_length[layout.hosted[h].tendon] += weight * work.tendon_tangents[h - section.hosted.begin].speed;
    }

    // --- one cross-section -----------------------------------------------------------------------------------------

    void place_tendons_at(const Section<P>& section, const P& s) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h) {
            const Hosted& hosted = layout.hosted[h];
            const Tendon& tendon = robot.tendons[hosted.tendon];
            TendonState<P>& state = work.tendons[h - section.hosted.begin];
            const P sigma = s - actuation.translation[tendon.tube];
            evaluate_routing(robot.routing[hosted.routing], sigma, state.r, state.dr);
            state.tension = actuation.tension[hosted.tendon] * actuation.shape_scale;
            if (hosted.profile >= 0) {
                const TensionPiece& piece = robot.profiles[hosted.profile];
                P factor, slope;
                evaluate_polynomial(piece.c, piece.count, P(sigma - piece.start), factor, slope);
                state.tension = state.tension * factor;
            }
            state.slot = hosted.slot;
        }
    }

    TendonState<double> plain(const TendonState<P>& t) const {
        return {{value(t.r[0]), value(t.r[1])}, {value(t.dr[0]), value(t.dr[1])}, value(t.tension), t.slot};
    }

    void evaluate_wrenches(const Section<P>& section, const Strains& e) {
        for (int a = 0; a < section.active_count; ++a) {
            const TubePiece& piece = robot.pieces[section.piece[a]];
            const double c = value(cosine[a]), s = value(sine[a]), f = actuation.shape_scale;
            const double ustar[3] = {f * piece.ustar[0], f * piece.ustar[1], f * piece.ustar[2]};
            elastic_wrench(piece, ustar, c, s, e, a, N[a], M[a]);
        }
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) {
            const TendonState<double> tendon = plain(work.tendons[h]);
            const int a = tendon.slot;
            TendonTangent& tangent = work.tendon_tangents[h];
            double r[2];
            add_tendon(tendon, value(cosine[a]), value(sine[a]), e, N[a], M[a], tangent.speed, tangent.t, r);
            tangent.x = r[0];
            tangent.y = r[1];
            tangent.stiffness = tendon.tension / tangent.speed;
        }
    }

    bool factor_tangent(const Section<P>& section, const Strains& e) {
        for (int a = 0; a < section.active_count; ++a)
            elastic_tangent(robot.pieces[section.piece[a]], value(cosine[a]), value(sine[a]), e, a, work.tangent[a]);
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) {
            const int a = work.tendons[h].slot;
            add_tendon_tangent(work.tendon_tangents[h], e, a, work.tangent[a]);
        }
        return factor_.factor(work.tangent, section.active_count, section.guided);
    }

    /// Residual of the section's equations, as right-hand sides of the Newton step; returns the largest, scaled.
    double residual(const Section<P>& section, const T* state, double total[4][1], double tube[MAX_TUBES][2][1]) const {
        double worst = 0.0, forces = force_scale, moments = moment_scale;
        for (int r = 0; r < 2; ++r) {
            const double m = options.sums ? value(state[SUM_M + r]) : 0.0, n = options.sums ? value(state[SUM_N + r]) : 0.0;
            total[r][0] = m;
            total[r + 2][0] = n;
            moments += std::fabs(m);
            forces += std::fabs(n);
        }
        for (int a = 0; a < section.active_count; ++a) {
            for (int r = 0; r < 2; ++r) {
                total[r][0] -= M[a][r];
                total[r + 2][0] -= N[a][r];
            }
            const double m = value(state[M3 + section.active[a]]), n = value(state[N3 + section.active[a]]);
            tube[a][0][0] = m - M[a][2];
            tube[a][1][0] = n - N[a][2];
            worst = std::fmax(worst, std::fabs(tube[a][0][0]) / (moments + std::fabs(m)));
            worst = std::fmax(worst, std::fabs(tube[a][1][0]) / (forces + std::fabs(n)));
        }
        if (section.guided) return worst;
        for (int r = 0; r < 2; ++r) {
            worst = std::fmax(worst, std::fabs(total[r][0]) / moments);
            worst = std::fmax(worst, std::fabs(total[r + 2][0]) / forces);
        }
        return std::isfinite(total[0][0] + total[1][0] + total[2][0] + total[3][0]) ? worst : INFINITY;
    }

    bool solve_strains(const Section<P>& section, const T* state, Strains& e) {
        double total[4][1], tube[MAX_TUBES][2][1];
        Strains from = e, step = e;
        double last = INFINITY, fraction = 1.0;
        for (int iteration = 0; iteration < SECTION_ITERATIONS; ++iteration) {
            evaluate_wrenches(section, e);
            const double worst = residual(section, state, total, tube);
            if (worst <= SECTION_TOLERANCE) {
                if (worst > worst_section_residual) worst_section_residual = worst;
                return LANES == 0 || factor_tangent(section, e);
            }
            if (!(worst < last) && fraction > 1e-3) {
                fraction *= 0.5;
                move_strains(section, from, step, fraction, e);
                continue;
            }
            if (!std::isfinite(worst) || !factor_tangent(section, e)) return false;
            factor_.template solve<1>(total, tube);
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

    static void move_strains(const Section<P>& section, const Strains& from, const Strains& step, double f, Strains& e) {
        if (!section.guided) {
            e.kx = from.kx + f * step.kx;
            e.ky = from.ky + f * step.ky;
            e.wx = from.wx + f * step.wx;
            e.wy = from.wy + f * step.wy;
        }
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = from.tau[a] + f * step.tau[a];
            e.eta[a] = from.eta[a] + f * step.eta[a];
        }
    }

    /// Derivatives of the strains by the implicit function theorem, and of N_xy, M_xy with them.
    void carry_tangents(const Section<P>& section, const T* state, const Strains& e) {
        if constexpr (LANES == 0) {
            strains = e;
            for (int a = 0; a < section.active_count; ++a)
                for (int r = 0; r < 2; ++r) {
                    N_xy[a][r] = N[a][r];
                    M_xy[a][r] = M[a][r];
                }
        } else {
            double fixed[MAX_TUBES][6][WIDTH];  // lanes of (N, M) at fixed strains
            fixed_strain_lanes(section, state, e, fixed);
            double total[4][WIDTH], tube[MAX_TUBES][2][WIDTH];
            for (int r = 0; r < 2; ++r)
                for (int l = 0; l < WIDTH; ++l) {
                    total[r][l] = options.sums ? state[SUM_M + r].d[l] : 0.0;
                    total[r + 2][l] = options.sums ? state[SUM_N + r].d[l] : 0.0;
                }
            for (int a = 0; a < section.active_count; ++a) {
                const int i = section.active[a];
                for (int l = 0; l < WIDTH; ++l) {
                    for (int r = 0; r < 2; ++r) {
                        total[r][l] -= fixed[a][3 + r][l];
                        total[r + 2][l] -= fixed[a][r][l];
                    }
                    tube[a][0][l] = state[M3 + i].d[l] - fixed[a][5][l];
                    tube[a][1][l] = state[N3 + i].d[l] - fixed[a][2][l];
                }
            }
            if (section.guided)
                for (int r = 0; r < 4; ++r)
                    for (int l = 0; l < WIDTH; ++l) total[r][l] = 0.0;
            factor_.template solve<WIDTH>(total, tube);
            const double values[4] = {e.kx, e.ky, e.wx, e.wy};
            T* shared[4] = {&strains.kx, &strains.ky, &strains.wx, &strains.wy};
            for (int r = 0; r < 4; ++r) {
                shared[r]->v = values[r];
                for (int l = 0; l < WIDTH; ++l) shared[r]->d[l] = total[r][l];
            }
            constexpr int row[4] = {0, 1, 3, 4};
            for (int a = 0; a < section.active_count; ++a) {
                strains.tau[a].v = e.tau[a];
                strains.eta[a].v = e.eta[a];
                T* out[4] = {&N_xy[a][0], &N_xy[a][1], &M_xy[a][0], &M_xy[a][1]};
                const double plain_value[4] = {N[a][0], N[a][1], M[a][0], M[a][1]};
                for (int l = 0; l < WIDTH; ++l) {
                    strains.tau[a].d[l] = tube[a][0][l];
                    strains.eta[a].d[l] = tube[a][1][l];
                }
                for (int r = 0; r < 4; ++r) {
                    const double* J = work.tangent[a][row[r]];
                    out[r]->v = plain_value[r];
                    for (int l = 0; l < WIDTH; ++l)
                        out[r]->d[l] = fixed[a][row[r]][l] + J[0] * total[0][l] + J[1] * total[1][l] + J[2] * total[2][l] +
                                       J[3] * total[3][l] + J[4] * tube[a][0][l] + J[5] * tube[a][1][l];
                }
            }
        }
    }

    /// Lanes of (N, M) of every tube with the strains held fixed. With plain parameters only psi moves them.
    void fixed_strain_lanes(const Section<P>& section, const T* state, const Strains& e, double fixed[MAX_TUBES][6][WIDTH]) {
        using S = std::conditional_t<std::is_same_v<P, double>, Dual<1>, T>;
        S c[MAX_TUBES], s[MAX_TUBES], n[MAX_TUBES][3], m[MAX_TUBES][3];
        for (int a = 0; a < section.active_count; ++a) {
            if constexpr (std::is_same_v<P, double>) {
                c[a].v = cosine[a].v;
                c[a].d[0] = -sine[a].v;
                s[a].v = sine[a].v;
                s[a].d[0] = cosine[a].v;
            } else {
                c[a] = cosine[a];
                s[a] = sine[a];
            }
            const TubePiece& piece = robot.pieces[section.piece[a]];
            const double f = actuation.shape_scale;
            const double ustar[3] = {f * piece.ustar[0], f * piece.ustar[1], f * piece.ustar[2]};
            elastic_wrench(piece, ustar, c[a], s[a], e, a, n[a], m[a]);
        }
        const int count = section.hosted.end - section.hosted.begin;
        for (int h = 0; h < count; ++h) {
            const TendonState<P>& tendon = work.tendons[h];
            const int a = tendon.slot;
            S speed, t[3], r[2];
            add_tendon(tendon, c[a], s[a], e, n[a], m[a], speed, t, r);
        }
        for (int a = 0; a < section.active_count; ++a) {
            const T& psi = state[PSI + section.active[a]];
            for (int r = 0; r < 3; ++r)
                for (int l = 0; l < WIDTH; ++l) {
                    if constexpr (std::is_same_v<P, double>) {
                        fixed[a][r][l] = n[a][r].d[0] * psi.d[l];
                        fixed[a][3 + r][l] = m[a][r].d[0] * psi.d[l];
                    } else {
                        fixed[a][r][l] = n[a][r].d[l];
                        fixed[a][3 + r][l] = m[a][r].d[l];
                    }
                }
        }
    }

    /// The differential equations of theory section 2.
    void equations(const Section<P>& section, const T* state, T* rate) {
        const T &kx = strains.kx, &ky = strains.ky, &wx = strains.wx, &wy = strains.wy;
        T sum_n3(0.0), sum_m3(0.0), stretched[3] = {T(0.0), T(0.0), T(0.0)};
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            const T stretch = 1.0 + strains.eta[a];
            rate[PSI + i] = strains.tau[a];
            rate[N3 + i] = ky * N_xy[a][0] - kx * N_xy[a][1];
            rate[M3 + i] = ky * M_xy[a][0] - kx * M_xy[a][1] + stretch * (wy * N_xy[a][0] - wx * N_xy[a][1]);
            if (!options.sums) continue;
            sum_n3 += state[N3 + i];
            sum_m3 += state[M3 + i];
            stretched[0] += stretch * N_xy[a][0];
            stretched[1] += stretch * N_xy[a][1];
            stretched[2] += stretch * state[N3 + i];
        }
        if (!section.guided) {
            if (options.sums) {
                rate[SUM_N] = -(ky * sum_n3);
                rate[SUM_N + 1] = kx * sum_n3;
                rate[SUM_M] = -(ky * sum_m3) - wy * stretched[2] + stretched[1];
                rate[SUM_M + 1] = kx * sum_m3 - stretched[0] + wx * stretched[2];
            }
            if (options.frame) turn_frame(state, rate);
            if (options.path) {
                const T stretch = 1.0 + strains.eta[0];
                const T v[3] = {stretch * wx, stretch * wy, stretch};
                to_world(&state[QUAT], v, &rate[POS]);
            }
        }
        apply_distributed_loads(section, state, rate);
    }

    /// R_b' = R_b [kappa], kappa = (kx, ky, 0).
    void turn_frame(const T* state, T* rate) const {
        const T* q = &state[QUAT];
        const T hx = strains.kx * 0.5, hy = strains.ky * 0.5;
        rate[QUAT] = -(q[1] * hx) - q[2] * hy;
        rate[QUAT + 1] = q[0] * hx - q[3] * hy;
        rate[QUAT + 2] = q[0] * hy + q[3] * hx;
        rate[QUAT + 3] = q[1] * hy - q[2] * hx;
    }

    void apply_distributed_loads(const Section<P>& section, const T* state, T* rate) const {
        for (int d = section.distributed_loads.begin; d < section.distributed_loads.end; ++d) {
            const SectionLoad& placed = layout.distributed_loads[d];
            const DistributedLoad& load = robot.distributed_loads[placed.load];
            const int tube = section.active[placed.slot];
            T force[3], moment[3];
            load_in_frame(load.force, load.body_axes, tube, state, force);
            load_in_frame(load.moment, load.body_axes, tube, state, moment);
            rate[N3 + tube] -= force[2];
            rate[M3 + tube] -= moment[2];
            if (section.guided) continue;
            for (int r = 0; r < 2; ++r) {
                rate[SUM_N + r] -= force[r];
                rate[SUM_M + r] -= moment[r];
            }
        }
    }
};

}  // namespace tactr
