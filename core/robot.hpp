// The robot as plain arrays: what the kernel knows of tubes, tendons and loads. SI units.
#pragma once

namespace tactr {

constexpr int MAX_TUBES = 8;
constexpr int MAX_COEFFICIENTS = 16;

constexpr int MAX_TUBE_COEFFICIENTS = 8;

/// What describes a tube at one cross-section, in its own material frame: bending stiffness about x and y, torsional,
/// axial and shear stiffness, rest curvature and twist u*, rest shear and stretch v* - e3, neutral axis (x, y).
enum TubeQuantity { EIX, EIY, GJ, EA, GA, USTAR, VSTAR = USTAR + 3, AXIS = VSTAR + 3, QUANTITIES = AXIS + 2 };

/// One stretch of a tube: its quantities as polynomials in sigma - start, ascending powers.
struct TubePiece {
    double start;  // arc length sigma of the tube where the piece begins
    int count;     // of coefficients; 1: constant
    int plain;     // 1: v* = e3, and the neutral axis on the centreline
    double c[MAX_TUBE_COEFFICIENTS][QUANTITIES];
};

/// Tube i, outermost first; its pieces are pieces[piece_begin..piece_end).
struct Tube {
    double length;
    double weight_per_gravity;  // linear density, kg/m
    int piece_begin, piece_end;
};

/// Tendon position in the host's cross-section on [start, end] of its own tube's arc length sigma, by
/// polynomials in sigma - start: (x, y), or (radius, angle) when polar.
struct RoutingPiece {
    double start, end;
    int polar, count_a, count_b;
    double a[MAX_COEFFICIENTS], b[MAX_COEFFICIENTS];
};

/// Tension along a tendon, relative to its input tension, by a polynomial in sigma - start.
struct TensionPiece {
    double start;
    int count;
    double c[4];
};

struct Tendon {
    int tube;       // the tube on which it ends
    int outermost;  // 1: hosted by the outermost tube present (approach A), 0: by its own tube (approach B)
    double end;     // sigma of its termination
    int piece_begin, piece_end;
    int profile_begin, profile_end;  // empty: constant tension
};

struct PointLoad {
    int tube;
    int body_axes;
    double at;  // sigma
    double force[3], moment[3];
};

struct DistributedLoad {
    int tube;  // -1: the outermost tube present, start and end are then s from the guide exit
    int body_axes;
    double start, end;
    double force[3], moment[3];  // per metre
};

struct Robot {
    int tube_count, tendon_count, point_load_count, distributed_load_count;
    const Tube* tubes;
    const TubePiece* pieces;
    const Tendon* tendons;
    const RoutingPiece* routing;
    const TensionPiece* profiles;
    const PointLoad* point_loads;
    const DistributedLoad* distributed_loads;
};

/// Actuation: what changes from solve to solve. P is double, or a dual number for sensitivities.
template <class P>
struct Actuation {
    const P* tension;      // per tendon, N
    const P* rotation;     // per tube, rad, at its proximal end
    const P* translation;  // per tube, z of its proximal end, m, <= 0
    double shape_scale;    // homotopy: multiplies u* and tension
    double load_scale;     // homotopy: multiplies external loads
};

}  // namespace tactr
