// Where neighbouring tubes rub: their friction torques are point loads, the last ones of the robot, two for every node,
// on the inner tube and then on the outer one. A march reads the angle between the two tubes there.
#pragma once
#include <vector>

#include "states.hpp"

namespace tactr {

/// One place where two neighbours, or the outermost tube and the guide, rub.
struct RubbingNode {
    int inner, outer;  // tubes; outer -1: the guide
    double s;
    double arm;    // coefficient of friction times contact radius, m
    double lever;  // m, over which a concentrated contact moment is borne
    double radius; // of the contact, m
    double slide;  // m, by which the inner tube has slid along the outer one
    double torque; // N m about d3, on the inner tube
    double twist;  // rad, angle of the inner tube from the outer one; NaN: not known, whatever it is
};

/// In a march: the angles at the nodes and, in the lanes from ``lane`` on, their torques.
template <class T>
struct RubbingNodes {
    const std::vector<RubbingNode>& nodes;
    int first_load;
    int lane;
    std::vector<T> twist;
    std::vector<char> felt;  // 0: no tube can turn there

    RubbingNodes(const std::vector<RubbingNode>& nodes_, int first_load_, int lane_)
        : nodes(nodes_), first_load(first_load_), lane(lane_), twist(nodes_.size(), T(0.0)), felt(nodes_.size(), 0) {}

    void visit(int load, T* y) {
        if (load < first_load) return;
        const int k = (load - first_load) / 2;
        const bool on_inner = (load - first_load) % 2 == 0;
        const RubbingNode& node = nodes[k];
        twist[k] = y[PSI + node.inner];
        if (node.outer >= 0) twist[k] -= y[PSI + node.outer];
        felt[k] = 1;
        if constexpr (LaneCount<T>::value > 0) {
            const int l = lane + k;
            if (l < 0 || l >= LaneCount<T>::value) return;
            if (on_inner) y[M3 + node.inner].d[l] += 1.0;
            else if (node.outer >= 0) y[M3 + node.outer].d[l] -= 1.0;
        }
    }
};

}  // namespace tactr
