// What a solve is asked and what it returns.
#pragma once
#include <limits>
#include <vector>

#include "states.hpp"

namespace tactr {

enum class Status { converged = 0, no_equilibrium = 1, stalled = 2, too_coarse = 3, collapsed = 4, too_sensitive = 5 };

/// What is known of a solution's stability: unchecked where a guess chose the branch.
enum class StabilityFound { unchecked = 0, stable = 1, unstable = 2 };

struct Settings {
    double tolerance = 1e-6;           // discretisation error at the tip and of tendons' lengths, m
    double residual_tolerance = 1e-9;  // rad at the base
    int fixed_steps = 0;               // > 0: steps in every section, without error control
    int max_iterations = 60;           // of one Newton run
    long max_steps = 48000;            // marched by one way from cold: about a second at most
    long most_work = 200000;           // steps marched in all by these ways and a search for a stable solution
    int patience = 12;                 // times max_steps for a search for any solution, where all ways have failed
    bool stay = false;                 // with a guess: its branch or none, never from cold
};

struct Solution {
    Status status = Status::stalled;
    int iterations = 0;  // marches with derivatives
    long steps_marched = 0;
    double base_residual = std::numeric_limits<double>::max();
    double section_residual = std::numeric_limits<double>::max();
    double discretisation_error = std::numeric_limits<double>::max();  // at the tip, m
    double length_error = std::numeric_limits<double>::max();          // of any tendon's length, m
    double least_stretch = 1.0;
    double shortest_tendon = 1.0;  // least |q| of the last marches; near 0: a tendon at the centre of curvature
    double amplification = 1.0;    // where the robot was grown: by how much the base answers the free end, at the last clamp
    double base_determinant = 0.0;  // of d(base)/d(free end)
    bool used_continuation = false;
    StabilityFound stability = StabilityFound::unchecked;
    bool switched = false;  // the cold start had found an unstable solution, this one was searched for
    double energy = 0.0;    // J, where it was needed to choose
    double jacobian[MAX_UNKNOWNS][MAX_UNKNOWNS] = {};  // d(base)/d(free end), last computed
    FreeEnd<double> free_end;
    Mesh mesh;
    std::vector<double> tension, rotation, translation, tendon_length;
    double tip_position[3] = {}, tip_quaternion[4] = {1, 0, 0, 0};
};

}  // namespace tactr
