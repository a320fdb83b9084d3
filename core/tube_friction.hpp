// One quasi-static step of Coulomb friction between tubes that turn in each other and in the guide.
//
// Every node bears a torque G between two neighbours, |G| <= coefficient x radius x contact force. Where it is less the two
// do not turn on each other; where they do it is at its limit, against the slip. Torques and contact forces belong to the
// same equilibrium: both are found together, by iteration.
#pragma once
#include <vector>

#include "robot_tables.hpp"
#include "rubbing_model.hpp"
#include "rubbing_nodes.hpp"
#include "solution.hpp"

namespace tactr {

struct FrictionStep {
    RobotTables<double> robot;        // with the torques as its last point loads
    Solution solution;
    std::vector<double> torque, twist, limit, pressing;  // by node; twist: at which it holds; pressing: contact force, N
    std::vector<double> slides;       // by node: -1 or 1 where the inner tube turns on the outer one, against the torque; 0: it holds
    std::vector<char> felt;           // by node: as of RubbingNodes
    std::vector<double> heat;         // J, by inner tube, since the nodes' angles before
    RubbingModel model;               // for the next step: it may be an old one, which costs iterations and nothing else
    int falls = 0;                    // directions of falling energy at these torques
    std::vector<double> compliance;   // d(twist)/d(torque) there, row-major, where the energy falls in any
    int iterations = 0;
    double missing = 0.0;             // rad, by which the last iteration would still have turned a node
    bool settled = false;
};

/// nodes: those of a pair side by side, by ascending s, the torques and angles before the step. at_end: by node, whether it
/// stands at an end of the pair's overlap. model: at the guess, where there is one.
void friction_step(const RobotTables<double>& robot, const std::vector<RubbingNode>& nodes, const std::vector<char>& at_end,
                   const Settings& settings, const Solution& empty, const Solution* guess, const RubbingModel* model, FrictionStep& out);

}  // namespace tactr
