// What all configurations of one pack have in common: which tubes and tendons are where. Their numbers stand apart, in a
// row of their own for each kind, so that they can be read side by side. Plain data: it goes to other units and processors.
#pragma once
#include "robot.hpp"

namespace tactr {

constexpr int LANE_TUBES = 4, LANE_SECTIONS = 24, LANE_HOSTED = 12, LANE_TENDONS = 12, LANE_LOADS = 2, LANE_STEPS = 64;
constexpr int LANE_STRAINS = 4 + 2 * LANE_TUBES;
constexpr int LANE_UNKNOWNS = LANE_TUBES - 1;

/// first: where its numbers start. Of a piece of a tube: start, then the quantities' coefficients of each power in turn.
struct LanePiece {
    int first, count, plain;
};

/// Numbers: start, count_a coefficients, count_b coefficients; base: where the translation of the tendon's tube is.
struct LaneHosted {
    int tendon, slot, base, first, polar, count_a, count_b;
};

/// In body axes. Numbers: force, moment.
struct LaneLoad {
    int slot, first;
};

/// A tendon hosted by another tube beyond a section's distal end than in it.
struct LaneHandOver {
    int hosted, from, to;  // hosted: by place among those beyond; from, to: tubes
};

/// Numbers: proximal, distal.
struct LaneSection {
    int first, steps, guided, even, bare;
    int active_count, active[LANE_TUBES];
    LanePiece piece[LANE_TUBES];
    int hosted_count;
    LaneHosted hosted[LANE_HOSTED];
    int handed_count;
    LaneHandOver handed[LANE_HOSTED];
    int point_count, distributed_count;
    LaneLoad point[LANE_LOADS], distributed[LANE_LOADS];
};

struct LanePlan {
    int tubes, tendons, sums, tip_tube, section_count;
    int numbers;                                     // how many there are in all
    int rotation, translation, tension;              // where they start
    int moment_scale, force_scale;
    int psi_weight, n3_weight, m3_weight, sum_weight;  // of errors: one, one a tube, one a tube, two
    int residual_tolerance;
    LaneSection sections[LANE_SECTIONS];             // from base to tip
};

/// What a pack goes through: the first march, Newton from there, Newton from a solution on other steps.
enum LanePhase { LANES_BEGIN, LANES_FAR, LANES_NEAR };

/// Where results stand, a row for each kind.
struct LaneResults {
    enum Row {
        ALIVE,            // 1: it went well
        PSI,              // of every tube at its distal end
        TIP = PSI + LANE_TUBES,
        QUATERNION = TIP + 3,
        LENGTH = QUATERNION + 4,
        BASE_RESIDUAL = LENGTH + LANE_TENDONS,
        SECTION_RESIDUAL,
        ERROR,            // m at the tip
        LENGTH_ERROR,     // m
        LEAST_STRETCH,
        DETERMINANT,
        FAR_FROM_SNAPPING,  // 1: no conjugate point can have been passed
        MARCHES,
        SHIFT,            // of the unknowns since the march that the memory holds
        JACOBIAN = SHIFT + LANE_UNKNOWNS,
        SECTION_ERROR = JACOBIAN + LANE_UNKNOWNS * LANE_UNKNOWNS,
        SECTION_LENGTH_ERROR = SECTION_ERROR + LANE_SECTIONS,
        ROWS = SECTION_LENGTH_ERROR + LANE_SECTIONS
    };
};

}  // namespace tactr
