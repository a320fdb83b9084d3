// Places over the whole bounded set of the free-end unknowns: grids of angles, and low-discrepancy points in angles and
// rotations.
#pragma once
#include <cmath>

#include "free_end.hpp"
#include "sections.hpp"
#include "solution.hpp"

namespace tactr {

constexpr double FULL_TURN = 6.283185307179586;

/// Point number k of the additive recurrence with the generalised golden ratio (M. Roberts, 2018), in [0, 1)^d.
inline void low_discrepancy(int k, int d, double* point) {
    double ratio = 1.5;
    for (int i = 0; i < 40; ++i) ratio = std::pow(1.0 + ratio, 1.0 / (d + 1));
    double step = 1.0;
    for (int i = 0; i < d; ++i) {
        step /= ratio;
        const double x = 0.5 + (k + 1) * step;
        point[i] = x - std::floor(x);
    }
}

/// Uniform rotations from three uniform numbers (K. Shoemake, Graphics Gems III, 1992).
inline void uniform_rotation(const double* u, double* q) {
    const double a = std::sqrt(1.0 - u[0]), b = std::sqrt(u[0]);
    sine_cosine(FULL_TURN * u[1], q[1], q[2]);
    sine_cosine(FULL_TURN * u[2], q[3], q[0]);
    q[1] *= a;
    q[2] *= a;
    q[3] *= b;
    q[0] *= b;
}

/// Free end number k: the first tube's angle as in like, the others' and, where it counts, R_b anywhere.
inline FreeEnd<double> scattered_start(const FreeEnd<double>& like, int tubes, bool world, int k) {
    double u[MAX_UNKNOWNS];
    low_discrepancy(k, tubes - 1 + (world ? 3 : 0), u);
    FreeEnd<double> end = like;
    for (int i = 1; i < tubes; ++i) end.psi[i] = like.psi[0] + FULL_TURN * u[i - 1];
    if (world) uniform_rotation(u + tubes - 1, end.quaternion);
    return end;
}

/// Largest angle between the free ends of two solutions of one robot: tubes from the first tube, and the first tube's
/// frame in space where loads in world axes make it count. The angle of R_b itself is a matter of convention.
inline double free_end_distance(const Robot& robot, const Solution& a, const Solution& b) {
    const Shooting shooting(robot, cut_into_sections(robot, a.translation.data()));
    const auto from_first_tube = [&](const FreeEnd<double>& end) {
        FreeEnd<double> turned = end;
        double turn[4];
        turn_about_z(end.psi[0], turn);
        multiply_quaternions(end.quaternion, turn, turned.quaternion);
        for (int i = 0; i < robot.tube_count; ++i) turned.psi[i] = end.psi[i] - end.psi[0];
        return turned;
    };
    return shooting.distance(from_first_tube(a.free_end), from_first_tube(b.free_end));
}

}  // namespace tactr
