// Which torques in a box hold: x in [-limit, limit], w = A x + b, where w = 0 inside, w >= 0 at the lower end, w <= 0 at
// the upper one. The optimality conditions of a convex quadratic over a box for a symmetric positive definite A.
#pragma once
#include <cmath>
#include <vector>

#include "dense.hpp"

namespace tactr {

class BoxProblem {
  public:
    /// A: n x n, row-major.
    BoxProblem(const std::vector<double>& A, const std::vector<double>& b, const std::vector<double>& limit)
        : A_(A), b_(b), limit_(limit), n_(b.size()), w_(n_, 0.0) {}

    /// Block pivoting (Judice and Pires, Computers and Operations Research 21, 1994), mostly a few rounds, from x or from all
    /// sliding the way they would without torques; where both go in circles, projected Newton (Bertsekas, SIAM J. Control
    /// and Optimization 20, 1982), which falls to the minimum of a convex quadratic. x: start and result. False: neither
    /// came to an end.
    bool solve(std::vector<double>& x) {
        for (bool slides : {false, true}) {
            std::vector<double> pivoted = x;
            choose_sides(slides ? b_ : x, slides);
            if (!pivot_blocks(pivoted)) continue;
            x = pivoted;
            return true;
        }
        return descend(x);
    }

  private:
    static constexpr int MOST_BLOCKS = 12, MOST_DESCENTS = 100;
    static constexpr double NOTHING = 1e-14;  // rad
    static constexpr double AT_END = 1e-6;    // of the limit
    const std::vector<double>&A_, &b_, &limit_;
    const size_t n_;
    std::vector<double> w_, matrix_, right_;
    std::vector<int> side_;  // -1, 1: at an end of the box; 0: inside
    std::vector<size_t> inside_;

    bool is_at_end(size_t i, double x) const { return std::fabs(x) >= limit_[i] * (1.0 - AT_END); }

    void choose_sides(const std::vector<double>& by, bool slides) {
        side_.assign(n_, 0);
        for (size_t i = 0; i < n_; ++i) {
            if (slides) side_[i] = by[i] < 0.0 ? 1 : -1;
            else if (limit_[i] <= 0.0 || is_at_end(i, by[i])) side_[i] = by[i] < 0.0 ? -1 : 1;
        }
    }

    bool pivot_blocks(std::vector<double>& x) {
        for (int round = 0; round < MOST_BLOCKS; ++round) {
            if (!settle(x)) return false;
            bool right = true;
            for (size_t i = 0; i < n_; ++i) {
                if (!is_wrong(i, x)) continue;
                side_[i] = side_[i] != 0 ? 0 : x[i] > 0.0 ? 1 : -1;
                right = false;
            }
            if (right) return true;
        }
        return false;
    }

    double clipped(size_t i, double x) const { return x > limit_[i] ? limit_[i] : x < -limit_[i] ? -limit_[i] : x; }

    bool descend(std::vector<double>& x) {
        for (size_t i = 0; i < n_; ++i) x[i] = clipped(i, x[i]);
        std::vector<double> next(n_);
        for (int round = 0; round < MOST_DESCENTS; ++round) {
            const double energy = energy_at(x);
            inside_.clear();
            double worst = 0.0;
            for (size_t i = 0; i < n_; ++i) {
                if (limit_[i] <= 0.0) continue;
                if (is_at_end(i, x[i]) && x[i] * w_[i] <= 0.0) {
                    x[i] = x[i] > 0.0 ? limit_[i] : -limit_[i];
                    continue;
                }
                inside_.push_back(i);
                worst = std::fabs(w_[i]) > worst ? std::fabs(w_[i]) : worst;
            }
            if (worst <= NOTHING) return true;
            const size_t m = inside_.size();
            matrix_.resize(m * m);
            right_.resize(m);
            for (size_t r = 0; r < m; ++r) {
                right_[r] = -w_[inside_[r]];
                for (size_t c = 0; c < m; ++c) matrix_[r * m + c] = A_[inside_[r] * n_ + inside_[c]];
            }
            if (!eliminate(m)) return false;
            const std::vector<double> slope = w_;
            double share = 1.0;
            for (; share > 1e-9; share *= 0.5) {
                next = x;
                double fall = 0.0;
                for (size_t r = 0; r < m; ++r) {
                    const size_t i = inside_[r];
                    next[i] = clipped(i, x[i] + share * right_[r]);
                    fall += slope[i] * (x[i] - next[i]);
                }
                if (energy_at(next) <= energy - 1e-4 * fall && fall > 0.0) break;
            }
            if (!(share > 1e-9)) return worst <= 1e3 * NOTHING;  // at the rounding floor
            x = next;
        }
        return false;
    }

    /// And w there.
    double energy_at(const std::vector<double>& x) {
        double sum = 0.0;
        for (size_t i = 0; i < n_; ++i) {
            w_[i] = b_[i];
            for (size_t j = 0; j < n_; ++j) w_[i] += A_[i * n_ + j] * x[j];
            sum += 0.5 * x[i] * (w_[i] + b_[i]);
        }
        return sum;
    }

    /// x inside and w at the ends, from the sides.
    bool settle(std::vector<double>& x) {
        inside_.clear();
        for (size_t i = 0; i < n_; ++i) {
            if (side_[i] == 0) inside_.push_back(i);
            else x[i] = limit_[i] > 0.0 ? side_[i] * limit_[i] : 0.0;
        }
        const size_t m = inside_.size();
        matrix_.resize(m * m);
        right_.resize(m);
        for (size_t r = 0; r < m; ++r) {
            const double* row = &A_[inside_[r] * n_];
            right_[r] = -b_[inside_[r]];
            for (size_t i = 0; i < n_; ++i)
                if (side_[i] != 0) right_[r] -= row[i] * x[i];
            for (size_t c = 0; c < m; ++c) matrix_[r * m + c] = row[inside_[c]];
        }
        if (!eliminate(m)) return false;
        for (size_t r = 0; r < m; ++r) x[inside_[r]] = right_[r];
        for (size_t i = 0; i < n_; ++i) {
            if (side_[i] == 0) continue;
            w_[i] = b_[i];
            for (size_t j = 0; j < n_; ++j) w_[i] += A_[i * n_ + j] * x[j];
        }
        return true;
    }

    /// right_ becomes the solution; false: singular.
    bool eliminate(size_t m) {
        const int n = static_cast<int>(m);
        return m == 0 || solve_dense(n, matrix_.data(), n, right_.data()) != 0.0;
    }

    bool is_wrong(size_t i, const std::vector<double>& x) const {
        if (limit_[i] <= 0.0) return false;
        if (side_[i] == 0) return std::fabs(x[i]) > limit_[i] * (1.0 + 1e-12);
        return side_[i] * w_[i] > NOTHING;  // it would turn against its torque
    }
};

}  // namespace tactr
