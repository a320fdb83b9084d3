// From free ends near by to those that meet the base, for a pack of configurations in lock-step. What does not go straight
// is left to the solver of single configurations; what counts as found passes the same checks as there.
#pragma once
#include "lane_free_end.hpp"
#include "stride.hpp"

namespace tactr {

template <class R, int N>
class LaneNewton : LaneFreeEnd<R, N> {
    using Base = LaneFreeEnd<R, N>;
    using Base::alive_, Base::factors_, Base::marches_, Base::memory_, Base::numbers_, Base::out_, Base::plan_, Base::psi_;
    using Base::LONGEST, Base::SIZE;

  public:
    TACTR_ANY LaneNewton(const LanePlan& plan, const LaneNumbers<R>& numbers, const LaneStore<R>& memory, const LaneOut<R>& out)
        : Base(plan, numbers, memory, out) {}

    /// From the free ends in the results, on the plan's steps. remembers: the memory holds the march before, on the same steps.
    TACTR_ANY void run(bool remembers) {
        psi_[0] = numbers_[plan_.rotation];
        for (int l = 0; l < N; ++l) psi_[1 + l] = out_[LaneResults::PSI + 1 + l];
        alive_ = out_[LaneResults::ALIVE] > 0.0;
        memory_.warm = remembers && N > 0;
        if (memory_.warm) {
            marches_ = out_[LaneResults::MARCHES];
            for (int l = 0; l < N; ++l) memory_.shift[l] = out_[LaneResults::SHIFT + l];
        }
        draft();
        check();
        out_.put(LaneResults::ALIVE, select(alive_, R(1.0), R(0.0)));
        out_.put(LaneResults::MARCHES, marches_);
        for (int i = 0; i < plan_.tubes; ++i) out_.put(LaneResults::PSI + i, psi_[i]);
    }

  private:
    static constexpr double FINE = 1e-4;  // residual of sections before their last linear step
    static constexpr int MOST_DRAFTS = 4, MOST_CHECKS = 4;
    static constexpr double ERROR_SAFETY = 2.0;  // as for single configurations

    /// Newton's step with the factored Jacobian, where it is wanted; returns the longest turn of it.
    TACTR_ANY R step(const R* missed, const MaskOf<R>& wanted) {
        R by[SIZE];
        for (int l = 0; l < N; ++l) by[l] = -missed[l];
        solve_lanes(N, factors_, by);
        const R longest = this->norm(by);
        const R fraction = select(longest > LONGEST, LONGEST / longest, R(1.0));
        for (int l = 0; l < N; ++l) {
            const R turn = fraction * by[l];
            memory_.shift[l] = select(wanted, turn, memory_.shift[l]);
            psi_[1 + l] = select(wanted, psi_[1 + l] + turn, psi_[1 + l]);
        }
        return longest;
    }

    /// Marches with derivatives, path and errors, until one is so near that its derivatives hold where the base is met.
    TACTR_APART void draft() {
        MaskOf<R> open = alive_;
        for (int attempt = 0; attempt < MOST_DRAFTS && any(open); ++attempt) {
            LaneMarch<R, N + 1> march(plan_, numbers_, LaneMarchKind{FINE, true, true, true});
            LaneStability<R> stability;
            march.stability = &stability;
            Dual<N + 1, R> end[LANE_TUBES], r[LANE_TUBES];
            this->seed(end);
            march.run(end, memory_, open);
            alive_ = alive_ & (march.found | (!open));
            open = open & alive_;
            marches_ += select(open, R(1.0), R(0.0));
            this->residual(march.psi, r);
            R missed[SIZE], A[SIZE][SIZE];
            this->split(r, missed, A);
            for (int i = 0; i < N; ++i)
                for (int j = 0; j < N; ++j) this->keep(LaneResults::JACOBIAN + i * N + j, open, A[i][j]);
            const R determinant = this->factor(A, open);
            write_estimates(march, end, r, open);
            this->keep(LaneResults::FAR_FROM_SNAPPING, open, select(stability.farthest < FAR, R(1.0), R(0.0)));
            this->keep(LaneResults::DETERMINANT, open, determinant);
            if constexpr (N == 0) return;
            const R turn = step(missed, open);
            alive_ = alive_ & ((!open) | (turn < LONGEST));
            open = open & alive_ & !(turn < Stride::CLOSE);
        }
        alive_ = alive_ & !open;
    }

    /// The discretisation's errors: in every section, at the tip and of the tendons' lengths.
    TACTR_ANY void write_estimates(const LaneMarch<R, N + 1>& march, const Dual<N + 1, R>* end, const Dual<N + 1, R>* r, const MaskOf<R>& wanted) {
        this->write_errors(march, wanted);
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
        this->keep(LaneResults::ERROR, wanted, ERROR_SAFETY * square_root(error));
        this->keep(LaneResults::LENGTH_ERROR, wanted, length_error);
    }

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
            this->residual(march.psi, missed);
            const R size = this->norm(missed);
            write_tip(march, open, size);
            open = open & !(size <= numbers_[plan_.residual_tolerance]);
            if (any(open)) step(missed, open);
        }
        alive_ = alive_ & !open;
    }

    TACTR_ANY void write_tip(const LaneMarch<R, 0>& march, const MaskOf<R>& wanted, const R& size) const {
        R position[3], quaternion[4];
        tip_pose(psi_, march, position, quaternion);
        for (int c = 0; c < 3; ++c) this->keep(LaneResults::TIP + c, wanted, position[c]);
        for (int c = 0; c < 4; ++c) this->keep(LaneResults::QUATERNION + c, wanted, quaternion[c]);
        for (int j = 0; j < plan_.tendons; ++j) this->keep(LaneResults::LENGTH + j, wanted, march.length[j]);
        this->keep(LaneResults::BASE_RESIDUAL, wanted, size);
        this->keep(LaneResults::SECTION_RESIDUAL, wanted, march.solver.worst_residual);
        this->keep(LaneResults::LEAST_STRETCH, wanted, march.solver.least_stretch);
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
