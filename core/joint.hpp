// Newton on free end and tensions together, as where tendons are pulled by displacements: one march of it.
//
// At held tensions a branch may end at a fold that it passes smoothly at held displacements; there the free end is no
// function of the tensions, but both still are of the displacements.
#pragma once
#include <vector>

#include "robot.hpp"
#include "solution.hpp"

namespace tactr {

/// missed (n): residual at the base, n free-end unknowns. matrix: d(missed, lengths)/d(free end, tensions), (n + m) squared,
/// rows in turn; m tendons.
struct JointMarch {
    std::vector<double> missed, matrix;
};

/// Marches from the solution's free end, moved by a step in its unknowns, at the solution's actuation. The solution takes
/// the free end, the mesh's strains, the derivatives at the base and the tendons' lengths. False: a section had no
/// equilibrium.
bool joint_march(const Robot& robot, const std::vector<double>& step, const Settings& settings, Solution& solution, JointMarch& out);

}  // namespace tactr
