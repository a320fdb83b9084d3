#include "tube_friction.hpp"

#include <cmath>
#include <cstddef>

#include "box_problem.hpp"
#include "friction_pressing.hpp"
#include "newton.hpp"
#include "solve.hpp"

namespace tactr {

namespace {

class FrictionStepper {
  public:
    FrictionStepper(const RobotTables<double>& robot, const std::vector<RubbingNode>& nodes, const std::vector<char>& at_end,
                    const Settings& settings, const Solution& empty, FrictionStep& out)
        : nodes_(nodes), at_end_(at_end), settings_(settings), empty_(empty), out_(out), count_(nodes.size()),
          first_load_(static_cast<int>(robot.point_loads.size())) {
        out_.robot = robot;
        out_.torque.resize(count_);
        out_.slides.assign(count_, 0.0);
        out_.limit.assign(count_, 0.0);
        out_.twist.assign(count_, 0.0);
        out_.pressing.assign(count_, 0.0);
        out_.compliance.assign(count_ * count_, 0.0);
        for (size_t k = 0; k < count_; ++k) {
            const RubbingNode& node = nodes_[k];
            out_.torque[k] = node.torque;
            for (int tube : {node.inner, node.outer < 0 ? node.inner : node.outer})
                out_.robot.point_loads.push_back({tube, 1, node.s - empty.translation[tube], {}, {}});
        }
    }

    void run(const Solution* guess) {
        double before = INFINITY;
        for (out_.iterations = 1; out_.iterations <= MOST_ITERATIONS; ++out_.iterations) {
            if (!equilibrium(guess) || !read_nodes()) return;
            if (out_.iterations == 1 && !find_compliance()) return;
            std::vector<double> next = out_.torque;
            if (!balance(next)) return;
            note_slides(next);
            out_.missing = turned_by(next);
            out_.settled = out_.missing <= settings_.residual_tolerance * LOOSER;
            if (out_.settled) return;
            if (out_.missing > SLOW * before && !find_compliance()) return;
            before = out_.missing;
            out_.torque = next;
            guess = &out_.solution;
        }
    }

  private:
    static constexpr int MOST_ITERATIONS = 60, LANES = 11;
    static constexpr double LOOSER = 3.0;  // than what the base may miss: that leaves errors of this size
    static constexpr double SLOW = 0.3;    // of what was missing before: the compliance is another by now

    const std::vector<RubbingNode>& nodes_;
    const std::vector<char>& at_end_;
    const Settings& settings_;
    const Solution& empty_;
    FrictionStep& out_;
    const size_t count_;
    const int first_load_;
    std::vector<char> felt_;

    Actuation<double> actuation() const {
        return {empty_.tension.data(), empty_.rotation.data(), empty_.translation.data(), 1.0, 1.0};
    }

    bool equilibrium(const Solution* guess) {
        for (size_t k = 0; k < count_; ++k) {
            out_.robot.point_loads[first_load_ + 2 * k].moment[2] = out_.torque[k];
            out_.robot.point_loads[first_load_ + 2 * k + 1].moment[2] = nodes_[k].outer < 0 ? 0.0 : -out_.torque[k];
        }
        Solution found = empty_;
        solve(out_.robot.view(), actuation(), settings_, guess, found);
        out_.solution = std::move(found);
        return out_.solution.status == Status::converged;
    }

    /// Angles and limits at the equilibrium.
    bool read_nodes() {
        const Robot robot = out_.robot.view();
        const Actuation<double> at = actuation();
        const Layout<double> layout = cut_into_sections(robot, at.translation);
        const Shooting shooting(robot, layout);
        March<double, double> march(robot, layout, at, {true, true, false});
        shooting.scale(march);
        RubbingNodes<double> rubbing(nodes_, first_load_, 0);
        march.rubbing = &rubbing;
        PressingReader reader(robot, layout, out_.solution);
        Mesh mesh = out_.solution.mesh;
        mesh.unknowns = 0;
        if (!march.run(out_.solution.free_end, mesh, reader) || reader.failed) return false;
        out_.twist = rubbing.twist;
        felt_ = rubbing.felt;
        for (size_t k = 0; k < count_; ++k) {
            if (nodes_[k].outer < 0) out_.twist[k] += at.rotation[0] - march.base.psi[0];
            else if (!felt_[k]) out_.twist[k] = march.base.psi[nodes_[k].inner] - march.base.psi[nodes_[k].outer];
        }
        out_.pressing.assign(count_, 0.0);
        Pressing(nodes_, at_end_, robot, layout, reader).add_to(out_.pressing);
        out_.limit.resize(count_);
        for (size_t k = 0; k < count_; ++k) out_.limit[k] = nodes_[k].arm * out_.pressing[k];
        return true;
    }

    /// One pass of Newton's derivatives, with the torques besides the free end.
    bool march_lanes(int first, const Layout<double>& layout, const Shooting& shooting, std::vector<double>& missed,
                     std::vector<double>& turned) const {
        using D = Dual<LANES>;
        const Robot robot = out_.robot.view();
        const Actuation<double> at = actuation();
        const int n = shooting.unknowns, inputs = n + static_cast<int>(count_);
        March<D, double> march(robot, layout, at, shooting.newton_options());
        shooting.scale(march);
        march.solver.precision = Precision::rough;  // it only leads there
        RubbingNodes<D> rubbing(nodes_, first_load_, n - first);
        march.rubbing = &rubbing;
        FreeEnd<D> end;
        shooting.seed(out_.solution.free_end, first, end);
        Mesh mesh = out_.solution.mesh;
        mesh.unknowns = 0;
        if (!march.run(end, mesh)) return false;
        D r[MAX_UNKNOWNS];
        shooting.residual(march.base, at.rotation, r);
        for (int l = 0; l < LANES && first + l < inputs; ++l) {
            for (int i = 0; i < n; ++i) missed[static_cast<size_t>(i) * inputs + first + l] = r[i].d[l];
            for (size_t k = 0; k < count_; ++k) {
                const double at_base = nodes_[k].outer < 0 ? march.base.psi[0].d[l] : 0.0;
                turned[k * inputs + first + l] = rubbing.twist[k].d[l] - at_base;
            }
        }
        return true;
    }

    bool find_compliance() {
        const Robot robot = out_.robot.view();
        const Layout<double> layout = cut_into_sections(robot, empty_.translation.data());
        const Shooting shooting(robot, layout);
        const int n = shooting.unknowns, inputs = n + static_cast<int>(count_);
        std::vector<double> missed(static_cast<size_t>(n) * inputs), turned(count_ * inputs);
        for (int first = 0; first < inputs; first += LANES)
            if (!march_lanes(first, layout, shooting, missed, turned)) return false;
        double A[MAX_UNKNOWNS][MAX_UNKNOWNS], inverse[MAX_UNKNOWNS][MAX_UNKNOWNS];
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) A[i][j] = missed[static_cast<size_t>(i) * inputs + j];
        if (n > 0 && invert(n, A, inverse) == 0.0) return false;
        out_.compliance.assign(count_ * count_, 0.0);
        for (size_t c = 0; c < count_; ++c) {
            double moved[MAX_UNKNOWNS];  // the free end, so that the base is met
            for (int i = 0; i < n; ++i) {
                moved[i] = 0.0;
                for (int j = 0; j < n; ++j) moved[i] -= inverse[i][j] * missed[static_cast<size_t>(j) * inputs + n + c];
            }
            for (size_t k = 0; k < count_; ++k) {
                double sum = turned[k * inputs + n + c];
                for (int i = 0; i < n; ++i) sum += turned[k * inputs + i] * moved[i];
                out_.compliance[k * count_ + c] = sum;
            }
        }
        return true;
    }

    /// Torques that hold, as far as the compliance tells; a node that slides along as it turns gives way in the direction
    /// of both.
    bool balance(std::vector<double>& torque) const {
        std::vector<double> A = out_.compliance, b(count_), limit(count_);
        for (size_t k = 0; k < count_; ++k) {
            const RubbingNode& node = nodes_[k];
            const bool known = felt_[k] && !std::isnan(node.twist);
            limit[k] = known ? out_.limit[k] : 0.0;
            const double slip = known ? out_.twist[k] - node.twist : 0.0;
            b[k] = slip;
            for (size_t c = 0; c < count_; ++c) b[k] -= out_.compliance[k * count_ + c] * out_.torque[c];
            if (node.slide != 0.0 && limit[k] > 0.0)
                A[k * count_ + k] += std::hypot(node.radius * slip, node.slide) / (limit[k] * node.radius);
        }
        return BoxProblem(A, b, limit).solve(torque);
    }

    void note_slides(const std::vector<double>& torque) {
        out_.slides.assign(count_, 0.0);
        for (size_t k = 0; k < count_; ++k)
            if (out_.limit[k] > 0.0 && std::fabs(torque[k]) >= out_.limit[k] * (1.0 - 1e-12)) out_.slides[k] = torque[k] > 0.0 ? -1.0 : 1.0;
    }

    double turned_by(const std::vector<double>& next) const {
        double worst = 0.0;
        for (size_t k = 0; k < count_; ++k) {
            double turn = 0.0;
            for (size_t c = 0; c < count_; ++c) turn += out_.compliance[k * count_ + c] * (next[c] - out_.torque[c]);
            worst = larger(worst, std::fabs(turn));
        }
        return worst;
    }
};

}  // namespace

void friction_step(const RobotTables<double>& robot, const std::vector<RubbingNode>& nodes, const std::vector<char>& at_end,
                   const Settings& settings, const Solution& empty, const Solution* guess, FrictionStep& out) {
    FrictionStepper(robot, nodes, at_end, settings, empty, out).run(guess);
}

}  // namespace tactr
