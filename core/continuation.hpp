// Homotopy from the straight, unloaded robot to the one asked for.
//
// Rest curvature, tension and loads are scaled together by t. At t = 0 the free end is known and unique. The unknowns
// are angles, so the solution curve that starts there is bounded and, except for a set of robots of measure zero, must
// reach t = 1; it may turn back in t on the way (snapping), so it is followed by its arc length.
#pragma once
#include <cmath>

#include "dense.hpp"
#include "newton.hpp"

namespace tactr {

class Continuation {
  public:
    Continuation(NewtonSolver& newton, Solution& solution)
        : newton_(newton), solution_(solution), n_(newton.shooting.unknowns), target_(newton.actuation) {}

    /// Leaves the solution's free end at t = 1. False: the curve was not followed to the end.
    bool reach() {
        newton_.start_straight(solution_);
        here_ = solution_.free_end;
        t_ = 0.0;
        for (int i = 0; i <= n_; ++i) tangent_[i] = i == n_;
        newton_.choose_mesh(solution_);  // for the full scale: steps that change along the curve would bend it
        double step = FIRST_STEP;
        bool found = linearise(here_, t_) && find_tangent();
        while (found && step > LEAST_STEP && solution_.steps_marched < newton_.settings.max_steps) {
            if (!advance(step)) {
                step *= 0.4;
                continue;
            }
            if (t_ >= 1.0) {
                if (land()) return true;
                restore();
                step *= 0.4;
                continue;
            }
            if (corrections_ <= 3) step = smaller(1.6 * step, LONGEST_STEP);
            if (corrections_ >= 6) step *= 0.7;
        }
        newton_.actuation = target_;
        return false;
    }

  private:
    static constexpr int N = MAX_UNKNOWNS + 1;
    static constexpr double FIRST_STEP = 0.1, LONGEST_STEP = 0.6, LEAST_STEP = 1e-7;
    static constexpr double STRAIGHTNESS = 0.9;  // least cosine between the tangents at both ends of a step
    static constexpr double ON_CURVE = 1e-7;     // rad

    NewtonSolver& newton_;
    Solution& solution_;
    const int n_;
    const Actuation<double> target_;
    FreeEnd<double> here_, previous_;
    double t_ = 0.0, previous_t_ = 0.0;
    double tangent_[N], previous_tangent_[N];
    double slope_[MAX_UNKNOWNS];  // d(residual)/dt
    int corrections_ = 0;

    void scale(double t) {
        newton_.actuation.shape_scale = target_.shape_scale * t;
        newton_.actuation.load_scale = target_.load_scale * t;
    }

    /// Residual and its derivatives in the free end and, by a difference, in t.
    bool linearise(const FreeEnd<double>& at, double t) {
        constexpr double H = 1e-6;
        scale(t);
        solution_.free_end = at;
        if (!newton_.evaluate(solution_, NewtonSolver::Kind::firm)) return false;
        double ahead[MAX_UNKNOWNS];
        scale(t + H);
        const bool found = newton_.plain_residual(at, solution_.mesh, ahead);
        scale(t);
        if (!found) return false;
        for (int i = 0; i < n_; ++i) slope_[i] = (ahead[i] - newton_.residual[i]) / H;
        return true;
    }

    /// Unit tangent of the curve at the last linearisation, in the direction of the former one.
    bool find_tangent() {
        double A[N][N], v[N];
        border(A);
        for (int i = 0; i <= n_; ++i) v[i] = i == n_;
        if (solve_dense(n_ + 1, A, v) == 0.0) return false;
        double length = 0.0;
        for (int i = 0; i <= n_; ++i) length += v[i] * v[i];
        if (!std::isfinite(length)) return false;
        for (int i = 0; i <= n_; ++i) tangent_[i] = v[i] / std::sqrt(length);
        return true;
    }

    /// [dr/dx dr/dt; tangent]: regular at folds in t too.
    void border(double (&A)[N][N]) const {
        for (int i = 0; i < n_; ++i) {
            for (int j = 0; j < n_; ++j) A[i][j] = solution_.jacobian[i][j];
            A[i][n_] = slope_[i];
        }
        for (int j = 0; j <= n_; ++j) A[n_][j] = tangent_[j];
    }

    /// One step along the curve: predict on the tangent, correct across it.
    bool advance(double step) {
        double move[MAX_UNKNOWNS], from_tangent[N];
        for (int i = 0; i < n_; ++i) move[i] = tangent_[i];
        for (int i = 0; i <= n_; ++i) from_tangent[i] = tangent_[i];
        FreeEnd<double> end;
        newton_.shooting.move(here_, move, step, end);
        double t = t_ + step * tangent_[n_];
        scale(t);
        solution_.free_end = end;
        if (!newton_.add_steps(solution_)) return false;
        if (!correct(step, end, t) || !find_tangent()) return reset(from_tangent);
        double cosine = 0.0;
        for (int i = 0; i <= n_; ++i) cosine += tangent_[i] * from_tangent[i];
        if (cosine < STRAIGHTNESS) return reset(from_tangent);
        previous_ = here_;
        previous_t_ = t_;
        for (int i = 0; i <= n_; ++i) previous_tangent_[i] = from_tangent[i];
        here_ = end;
        t_ = t;
        return true;
    }

    bool reset(const double* tangent) {
        for (int i = 0; i <= n_; ++i) tangent_[i] = tangent[i];
        return false;
    }

    void restore() {
        here_ = previous_;
        t_ = previous_t_;
        reset(previous_tangent_);
    }

    /// Newton on the curve and the plane across it at the predicted point.
    bool correct(double step, FreeEnd<double>& end, double& t) {
        double last = INFINITY;
        for (corrections_ = 1; corrections_ <= 8; ++corrections_) {
            if (!linearise(end, t)) return false;
            const double size = newton_.norm(newton_.residual);
            if (size < ON_CURVE) return true;
            if (size > 0.5 * last && corrections_ > 2) return false;
            last = size;
            double A[N][N], v[N], travelled[MAX_UNKNOWNS] = {};
            border(A);
            newton_.shooting.difference(here_, end, travelled);
            v[n_] = step - tangent_[n_] * (t - t_);
            for (int i = 0; i < n_; ++i) {
                v[i] = -newton_.residual[i];
                v[n_] -= tangent_[i] * travelled[i];
            }
            if (solve_dense(n_ + 1, A, v) == 0.0) return false;
            FreeEnd<double> from = end;
            double change[MAX_UNKNOWNS];
            for (int i = 0; i < n_; ++i) change[i] = v[i];
            if (newton_.norm(change) > 2.0 * step + 0.1) return false;
            newton_.shooting.move(from, change, 1.0, end);
            t += v[n_];
        }
        return false;
    }

    /// From the two points on either side of t = 1 to t = 1 itself.
    bool land() {
        const double part = (1.0 - previous_t_) / (t_ - previous_t_);
        double step[MAX_UNKNOWNS];
        newton_.shooting.difference(previous_, here_, step);
        newton_.shooting.move(previous_, step, part, solution_.free_end);
        newton_.actuation = target_;
        const FreeEnd<double> expected = solution_.free_end;
        newton_.add_steps(solution_);
        return newton_.newton(solution_, ON_CURVE, NewtonSolver::Kind::firm) &&
               newton_.shooting.distance(expected, solution_.free_end) < 2.0 * newton_.norm(step) + 1e-3;
    }
};

}  // namespace tactr
