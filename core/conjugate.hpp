// Conjugate points of a Jacobi field, counted with their multiplicity.
//
// D(s) holds the derivatives of what would be clamped if the robot were cut at s (angles of the tubes, orientation of
// the cross-section) with respect to the free-end unknowns; it is regular at the tip. By Morse's index theorem the second
// variation of the energy has as many negative directions as D(s) loses ranks between tip and base: the spaces of
// variations that vanish below s grow as s goes to the base. Roots of det D are not safe to count by its sign: a
// straight rod under axial load has det D = cos^2, two roots at once.
//
// Count instead between neighbouring samples s_k, closer to the tip, and s_k+1. Clamp at s_k+1 and condense the second
// variation on the displacement at s_k: the robot beyond s_k has the stiffness W, the piece between, clamped at its far
// end, a stiffness; their sum is S. Let C be the compliance of the piece, the displacement at s_k+1 per momentum at
// s_k. A field with the displacement X at s_k that keeps the equations arrives at s_k+1 with D_k+1 D_k^-1 X, and the
// momentum that has to be added at s_k to arrive at zero is -S X; hence
//     T = D_k+1 D_k^-1 = C S.
// S is symmetric and, while the piece is shorter than its own first conjugate point (half a wave, both ends clamped),
// C is symmetric and positive. C S is similar to C^1/2 S C^1/2, so its eigenvalues are real with the signs of those of
// S (Sylvester), and by the additivity of inertia under condensation the index is the sum over all pieces of the number
// of negative eigenvalues of T. Where a quantity does not move in a piece (a tube clamped already, R_b in the guide), T
// is the identity on it. D has to be read in coordinates that do not change along s. No momenta are needed, and double roots count twice. Terms of the order of the strains make T
// slightly unsymmetric: a double eigenvalue may become a complex pair, hence real parts are counted.
#pragma once
#include <cmath>

#include "dense.hpp"
#include "states.hpp"

namespace tactr {

struct Field {
    double D[MAX_UNKNOWNS][MAX_UNKNOWNS];
};

class ConjugateCounter {
  public:
    explicit ConjugateCounter(int unknowns) : n_(unknowns) {
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j) inverse_[i][j] = i == j;
    }

    /// Conjugate points between the last sample and this one: eigenvalues of T below -slack.
    int between(const Field& field, double slack = 0.0) const {
        double T[MAX_UNKNOWNS][MAX_UNKNOWNS], away = 0.0;
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j) {
                double sum = 0.0;
                for (int k = 0; k < n_; ++k) sum += field.D[i][k] * inverse_[k][j];
                T[i][j] = sum;
                away += (sum - (i == j)) * (sum - (i == j));
            }
        if (away < 0.99) return 0;  // |T - I| < 1: no eigenvalue in the left half
        for (int i = 0; i < n_; ++i) T[i][i] += slack;
        return eigenvalues_left(n_, T);
    }

    /// Whether the field is singular here to the accuracy at which it is known. Its sign then means nothing: let the
    /// next sample tell.
    bool is_ambiguous(const Field& field) const { return between(field, NEUTRAL) != between(field, -NEUTRAL); }

    /// Makes this the last sample.
    void move_to(const Field& field) {
        double inverse[MAX_UNKNOWNS][MAX_UNKNOWNS];
        const double determinant = invert(n_, field.D, inverse);
        if (determinant == 0.0 || !std::isfinite(determinant)) return;
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j) inverse_[i][j] = inverse[i][j];
    }

    /// Eigenvalues this near to zero count as zero: of neutral equilibria, as of a buckled round rod, which may turn about
    /// the guide, and of the limit itself.
    static constexpr double NEUTRAL = 1e-4;

  private:
    int n_;
    double inverse_[MAX_UNKNOWNS][MAX_UNKNOWNS];
};

}  // namespace tactr
