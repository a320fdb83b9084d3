// An equilibrium with friction torques, and how base, angles and limits answer free end and torques around it.
#pragma once
#include <cmath>
#include <vector>

#include "dense.hpp"
#include "rubbing_nodes.hpp"
#include "states.hpp"

namespace tactr {

/// Rows of rates: what the base misses (unknowns), angles at the nodes, limits of the torques there; columns: free end
/// (unknowns), torques.
struct RubbingModel {
    int unknowns = 0;
    std::vector<double> torque, twist, limit;  // by node, at the equilibrium
    std::vector<char> felt;                    // by node: as of RubbingNodes
    std::vector<double> rates;                 // row-major
    FreeEnd<double> drafted{};                 // where the rates by the free end were last found exactly
    double proven = 0.0;                       // their determinant, at the base, where it was seen to be stable; 0: not known

    size_t nodes() const { return torque.size(); }
    size_t columns() const { return unknowns + nodes(); }
    size_t rows() const { return unknowns + 2 * nodes(); }
    bool fits(int n, size_t count) const { return unknowns == n && nodes() == count && rates.size() == rows() * columns(); }

    double* missed_by(int i) { return &rates[i * columns()]; }
    double* twist_by(size_t k) { return &rates[(unknowns + k) * columns()]; }
    double* limit_by(size_t k) { return &rates[(unknowns + nodes() + k) * columns()]; }
    const double* missed_by(int i) const { return &rates[i * columns()]; }
    const double* twist_by(size_t k) const { return &rates[(unknowns + k) * columns()]; }
    const double* limit_by(size_t k) const { return &rates[(unknowns + nodes() + k) * columns()]; }

    /// rad/(N m): by how much a torque turns anything while the free end stays, at the most.
    double softest() const {
        double most = 0.0;
        for (size_t k = 0; k < nodes(); ++k)
            for (size_t c = unknowns; c < columns(); ++c) most = larger(most, std::fabs(twist_by(k)[c]));
        return most;
    }

    /// Broyden's update: of all rates with the least change that agree with what a step has shown. step: by column; change: by
    /// row.
    void learn(const std::vector<double>& step, const std::vector<double>& change) {
        const double weight = softest() * softest();
        double size = 0.0;
        for (size_t c = 0; c < columns(); ++c) size += step[c] * step[c] * (static_cast<int>(c) < unknowns ? 1.0 : weight);
        if (!(size > LEAST_STEP * LEAST_STEP)) return;
        for (size_t r = 0; r < rows(); ++r) {
            double* row = &rates[r * columns()];
            double left = change[r];
            for (size_t c = 0; c < columns(); ++c) left -= row[c] * step[c];
            left /= size;
            for (size_t c = 0; c < columns(); ++c) row[c] += left * step[c] * (static_cast<int>(c) < unknowns ? 1.0 : weight);
        }
    }

  private:
    static constexpr double LEAST_STEP = 1e-7;  // rad: rounding tells nothing
};

/// The model with the free end moved so that the base is met.
struct BaseMet {
    std::vector<double> compliance;  // d(twist)/d(torque), row-major
    std::vector<double> end_by;      // d(free end)/d(torque), unknowns rows
    std::vector<double> end;         // by how much the free end moves at these torques
    std::vector<double> turn;        // and the nodes turn by that
    double determinant = 0.0;        // of d(base)/d(free end)

    /// missed: at the base. False: the free end has no say there.
    bool from(const RubbingModel& model, const double* missed) {
        const int n = model.unknowns;
        const size_t count = model.nodes();
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS], inverse[MAX_UNKNOWNS][MAX_UNKNOWNS];
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) A[i][j] = model.missed_by(i)[j];
        determinant = n > 0 ? invert(n, A, inverse) : 1.0;
        if (determinant == 0.0) return false;
        end.assign(n, 0.0);
        end_by.assign(n * count, 0.0);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                end[i] -= inverse[i][j] * missed[j];
                for (size_t c = 0; c < count; ++c) end_by[i * count + c] -= inverse[i][j] * model.missed_by(j)[n + c];
            }
        compliance.resize(count * count);
        turn.assign(count, 0.0);
        for (size_t k = 0; k < count; ++k) {
            const double* row = model.twist_by(k);
            for (size_t c = 0; c < count; ++c) compliance[k * count + c] = row[n + c];
            for (int i = 0; i < n; ++i) {
                turn[k] += row[i] * end[i];
                for (size_t c = 0; c < count; ++c) compliance[k * count + c] += row[i] * end_by[i * count + c];
            }
        }
        return true;
    }
};

}  // namespace tactr
