// Solves many configurations, each by itself, on several threads: plain arrays in, plain arrays out.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lanes_door.hpp"
#include "robot_tables.hpp"
#include "solution.hpp"

namespace tactr {

/// How configurations go side by side: not at all, with any processor's instructions, with AVX2's, with the widest there
/// are; or as on a device, on this processor (single) or on the device itself.
enum class Lanes { none, baseline, avx2, widest, single, device };

/// Whether this processor and this build have it.
bool has_lanes(Lanes lanes);

/// Item i is row i of every array; rows of what is the same for all items are repeated by the caller, except robots and
/// stations, of which one may stand for all.
struct BatchRequest {
    std::vector<const RobotTables<double>*> robots;
    std::size_t count = 0, station_count = 0;
    const double *tension = nullptr, *rotation = nullptr, *translation = nullptr, *residual_tolerance = nullptr;
    const double* stations = nullptr;
    bool own_stations = false;       // a row for every item
    const std::uint8_t* skip = nullptr;  // items that are not to be solved
    double tolerance = 1e-6;
    long most_work = Settings{}.most_work;
    int threads = 1;
    Lanes lanes = Lanes::widest;
    TactrLanesDoor device = nullptr;  // for Lanes::device
};

/// Where results go, row by row; what is null is not asked for. The caller fills them with NaN: rows of items without a
/// solution stay as they are.
struct BatchResult {
    std::int8_t* status = nullptr;  // Status
    std::uint8_t* unstable = nullptr;
    std::uint8_t* side_by_side = nullptr;  // whether it was solved in a pack
    double *shortest_tendon = nullptr, *discretisation_error = nullptr, *residual = nullptr;
    double *tip_position = nullptr, *tip_quaternion = nullptr;
    double *tendon_length = nullptr;
    double *shape = nullptr;       // (stations, 3)
    double *strain = nullptr;      // (tubes, 6)
    double *jacobian = nullptr;    // (6, tendons + 2 tubes): tensions, rotations, translations
    double *compliance = nullptr;  // (6, 6)
    double *margin = nullptr;
    std::uint8_t* stable = nullptr;
    double *energy = nullptr;
};

/// The largest |u - u*| and |v - v*| of every tube, (tubes, 6), at the stations of a converged solution that are on it.
bool strain_maxima(const RobotTables<double>& robot, const Solution& solution, const std::vector<double>& stations, double* worst);

/// poll is called every now and then by the calling thread, and stops the batch by returning false.
void solve_batch(const BatchRequest& request, const BatchResult& result, const std::function<bool()>& poll);

}  // namespace tactr
