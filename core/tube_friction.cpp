#include "tube_friction.hpp"

#include <algorithm>
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
          first_load_(static_cast<int>(robot.point_loads.size())),
          actuation_{empty.tension.data(), empty.rotation.data(), empty.translation.data(), 1.0, 1.0} {
        out_.robot = robot;
        for (const RubbingNode& node : nodes_)
            for (int tube : {node.inner, node.outer < 0 ? node.inner : node.outer})
                out_.robot.point_loads.push_back({tube, 1, node.s - empty.translation[tube], {}, {}});
        robot_ = out_.robot.view();
    }

    void run(const Solution* guess, const RubbingModel* model) {
        if (!(guess && model && follow(*guess, *model))) search(guess);
        if (!out_.settled) return;
        if (!surely_stable_) judge();
        out_.felt = model_.felt;
        out_.model = std::move(model_);
        out_.model.torque = out_.torque;
        out_.model.twist = out_.twist;
        out_.model.limit = out_.limit;
        remember();
    }

  private:
    /// Angles at which nodes hold, without a drift by rounding, and torque times slip: with the mean torque where a node slid
    /// on, otherwise that after, for it turns round before there is slip.
    void remember() {
        out_.heat.assign(robot_.tube_count, 0.0);
        for (size_t k = 0; k < count_; ++k) {
            const RubbingNode& node = nodes_[k];
            if (std::isnan(node.twist)) continue;
            if (out_.slides[k] == 0.0 && node.slide == 0.0 && out_.felt[k]) out_.twist[k] = node.twist;
            const bool slid_on = out_.slides[k] != 0.0 && out_.slides[k] == node.slid;
            out_.heat[node.inner] -= (slid_on ? 0.5 * (node.torque + out_.torque[k]) : out_.torque[k]) * (out_.twist[k] - node.twist);
        }
    }

    static constexpr int MOST_ITERATIONS = 60, MOST_ROUNDS = 16, MOST_LOOPS = 30, LANES = 11;
    static constexpr double LOOSER = 3.0;  // than what the base may miss: that leaves errors of this size
    static constexpr double SLOW = 0.3;    // of what was missing before: the compliance is another by now
    static constexpr double ROUGHLY = 3e-3;  // of what torques change, told by a model
    static constexpr double OLD = 0.5;     // rad, from where derivatives were found
    static constexpr double FAR = 0.3;     // rad: what leads there is no neighbour

    const std::vector<RubbingNode>& nodes_;
    const std::vector<char>& at_end_;
    const Settings& settings_;
    const Solution& empty_;
    FrictionStep& out_;
    const size_t count_;
    const int first_load_;
    const Actuation<double> actuation_;
    Robot robot_;
    RubbingModel model_;
    BaseMet met_;
    std::vector<double> limit_;  // that balance expects at the torques it finds
    std::vector<int> sides_;     // by node, of what it found: -1 or 1 where the torque is at its limit
    bool surely_stable_ = false;

    void start(const std::vector<double>& torque) {
        out_.torque = torque;
        out_.slides.assign(count_, 0.0);
        out_.limit.assign(count_, 0.0);
        out_.twist.assign(count_, 0.0);
        out_.pressing.assign(count_, 0.0);
    }

    void load() {
        for (size_t k = 0; k < count_; ++k) {
            out_.robot.point_loads[first_load_ + 2 * k].moment[2] = out_.torque[k];
            out_.robot.point_loads[first_load_ + 2 * k + 1].moment[2] = nodes_[k].outer < 0 ? 0.0 : -out_.torque[k];
        }
    }

    // --- an equilibrium for every iteration --------------------------------------------------------------------------

    void search(const Solution* guess) {
        std::vector<double> torque, none(MAX_UNKNOWNS, 0.0), next, step;
        for (const RubbingNode& node : nodes_) torque.push_back(node.torque);
        model_ = RubbingModel{};
        surely_stable_ = false;
        start(torque);
        double before = INFINITY;
        for (int iteration = 1; iteration <= MOST_ITERATIONS; ++iteration, ++out_.iterations) {
            if (!equilibrium(guess) || !read_nodes()) return;
            if (iteration == 1 && !find_model(out_.solution)) return;
            if (!balance(none.data(), next, step)) return;
            note_slides(next);
            out_.missing = turned_by(next);
            out_.settled = out_.missing <= settings_.residual_tolerance * LOOSER;
            if (out_.settled) return;
            if (out_.missing > SLOW * before && !find_model(out_.solution)) return;
            before = out_.missing;
            out_.torque = next;
            guess = &out_.solution;
        }
    }

    bool equilibrium(const Solution* guess) {
        load();
        Solution found = empty_;
        solve(robot_, actuation_, settings_, guess, found);
        out_.solution = std::move(found);
        return out_.solution.status == Status::converged;
    }

    /// Angles and limits at the equilibrium.
    bool read_nodes() {
        const Layout<double> layout = cut_into_sections(robot_, actuation_.translation);
        const Shooting shooting(robot_, layout);
        March<double, double> march(robot_, layout, actuation_, {true, true, false});
        shooting.scale(march);
        RubbingNodes<double> rubbing(nodes_, first_load_, 0);
        march.rubbing = &rubbing;
        PressingReader reader(robot_, layout, out_.solution);
        Mesh mesh = out_.solution.mesh;
        mesh.unknowns = 0;
        if (!march.run(out_.solution.free_end, mesh, reader) || reader.failed) return false;
        RubbedNodes rubbed(nodes_, first_load_);
        rubbed.take(rubbing, march.base, actuation_.rotation, 0);
        out_.twist = std::move(rubbed.twist);
        model_.felt = std::move(rubbed.felt);
        read_limits(layout, reader);
        return true;
    }

    void read_limits(const Layout<double>& layout, const PressingReader& reader) {
        out_.pressing.assign(count_, 0.0);
        Pressing(nodes_, at_end_, robot_, layout, reader).add_to(out_.pressing);
        for (size_t k = 0; k < count_; ++k) out_.limit[k] = nodes_[k].arm * out_.pressing[k];
    }

    // --- free end and torques at once, after a neighbour -------------------------------------------------------------

    /// A march for every round: it measures what the base misses, angles and limits.
    struct Follow {
        NewtonSolver newton;
        Solution near;
        RubbedNodes rubbed;
        PressingReader reader;
        std::vector<double> next, step;   // torques to go on with, and by how much free end and torques move

        explicit Follow(const FrictionStepper& owner)
            : newton(owner.robot_, owner.actuation_, owner.settings_), near(owner.empty_), rubbed(owner.nodes_, owner.first_load_),
              reader(owner.robot_, newton.layout, near) {
            newton.rubbed = &rubbed;
            newton.pressing = &reader;
            newton.watches_stability = newton.bounds_error = true;
        }
    };

    /// What the model of the neighbour tells is good for a step, and every step betters the model. Marches have derivatives by
    /// the free end where those of the model are old, or where errors and stability cannot be told without. False: not found
    /// near by.
    bool follow(const Solution& guess, const RubbingModel& from) {
        if (from.nodes() != count_) return false;
        Follow way(*this);
        NewtonSolver& newton = way.newton;
        if (newton.shooting.unknowns == 0 || !from.fits(newton.shooting.unknowns, count_)) return false;
        if (!newton.take_over(guess, way.near) && !newton.carry_over(guess, way.near, &guess.free_end)) return false;
        model_ = from;
        start(from.torque);
        out_.twist = from.twist;
        out_.limit = from.limit;
        newton.missed_at(guess, newton.residual);
        if (!balance(newton.residual, way.next, way.step)) return false;
        const bool only_turned = guess.translation == empty_.translation && guess.tension == empty_.tension && out_.robot.profiles.empty();
        bool learns = only_turned, renewed = false, drafts = newton.shooting.distance(from.drafted, guess.free_end) > OLD;
        drafts = drafts || way.near.mesh.unknowns == 0;  // a mesh that has no slopes yet
        double before = INFINITY;
        for (int round = 0; round < MOST_ROUNDS; ++round) {
            if (!measure(way, drafts, learns) || !balance(newton.residual, way.next, way.step)) return false;
            out_.missing = turned_by(way.next);
            double size = larger(newton.norm(way.step.data()), out_.missing);
            if (!(size < FAR)) return false;
            const bool met = way.near.base_residual <= settings_.residual_tolerance && out_.missing <= settings_.residual_tolerance * LOOSER;
            surely_stable_ = drafts ? newton.surely_stable : is_surely_stable();
            const bool told = newton.is_fine(way.near) && surely_stable_;
            if (met && (told || drafts)) return arrive(way);
            if (round > 2 && size > SLOW * before) {
                if (renewed || !find_model(way.near) || !balance(newton.residual, way.next, way.step)) return false;
                renewed = true;
                size = INFINITY;
            }
            before = size;
            drafts = !drafts && !told && size < Stride::CLOSE;
            learns = true;
        }
        return false;
    }

    bool is_surely_stable() const {
        constexpr double LEAST = 0.3, CHANGE = 1.5;
        return is_still_stable(met_.determinant, model_.proven, LEAST, CHANGE);
    }

    bool measure(Follow& way, bool drafts, bool learns) {
        std::vector<double> change = measured(way.newton);
        way.newton.shooting.move(FreeEnd<double>(way.near.free_end), way.step.data(), 1.0, way.near.free_end);
        out_.torque = way.next;
        load();
        ++out_.iterations;
        BaseState<double> base;
        if (drafts ? !way.newton.evaluate_finely(way.near, NewtonSolver::Kind::exact, FAR) : !way.newton.watch(way.near, way.reader, base))
            return false;
        if (way.reader.failed) return false;
        if (drafts) {
            model_.drafted = way.near.free_end;
            model_.proven = way.newton.surely_stable ? way.near.base_determinant : 0.0;
        }
        read_limits(way.newton.layout, way.reader);
        out_.twist = way.rubbed.twist;
        model_.felt = way.rubbed.felt;
        const std::vector<double> now = measured(way.newton);
        for (size_t r = 0; r < now.size(); ++r) change[r] = now[r] - change[r];
        if (learns) model_.learn(way.step, change);
        if (drafts) take_rates(way);
        return true;
    }

    /// What the base misses, angles and limits: the rows of the model.
    std::vector<double> measured(const NewtonSolver& newton) const {
        std::vector<double> out(newton.residual, newton.residual + model_.unknowns);
        out.insert(out.end(), out_.twist.begin(), out_.twist.end());
        out.insert(out.end(), out_.limit.begin(), out_.limit.end());
        return out;
    }

    /// By the free end, from the march with derivatives.
    void take_rates(const Follow& way) {
        const int n = model_.unknowns;
        for (int i = 0; i < n; ++i) std::copy(way.near.jacobian[i], way.near.jacobian[i] + n, model_.missed_by(i));
        for (size_t k = 0; k < count_; ++k) std::copy_n(&way.rubbed.rates[k * n], n, model_.twist_by(k));
    }

    bool arrive(Follow& way) {
        note_slides(way.next);
        way.near.base_determinant = met_.determinant;
        for (int i = 0; i < model_.unknowns; ++i) std::copy_n(model_.missed_by(i), model_.unknowns, way.near.jacobian[i]);
        out_.settled = NewtonSolver::succeed(way.near);
        way.newton.note_edges(way.near);
        out_.solution = std::move(way.near);
        return out_.settled;
    }

    // --- the linear model ---------------------------------------------------------------------------------------------

    /// One pass of Newton's derivatives, with the torques besides the free end.
    bool march_lanes(int first, const Layout<double>& layout, const Shooting& shooting, const Solution& at) {
        using D = Dual<LANES>;
        const int n = shooting.unknowns, inputs = n + static_cast<int>(count_);
        March<D, double> march(robot_, layout, actuation_, shooting.newton_options());
        shooting.scale(march);
        march.solver.precision = Precision::rough;  // it only leads there
        RubbingNodes<D> rubbing(nodes_, first_load_, n - first);
        march.rubbing = &rubbing;
        FreeEnd<D> end;
        shooting.seed(at.free_end, first, end);
        Mesh mesh = at.mesh;
        mesh.unknowns = 0;
        if (!march.run(end, mesh)) return false;
        D r[MAX_UNKNOWNS];
        shooting.residual(march.base, actuation_.rotation, r);
        for (int l = 0; l < LANES && first + l < inputs; ++l) {
            for (int i = 0; i < n; ++i) model_.missed_by(i)[first + l] = r[i].d[l];
            for (size_t k = 0; k < count_; ++k) {
                const double at_base = nodes_[k].outer < 0 ? march.base.psi[0].d[l] : 0.0;
                model_.twist_by(k)[first + l] = rubbing.twist[k].d[l] - at_base;
            }
        }
        return true;
    }

    /// Anew, at a shape with the torques as they are; the rates of the limits stay what they are.
    bool find_model(const Solution& at) {
        const Layout<double> layout = cut_into_sections(robot_, actuation_.translation);
        const Shooting shooting(robot_, layout);
        model_.unknowns = shooting.unknowns;
        model_.torque.resize(count_);
        model_.rates.resize(model_.rows() * model_.columns());
        for (int first = 0; first < static_cast<int>(model_.columns()); first += LANES)
            if (!march_lanes(first, layout, shooting, at)) return false;
        model_.drafted = at.free_end;
        return true;
    }

    /// Torques that hold, as far as the model tells, and the step of free end and torques (columns of the model) to them;
    /// limits follow the step, and a node that slides along as it turns gives way in the direction of both.
    bool balance(const double* missed, std::vector<double>& next, std::vector<double>& step) {
        if (!met_.from(model_, missed)) return false;
        const int n = model_.unknowns;
        limit_ = out_.limit;
        sides_.resize(count_, 0);
        next = out_.torque;
        step.assign(model_.columns(), 0.0);
        std::vector<double> slip(count_), turn = met_.turn, ahead = limit_;
        for (size_t k = 0; k < count_; ++k) slip[k] = is_known(k) ? out_.twist[k] - nodes_[k].twist : 0.0;
        const double softest = model_.softest();
        for (int loop = 0; loop < MOST_LOOPS; ++loop) {
            const std::vector<double> last = next;
            limit_ = ahead;
            for (size_t k = 0; k < count_; ++k)
                if (sides_[k] != 0) next[k] = sides_[k] * limit_[k];
            if (!solve_box(slip, turn, next)) return false;
            for (size_t k = 0; k < count_; ++k) sides_[k] = is_at_limit(k, next[k]) ? (next[k] > 0.0 ? 1 : -1) : 0;
            std::copy(met_.end.begin(), met_.end.end(), step.begin());
            for (size_t c = 0; c < count_; ++c) step[n + c] = next[c] - out_.torque[c];
            for (int i = 0; i < n; ++i)
                for (size_t c = 0; c < count_; ++c) step[i] += met_.end_by[i * count_ + c] * step[n + c];
            double moved = 0.0, most = 0.0;
            for (size_t k = 0; k < count_; ++k) {
                turn[k] = met_.turn[k];
                for (size_t c = 0; c < count_; ++c) turn[k] += met_.compliance[k * count_ + c] * step[n + c];
                double limit = out_.limit[k];
                for (size_t c = 0; c < step.size(); ++c) limit += model_.limit_by(k)[c] * step[c];
                ahead[k] = larger(0.5 * out_.limit[k], smaller(limit, 2.0 * out_.limit[k]));
                moved = larger(moved, std::fabs(next[k] - last[k]) * softest);
                most = larger(most, std::fabs(step[n + k]) * softest);
            }
            if (moved <= larger(0.1 * settings_.residual_tolerance, ROUGHLY * most)) break;
        }
        return true;
    }

    bool is_known(size_t k) const { return model_.felt[k] && !std::isnan(nodes_[k].twist); }

    /// turn: of the nodes on the way, which tells how those that slide along turn.
    bool solve_box(const std::vector<double>& slip, const std::vector<double>& turn, std::vector<double>& torque) const {
        std::vector<double> A = met_.compliance, b(count_), limit(count_);
        for (size_t k = 0; k < count_; ++k) {
            const RubbingNode& node = nodes_[k];
            limit[k] = is_known(k) ? limit_[k] : 0.0;
            b[k] = is_known(k) ? slip[k] + met_.turn[k] : 0.0;
            for (size_t c = 0; c < count_; ++c) b[k] -= met_.compliance[k * count_ + c] * out_.torque[c];
            if (node.slide != 0.0 && limit[k] > 0.0)
                A[k * count_ + k] += std::hypot(node.radius * (slip[k] + turn[k]), node.slide) / (limit[k] * node.radius);
        }
        return BoxProblem(A, b, limit).solve(torque);
    }

    void note_slides(const std::vector<double>& torque) {
        out_.slides.assign(count_, 0.0);
        for (size_t k = 0; k < count_; ++k)
            if (limit_[k] > 0.0 && is_at_limit(k, torque[k])) out_.slides[k] = torque[k] > 0.0 ? -1.0 : 1.0;
    }

    bool is_at_limit(size_t k, double torque) const { return std::fabs(torque) >= limit_[k] * (1.0 - 1e-12); }

    double turned_by(const std::vector<double>& next) const {
        double worst = 0.0;
        for (size_t k = 0; k < count_; ++k) {
            double turn = 0.0;
            for (size_t c = 0; c < count_; ++c) turn += met_.compliance[k * count_ + c] * (next[c] - out_.torque[c]);
            worst = larger(worst, std::fabs(turn));
        }
        return worst;
    }

    /// In how many directions the energy falls; where in any, the compliance is asked for.
    void judge() {
        StabilityReport report;
        const bool known = stability_of(robot_, out_.solution, 0, report);
        out_.falls = known ? report.conjugate_count : static_cast<int>(MAX_UNKNOWNS + count_);
        model_.proven = 0.0;
        if (out_.falls == 0) {
            model_.proven = met_.determinant;
            return;
        }
        const std::vector<double> none(MAX_UNKNOWNS, 0.0);
        if (find_model(out_.solution) && met_.from(model_, none.data())) out_.compliance = met_.compliance;
    }
};

}  // namespace

void friction_step(const RobotTables<double>& robot, const std::vector<RubbingNode>& nodes, const std::vector<char>& at_end,
                   const Settings& settings, const Solution& empty, const Solution* guess, const RubbingModel* model, FrictionStep& out) {
    FrictionStepper(robot, nodes, at_end, settings, empty, out).run(guess, model);
}

}  // namespace tactr
