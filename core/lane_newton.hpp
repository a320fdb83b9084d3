// From cold to the free ends that meet the base, for a pack of configurations in lock-step. What does not go straight is
// left to the solver of single configurations; what counts as found passes the same checks as there.
#pragma once
#include "lane_march.hpp"
#include "stride.hpp"

namespace tactr {

template <class R, int N>  // N: unknowns
class LaneNewton {
  public:
    TACTR_ANY LaneNewton(const LanePlan& plan, const LaneRows<const R>& numbers, const LaneRows<R>& memory, const LaneRows<R>& results)
        : plan_(plan), numbers_(numbers), memory_{memory, N, {}, false}, out_(results) {
        for (int l = 0; l <= N; ++l) memory_.shift[l] = R(0.0);
    }

    TACTR_ANY void go(int phase) {
        if (phase == LANES_BEGIN)
            begin();
        else
            run(phase == LANES_FAR);
    }

  private:
    /// One march from the straight robot without derivatives: its errors, and free ends moved by what it missed the base.
    TACTR_ANY void begin() {
        for (int i = 0; i < plan_.tubes; ++i) psi_[i] = numbers_[plan_.rotation + i];
        LaneMarch<R, 0> march(plan_, numbers_, LaneMarchKind{ROUGH, true, true, true});
        march.run(psi_, memory_, MaskOf<R>(true));
        R missed[LANE_TUBES];
        residual(march.psi, missed);
        const R size = norm(missed);
        const MaskOf<R> wind = march.found & (size < LONGEST_CHORD);
        for (int l = 0; l < N; ++l) psi_[1 + l] = select(wind, psi_[1 + l] - missed[l], psi_[1 + l]);
        write_errors(march, MaskOf<R>(true));
        out_[LaneResults::BASE_RESIDUAL] = size;
        out_[LaneResults::ALIVE] = select(march.found, R(1.0), R(0.0));
        for (int i = 0; i < plan_.tubes; ++i) out_[LaneResults::PSI + i] = psi_[i];
    }

    /// Newton from the free ends in the results, on the plan's steps.
    TACTR_ANY void run(bool far) {
        for (int i = 0; i < plan_.tubes; ++i) psi_[i] = out_[LaneResults::PSI + i];
        alive_ = MaskOf<R>(true);
        marches_ = R(0.0);
        if constexpr (N > 0)
            if (far) approach();
        draft();
        check();
        out_[LaneResults::ALIVE] = select(alive_, R(1.0), R(0.0));
        out_[LaneResults::MARCHES] = marches_;
        for (int i = 0; i < plan_.tubes; ++i) out_[LaneResults::PSI + i] = psi_[i];
    }

    static constexpr double ROUGH = 5e-2, FINE = 1e-4;  // residual of sections before their last linear step
    static constexpr double CLOSE = 1e-2;               // rad: from here Newton squares the residual
    static constexpr double LONGEST = 1.0;              // rad, of a step
    static constexpr double SHORTER = 0.4, SHORTEST = 0.02;
    static constexpr double LONGEST_CHORD = 1.0;        // rad, of one without derivatives of its own
    static constexpr int MOST_APPROACHES = 16, MOST_DRAFTS = 4, MOST_CHECKS = 4;
    static constexpr double ERROR_SAFETY = 2.0;  // as for single configurations
    static constexpr int SIZE = N > 0 ? N : 1;

    const LanePlan& plan_;
    const LaneRows<const R>& numbers_;
    LaneMemory<R> memory_;
    const LaneRows<R> out_;
    MaskOf<R> alive_;
    R psi_[LANE_TUBES], factors_[SIZE][SIZE], marches_;

    template <class T>
    TACTR_ANY void residual(const T* psi, T* r) const {
        const R first = numbers_[plan_.rotation];
        for (int i = 1; i < plan_.tubes; ++i) r[i - 1] = (psi[i] - numbers_[plan_.rotation + i]) - (psi[0] - first);
    }

    TACTR_ANY R norm(const R* r) const {
        R worst(0.0), check(0.0);
        for (int l = 0; l < N; ++l) {
            worst = larger(worst, absolute(r[l]));
            check += r[l];
        }
        return select(is_finite(check), worst, R(HUGE_VAL));
    }

    template <int K>
    TACTR_ANY void seed(Dual<K, R>* end) const {
        for (int i = 0; i < plan_.tubes; ++i) {
            end[i] = Dual<K, R>(psi_[i]);
            if (i > 0 && i - 1 < K) end[i].d[i - 1] = R(1.0);
        }
        if (K > N)
            for (int i = 0; i < plan_.tubes; ++i)
                for (int l = N; l < K; ++l) end[i].d[l] = R(0.0);
    }

    /// Newton's step with the factored Jacobian, where it is wanted; returns the longest turn of it.
    TACTR_ANY R step(const R* missed, const MaskOf<R>& wanted) {
        R by[SIZE];
        for (int l = 0; l < N; ++l) by[l] = -missed[l];
        solve_lanes(N, factors_, by);
        const R longest = norm(by);
        const R fraction = select(longest > LONGEST, LONGEST / longest, R(1.0));
        for (int l = 0; l < N; ++l) {
            const R turn = fraction * by[l];
            memory_.shift[l] = select(wanted, turn, memory_.shift[l]);
            psi_[1 + l] = select(wanted, psi_[1 + l] + turn, psi_[1 + l]);
        }
        return longest;
    }

    template <int K>
    TACTR_ANY R take_jacobian(const Dual<K, R>* r, const MaskOf<R>& wanted, R* missed) {
        R A[SIZE][SIZE];
        for (int i = 0; i < N; ++i) {
            missed[i] = r[i].v;
            for (int j = 0; j < N; ++j) A[i][j] = r[i].d[j];
        }
        for (int i = 0; i < N; ++i)
            for (int j = 0; j < N; ++j) {
                R& kept = out_[LaneResults::JACOBIAN + i * N + j];
                kept = select(wanted, A[i][j], kept);
            }
        const R determinant = factor_lanes(N, A);
        for (int i = 0; i < N; ++i)
            for (int j = 0; j < N; ++j) factors_[i][j] = select(wanted, A[i][j], factors_[i][j]);
        return determinant;
    }

    /// Rough marches until Newton's next step leads close. Where a step does not keep its promise it is shortened, as for
    /// single configurations.
    TACTR_APART void approach() {
        if constexpr (N > 0) {
            MaskOf<R> far = alive_;
            R bound(HUGE_VAL), size(0.0), fraction(1.0), from[SIZE], by[SIZE];
            for (int i = 0; i < SIZE; ++i) {
                from[i] = by[i] = R(0.0);
                for (int j = 0; j < SIZE; ++j) factors_[i][j] = R(i == j ? 1.0 : 0.0);
            }
            for (int attempt = 0; attempt < MOST_APPROACHES && any(far); ++attempt) {
                LaneMarch<R, N> march(plan_, numbers_, LaneMarchKind{ROUGH, true, false, false});
                Dual<N, R> end[LANE_TUBES], r[LANE_TUBES];
                seed(end);
                march.run(end, memory_, far);
                marches_ += select(far, R(1.0), R(0.0));
                residual(march.psi, r);
                R missed[SIZE], step[SIZE];
                for (int i = 0; i < N; ++i) missed[i] = r[i].v;
                const MaskOf<R> kept = far & march.found & (norm(missed) < bound);
                take_jacobian(r, kept, missed);
                for (int i = 0; i < N; ++i) step[i] = -missed[i];
                solve_lanes(N, factors_, step);
                size = select(kept, norm(missed), size);
                R ahead(0.0);
                for (int i = 0; i < N; ++i) ahead -= step[i] * missed[i];
                R longest = norm(step);  // then as NewtonSolver::is_astray
                const MaskOf<R> astray = kept & (size > CLOSE) & ((ahead < 0.0) | (longest > Stride::LIKELY));
                for (int i = 0; i < N; ++i) step[i] = select(astray, -missed[i] * (Stride::LENGTH / size), step[i]);
                longest = select(astray, R(Stride::LENGTH), longest);
                fraction = select(kept, select(longest > LONGEST, LONGEST / longest, R(1.0)), SHORTER * fraction);
                for (int i = 0; i < N; ++i) {
                    by[i] = select(kept, step[i], by[i]);
                    from[i] = select(kept, psi_[1 + i], from[i]);
                    const R to = from[i] + fraction * by[i];
                    memory_.shift[i] = select(far, to - psi_[1 + i], memory_.shift[i]);
                    psi_[1 + i] = select(far, to, psi_[1 + i]);
                }
                bound = select(astray, R(HUGE_VAL), (1.0 - 0.1 * fraction) * size);
                alive_ = alive_ & ((!far) | (march.found & (fraction > SHORTEST) & is_finite(longest)));
                far = far & alive_ & !(kept & (size < CLOSE) & !astray & (fraction >= 1.0));
            }
            alive_ = alive_ & !far;
        }
    }

    /// Marches with derivatives, path and errors, until one is so near that its derivatives hold where the base is met.
    TACTR_APART void draft() {
        MaskOf<R> open = alive_;
        for (int attempt = 0; attempt < MOST_DRAFTS && any(open); ++attempt) {
            LaneMarch<R, N + 1> march(plan_, numbers_, LaneMarchKind{FINE, true, true, true});
            LaneStability<R> stability;
            march.stability = &stability;
            Dual<N + 1, R> end[LANE_TUBES], r[LANE_TUBES];
            seed(end);
            march.run(end, memory_, open);
            alive_ = alive_ & (march.found | (!open));
            open = open & alive_;
            marches_ += select(open, R(1.0), R(0.0));
            residual(march.psi, r);
            R missed[SIZE];
            const R determinant = take_jacobian(r, open, missed);
            write_estimates(march, end, r, open);
            keep(LaneResults::FAR_FROM_SNAPPING, open, select(stability.farthest < FAR, R(1.0), R(0.0)));
            keep(LaneResults::DETERMINANT, open, determinant);
            if constexpr (N == 0) return;
            const R turn = step(missed, open);
            alive_ = alive_ & ((!open) | (turn < LONGEST));
            open = open & alive_ & !(turn < CLOSE);
        }
        alive_ = alive_ & !open;
    }

    /// The discretisation's errors: in every section, at the tip and of the tendons' lengths.
    TACTR_ANY void write_estimates(const LaneMarch<R, N + 1>& march, const Dual<N + 1, R>* end, const Dual<N + 1, R>* r, const MaskOf<R>& wanted) {
        write_errors(march, wanted);
        R shift[SIZE], error(0.0), length_error(0.0);
        for (int i = 0; i < N; ++i) shift[i] = r[i].d[N];
        solve_lanes(N, factors_, shift);
        Dual<N + 1, R> position[3], quaternion[4];
        tip_pose(end, march, position, quaternion);
        for (int a = 0; a < 3; ++a) {
            R d = position[a].d[N];
            for (int j = 0; j < N; ++j) d -= position[a].d[j] * shift[j];
            error += d * d;
        }
        for (int k = 0; k < plan_.section_count; ++k) length_error += ERROR_SAFETY * march.length_error[k];
        keep(LaneResults::ERROR, wanted, ERROR_SAFETY * square_root(error));
        keep(LaneResults::LENGTH_ERROR, wanted, length_error);
    }

    TACTR_ANY void keep(int row, const MaskOf<R>& wanted, const R& x) const { out_[row] = select(wanted, x, out_[row]); }

    static constexpr double FAR = 0.9;  // of 1; derivatives are those a small step before

    /// Marches without derivatives, to the sections' full tolerance, until the base is met.
    TACTR_APART void check() {
        MaskOf<R> open = alive_;
        for (int attempt = 0; attempt < MOST_CHECKS && any(open); ++attempt) {
            LaneMarch<R, 0> march(plan_, numbers_, LaneMarchKind{SECTION_TOLERANCE, false, true, false});
            march.run(psi_, memory_, open);
            alive_ = alive_ & (march.found | (!open));
            open = open & alive_;
            R missed[LANE_TUBES];
            residual(march.psi, missed);
            const R size = norm(missed);
            write_tip(march, open, size);
            open = open & !(size <= numbers_[plan_.residual_tolerance]);
            if (any(open)) step(missed, open);
        }
        alive_ = alive_ & !open;
    }

    template <class M>
    TACTR_ANY void write_errors(const M& march, const MaskOf<R>& wanted) const {
        for (int k = 0; k < plan_.section_count; ++k) {
            keep(LaneResults::SECTION_ERROR + k, wanted, march.section_error[k]);
            keep(LaneResults::SECTION_LENGTH_ERROR + k, wanted, march.length_error[k]);
        }
    }

    TACTR_ANY void write_tip(const LaneMarch<R, 0>& march, const MaskOf<R>& wanted, const R& size) const {
        R position[3], quaternion[4];
        tip_pose(psi_, march, position, quaternion);
        for (int c = 0; c < 3; ++c) keep(LaneResults::TIP + c, wanted, position[c]);
        for (int c = 0; c < 4; ++c) keep(LaneResults::QUATERNION + c, wanted, quaternion[c]);
        for (int j = 0; j < plan_.tendons; ++j) keep(LaneResults::LENGTH + j, wanted, march.length[j]);
        keep(LaneResults::BASE_RESIDUAL, wanted, size);
        keep(LaneResults::SECTION_RESIDUAL, wanted, march.solver.worst_residual);
        keep(LaneResults::LEAST_STRETCH, wanted, march.solver.least_stretch);
    }

    template <class T, class M>
    TACTR_ANY void tip_pose(const T* end, const M& march, T* position, T* quaternion) const {
        const T *base = march.quaternion, *p = march.position;
        T turn[4], q[4], own[4];
        turn_about_z(T(numbers_[plan_.rotation] - march.psi[0]), turn);
        const T conjugate[4] = {base[0], -base[1], -base[2], -base[3]};
        multiply_quaternions(turn, conjugate, q);
        const T back[3] = {-p[0], -p[1], -p[2]};
        to_world(q, back, position);
        turn_about_z(end[plan_.tip_tube], own);
        multiply_quaternions(q, own, quaternion);
    }
};

}  // namespace tactr
