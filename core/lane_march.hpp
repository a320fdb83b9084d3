// Marches a pack of configurations from the free end to the base in lock-step: the same sections, steps and stages for all.
#pragma once
#include "dp8_tableau.hpp"
#include "lane_plan.hpp"
#include "lane_rows.hpp"
#include "lane_section.hpp"
#include "lane_stability.hpp"
#include "resultant_rates.hpp"
#include "rotations.hpp"
#include "stage_sums.hpp"
#include "states.hpp"

namespace tactr {

constexpr int LANE_STATES = 3 * LANE_TUBES + 4 + 4 + 3;  // packed, of one section

/// Strains at every stage of the march before, and their slopes in the unknowns: a row for each.
template <class R>
struct LaneMemory {
    LaneStore<R> rows;
    int unknowns;
    R shift[LANE_UNKNOWNS + 1];  // of the unknowns since then
    bool warm;

    TACTR_ANY long strain(int stage, int n) const { return static_cast<long>(stage) * LANE_STRAINS * (1 + unknowns) + n; }
    TACTR_ANY long slope(int stage, int n, int l) const { return strain(stage, n) + LANE_STRAINS * (1 + l); }
    /// Only where active, once there is something to keep.
    TACTR_ANY void put(long row, const R& x, const MaskOf<R>& active) const { rows.put(row, warm ? select(active, x, rows[row]) : x); }
};

/// How a march is made.
struct LaneMarchKind {
    double enough;      // of a section's residual, before a last linear step
    bool last_step;
    bool path;          // R_b, p and lengths too
    bool errors;        // estimates of the discretisation's
};

template <class R, int K>
class LaneMarch {
  public:
    using T = typename LaneState<R, K>::type;

    const LanePlan& plan;
    const LaneNumbers<R>& numbers;
    const LaneMarchKind kind;
    LaneSectionSolver<R, K> solver;
    LaneStability<R>* stability = nullptr;  // to be told of every step

    // Results
    MaskOf<R> found;
    T psi[LANE_TUBES];        // of every tube at its own proximal end
    T quaternion[4], position[3];  // at the guide's exit
    R length[LANE_TENDONS], section_error[LANE_SECTIONS], length_error[LANE_SECTIONS];

    TACTR_ANY LaneMarch(const LanePlan& plan_, const LaneNumbers<R>& numbers_, const LaneMarchKind& kind_)
        : plan(plan_), numbers(numbers_), kind(kind_), solver(plan_, numbers_) {
        solver.enough = kind.enough;
        solver.last_step = kind.last_step;
    }

    /// free_end: the tubes' angles at their distal ends. Only where active is anything kept in memory.
    TACTR_APART void run(const T* free_end, LaneMemory<R>& memory, const MaskOf<R>& active) {
        start(free_end);
        int stage = 0;
        for (int k = plan.section_count - 1; k >= 0; --k) {
            const LaneSection& section = plan.sections[k];
            cross_boundary(free_end, k);
            packing_.set(section.active, section.active_count, section.guided != 0, MarchOptions{plan.sums != 0, kind.path, kind.path});
            for (int n = 0; n < packing_.count; ++n) z_[n] = y_[packing_.index[n]];
            section_error[k] = length_error[k] = R(0.0);
            if (section.even)
                cross_evenly(section, memory, active, stage);
            else
                march_section(section, k, memory, active, stage);
            for (int n = 0; n < packing_.count; ++n) y_[packing_.index[n]] = z_[n];
            leave_section(k);
        }
        memory.warm = true;
        for (int i = 0; i < plan.tubes; ++i) psi[i] = y_[PSI + i];
    }

  private:
    T y_[STATES];                            // all states between sections
    T z_[LANE_STATES], k_[dp8::STAGES][LANE_STATES];
    Packing packing_;
    R kx_, ky_, wx_, wy_, tau_[LANE_TUBES], eta_[LANE_TUBES];  // strains found last, by tube
    R fifth_[LANE_HOSTED], third_[LANE_HOSTED];                 // of one step, of the tendons' lengths

    TACTR_ANY void start(const T* free_end) {
        for (int c = 0; c < STATES; ++c) y_[c] = T(R(0.0));
        for (int i = 0; i < plan.tubes; ++i) y_[PSI + i] = free_end[i];
        y_[QUAT] = T(R(1.0));
        found = MaskOf<R>(true);
        kx_ = ky_ = wx_ = wy_ = R(0.0);
        for (int i = 0; i < LANE_TUBES; ++i) tau_[i] = eta_[i] = R(0.0);
        for (int j = 0; j < plan.tendons; ++j) length[j] = R(0.0);
        solver.begin();
        if constexpr (K > 0)
            if (stability) stability->read(plan, y_);
    }

    // --- boundaries between sections -------------------------------------------------------------------------------

    TACTR_ANY void cross_boundary(const T* free_end, int k) {
        const LaneSection& section = plan.sections[k];
        if (k + 1 < plan.section_count && section.handed_count > 0) hand_over(section, plan.sections[k + 1]);
        if (section.guided) kx_ = ky_ = wx_ = wy_ = R(0.0);
        for (int p = 0; p < section.point_count; ++p) {
            const LaneLoad& load = section.point[p];
            const int tube = section.active[load.slot];
            T force[3], moment[3];
            turned(load.first, y_[PSI + tube], force);
            turned(load.first + 3, y_[PSI + tube], moment);
            for (int a = 0; a < 2; ++a) {
                y_[SUM_N + a] += force[a];
                y_[SUM_M + a] += moment[a];
            }
            y_[N3 + tube] += force[2];
            y_[M3 + tube] += moment[2];
        }
        (void)free_end;
    }

    /// A vector in the axes of a tube, in R_b.
    TACTR_ANY void turned(int first, const T& angle, T* out) const {
        T s, c;
        sine_cosine(angle, s, c);
        const R x = numbers[first], y = numbers[first + 1], z = numbers[first + 2];
        out[0] = c * x - s * y;
        out[1] = s * x + c * y;
        out[2] = T(z);
    }

    /// Where a tendon's host changes its axial part moves to the new host.
    TACTR_ANY void hand_over(const LaneSection& section, const LaneSection& beyond) {
        packing_.set(beyond.active, beyond.active_count, beyond.guided != 0, MarchOptions{plan.sums != 0, kind.path, kind.path});
        for (int n = 0; n < packing_.count; ++n) z_[n] = y_[packing_.index[n]];
        StrainsOf<R> e;
        copy_last(beyond, e);
        found = found & solver.solve(beyond, numbers[beyond.first], z_, packing_, e);
        for (int h = 0; h < section.handed_count; ++h) {
            const LaneHandOver& handed = section.handed[h];
            T force, moment;
            solver.axial_part(handed.hosted, force, moment);
            y_[N3 + handed.from] -= force;
            y_[M3 + handed.from] -= moment;
            y_[N3 + handed.to] += force;
            y_[M3 + handed.to] += moment;
        }
    }

    TACTR_ANY void leave_section(int k) {
        const LaneSection& section = plan.sections[k];
        if (section.guided || (k > 0 && !plan.sections[k - 1].guided)) return;
        for (int c = 0; c < 4; ++c) quaternion[c] = y_[QUAT + c];
        for (int c = 0; c < 3; ++c) position[c] = y_[POS + c];
    }

    // --- strains -----------------------------------------------------------------------------------------------------

    TACTR_ANY void copy_last(const LaneSection& section, StrainsOf<R>& e) const {
        e.kx = kx_;
        e.ky = ky_;
        e.wx = wx_;
        e.wy = wy_;
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = tau_[section.active[a]];
            e.eta[a] = eta_[section.active[a]];
        }
    }

    TACTR_ANY void keep_last(const LaneSection& section, const StrainsOf<R>& e) {
        kx_ = e.kx;
        ky_ = e.ky;
        wx_ = e.wx;
        wy_ = e.wy;
        for (int a = 0; a < section.active_count; ++a) {
            tau_[section.active[a]] = e.tau[a];
            eta_[section.active[a]] = e.eta[a];
        }
    }

    /// Where to start a stage's strains.
    TACTR_ANY void expect(const LaneSection& section, const LaneMemory<R>& memory, int stage, StrainsOf<R>& e) const {
        if (!memory.warm) {
            copy_last(section, e);
            return;
        }
        const auto shifted = [&](int n) {
            R strain = memory.rows[memory.strain(stage, n)];
            for (int l = 0; l < memory.unknowns; ++l) strain += memory.rows[memory.slope(stage, n, l)] * memory.shift[l];
            return strain;
        };
        e.kx = shifted(0);
        e.ky = shifted(1);
        e.wx = shifted(2);
        e.wy = shifted(3);
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = shifted(4 + 2 * a);
            e.eta[a] = shifted(5 + 2 * a);
        }
    }

    TACTR_ANY void keep(const LaneSection& section, LaneMemory<R>& memory, const MaskOf<R>& active, int stage, const StrainsOf<R>& e) const {
        const auto stored = [&](int n, const R& strain, const T& moving) {
            memory.put(memory.strain(stage, n), strain, active);
            if constexpr (K > 0)
                for (int l = 0; l < memory.unknowns; ++l) memory.put(memory.slope(stage, n, l), moving.d[l], active);
            else
                for (int l = 0; l < memory.unknowns && !memory.warm; ++l) memory.rows.put(memory.slope(stage, n, l), R(0.0));
            (void)moving;
        };
        const StrainsOf<T>& moving = solver.strains;
        stored(0, e.kx, moving.kx);
        stored(1, e.ky, moving.ky);
        stored(2, e.wx, moving.wx);
        stored(3, e.wy, moving.wy);
        for (int a = 0; a < section.active_count; ++a) {
            stored(4 + 2 * a, e.tau[a], moving.tau[a]);
            stored(5 + 2 * a, e.eta[a], moving.eta[a]);
        }
    }

    // --- steps -----------------------------------------------------------------------------------------------------

    TACTR_APART void solve_stage(const LaneSection& section, const R& s, LaneMemory<R>& memory, const MaskOf<R>& active, int stage, T* rate) {
        StrainsOf<R> e;
        expect(section, memory, stage, e);
        found = found & solver.solve(section, s, z_, packing_, e);
        keep(section, memory, active, stage, e);
        keep_last(section, e);
        resultant_rates(section.active_count, section.guided != 0, packing_, solver.strains, solver.N_xy, solver.M_xy, z_, rate);
        for (int d = 0; d < section.distributed_count; ++d) add_distributed(section.distributed[d], rate);
    }

    TACTR_ANY void add_distributed(const LaneLoad& load, T* rate) const {
        T force[3], moment[3];
        turned(load.first, z_[3 * load.slot], force);
        turned(load.first + 3, z_[3 * load.slot], moment);
        rate[3 * load.slot + 1] -= force[2];
        rate[3 * load.slot + 2] -= moment[2];
        if (packing_.sums < 0) return;
        for (int r = 0; r < 2; ++r) {
            rate[packing_.sums + r] -= force[r];
            rate[packing_.sums + 2 + r] -= moment[r];
        }
    }

    /// One stage serves an even section.
    TACTR_ANY void cross_evenly(const LaneSection& section, LaneMemory<R>& memory, const MaskOf<R>& active, int& stage) {
        const R distal = numbers[section.first + 1], h = numbers[section.first] - distal;
        solve_stage(section, distal, memory, active, stage++, k_[0]);
        if (kind.path) add_lengths(section, -h);
        for (int n = 0; n < packing_.count; ++n) z_[n] += k_[0][n] * h;
        watch(section);
    }

    TACTR_ANY void march_section(const LaneSection& section, int k, LaneMemory<R>& memory, const MaskOf<R>& active, int& stage) {
        const R distal = numbers[section.first + 1], length_here = numbers[section.first] - distal;
        for (int step = 0; step < section.steps; ++step) {
            const R s = distal + length_here * (static_cast<double>(step) / section.steps), h = length_here * (1.0 / section.steps);
            T before[LANE_STATES];
            for (int n = 0; n < packing_.count; ++n) before[n] = z_[n];
            for (int i = 0; i < dp8::STAGES; ++i) {
                Sums::at(i, h, before, k_, packing_.fed_back, z_);
                solve_stage(section, s + h * dp8::node(i), memory, active, stage++, k_[i]);
                if (kind.path) add_lengths(section, -h * dp8::weight(i));
                if (kind.errors) add_length_estimates(section, i);
            }
            Sums::at(dp8::STAGES, h, before, k_, packing_.count, z_);
            if (kind.errors) {
                add_error(h, section_error[k]);
                length_error[k] += largest_length_error(section, h);
            }
            watch(section);
        }
    }
    using Sums = StageSums<T, R, LANE_STATES, dp8::STAGES>;

    TACTR_ANY void watch(const LaneSection& section) {
        if constexpr (K > 0)
            if (stability) {
                for (int a = 0; a < section.active_count; ++a) y_[PSI + section.active[a]] = z_[3 * a];
                stability->read(plan, y_);
            }
    }

    TACTR_ANY void add_lengths(const LaneSection& section, const R& weight) {
        if (section.bare) return;
        for (int h = 0; h < section.hosted_count; ++h) length[section.hosted[h].tendon] += weight / solver.tendon_tangents[h].inverse;
    }

    TACTR_ANY void add_length_estimates(const LaneSection& section, int i) {
        for (int h = 0; h < section.hosted_count; ++h) {
            if (i == 0) fifth_[h] = third_[h] = R(0.0);
            const R rate = 1.0 / solver.tendon_tangents[h].inverse;
            fifth_[h] += dp8::fifth(i) * rate;
            third_[h] += dp8::third(i) * rate;
        }
    }

    TACTR_ANY R largest_length_error(const LaneSection& section, const R& h) const {
        R worst(0.0);
        for (int j = 0; j < section.hosted_count; ++j)
            worst = larger(worst, absolute(h * fifth_[j]) * damping_of(fifth_[j] * fifth_[j], third_[j] * third_[j]));
        return worst;
    }

    TACTR_ANY static R damping_of(const R& square5, const R& square3) {
        const R size = square5 + 0.01 * square3;
        return select(size > 0.0, square_root(square5 / size), R(0.0));
    }

    TACTR_ANY R weight_of(int state) const {
        if (state < N3) return numbers[plan.psi_weight];
        if (state < M3) return numbers[plan.n3_weight + state - N3];
        if (state < SUM_N) return numbers[plan.m3_weight + state - M3];
        if (state < QUAT) return numbers[plan.sum_weight + (state < SUM_M ? 0 : 1)];
        return state < POS ? 2.0 * numbers[plan.psi_weight] : R(1.0);
    }

    /// Embedded estimates of order 5 and 3, combined to one of about order 8 (Hairer et al., section II.10); carried on to
    /// the base in the last of the derivatives.
    TACTR_APART void add_error(const R& h, R& total) {
        R step_error[LANE_STATES], norm5(0.0), norm3(0.0);
        for (int n = 0; n < packing_.count; ++n) {
            R e5(0.0), e3(0.0);
            for (int j = 0; j < dp8::STAGES; j = j > 0 ? j + 1 : 5) {  // the others' weights are 0
                e5 += dp8::fifth(j) * value(k_[j][n]);
                e3 += dp8::third(j) * value(k_[j][n]);
            }
            step_error[n] = e5 * h;
            const R weight = weight_of(packing_.index[n]), w5 = e5 * weight, w3 = e3 * weight;
            norm5 += w5 * w5;
            norm3 += w3 * w3;
        }
        const R damping = damping_of(norm5, norm3);
        total += absolute(h) * square_root(norm5) * damping;
        if constexpr (K > 0)
            for (int n = 0; n < packing_.count; ++n) z_[n].d[K - 1] += step_error[n] * damping;
    }
};

}  // namespace tactr
