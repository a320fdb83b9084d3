// Which torques in a box hold: x in [-limit, limit], w = A x + b, where w = 0 inside, w >= 0 at the lower end, w <= 0 at
// the upper one. The optimality conditions of a convex quadratic over a box for a symmetric positive definite A.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

namespace tactr {

class BoxProblem {
  public:
    /// A: n x n, row-major.
    BoxProblem(const std::vector<double>& A, const std::vector<double>& b, const std::vector<double>& limit)
        : A_(A), b_(b), limit_(limit), n_(b.size()), w_(n_, 0.0) {}

    /// Block pivoting; where the number of variables out of place does not fall, one at a time (Judice and Pires, Computers
    /// and Operations Research 21, 1994), which ends for every matrix whose principal minors are positive. x: start and
    /// result. False: it did not end.
    bool solve(std::vector<double>& x) {
        side_.assign(n_, 0);
        for (size_t i = 0; i < n_; ++i)
            if (limit_[i] <= 0.0 || std::fabs(x[i]) >= limit_[i]) side_[i] = x[i] < 0.0 ? -1 : 1;
        size_t fewest = n_ + 1;
        int blocks_left = MOST_BLOCKS;
        for (size_t round = 0; round < 20 * n_ + 50; ++round) {
            if (!settle(x)) return false;
            const size_t wrong = count_wrong(x);
            if (wrong == 0) return true;
            if (wrong < fewest) {
                fewest = wrong;
                blocks_left = MOST_BLOCKS;
            }
            pivot(x, blocks_left-- > 0);
        }
        return false;
    }

  private:
    static constexpr int MOST_BLOCKS = 8;
    const std::vector<double>&A_, &b_, &limit_;
    const size_t n_;
    std::vector<double> w_, matrix_, right_;
    std::vector<int> side_;  // -1, 1: at an end of the box; 0: inside
    std::vector<size_t> inside_;

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

    /// Gaussian elimination with partial pivoting.
    bool eliminate(size_t m) {
        for (size_t k = 0; k < m; ++k) {
            size_t best = k;
            for (size_t r = k + 1; r < m; ++r)
                if (std::fabs(matrix_[r * m + k]) > std::fabs(matrix_[best * m + k])) best = r;
            if (!(std::fabs(matrix_[best * m + k]) > 1e-300)) return false;
            if (best != k) {
                for (size_t c = k; c < m; ++c) std::swap(matrix_[k * m + c], matrix_[best * m + c]);
                std::swap(right_[k], right_[best]);
            }
            for (size_t r = k + 1; r < m; ++r) {
                const double f = matrix_[r * m + k] / matrix_[k * m + k];
                if (f == 0.0) continue;
                for (size_t c = k; c < m; ++c) matrix_[r * m + c] -= f * matrix_[k * m + c];
                right_[r] -= f * right_[k];
            }
        }
        for (size_t r = m; r-- > 0;) {
            for (size_t c = r + 1; c < m; ++c) right_[r] -= matrix_[r * m + c] * right_[c];
            right_[r] /= matrix_[r * m + r];
        }
        return true;
    }

    bool is_wrong(size_t i, const std::vector<double>& x) const {
        if (limit_[i] <= 0.0) return false;
        if (side_[i] == 0) return std::fabs(x[i]) > limit_[i] * (1.0 + 1e-12);
        return side_[i] * w_[i] > 1e-14;  // rad: it would turn against its torque
    }

    size_t count_wrong(const std::vector<double>& x) const {
        size_t count = 0;
        for (size_t i = 0; i < n_; ++i) count += is_wrong(i, x);
        return count;
    }

    void pivot(const std::vector<double>& x, bool all) {
        for (size_t i = n_; i-- > 0;) {
            if (!is_wrong(i, x)) continue;
            side_[i] = side_[i] != 0 ? 0 : x[i] > 0.0 ? 1 : -1;
            if (!all) return;
        }
    }
};

}  // namespace tactr
