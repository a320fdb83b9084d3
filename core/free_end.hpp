// The two-point boundary problem: which free-end unknowns there are, what they must meet at the base, and the pose of
// the tip in world axes.
//
// Without loads in world axes only the tubes' angles relative to the first tube matter; with them, R_b at the tip too.
#pragma once
#include <cmath>
#include <limits>
#include <type_traits>

#include "march.hpp"
#include "rotations.hpp"

namespace tactr {

template <class F>
bool with_lanes(int count, F&& f) {
    if (count <= 1) return f(std::integral_constant<int, 1>());
    if (count == 2) return f(std::integral_constant<int, 2>());
    if (count == 3) return f(std::integral_constant<int, 3>());
    if (count == 4) return f(std::integral_constant<int, 4>());
    if (count <= 6) return f(std::integral_constant<int, 6>());
    return f(std::integral_constant<int, 11>());
}

class Shooting {
  public:
    bool sums = false;   // whether the transverse resultants summed over the tubes can differ from zero
    bool world = false;  // any load in world axes
    bool loaded = false;
    int unknowns = 0;
    int tip_tube = 0;    // the innermost tube that reaches the distal end
    double error_weight[STATES];
    double moment_scale, force_scale;

    template <class P>
    Shooting(const Robot& robot, const Layout<P>& layout) : tubes_(robot.tube_count) {
        sums = tubes_ > 1;  // tubes that stretch differently exchange moment: Q' holds w x sum of eps_i N_i
        for (int l = 0; l < robot.point_load_count; ++l) note_load(robot.point_loads[l].body_axes);
        for (int l = 0; l < robot.distributed_load_count; ++l) note_load(robot.distributed_loads[l].body_axes);
        unknowns = tubes_ - 1 + (world ? 3 : 0);
        const Section<P>& last = layout.sections.back();
        tip_tube = last.active[last.active_count - 1];
        set_scales(robot, value(last.distal));
    }

    MarchOptions newton_options() const { return {sums, world, false}; }
    MarchOptions full_options() const { return {sums, true, true}; }

    template <class M>
    void scale(M& march) const {
        march.solver.moment_scale = moment_scale;
        march.solver.force_scale = force_scale;
    }

    /// Unknowns: psi of tubes 1..n-1, then the rotation of R_b about its own axes; unknown u sits in lane u - first.
    template <int K>
    void seed(const FreeEnd<double>& at, int first, FreeEnd<Dual<K>>& end) const {
        const auto lane = [first](int unknown) { return unknown >= first && unknown < first + K ? unknown - first : -1; };
        for (int i = 0; i < tubes_; ++i) {
            end.psi[i] = Dual<K>(at.psi[i]);
            if (i > 0 && lane(i - 1) >= 0) end.psi[i].d[lane(i - 1)] = 1.0;
        }
        for (int c = 0; c < 4; ++c) end.quaternion[c] = Dual<K>(at.quaternion[c]);
        if (!world) return;
        for (int axis = 0; axis < 3; ++axis) {
            const int l = lane(tubes_ - 1 + axis);
            if (l < 0) continue;
            double half[4] = {0, 0, 0, 0}, turned[4];
            half[1 + axis] = 0.5;
            multiply_quaternions(at.quaternion, half, turned);
            for (int c = 0; c < 4; ++c) end.quaternion[c].d[l] = turned[c];
        }
    }

    void move(const FreeEnd<double>& from, const double* step, double fraction, FreeEnd<double>& to) const {
        for (int i = 0; i < tubes_; ++i) to.psi[i] = from.psi[i] + (i > 0 ? fraction * step[i - 1] : 0.0);
        double q[4] = {from.quaternion[0], from.quaternion[1], from.quaternion[2], from.quaternion[3]};
        if (world) {
            double angle2 = 0.0, turn[4], v[3];
            for (int a = 0; a < 3; ++a) {
                v[a] = fraction * step[tubes_ - 1 + a];
                angle2 += v[a] * v[a];
            }
            const double angle = std::sqrt(angle2);
            const double f = angle > 1e-12 ? std::sin(0.5 * angle) / angle : 0.5;
            turn[0] = std::cos(0.5 * angle);
            for (int a = 0; a < 3; ++a) turn[1 + a] = f * v[a];
            multiply_quaternions(from.quaternion, turn, q);
        }
        double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int c = 0; c < 4; ++c) to.quaternion[c] = q[c] / norm;
    }

    /// The step that leads from a to b, in the unknowns.
    void difference(const FreeEnd<double>& a, const FreeEnd<double>& b, double* step) const {
        for (int i = 1; i < tubes_; ++i) step[i - 1] = b.psi[i] - a.psi[i];
        if (!world) return;
        const double conjugate[4] = {a.quaternion[0], -a.quaternion[1], -a.quaternion[2], -a.quaternion[3]};
        double q[4];
        multiply_quaternions(conjugate, b.quaternion, q);
        const double sign = q[0] < 0.0 ? -1.0 : 1.0;
        const double half = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        const double f = half > 1e-12 ? 2.0 * std::atan2(half, sign * q[0]) / half : 2.0;
        for (int c = 0; c < 3; ++c) step[tubes_ - 1 + c] = sign * f * q[1 + c];
    }

    double distance(const FreeEnd<double>& a, const FreeEnd<double>& b) const {
        double step[MAX_TUBES + 2], worst = 0.0;
        difference(a, b, step);
        for (int i = 0; i < unknowns; ++i) worst = larger(worst, std::fabs(step[i]));
        return worst;
    }

    /// Angles by which the base is missed. With world loads: tilt of d3 (2), then psi_i + turn of R_b - alpha_i.
    template <class T, class P>
    void residual(const BaseState<T>& base, const P* alpha, T* r) const {
        if (!world) {
            for (int i = 1; i < tubes_; ++i) r[i - 1] = (base.psi[i] - alpha[i]) - (base.psi[0] - alpha[0]);
            return;
        }
        const T &w = base.quaternion[0], &x = base.quaternion[1], &y = base.quaternion[2], &z = base.quaternion[3];
        const T m = square_root(w * w + z * z + 1e-300);
        const T tilt_x = (x * w - y * z) / m, tilt_y = (y * w + x * z) / m;
        const T half2 = tilt_x * tilt_x + tilt_y * tilt_y;
        T factor = T(2.0) / m;
        if (value(half2) > 1e-16) {
            const T half = square_root(half2);
            factor = arc_tangent2(half, m) * 2.0 / half;
        }
        r[0] = factor * tilt_x;
        r[1] = factor * tilt_y;
        const T turn = arc_tangent2(z, w) * 2.0;
        const double TURN = 6.283185307179586;
        const double whole = TURN * std::round(value(base.psi[0] + turn - alpha[0]) / TURN);
        for (int i = 0; i < tubes_; ++i) r[2 + i] = base.psi[i] + turn - alpha[i] - whole;
    }

    /// Turns R_b at the tip so that the base found stands upright, first tube at its rotation.
    template <class T, class P>
    void world_turn(const BaseState<T>& base, const P& alpha, T* q) const {
        T turn[4];
        turn_about_z(T(alpha - base.psi[0]), turn);
        const T conjugate[4] = {base.quaternion[0], -base.quaternion[1], -base.quaternion[2], -base.quaternion[3]};
        multiply_quaternions(turn, conjugate, q);
    }

    void upright(const BaseState<double>& base, double alpha, FreeEnd<double>& end) const {
        double q[4], turned[4];
        world_turn(base, alpha, q);
        multiply_quaternions(q, end.quaternion, turned);
        for (int c = 0; c < 4; ++c) end.quaternion[c] = turned[c];
    }

    /// Position of the distal end and orientation of the tube that reaches it, world axes.
    template <class T, class P>
    void tip_pose(const FreeEnd<T>& end, const BaseState<T>& base, const P& alpha, T* position, T* quaternion) const {
        T q[4], frame[4], own[4];
        world_turn(base, alpha, q);
        const T back[3] = {-base.position[0], -base.position[1], -base.position[2]};
        to_world(q, back, position);
        multiply_quaternions(q, end.quaternion, frame);
        turn_about_z(end.psi[tip_tube], own);
        multiply_quaternions(frame, own, quaternion);
    }

  private:
    int tubes_;

    void note_load(int body_axes) {
        sums = loaded = true;
        world = world || !body_axes;
    }

    /// The least of a quantity over a tube, as seen at both ends of its pieces.
    static double least(const Robot& robot, const Tube& tube, TubeQuantity quantity) {
        double found = std::numeric_limits<double>::max();
        for (int k = tube.piece_begin; k < tube.piece_end; ++k) {
            const TubePiece& piece = robot.pieces[k];
            const double d = (k + 1 < tube.piece_end ? robot.pieces[k + 1].start : tube.length) - piece.start;
            double end = 0.0;
            for (int c = piece.count - 1; c >= 0; --c) end = end * d + piece.c[c][quantity];
            found = smaller(found, smaller(end, piece.c[0][quantity]));
        }
        return found;
    }

    /// Moment that bends the softest tube by one radian over the robot's length, and the force that goes with it.
    void set_scales(const Robot& robot, double length) {
        double EI = std::numeric_limits<double>::max();
        for (int c = 0; c < STATES; ++c) error_weight[c] = 0.0;
        for (int i = 0; i < tubes_; ++i) {
            const Tube& tube = robot.tubes[i];
            EI = smaller(EI, smaller(least(robot, tube, EIX), least(robot, tube, EIY)));
            error_weight[PSI + i] = length;
            error_weight[N3 + i] = length / least(robot, tube, EA);
            error_weight[M3 + i] = length * length / least(robot, tube, GJ);
        }
        moment_scale = EI / length;
        force_scale = moment_scale / length;
        for (int c = 0; c < 2; ++c) {
            error_weight[SUM_N + c] = length * length * length / EI;
            error_weight[SUM_M + c] = length * length / EI;
        }
        for (int c = 0; c < 4; ++c) error_weight[QUAT + c] = 2.0 * length;
        for (int c = 0; c < 3; ++c) error_weight[POS + c] = 1.0;
    }
};

}  // namespace tactr
