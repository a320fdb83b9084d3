// From cold to free ends near those that meet the base, for a pack of configurations in lock-step. Single precision serves:
// what is found here is only where the solver for packs starts.
#pragma once
#include "lane_free_end.hpp"
#include "stride.hpp"

namespace tactr {

template <class R, int N>
class LaneApproach : LaneFreeEnd<R, N> {
    using Base = LaneFreeEnd<R, N>;
    using Base::alive_, Base::factors_, Base::marches_, Base::memory_, Base::numbers_, Base::out_, Base::plan_, Base::psi_;
    using Base::LONGEST, Base::SIZE;

  public:
    TACTR_ANY LaneApproach(const LanePlan& plan, const LaneNumbers<R>& numbers, const LaneStore<R>& memory, const LaneOut<R>& out)
        : Base(plan, numbers, memory, out) {}

    /// One march from the straight robot without derivatives: its errors, and free ends moved by what it missed the base.
    TACTR_ANY void begin() {
        for (int i = 0; i < plan_.tubes; ++i) psi_[i] = numbers_[plan_.rotation + i];
        LaneMarch<R, 0> march(plan_, numbers_, LaneMarchKind{ROUGH, true, true, true});
        march.run(psi_, memory_, MaskOf<R>(true));
        R missed[LANE_TUBES];
        this->residual(march.psi, missed);
        const R size = this->norm(missed);
        const MaskOf<R> wind = march.found & (size < LONGEST_CHORD);
        for (int l = 0; l < N; ++l) psi_[1 + l] = select(wind, psi_[1 + l] - missed[l], psi_[1 + l]);
        this->write_errors(march, MaskOf<R>(true));
        out_.put(LaneResults::BASE_RESIDUAL, size);
        alive_ = march.found;
        write();
    }

    /// Newton from the free ends in the results, on the plan's steps.
    TACTR_ANY void run() {
        for (int i = 0; i < plan_.tubes; ++i) psi_[i] = out_[LaneResults::PSI + i];
        if constexpr (N > 0) approach();
        write();
    }

  private:
    static constexpr double ROUGH = 5e-2;  // residual of sections before their last linear step
    static constexpr double SHORTER = 0.4, SHORTEST = 0.02;
    static constexpr double LONGEST_CHORD = 1.0;  // rad, of one without derivatives of its own
    static constexpr int MOST_APPROACHES = 16;

    TACTR_ANY void write() const {
        out_.put(LaneResults::ALIVE, select(alive_, R(1.0), R(0.0)));
        out_.put(LaneResults::MARCHES, marches_);
        for (int i = 0; i < plan_.tubes; ++i) out_.put(LaneResults::PSI + i, psi_[i]);
        for (int l = 0; l < N; ++l) out_.put(LaneResults::SHIFT + l, memory_.shift[l]);
    }

    /// Rough marches until Newton's next step leads close. Where a step does not keep its promise it is shortened, as for
    /// single configurations.
    TACTR_APART void approach() {
        MaskOf<R> far = alive_;
        R bound(HUGE_VAL), size(0.0), fraction(1.0), from[SIZE], by[SIZE];
        for (int i = 0; i < SIZE; ++i) {
            from[i] = by[i] = R(0.0);
            for (int j = 0; j < SIZE; ++j) factors_[i][j] = R(i == j ? 1.0 : 0.0);
        }
        for (int attempt = 0; attempt < MOST_APPROACHES && any(far); ++attempt) {
            LaneMarch<R, N> march(plan_, numbers_, LaneMarchKind{ROUGH, true, false, false});
            Dual<N, R> end[LANE_TUBES], r[LANE_TUBES];
            this->seed(end);
            march.run(end, memory_, far);
            marches_ += select(far, R(1.0), R(0.0));
            this->residual(march.psi, r);
            R missed[SIZE], step[SIZE], A[SIZE][SIZE];
            this->split(r, missed, A);
            const MaskOf<R> kept = far & march.found & (this->norm(missed) < bound);
            this->factor(A, kept);
            for (int i = 0; i < N; ++i) step[i] = -missed[i];
            solve_lanes(N, factors_, step);
            size = select(kept, this->norm(missed), size);
            R longest = this->norm(step);
            const MaskOf<R> stride = kept & Stride::is_due(N, step, longest, missed, size);
            for (int i = 0; i < N; ++i) step[i] = select(stride, -missed[i] * (Stride::LENGTH / size), step[i]);
            longest = select(stride, R(Stride::LENGTH), longest);
            fraction = select(kept, select(longest > LONGEST, LONGEST / longest, R(1.0)), SHORTER * fraction);
            for (int i = 0; i < N; ++i) {
                by[i] = select(kept, step[i], by[i]);
                from[i] = select(kept, psi_[1 + i], from[i]);
                const R to = from[i] + fraction * by[i];
                memory_.shift[i] = select(far, to - psi_[1 + i], memory_.shift[i]);
                psi_[1 + i] = select(far, to, psi_[1 + i]);
            }
            bound = select(stride, R(HUGE_VAL), (1.0 - 0.1 * fraction) * size);
            alive_ = alive_ & ((!far) | (march.found & (fraction > SHORTEST) & is_finite(longest)));
            far = far & alive_ & !(kept & (size < Stride::CLOSE) & (fraction >= 1.0));
        }
        alive_ = alive_ & !far;
    }
};

}  // namespace tactr
