// Where a tendon runs in its host's cross-section.
#pragma once
#include "dual.hpp"
#include "robot.hpp"

namespace tactr {

template <class P, class C>
TACTR_ANY inline void evaluate_polynomial(const C* c, int count, const P& d, P& f, P& df) {
    f = P(c[count - 1]);
    df = P(0.0);
    for (int i = count - 2; i >= 0; --i) {
        df = df * d + f;
        f = f * d + c[i];
    }
}

template <class P, class C>
TACTR_ANY inline void evaluate_routing(const RoutingPieceOf<C>& piece, const P& sigma, P r[2], P dr[2]) {
    const P d = sigma - piece.start;
    P a, da, b, db;
    evaluate_polynomial(piece.a, piece.count_a, d, a, da);
    evaluate_polynomial(piece.b, piece.count_b, d, b, db);
    if (!piece.polar) {
        r[0] = a;
        r[1] = b;
        dr[0] = da;
        dr[1] = db;
        return;
    }
    P s, c;
    sine_cosine(b, s, c);
    r[0] = a * c;
    r[1] = a * s;
    dr[0] = da * c - db * r[1];
    dr[1] = da * s + db * r[0];
}

}  // namespace tactr
