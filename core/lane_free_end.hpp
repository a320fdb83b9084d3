// What both ways of Newton for packs stand on: the unknowns, angles of the tubes' free ends, and what is missed of the base.
#pragma once
#include "lane_march.hpp"

namespace tactr {

template <class R, int N>  // N: unknowns
class LaneFreeEnd {
  protected:
    static constexpr int SIZE = N > 0 ? N : 1;
    static constexpr double LONGEST = 1.0;  // rad, of a step

    const LanePlan& plan_;
    const LaneNumbers<R> numbers_;
    const LaneOut<R> out_;
    LaneMemory<R> memory_;
    MaskOf<R> alive_;
    R psi_[LANE_TUBES], factors_[SIZE][SIZE], marches_;

    TACTR_ANY LaneFreeEnd(const LanePlan& plan, const LaneNumbers<R>& numbers, const LaneStore<R>& memory, const LaneOut<R>& out)
        : plan_(plan), numbers_(numbers), out_(out), memory_{memory, N, {}, false}, alive_(true), marches_(0.0) {
        for (int l = 0; l <= N; ++l) memory_.shift[l] = R(0.0);
    }

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

    /// Factors of the residual's derivatives A, where wanted; returns their determinant.
    TACTR_ANY R factor(R (&A)[SIZE][SIZE], const MaskOf<R>& wanted) {
        const R determinant = factor_lanes(N, A);
        for (int i = 0; i < N; ++i)
            for (int j = 0; j < N; ++j) factors_[i][j] = select(wanted, A[i][j], factors_[i][j]);
        return determinant;
    }

    template <int K>
    TACTR_ANY static void split(const Dual<K, R>* r, R* missed, R (&A)[SIZE][SIZE]) {
        for (int i = 0; i < N; ++i) {
            missed[i] = r[i].v;
            for (int j = 0; j < N; ++j) A[i][j] = r[i].d[j];
        }
    }

    TACTR_ANY void keep(int row, const MaskOf<R>& wanted, const R& x) const { out_.put(row, select(wanted, x, out_[row])); }

    template <class M>
    TACTR_ANY void write_errors(const M& march, const MaskOf<R>& wanted) const {
        for (int k = 0; k < plan_.section_count; ++k) {
            keep(LaneResults::SECTION_ERROR + k, wanted, march.section_error[k]);
            keep(LaneResults::SECTION_LENGTH_ERROR + k, wanted, march.length_error[k]);
        }
    }
};

}  // namespace tactr
