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
    double slid;   // -1 or 1 where it slid in the step before, as FrictionStep::slides; 0: it held
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

/// What a march found at the nodes: angles, and in one with derivatives their rates with its first lanes, row-major.
struct RubbedNodes {
    const std::vector<RubbingNode>& nodes;
    int first_load;
    std::vector<double> twist, rates;
    std::vector<char> felt;

    RubbedNodes(const std::vector<RubbingNode>& nodes_, int first_load_) : nodes(nodes_), first_load(first_load_) {}

    template <class T>
    void take(const RubbingNodes<T>& read, const BaseState<T>& base, const double* rotation, int lanes) {
        const size_t count = nodes.size();
        felt = read.felt;
        twist.resize(count);
        for (size_t k = 0; k < count; ++k) {
            const RubbingNode& node = nodes[k];
            twist[k] = value(read.twist[k]);
            if (!felt[k]) twist[k] = value(base.psi[node.inner]) - (node.outer < 0 ? 0.0 : value(base.psi[node.outer]));
            if (node.outer < 0) twist[k] += rotation[0] - value(base.psi[0]);
        }
        if constexpr (LaneCount<T>::value > 0) {
            rates.resize(count * lanes);
            for (size_t k = 0; k < count; ++k)
                for (int l = 0; l < lanes; ++l)
                    rates[k * lanes + l] = read.twist[k].d[l] - (nodes[k].outer < 0 ? base.psi[0].d[l] : 0.0);
        }
    }
};

}  // namespace tactr
