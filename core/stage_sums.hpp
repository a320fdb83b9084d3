// Sums of rates at the stages of the eighth-order rule, unrolled over its nonzero weights.
#pragma once
#include <type_traits>
#include <utility>

#include "dp8_tableau.hpp"
#include "dual.hpp"
#include "states.hpp"

namespace tactr {

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

template <int I>
struct StageRow {
    static constexpr SparseRow ROW = SparseRow(I == dp8::STAGES ? dp8::B : dp8::A[I], I);
};

/// One of them: scalars, because a graphics processor knows no constants that are more.
template <int I, int J>
struct StageEntry {
    static constexpr int STAGE = StageRow<I>::ROW.stage[J];
    static constexpr double WEIGHT = StageRow<I>::ROW.weight[J];
};

/// T: states, P: step lengths; at most WIDE states side by side, rates of ROWS stages.
template <class T, class P, int WIDE = STATES, int ROWS = dp8::DENSE_STAGES>
class StageSums {
  public:
    using R = RealOf<T>;
    using Rates = T[ROWS][WIDE];

    /// The first count states at stage i (the step's end: i = STAGES), from those before the step and the rates at the
    /// stages before.
    TACTR_APART static void at(int i, const P& h, const T* before, const Rates& k, int count, T* z) {
        switch (i) {
            case 1: return add<1>(h, before, k, count, z);
            case 2: return add<2>(h, before, k, count, z);
            case 3: return add<3>(h, before, k, count, z);
            case 4: return add<4>(h, before, k, count, z);
            case 5: return add<5>(h, before, k, count, z);
            case 6: return add<6>(h, before, k, count, z);
            case 7: return add<7>(h, before, k, count, z);
            case 8: return add<8>(h, before, k, count, z);
            case 9: return add<9>(h, before, k, count, z);
            case 10: return add<10>(h, before, k, count, z);
            case 11: return add<11>(h, before, k, count, z);
            case dp8::STAGES: return add<dp8::STAGES>(h, before, k, count, z);
            default: return;
        }
    }

  private:
    static constexpr int LANES = static_cast<int>(sizeof(T) / sizeof(R)) - 1;

    template <int I>
    TACTR_ANY static void add(const P& h, const T* before, const Rates& k, int count, T* z) {
        add_row<I>(h, before, k, count, z, std::make_integer_sequence<int, StageRow<I>::ROW.count>());
    }

    /// z = before + h * sum of weight * k; the lanes of a state lie behind its value, so that one loop runs over all.
    template <int I, int... J>
    TACTR_ANY static void add_row(const P& h, const T* before, const Rates& k, int count, T* z, std::integer_sequence<int, J...>) {
        const R length = value(h);
        const int width = count * (LANES + 1);
        const R* from = reinterpret_cast<const R*>(before);
        R* to = reinterpret_cast<R*>(z);
        const R* rates = reinterpret_cast<const R*>(k);
        constexpr int STRIDE = WIDE * (LANES + 1);
        for (int n = 0; n < width; ++n) to[n] = from[n] + length * ((rates[StageEntry<I, J>::STAGE * STRIDE + n] * StageEntry<I, J>::WEIGHT) + ...);
        if constexpr (!std::is_same_v<P, R>)
            for (int n = 0; n < count; ++n) {
                const double rate = ((k[StageEntry<I, J>::STAGE][n].v * StageEntry<I, J>::WEIGHT) + ...);
                for (int l = 0; l < LANES; ++l) z[n].d[l] += rate * h.d[l];
            }
    }
};

}  // namespace tactr
