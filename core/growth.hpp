// Grows the robot from its tip to its base, under all that acts on it: clamped first just before its end, then nearer and
// nearer to the base, where every robot starts from the free end of the one before.
//
// A change at the free end grows towards the base, as exp(s sqrt(F / EI)) under a pulling force F, so that a whole robot
// tells a good free end from a bad one only very close to the good one. What one more piece adds is an angle of the order of
// that piece's bend, however much stands before it. The robot grows along the loads' total force, which then pulls it
// straight and cannot buckle it; then the base is turned upright.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "newton.hpp"
#include "rotations.hpp"

namespace tactr {

/// A robot whose loads in world axes are given in the axes of a tilted base.
class TiltedBase {
  public:
    Robot robot;

    explicit TiltedBase(const Robot& upright)
        : robot(upright), points_(upright.point_loads, upright.point_loads + upright.point_load_count),
          distributed_(upright.distributed_loads, upright.distributed_loads + upright.distributed_load_count), upright_(upright) {
        double force[3] = {0.0, 0.0, 0.0};
        for (const PointLoad& load : points_) add(load, 1.0, force);
        for (const DistributedLoad& load : distributed_) add(load, load.end - load.start, force);
        const double across = std::hypot(force[0], force[1]);
        steepest = across == 0.0 && force[2] == 0.0 ? 0.0 : std::atan2(across, force[2]);
        axis_[0] = across > 0.0 ? -force[1] / across : 1.0;
        axis_[1] = across > 0.0 ? force[0] / across : 0.0;
        robot.point_loads = points_.data();
        robot.distributed_loads = distributed_.data();
    }

    TiltedBase(const TiltedBase&) = delete;
    TiltedBase& operator=(const TiltedBase&) = delete;

    double steepest;  // rad: the tilt at which the total force points along the base

    /// The base is tilted by an angle towards the total force; the free end stays where it is in space.
    void tilt(double angle, FreeEnd<double>& end) {
        double by[4], turned[4], q[4];
        quaternion(angle_ - angle, by);
        multiply_quaternions(by, end.quaternion, turned);
        std::copy(turned, turned + 4, end.quaternion);
        angle_ = angle;
        quaternion(angle, q);
        for (size_t l = 0; l < points_.size(); ++l) turn(q, upright_.point_loads[l], points_[l]);
        for (size_t l = 0; l < distributed_.size(); ++l) turn(q, upright_.distributed_loads[l], distributed_[l]);
    }

  private:
    std::vector<PointLoad> points_;
    std::vector<DistributedLoad> distributed_;
    const Robot& upright_;
    double axis_[2];
    double angle_ = 0.0;

    template <class Load>
    static void add(const Load& load, double length, double* force) {
        for (int a = 0; a < 3; ++a) force[a] += load.body_axes ? 0.0 : length * load.force[a];
    }

    template <class Load>
    static void turn(const double* q, const Load& upright, Load& load) {
        if (load.body_axes) return;
        to_frame(q, upright.force, load.force);
        to_frame(q, upright.moment, load.moment);
    }

    void quaternion(double angle, double* q) const {
        q[0] = std::cos(0.5 * angle);
        for (int a = 0; a < 2; ++a) q[1 + a] = std::sin(0.5 * angle) * axis_[a];
        q[3] = 0.0;
    }
};

class Growth {
  public:
    Growth(const NewtonSolver& whole, Solution& solution)
        : whole_(whole), solution_(solution), settings_(whole.settings), base_(whole.robot) {
        settings_.max_iterations = MOST_ITERATIONS;
    }

    /// Leaves free end and mesh of the whole robot in the solution. False: it was not grown to its base.
    bool reach() {
        whole_.start_straight(solution_);
        base_.tilt(base_.steepest, solution_.free_end);
        for (int c = 0; c < 4; ++c) solution_.free_end.quaternion[c] = c == 0;
        solution_.amplification = 1.0;
        solution_.mesh.cut(0, 1);
        return grow() && stand_up();
    }

  private:
    static constexpr double FIRST_PIECE = 0.05, LEAST_PIECE = 1e-4;  // of the robot's length
    static constexpr double FIRST_TURN = 0.3, LEAST_TURN = 1e-4;     // rad
    static constexpr int MOST_ITERATIONS = 12, QUICK = 6, MOST_MARCHES = 20;
    static constexpr double ON_CURVE = 1e-4;    // rad
    static constexpr double NEIGHBOUR = 1.0;    // rad: a free end further away is another branch
    static constexpr double FINEST = 1e-10;     // m: below, error estimates are rounding

    const NewtonSolver& whole_;
    Solution& solution_;
    Settings settings_;
    TiltedBase base_;
    int iterations_ = 0;  // of the last Newton run
    bool quick_ = true;   // the last piece or turn

    bool may_go_on() const { return solution_.steps_marched < whole_.settings.max_steps; }

    /// What the next piece or turn is of the last one: longer after two quick ones.
    double pace(bool stood) {
        const double factor = !stood ? 0.4 : quick_ && iterations_ <= QUICK ? 1.6 : 1.0;
        quick_ = stood && iterations_ <= QUICK;
        return factor;
    }

    bool grow() {
        const double tip = whole_.layout.sections.back().distal, base = whole_.layout.sections.front().proximal;
        double clamp = tip, piece = FIRST_PIECE * (tip - base), wound[MAX_TUBES] = {};
        while (clamp > base && piece > LEAST_PIECE * (tip - base) && may_go_on()) {
            const double next = clamp - piece > base + 0.1 * piece ? clamp - piece : base;
            const FreeEnd<double> before = solution_.free_end;
            for (int i = 0; i < whole_.robot.tube_count; ++i) solution_.free_end.psi[i] += wound[i] * (clamp - next);
            if (stands(next)) {
                for (int i = 0; i < whole_.robot.tube_count; ++i)
                    wound[i] = (solution_.free_end.psi[i] - before.psi[i]) / (clamp - next);
                clamp = next;
                piece *= pace(true);
            } else {
                solution_.free_end = before;
                piece *= pace(false);
            }
        }
        return clamp <= base;
    }

    bool stand_up() {
        double angle = base_.steepest, turn = FIRST_TURN;
        const double base = whole_.layout.sections.front().proximal;
        while (angle > 0.0 && turn > LEAST_TURN && may_go_on()) {
            const double next = larger(0.0, angle - turn);
            const FreeEnd<double> before = solution_.free_end;
            base_.tilt(next, solution_.free_end);
            if (stands(base)) {
                angle = next;
                turn *= pace(true);
            } else {
                base_.tilt(angle, solution_.free_end);
                solution_.free_end = before;
                turn *= pace(false);
            }
        }
        return angle <= 0.0;
    }

    /// Newton with the robot clamped there. Steps must be so fine that their error, as amplified, does not matter.
    bool stands(double clamp) {
        settings_.tolerance = larger(FINEST, whole_.settings.tolerance / solution_.amplification);
        settings_.max_steps = solution_.steps_marched + MOST_MARCHES * (solution_.mesh.total() + 8L);
        NewtonSolver part(base_.robot, whole_.actuation, settings_, clamp);
        const FreeEnd<double> from = solution_.free_end;
        const std::vector<int> steps = solution_.mesh.steps;
        const std::vector<double> grade = solution_.mesh.grade;
        const int before = solution_.iterations;
        extend(solution_.mesh, part.layout.sections.size());
        const bool found = part.add_steps(solution_) && part.newton(solution_, ON_CURVE, NewtonSolver::Kind::rough) &&
                           part.shooting.distance(from, solution_.free_end) < NEIGHBOUR;
        iterations_ = solution_.iterations - before;
        if (found) {
            solution_.amplification = amplification(part.shooting.unknowns);
        } else {
            solution_.mesh.steps = steps;
            solution_.mesh.grade = grade;
        }
        return found;
    }

    /// Steps stay as they are where the robot stood already.
    static void extend(Mesh& mesh, size_t sections) {
        const size_t more = sections - mesh.steps.size();
        mesh.steps.insert(mesh.steps.begin(), more, 1);
        mesh.grade.insert(mesh.grade.begin(), more, 1.0);
        mesh.fit();
    }

    double amplification(int unknowns) const {
        double most = 1.0;
        for (int i = 0; i < unknowns; ++i)
            for (int j = 0; j < unknowns; ++j) most = larger(most, std::fabs(solution_.jacobian[i][j]));
        return most;
    }
};

}  // namespace tactr
