// Exact derivatives of a converged solution: of the pose of the tip and of any station, and of the tendons' lengths, with
// respect to tensions, rotations, translations, a wrench in world axes at one place, and any constants of the robot.
#pragma once
#include <vector>

#include "robot_tables.hpp"
#include "solution.hpp"

namespace tactr {

struct SensitivityRequest {
    std::vector<double> stations;  // ascending s > 0, m
    bool lengths = false, actuators = true;
    double probe = -1.0;           // s of the wrench, m; at the distal end or beyond: the tip; < 0: no wrench
    std::vector<const RobotTables<double>*> rates;  // one for each parameter
};

/// Row-major. Columns: tensions, rotations, translations (where actuators are asked for), wrench (force, moment),
/// parameters. Rows: tip (position in m, small rotation in rad; world axes), the same for every station, lengths in m.
struct Sensitivities {
    int rows = 0, columns = 0;
    std::vector<double> matrix;
};

/// False: the solution is singular.
bool find_sensitivities(const RobotTables<double>& robot, const Solution& solution, const SensitivityRequest& request,
                        Sensitivities& out);

}  // namespace tactr
