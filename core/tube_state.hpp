// What a tube is at one cross-section: its stiffness, rest strains and neutral axis there.
#pragma once
#include "dual.hpp"
#include "robot.hpp"

namespace tactr {

/// One tube at one cross-section, in its own material frame. C: double, or a dual number where sigma is one.
template <class C>
struct TubeState {
    C EIx, EIy, GJ, EA, GA;
    C ustar[3];
    C vstar[3];  // v* - e3
    C axis[2];   // neutral axis, m from the centreline
    bool plain;  // v* = e3, neutral axis on the centreline
};

/// The tube at sigma. shape_scale multiplies the rest strains u* and v* - e3.
template <class C, class R>
TACTR_ANY inline TubeState<C> tube_at(const TubePieceOf<R>& piece, const C& sigma, double shape_scale) {
    C q[QUANTITIES];
    for (int i = 0; i < QUANTITIES; ++i) q[i] = C(piece.c[piece.count - 1][i]);
    const C d = sigma - piece.start;
    for (int k = piece.count - 2; k >= 0; --k)
        for (int i = 0; i < QUANTITIES; ++i) q[i] = q[i] * d + piece.c[k][i];
    for (int i = USTAR; i < AXIS; ++i) q[i] = q[i] * shape_scale;
    return {q[EIX],       q[EIY],       q[GJ],        q[EA],        q[GA],
            {q[USTAR], q[USTAR + 1], q[USTAR + 2]}, {q[VSTAR], q[VSTAR + 1], q[VSTAR + 2]}, {q[AXIS], q[AXIS + 1]},
            piece.plain != 0};
}

template <class C>
TACTR_ANY inline TubeState<RealOf<C>> values_of(const TubeState<C>& t) {
    TubeState<RealOf<C>> r;
    r.EIx = value(t.EIx);
    r.EIy = value(t.EIy);
    r.GJ = value(t.GJ);
    r.EA = value(t.EA);
    r.GA = value(t.GA);
    for (int i = 0; i < 3; ++i) {
        r.ustar[i] = value(t.ustar[i]);
        r.vstar[i] = value(t.vstar[i]);
    }
    for (int i = 0; i < 2; ++i) r.axis[i] = value(t.axis[i]);
    r.plain = t.plain;
    return r;
}

}  // namespace tactr
