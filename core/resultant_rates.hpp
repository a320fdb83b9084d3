// The differential equations of the resultants, the tubes' angles, R_b and p along s (theory, section 2).
#pragma once
#include "dual.hpp"
#include "rotations.hpp"
#include "section_equilibrium.hpp"
#include "states.hpp"

namespace tactr {

/// R_b' = R_b [kappa], kappa = (kx, ky, 0).
template <class T>
TACTR_ANY inline void turn_frame(const T& kx, const T& ky, const T* q, T* rate, bool guided) {
    if (guided) {
        for (int c = 0; c < 4; ++c) rate[c] = T(0.0);
        return;
    }
    const T hx = kx * 0.5, hy = ky * 0.5;
    rate[0] = -(q[1] * hx) - q[2] * hy;
    rate[1] = q[0] * hx - q[3] * hy;
    rate[2] = q[0] * hy + q[3] * hx;
    rate[3] = q[1] * hy - q[2] * hx;
}

/// Rates of the packed states of one section, but for distributed loads, from its strains and N_xy, M_xy of its tubes.
template <class T>
TACTR_ANY inline void resultant_rates(int tubes, bool guided, const Packing& packing, const StrainsOf<T>& e, const T (*N_xy)[2],
                                      const T (*M_xy)[2], const T* state, T* rate) {
    T sum_n3(0.0), sum_m3(0.0), stretched[3] = {T(0.0), T(0.0), T(0.0)};
    for (int a = 0; a < tubes; ++a) {
        const T *n = N_xy[a], *m = M_xy[a];
        const T stretch = 1.0 + e.eta[a], nx = stretch * n[0], ny = stretch * n[1];
        rate[3 * a] = e.tau[a];
        rate[3 * a + 1] = e.ky * n[0] - e.kx * n[1];
        rate[3 * a + 2] = e.ky * m[0] - e.kx * m[1] + e.wy * nx - e.wx * ny;
        if (packing.sums < 0) continue;
        sum_n3 += state[3 * a + 1];
        sum_m3 += state[3 * a + 2];
        stretched[0] += nx;
        stretched[1] += ny;
        stretched[2] += stretch * state[3 * a + 1];
    }
    if (packing.sums >= 0) {
        T* sums = rate + packing.sums;
        sums[0] = -(e.ky * sum_n3);
        sums[1] = e.kx * sum_n3;
        sums[2] = stretched[1] - e.ky * sum_m3 - e.wy * stretched[2];
        sums[3] = e.kx * sum_m3 - stretched[0] + e.wx * stretched[2];
    }
    if (packing.frame >= 0) turn_frame(e.kx, e.ky, &state[packing.frame], rate + packing.frame, guided);
    if (packing.path >= 0) {
        const T stretch = 1.0 + e.eta[0];
        const T v[3] = {stretch * e.wx, stretch * e.wy, stretch};
        to_world(&state[packing.frame], v, rate + packing.path);
    }
}

}  // namespace tactr
