// Dense output of order 7 of the eighth-order rule: the states anywhere inside a step (Hairer et al., section II.6).
#pragma once
#include "dp8_tableau.hpp"
#include "march.hpp"

namespace tactr {

template <class T, class P = double>
class DenseOutput {
  public:
    Strains strains;  // of the section, near the last point solved

    /// Four more stages of the step that the march has just made from before at s. False: a section had no equilibrium.
    template <class M>
    bool prepare(M& march, const Section<P>& section, const T* before, const P& s, const P& h) {
        count_ = march.packing.count;
        before_ = before;
        strains = nearest(march, section);
        if (!march.derivative(section, s + h, march.z, march.k[12], strains)) return false;
        T stage[STATES];
        for (int i = 13; i < dp8::DENSE_STAGES; ++i) {
            for (int n = 0; n < count_; ++n) stage[n] = before[n] + weighted(march, dp8::A[i], i, n) * h;
            if (!march.derivative(section, s + h * dp8::C[i], stage, march.k[i], strains)) return false;
        }
        for (int n = 0; n < count_; ++n) {
            const T rise = march.z[n] - before[n];
            coefficient_[0][n] = rise;
            coefficient_[1][n] = march.k[0][n] * h - rise;
            coefficient_[2][n] = rise * 2.0 - (march.k[0][n] + march.k[12][n]) * h;
            for (int t = 0; t < 4; ++t) coefficient_[3 + t][n] = weighted(march, dp8::D[t], dp8::DENSE_STAGES, n) * h;
        }
        return true;
    }

    /// The packed states at the fraction x of the step.
    void at(const P& x, T* packed) const {
        for (int n = 0; n < count_; ++n) {
            T sum(0.0);
            for (int t = dp8::DENSE_TERMS - 1; t >= 0; --t) sum = (sum + coefficient_[t][n]) * (t % 2 == 0 ? x : P(1.0 - x));
            packed[n] = before_[n] + sum;
        }
    }

  private:
    int count_ = 0;
    const T* before_ = nullptr;
    T coefficient_[dp8::DENSE_TERMS][STATES];

    template <class M>
    static T weighted(const M& march, const double* weight, int stages, int n) {
        T sum(0.0);
        for (int j = 0; j < stages; ++j)
            if (weight[j] != 0.0) sum += march.k[j][n] * weight[j];
        return sum;
    }

    template <class M>
    static Strains nearest(const M& march, const Section<P>& section) {
        const auto& from = march.solver.strains;
        Strains e{};
        if (!section.guided) {
            e.kx = value(from.kx);
            e.ky = value(from.ky);
            e.wx = value(from.wx);
            e.wy = value(from.wy);
        }
        for (int a = 0; a < section.active_count; ++a) {
            e.tau[a] = value(from.tau[a]);
            e.eta[a] = value(from.eta[a]);
        }
        return e;
    }
};

}  // namespace tactr
