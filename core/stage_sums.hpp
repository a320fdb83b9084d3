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

/// T: states, P: step lengths.
template <class T, class P>
class StageSums {
  public:
    using Rates = T[dp8::DENSE_STAGES][STATES];

    /// The first count states at stage i (the step's end: i = STAGES), from those before the step and the rates at the
    /// stages before.
    static void at(int i, const P& h, const T* before, const Rates& k, int count, T* z) {
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
    static constexpr int LANES = LaneCount<T>::value;

    template <int I>
    static void add(const P& h, const T* before, const Rates& k, int count, T* z) {
        static constexpr SparseRow ROW(I == dp8::STAGES ? dp8::B : dp8::A[I], I);
        add_row<ROW>(h, before, k, count, z, std::make_integer_sequence<int, ROW.count>());
    }

    /// z = before + h * sum of weight * k; the lanes of a state lie behind its value, so that one loop runs over all.
    template <const SparseRow& ROW, int... J>
    static void add_row(const P& h, const T* before, const Rates& k, int count, T* z, std::integer_sequence<int, J...>) {
        const double length = value(h);
        const int width = count * (LANES + 1);
        const double* from = reinterpret_cast<const double*>(before);
        double* to = reinterpret_cast<double*>(z);
        const double* rates = reinterpret_cast<const double*>(k);
        constexpr int STRIDE = STATES * (LANES + 1);
        for (int n = 0; n < width; ++n) to[n] = from[n] + length * ((rates[ROW.stage[J] * STRIDE + n] * ROW.weight[J]) + ...);
        if constexpr (!std::is_same_v<P, double>)
            for (int n = 0; n < count; ++n) {
                const double rate = ((k[ROW.stage[J]][n].v * ROW.weight[J]) + ...);
                for (int l = 0; l < LANES; ++l) z[n].d[l] += rate * h.d[l];
            }
    }
};

}  // namespace tactr
