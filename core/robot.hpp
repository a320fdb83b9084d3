// The robot as plain arrays: what the kernel knows of tubes, tendons and loads. SI units. C is double, or a dual number
// where derivatives with respect to the robot's own parameters are wanted.
#pragma once

namespace tactr {

constexpr int MAX_TUBES = 8;
constexpr int MAX_COEFFICIENTS = 16;

constexpr int MAX_TUBE_COEFFICIENTS = 8;
constexpr int MAX_TENSION_COEFFICIENTS = 12;

/// What describes a tube at one cross-section, in its own material frame: bending stiffness about x and y, torsional,
/// axial and shear stiffness, rest curvature and twist u*, rest shear and stretch v* - e3, neutral axis (x, y).
enum TubeQuantity { EIX, EIY, GJ, EA, GA, USTAR, VSTAR = USTAR + 3, AXIS = VSTAR + 3, QUANTITIES = AXIS + 2 };

/// One stretch of a tube: its quantities as polynomials in sigma - start, ascending powers.
template <class C>
struct TubePieceOf {
    C start;  // arc length sigma of the tube where the piece begins
    int count;     // of coefficients; 1: constant
    int plain;     // 1: v* = e3, and the neutral axis on the centreline
    C c[MAX_TUBE_COEFFICIENTS][QUANTITIES];
};
using TubePiece = TubePieceOf<double>;

/// Tube i, outermost first; its pieces are pieces[piece_begin..piece_end).
template <class C>
struct TubeOf {
    C length;
    C rotation_compliance;      // of what turns its proximal end, rad/(N m)
    double weight_per_gravity;  // linear density, kg/m
    int piece_begin, piece_end;
};
using Tube = TubeOf<double>;

/// Tendon position in the host's cross-section on [start, end] of its own tube's arc length sigma, by
/// polynomials in sigma - start: (x, y), or (radius, angle) when polar.
template <class C>
struct RoutingPieceOf {
    C start, end;
    int polar, count_a, count_b;
    C a[MAX_COEFFICIENTS], b[MAX_COEFFICIENTS];
};
using RoutingPiece = RoutingPieceOf<double>;

/// Tension along a tendon, relative to its input tension, by a polynomial in sigma - start.
template <class C>
struct TensionPieceOf {
    C start;
    int count;
    C c[MAX_TENSION_COEFFICIENTS];
};
using TensionPiece = TensionPieceOf<double>;

template <class C>
struct TendonOf {
    int tube;       // the tube on which it ends
    int outermost;  // 1: hosted by the outermost tube present (approach A), 0: by its own tube (approach B)
    C end;     // sigma of its termination
    int piece_begin, piece_end;
    int profile_begin, profile_end;  // empty: constant tension
};
using Tendon = TendonOf<double>;

template <class C>
struct PointLoadOf {
    int tube;
    int body_axes;
    C at;  // sigma
    C force[3], moment[3];
};
using PointLoad = PointLoadOf<double>;

template <class C>
struct DistributedLoadOf {
    int tube;  // -1: the outermost tube present, start and end are then s from the guide exit
    int body_axes;
    C start, end;
    C force[3], moment[3];  // per metre
};
using DistributedLoad = DistributedLoadOf<double>;

template <class C>
struct RobotOf {
    int tube_count, tendon_count, point_load_count, distributed_load_count;
    const TubeOf<C>* tubes;
    const TubePieceOf<C>* pieces;
    const TendonOf<C>* tendons;
    const RoutingPieceOf<C>* routing;
    const TensionPieceOf<C>* profiles;
    const PointLoadOf<C>* point_loads;
    const DistributedLoadOf<C>* distributed_loads;
};
using Robot = RobotOf<double>;

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
