// Stability of a solution: the Jacobi field from the free end to the base in one march with derivatives.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "conjugate.hpp"
#include "dense_output.hpp"
#include "free_end.hpp"
#include "march.hpp"
#include "solution.hpp"
#include "stability_report.hpp"

namespace tactr {

/// Watches a march whose first lanes are the free-end unknowns. samples: per step, 0 for the ends of the steps only.
template <int K>
class JacobiObserver {
  public:
    using T = Dual<K>;
    std::vector<double> section_error;  // estimated, of D, relative
    bool failed = false;

    JacobiObserver(const Layout<double>& layout, const Shooting& shooting, const FreeEnd<T>& end, int tubes, int samples,
                   StabilityReport& report)
        : section_error(layout.sections.size(), 0.0), layout_(layout), n_(shooting.unknowns), tubes_(tubes),
          reference_(shooting.tip_tube), world_(shooting.world), samples_(samples), report_(report), counter_(n_) {
        for (int i = 0; i < tubes_; ++i) psi_[i] = end.psi[i];
        for (int c = 0; c < 4; ++c) quaternion_[c] = end.quaternion[c];
        Field tip;
        assemble(tip);
        counter_.move_to(tip);
        orientation_ = raw_determinant(tip);
    }

    template <class M>
    void operator()(M& march, int k, const T* before, double s, double h) {
        const Section<double>& section = layout_.sections[k];
        section_error[k] += lane_error(march, h);
        Field field;
        if (samples_ > 0) {
            if (!dense_.prepare(march, section, before, s, h)) {
                failed = true;
                return;
            }
            T packed[STATES];
            for (int i = 1; i < samples_; ++i) {
                const double x = static_cast<double>(i) / samples_;
                dense_.at(x, packed);
                read(march.packing, section, packed, field);
                note(march.packing, section, field, x, s, h, false);
            }
        }
        read(march.packing, section, march.z, field);
        const bool base = s + h <= layout_.sections.front().proximal + BREAKPOINT_GAP;
        const bool springs = pass_springs(march, section, s + h);
        note(march.packing, section, field, 1.0, s, h, base && !springs);
        if (!springs) return;
        assemble(field);
        note(march.packing, section, field, 1.0, s, h, base);
        read(march.packing, section, march.z, field);  // the note may have looked elsewhere
        pass_springs(march, section, s + h);
    }

  private:
    const Layout<double>& layout_;
    const int n_, tubes_, reference_;
    const bool world_;
    const int samples_;
    StabilityReport& report_;
    ConjugateCounter counter_;
    DenseOutput<T> dense_;
    T psi_[MAX_TUBES], quaternion_[4];  // seeds of tubes still to come; where a tube was clamped, the last value stays
    double orientation_ = 1.0;          // of the rows of D: its determinant at the tip, 1 or -1
    double last_ = 0.0;                 // fraction of the step at the last sample

    /// D: the angles from the reference tube; with loads in world axes also the rotation of that tube's frame, in axes
    /// fixed in space: in axes that turn along the robot, D_k+1 D_k^-1 would hold their turn. Tubes that are not there
    /// yet bring in their unknown as it is.
    void read(const Packing& packing, const Section<double>& section, const T* packed, Field& field) {
        for (int a = 0; a < section.active_count; ++a) psi_[section.active[a]] = packed[3 * a];
        if (world_ && packing.frame >= 0)
            for (int c = 0; c < 4; ++c) quaternion_[c] = packed[packing.frame + c];
        assemble(field);
    }

    void assemble(Field& field) const {
        for (int i = 0, row = 0; i < tubes_; ++i) {
            if (i == reference_) continue;
            for (int l = 0; l < n_; ++l) field.D[row][l] = psi_[i].d[l] - psi_[reference_].d[l];
            ++row;
        }
        if (!world_) return;
        const T* q = quaternion_;
        const double w = q[0].v, x = q[1].v, y = q[2].v, z = q[3].v, f = 2.0 / (w * w + x * x + y * y + z * z);
        const double unit[4] = {w, x, y, z};
        for (int l = 0; l < n_; ++l) {
            const double dw = q[0].d[l], dx = q[1].d[l], dy = q[2].d[l], dz = q[3].d[l];
            const double turn[3] = {f * (w * dx - x * dw - y * dz + z * dy), f * (w * dy + x * dz - y * dw - z * dx),
                                    f * (w * dz - x * dy + y * dx - z * dw) + psi_[reference_].d[l]};
            double fixed[3];
            to_world(unit, turn, fixed);
            for (int r = 0; r < 3; ++r) field.D[tubes_ - 1 + r][l] = fixed[r];
        }
    }

    /// Springs that turn tubes whose proximal end is at s are a last stretch of them. False: there are none.
    template <class M>
    bool pass_springs(const M& march, const Section<double>& section, double s) {
        bool any = false;
        for (int a = 0; a < section.active_count; ++a) {
            const int i = section.active[a];
            const double compliance = march.robot.tubes[i].rotation_compliance;
            if (!(compliance > 0.0) || std::fabs(s - march.actuation.translation[i]) > BREAKPOINT_GAP) continue;
            psi_[i] -= march.z[3 * a + 2] * compliance;
            any = true;
        }
        return any;
    }

    void note(const Packing& packing, const Section<double>& section, const Field& field, double x, double s, double h, bool base) {
        const double determinant = raw_determinant(field) / orientation_;
        report_.margin = std::min(report_.margin, determinant);
        if (samples_ > 0) {
            report_.s.push_back(s + h * x);
            report_.determinant.push_back(determinant);
        }
        if (base || !counter_.is_ambiguous(field)) {
            const int count = counter_.between(field, base ? ConjugateCounter::NEUTRAL : 0.0);
            if (samples_ > 0)
                for (int number = 1; number <= count; ++number)
                    report_.conjugate.push_back(s + h * locate(packing, section, number, last_, x));
            report_.conjugate_count += count;
            counter_.move_to(field);
        }
        last_ = x < 1.0 ? x : 0.0;
    }

    double raw_determinant(const Field& field) const {
        Field inverse;
        return invert(n_, field.D, inverse.D);
    }

    /// Fraction of the step at which as many conjugate points have been passed since the last sample, by bisection.
    double locate(const Packing& packing, const Section<double>& section, int number, double low, double high) {
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (low + high);
            T packed[STATES];
            Field field;
            dense_.at(middle, packed);
            read(packing, section, packed, field);
            (counter_.between(field) >= number ? high : low) = middle;
        }
        return high;
    }

    /// The march's error estimate, for the derivatives of the angles and of R_b; of a whole D when it grows beyond I.
    template <class M>
    double lane_error(const M& march, double h) const {
        double worst = 0.0;
        for (int n = 0; n < march.packing.count; ++n) {
            const int state = march.packing.index[n];
            const bool turns = state < N3 || (state >= QUAT && state < POS);
            if (!turns) continue;
            for (int l = 0; l < n_; ++l) {
                double e5 = 0.0, e3 = 0.0;
                for (int j = 0; j < dp8::STAGES; ++j) {
                    e5 += dp8::E5[j] * march.k[j][n].d[l];
                    e3 += dp8::E3[j] * march.k[j][n].d[l];
                }
                const double size = std::sqrt(e5 * e5 + 0.01 * e3 * e3);
                const double scale = 1.0 + std::fabs(march.z[n].d[l]);
                if (size > 0.0) worst = larger(worst, std::fabs(h) * e5 * e5 / size / scale);
            }
        }
        return worst;
    }
};

class StabilityPass {
  public:
    static constexpr double ROUGH_TOLERANCE = 1e-3;  // of the field: enough to count conjugate points, but at the limit itself

    StabilityPass(const Robot& robot, const Actuation<double>& actuation, const Layout<double>& layout, const Shooting& shooting)
        : robot_(robot), actuation_(actuation), layout_(layout), shooting_(shooting) {}

    /// Whether a converged solution is stable. samples as in JacobiObserver. False: D could not be found.
    bool run(const Solution& solution, int samples, StabilityReport& report) {
        if (shooting_.unknowns == 0) return without_unknowns(report);
        Mesh mesh = solution.mesh;
        mesh.unknowns = 0;
        return with_lanes(shooting_.unknowns, [&](auto lanes) {
            for (int round = 0; round < ROUNDS; ++round) {
                report = StabilityReport{};
                if (!march<decltype(lanes)::value>(solution.free_end, mesh, samples, report)) return false;
                if (!refine(mesh, samples > 0 ? FIELD_TOLERANCE : ROUGH_TOLERANCE)) return true;
            }
            return true;
        });
    }

  private:
    static constexpr int ROUNDS = 8;
    static constexpr double FIELD_TOLERANCE = 1e-5;  // relative error of D in a section: where det D = 0 to 1e-5
    const Robot& robot_;
    const Actuation<double>& actuation_;
    const Layout<double>& layout_;
    const Shooting& shooting_;
    std::vector<double> error_;

    bool without_unknowns(StabilityReport& report) const {
        report = StabilityReport{};
        report.s = {layout_.sections.front().proximal, layout_.sections.back().distal};
        report.determinant = {1.0, 1.0};
        return true;
    }

    template <int K>
    bool march(const FreeEnd<double>& at, Mesh& mesh, int samples, StabilityReport& report) {
        March<Dual<K>, double> march(robot_, layout_, actuation_, shooting_.newton_options());
        shooting_.scale(march);
        FreeEnd<Dual<K>> end;
        shooting_.seed(at, 0, end);
        JacobiObserver<K> observer(layout_, shooting_, end, robot_.tube_count, samples, report);
        if (samples > 0) {
            report.s.push_back(layout_.sections.back().distal);
            report.determinant.push_back(1.0);
        }
        if (!march.run(end, mesh, observer) || observer.failed) return false;
        error_ = observer.section_error;
        finish(report);
        return true;
    }

    static void finish(StabilityReport& report) {
        report.stable = report.conjugate_count == 0;
        report.margin = report.stable ? larger(report.margin, 0.0) : smaller(report.margin, 0.0);
        std::reverse(report.s.begin(), report.s.end());
        std::reverse(report.determinant.begin(), report.determinant.end());
        std::reverse(report.conjugate.begin(), report.conjugate.end());
    }

    /// More steps where the field, which the mesh was not made for, needs them. A straight rod under load is exact in
    /// one step, its field is not.
    bool refine(Mesh& mesh, double tolerance) const {
        bool finer = false;
        for (size_t k = 0; k < error_.size(); ++k)
            if (error_[k] > tolerance && mesh.steps[k] < March<double, double>::MAX_STEPS) {
                mesh.grade.resize(error_.size(), 1.0);
                mesh.grade[k] = std::sqrt(mesh.grade[k]);
                mesh.steps[k] *= 2;
                finer = true;
            }
        if (finer) mesh.fit();
        return finer;
    }
};

}  // namespace tactr
