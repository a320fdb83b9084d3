// Python's door to batches.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "batch.hpp"
#include "bind_arrays.hpp"
#include "bind_batch.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using tactr::array_of, tactr::Shape, tactr::Table, tactr::Vector;
using Flags = nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void check_shape(const Table& table, size_t rows, size_t columns, const char* name) {
    if (table.shape(0) != rows || table.shape(1) != columns) throw std::invalid_argument(std::string(name) + " has the wrong shape");
}

/// A numpy array of one value, put into the dictionary; its data, to be written.
template <class T>
T* new_array(nb::dict& out, const char* name, const Shape& shape, T value) {
    size_t size = 1;
    for (size_t n : shape) size *= n;
    T* first = nullptr;
    out[name] = array_of(std::vector<T>(size, value), shape, &first);
    return first;
}

tactr::BatchResult new_results(nb::dict& out, const tactr::BatchRequest& request, const std::vector<std::string>& outputs) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const size_t k = request.count, tubes = request.robots.front()->tubes.size(), tendons = request.robots.front()->tendons.size();
    tactr::BatchResult result;
    result.status = new_array<std::int8_t>(out, "status", {k}, -1);
    result.unstable = new_array<std::uint8_t>(out, "unstable", {k}, 0);
    result.side_by_side = new_array<std::uint8_t>(out, "side_by_side", {k}, 0);
    result.shortest_tendon = new_array(out, "shortest_tendon", {k}, nan);
    result.discretisation_error = new_array(out, "discretisation_error", {k}, nan);
    result.residual = new_array(out, "residual", {k}, nan);
    result.tip_position = new_array(out, "tip_position", {k, 3}, nan);
    result.tip_quaternion = new_array(out, "tip_quaternion", {k, 4}, nan);
    result.tendon_length = new_array(out, "tendon_length", {k, tendons}, nan);
    for (const std::string& name : outputs) {
        if (name == "shape") result.shape = new_array(out, "shape", {k, request.station_count, 3}, nan);
        if (name == "strain") result.strain = new_array(out, "strain", {k, tubes, 6}, nan);
        if (name == "jacobian") result.jacobian = new_array(out, "jacobian", {k, 6, tendons + 2 * tubes}, nan);
        if (name == "compliance") result.compliance = new_array(out, "compliance", {k, 6, 6}, nan);
        if (name == "energy") result.energy = new_array(out, "energy", {k}, nan);
        if (name == "stability") {
            result.margin = new_array(out, "margin", {k}, nan);
            result.stable = new_array<std::uint8_t>(out, "stable", {k}, 0);
        }
    }
    return result;
}

tactr::Lanes lanes_of(const std::string& name) {
    const std::pair<const char*, tactr::Lanes> known[] = {{"none", tactr::Lanes::none}, {"baseline", tactr::Lanes::baseline},
                                                         {"avx2", tactr::Lanes::avx2}, {"widest", tactr::Lanes::widest},
                                                         {"single", tactr::Lanes::single}, {"device", tactr::Lanes::device}};
    for (const auto& [known_name, lanes] : known)
        if (name == known_name && tactr::has_lanes(lanes)) return lanes;
    throw std::invalid_argument("no lanes called " + name + " on this machine");
}

nb::dict batch_of(const std::vector<const tactr::RobotTables<double>*>& robots, const Table& tension, const Table& rotation,
                     const Table& translation, const Vector& residual_tolerance, const Flags& skip, const Table& stations,
                     double tolerance, long most_steps, const std::vector<std::string>& outputs, int threads,
                  const std::string& lanes, std::uintptr_t device) {
    tactr::BatchRequest request;
    request.device = reinterpret_cast<TactrLanesDoor>(device);
    request.robots = robots;
    request.count = tension.shape(0);
    if (robots.empty() || (robots.size() != 1 && robots.size() != request.count)) throw std::invalid_argument("one robot, or one for each item");
    for (const auto* robot : robots)
        if (robot->tubes.size() != robots.front()->tubes.size() || robot->tendons.size() != robots.front()->tendons.size())
            throw std::invalid_argument("robots with other tubes or tendons");
    const size_t k = request.count, tubes = robots.front()->tubes.size();
    check_shape(tension, k, robots.front()->tendons.size(), "tension");
    check_shape(rotation, k, tubes, "rotation");
    check_shape(translation, k, tubes, "translation");
    if (residual_tolerance.shape(0) != k || skip.shape(0) != k) throw std::invalid_argument("residual_tolerance and skip need a number for each item");
    if (stations.shape(0) != 1 && stations.shape(0) != k) throw std::invalid_argument("stations: one row, or one for each item");
    request.tension = tension.data();
    request.rotation = rotation.data();
    request.translation = translation.data();
    request.residual_tolerance = residual_tolerance.data();
    request.skip = skip.data();
    request.stations = stations.data();
    request.station_count = stations.shape(1);
    request.own_stations = stations.shape(0) == k && k > 1;
    request.tolerance = tolerance;
    request.most_work = most_steps;
    request.threads = threads;
    request.lanes = lanes_of(lanes);
    nb::dict out;
    const tactr::BatchResult result = new_results(out, request, outputs);
    bool interrupted = false;
    {
        nb::gil_scoped_release release;
        tactr::solve_batch(request, result, [&interrupted] {
            const nb::gil_scoped_acquire acquire;
            interrupted = interrupted || PyErr_CheckSignals() != 0;
            return !interrupted;
        });
    }
    if (interrupted) throw nb::python_error();
    return out;
}

nb::object maxima_of(const tactr::RobotTables<double>& robot, const tactr::Solution& solution, const Vector& stations) {
    nb::dict out;
    double* worst = new_array(out, "strain", {robot.tubes.size(), 6}, 0.0);
    const std::vector<double> s(stations.data(), stations.data() + stations.shape(0));
    if (!tactr::strain_maxima(robot, solution, s, worst)) throw std::runtime_error("the solution cannot be sampled");
    return out["strain"];
}

}  // namespace

void tactr::bind_batch(nb::module_& m) {
    m.def("solve_batch", &batch_of, "robots"_a, "tension"_a, "rotation"_a, "translation"_a, "residual_tolerance"_a, "skip"_a,
          "stations"_a, "tolerance"_a, "most_steps"_a, "outputs"_a, "threads"_a, "lanes"_a = "widest",
          "device"_a = 0, "Many configurations from cold, a row for each.");
    m.def("strain_maxima", &maxima_of, "robot"_a, "solution"_a, "stations"_a, "Largest |u - u*|, |v - v*| of every tube, (tubes, 6).");
}
