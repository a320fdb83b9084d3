// Section equilibrium in closed form, where no tendon runs and every tube bends alike in all directions: curvature then
// follows from the moments alone, slope and stretch from the forces.
#pragma once
#include <cmath>

#include "dual.hpp"
#include "robot.hpp"
#include "section_equilibrium.hpp"
#include "tube_state.hpp"

namespace tactr {

/// Whether a stretch of tube is plain, and bends alike in all directions.
template <class C>
inline bool bends_alike(const TubePieceOf<C>& piece) {
    if (!piece.plain) return false;
    for (int k = 0; k < piece.count; ++k)
        if (!(piece.c[k][EIX] == piece.c[k][EIY])) return false;
    return true;
}

/// Strains of all tubes, and their N_xy and M_xy in R_b, from what they carry: (N_3, M_3) of tube a in state[3a + 1] and
/// state[3a + 2], S and Q in sums (null: zero). False: a tube is pressed to nothing.
template <class T, class Q>
TACTR_ANY MaskOf<RealOf<T>> solve_bare_section(const TubeState<Q>* tubes, int count, bool guided, const T* cosine, const T* sine, const T* state,
                        const T* sums, StrainsOf<T>& e, T (*N_xy)[2], T (*M_xy)[2]) {
    Q bending(0.0);
    T shear(0.0), moment[2] = {T(0.0), T(0.0)}, rest[MAX_TUBES][2];
    for (int a = 0; a < count; ++a) {
        const TubeState<Q>& tube = tubes[a];
        e.eta[a] = state[3 * a + 1] / tube.EA;
        e.tau[a] = state[3 * a + 2] / tube.GJ + tube.ustar[2];
        bending += tube.EIx;
        shear += (e.eta[a] + 1.0) * tube.GA;
        rest[a][0] = (cosine[a] * tube.ustar[0] - sine[a] * tube.ustar[1]) * tube.EIx;
        rest[a][1] = (sine[a] * tube.ustar[0] + cosine[a] * tube.ustar[1]) * tube.EIx;
        for (int r = 0; r < 2; ++r) moment[r] += rest[a][r];
    }
    e.kx = e.ky = e.wx = e.wy = T(0.0);
    if (!guided) {
        e.kx = moment[0] / bending;
        e.ky = moment[1] / bending;
        if (sums) {
            e.wx = sums[0] / shear;
            e.wy = sums[1] / shear;
            e.kx += sums[2] / bending;
            e.ky += sums[3] / bending;
        }
    }
    for (int a = 0; a < count; ++a) {
        const TubeState<Q>& tube = tubes[a];
        const T shearing = (e.eta[a] + 1.0) * tube.GA;
        N_xy[a][0] = shearing * e.wx;
        N_xy[a][1] = shearing * e.wy;
        M_xy[a][0] = e.kx * tube.EIx - rest[a][0];
        M_xy[a][1] = e.ky * tube.EIx - rest[a][1];
    }
    const auto check = value(e.kx) + value(e.ky) + value(e.wx) + value(e.wy) + value(e.tau[0]);
    return (value(shear) > 0.0) & is_finite(check + value(shear));
}

}  // namespace tactr
