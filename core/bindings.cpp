// Python's door to the kernel: plain arrays in, plain arrays out. No mechanics here.
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bind_arrays.hpp"
#include "bind_batch.hpp"
#include "bind_friction.hpp"
#include "energetics.hpp"
#include "joint.hpp"
#include "point_contact.hpp"
#include "sample.hpp"
#include "sensitivity.hpp"
#include "solve.hpp"
#include "starts.hpp"
#include "tube_friction.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using tactr::array_of, tactr::doubles_of, tactr::Shape, tactr::Table, tactr::Vector;
using PreparedRobot = tactr::RobotTables<double>;

nb::object vector_of(const double* data, size_t count) {
    return array_of(std::vector<double>(data, data + count), {count});
}

void check_columns(const Table& table, size_t columns, const char* name) {
    if (table.shape(1) != columns)
        throw std::invalid_argument(std::string(name) + " needs " + std::to_string(columns) + " columns");
}

/// row: start, number of coefficients, then the quantities' coefficients of each power in turn.
tactr::TubePiece tube_piece(const double* row) {
    tactr::TubePiece piece{row[0], static_cast<int>(row[1]), 1, {}};
    if (piece.count < 1 || piece.count > tactr::MAX_TUBE_COEFFICIENTS)
        throw std::invalid_argument("tube pieces have 1 to 8 coefficients");
    row += 2;
    for (auto& power : piece.c)
        for (int q = 0; q < tactr::QUANTITIES; ++q) {
            power[q] = *row++;
            if (q >= tactr::VSTAR && power[q] != 0.0) piece.plain = 0;
        }
    return piece;
}

void read_tubes(PreparedRobot& robot, const Table& tubes, const Table& pieces) {
    check_columns(tubes, 4, "tubes");  // length, rotation compliance, linear density, number of pieces
    check_columns(pieces, 2 + tactr::MAX_TUBE_COEFFICIENTS * tactr::QUANTITIES, "pieces");
    if (tubes.shape(0) < 1 || tubes.shape(0) > tactr::MAX_TUBES) throw std::invalid_argument("1 to 8 tubes");
    int first = 0;
    for (size_t i = 0; i < tubes.shape(0); ++i) {
        const int count = static_cast<int>(tubes(i, 3));
        robot.tubes.push_back({tubes(i, 0), tubes(i, 1), tubes(i, 2), first, first + count});
        first += count;
    }
    if (static_cast<size_t>(first) != pieces.shape(0)) throw std::invalid_argument("pieces do not match tubes");
    for (size_t k = 0; k < pieces.shape(0); ++k) robot.pieces.push_back(tube_piece(&pieces(k, 0)));
}

void read_routing(PreparedRobot& robot, const Table& routing) {
    constexpr size_t N = tactr::MAX_COEFFICIENTS;
    check_columns(routing, 5 + 2 * N, "routing");
    for (size_t k = 0; k < routing.shape(0); ++k) {
        tactr::RoutingPiece piece{routing(k, 0), routing(k, 1), routing(k, 2) != 0.0,
                                  static_cast<int>(routing(k, 3)), static_cast<int>(routing(k, 4)), {}, {}};
        if (piece.count_a < 1 || piece.count_b < 1 || piece.count_a > static_cast<int>(N) || piece.count_b > static_cast<int>(N))
            throw std::invalid_argument("routing pieces have 1 to 16 coefficients");
        for (size_t c = 0; c < N; ++c) {
            piece.a[c] = routing(k, 5 + c);
            piece.b[c] = routing(k, 5 + N + c);
        }
        robot.routing.push_back(piece);
    }
}

void read_profiles(PreparedRobot& robot, const Table& profiles) {
    constexpr size_t N = tactr::MAX_TENSION_COEFFICIENTS;
    check_columns(profiles, 2 + N, "profiles");
    for (size_t k = 0; k < profiles.shape(0); ++k) {
        tactr::TensionPiece piece{profiles(k, 0), static_cast<int>(profiles(k, 1)), {}};
        if (piece.count < 1 || piece.count > static_cast<int>(N)) throw std::invalid_argument("tension pieces have 1 to 12 coefficients");
        for (size_t c = 0; c < N; ++c) piece.c[c] = profiles(k, 2 + c);
        robot.profiles.push_back(piece);
    }
}

void read_tendons(PreparedRobot& robot, const Table& tendons, const Table& profiles) {
    check_columns(tendons, 5, "tendons");  // tube, outermost, end, number of routing pieces, of tension pieces
    int routing = 0, profile = 0;
    for (size_t j = 0; j < tendons.shape(0); ++j) {
        const int tube = static_cast<int>(tendons(j, 0));
        if (tube < 0 || tube >= static_cast<int>(robot.tubes.size())) throw std::invalid_argument("tendon on no tube");
        const int routes = static_cast<int>(tendons(j, 3)), tensions = static_cast<int>(tendons(j, 4));
        robot.tendons.push_back({tube, tendons(j, 1) != 0.0, tendons(j, 2), routing, routing + routes, profile, profile + tensions});
        routing += routes;
        profile += tensions;
    }
    if (static_cast<size_t>(routing) != robot.routing.size()) throw std::invalid_argument("routing does not match tendons");
    if (static_cast<size_t>(profile) != profiles.shape(0)) throw std::invalid_argument("profiles do not match tendons");
    read_profiles(robot, profiles);
}

void read_loads(PreparedRobot& robot, const Table& points, const Table& distributed) {
    check_columns(points, 9, "point_loads");
    check_columns(distributed, 10, "distributed_loads");
    const int tubes = static_cast<int>(robot.tubes.size());
    for (size_t l = 0; l < points.shape(0); ++l) {
        tactr::PointLoad load{static_cast<int>(points(l, 0)), points(l, 1) != 0.0, points(l, 2), {}, {}};
        if (load.tube < 0 || load.tube >= tubes) throw std::invalid_argument("point load on no tube");
        for (size_t a = 0; a < 3; ++a) {
            load.force[a] = points(l, 3 + a);
            load.moment[a] = points(l, 6 + a);
        }
        robot.point_loads.push_back(load);
    }
    for (size_t l = 0; l < distributed.shape(0); ++l) {
        tactr::DistributedLoad load{static_cast<int>(distributed(l, 0)), distributed(l, 1) != 0.0, distributed(l, 2),
                                    distributed(l, 3), {}, {}};
        if (load.tube < -1 || load.tube >= tubes) throw std::invalid_argument("distributed load on no tube");
        for (size_t a = 0; a < 3; ++a) {
            load.force[a] = distributed(l, 4 + a);
            load.moment[a] = distributed(l, 7 + a);
        }
        robot.distributed_loads.push_back(load);
    }
}

tactr::Solution blank(const PreparedRobot& robot, const Vector& tension, const Vector& rotation, const Vector& translation) {
    tactr::Solution solution;
    solution.tension = doubles_of(tension, robot.tendons.size(), "tension");
    solution.rotation = doubles_of(rotation, robot.tubes.size(), "rotation");
    solution.translation = doubles_of(translation, robot.tubes.size(), "translation");
    return solution;
}

tactr::Settings settings_of(double tolerance, double residual_tolerance) {
    tactr::Settings settings;
    settings.tolerance = tolerance;
    settings.residual_tolerance = residual_tolerance;
    return settings;
}

tactr::Solution solve(const PreparedRobot& robot, const Vector& tension, const Vector& rotation, const Vector& translation,
                      double tolerance, double residual_tolerance, const tactr::Solution* guess, int steps, bool stay, long most_steps,
                      int patience) {
    tactr::Solution solution = blank(robot, tension, rotation, translation);
    nb::gil_scoped_release release;
    const tactr::Robot view = robot.view();
    const tactr::Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
    tactr::Settings settings = settings_of(tolerance, residual_tolerance);
    settings.fixed_steps = steps;
    settings.stay = stay;
    settings.most_work = most_steps;
    settings.patience = patience;
    tactr::solve(view, actuation, settings, guess, solution);
    return solution;
}

std::vector<tactr::Solution> branches(const PreparedRobot& robot, const Vector& tension, const Vector& rotation,
                                      const Vector& translation, double tolerance, double residual_tolerance, int samples) {
    const tactr::Solution empty = blank(robot, tension, rotation, translation);
    nb::gil_scoped_release release;
    const tactr::Robot view = robot.view();
    const tactr::Actuation<double> actuation{empty.tension.data(), empty.rotation.data(), empty.translation.data(), 1.0, 1.0};
    tactr::Settings settings = settings_of(tolerance, residual_tolerance);
    return tactr::branches(view, actuation, settings, samples, empty);
}

using Getter = const double* (*)(const tactr::StationRecord&, int);

nb::object tube_field(const tactr::Samples& samples, size_t width, Getter get) {
    std::vector<double> data;
    data.reserve(samples.stations.size() * samples.tubes * width);
    for (int i = 0; i < samples.tubes; ++i)
        for (const auto& station : samples.stations) data.insert(data.end(), get(station, i), get(station, i) + width);
    const Shape shape{static_cast<size_t>(samples.tubes), samples.stations.size(), width};
    return array_of(std::move(data), shape);
}

nb::object station_field(const tactr::Samples& samples, size_t width, Getter get) {
    std::vector<double> data;
    for (const auto& station : samples.stations) data.insert(data.end(), get(station, 0), get(station, 0) + width);
    const Shape shape{samples.stations.size(), width};
    return array_of(std::move(data), shape);
}

nb::dict sample(const PreparedRobot& robot, const tactr::Solution& solution, const Vector& stations) {
    const std::vector<double> s(stations.data(), stations.data() + stations.shape(0));
    if (!std::is_sorted(s.begin(), s.end())) throw std::invalid_argument("stations must ascend");
    tactr::Samples samples;
    if (!tactr::sample(robot.view(), solution, s, samples)) throw std::runtime_error("the solution cannot be sampled");
    using R = tactr::StationRecord;
    nb::dict out;
    out["position"] = station_field(samples, 3, [](const R& r, int) { return r.position; });
    out["quaternion"] = station_field(samples, 4, [](const R& r, int) { return r.quaternion; });
    out["psi"] = tube_field(samples, 1, [](const R& r, int i) { return &r.psi[i]; });
    out["u"] = tube_field(samples, 3, [](const R& r, int i) { return r.u[i]; });
    out["v"] = tube_field(samples, 3, [](const R& r, int i) { return r.v[i]; });
    out["n"] = tube_field(samples, 3, [](const R& r, int i) { return r.n[i]; });
    out["m"] = tube_field(samples, 3, [](const R& r, int i) { return r.m[i]; });
    std::vector<double> present, tendon;
    for (int i = 0; i < samples.tubes; ++i)
        for (const auto& station : samples.stations) present.push_back(station.present[i]);
    for (int j = 0; j < samples.tendons; ++j)
        for (size_t k = 0; k < s.size(); ++k) {
            const auto& record = samples.tendon[k * samples.tendons + j];
            tendon.insert(tendon.end(), {static_cast<double>(record.host), record.r[0], record.r[1], record.tension, record.rate});
            tendon.insert(tendon.end(), record.direction, record.direction + 3);
        }
    const Shape tube_shape{static_cast<size_t>(samples.tubes), s.size()};
    const Shape tendon_shape{static_cast<size_t>(samples.tendons), s.size(), 8};
    out["present"] = array_of(std::move(present), tube_shape);
    out["tendon"] = array_of(std::move(tendon), tendon_shape);
    return out;
}

/// (rows, columns) as tactr::Sensitivities has them.
nb::object sensitivities(const PreparedRobot& robot, const tactr::Solution& solution, const Vector& stations, bool lengths,
                         bool actuators, double probe, const std::vector<const PreparedRobot*>& rates) {
    tactr::SensitivityRequest request;
    request.stations.assign(stations.data(), stations.data() + stations.shape(0));
    if (!std::is_sorted(request.stations.begin(), request.stations.end())) throw std::invalid_argument("stations must ascend");
    request.lengths = lengths;
    request.actuators = actuators;
    request.probe = probe;
    request.rates = rates;
    for (const PreparedRobot* rate : rates)
        if (!tactr::same_layout(robot, *rate)) throw std::invalid_argument("rates of another robot");
    tactr::Sensitivities found;
    bool regular = false;
    {
        nb::gil_scoped_release release;
        regular = tactr::find_sensitivities(robot, solution, request, found);
    }
    if (!regular) throw std::runtime_error("the solution has no derivatives: it is singular");
    const Shape shape{static_cast<size_t>(found.rows), static_cast<size_t>(found.columns)};
    return array_of(std::move(found.matrix), shape);
}

/// d(tendon lengths)/d(tensions), (tendons, tendons).
nb::object length_jacobian(const PreparedRobot& robot, const tactr::Solution& solution) {
    tactr::SensitivityRequest request;
    request.lengths = true;
    tactr::Sensitivities found;
    if (!tactr::find_sensitivities(robot, solution, request, found))
        throw std::runtime_error("the solution has no derivatives: it is singular");
    const size_t m = robot.tendons.size();
    const Shape shape{m, m};
    std::vector<double> square;
    for (size_t j = 0; j < m; ++j) {
        const auto row = found.matrix.begin() + static_cast<long>((6 + j) * found.columns);
        square.insert(square.end(), row, row + static_cast<long>(m));
    }
    return array_of(std::move(square), shape);
}

/// (solution, missed at the base, d(missed, lengths)/d(free end, tensions)), or None: a section had no equilibrium. The
/// solution keeps the neighbour's status, to be its successor as a guess; it meets the base only where nothing is missed.
nb::object joint_march(const PreparedRobot& robot, const tactr::Solution& neighbour, const Vector& step, const Vector& tension,
                       const Vector& rotation, const Vector& translation, double tolerance) {
    tactr::Solution solution = neighbour;
    solution.tension = doubles_of(tension, robot.tendons.size(), "tension");
    solution.rotation = doubles_of(rotation, robot.tubes.size(), "rotation");
    solution.translation = doubles_of(translation, robot.tubes.size(), "translation");
    solution.iterations = 0;
    solution.steps_marched = 0;
    solution.stability = tactr::StabilityFound::unchecked;
    solution.switched = solution.used_continuation = false;
    std::vector<double> moved(step.data(), step.data() + step.shape(0));
    moved.resize(tactr::MAX_UNKNOWNS, 0.0);
    tactr::Settings settings;
    settings.tolerance = tolerance;
    tactr::JointMarch found;
    bool marched = false;
    {
        nb::gil_scoped_release release;
        marched = tactr::joint_march(robot.view(), moved, settings, solution, found);
    }
    if (!marched) return nb::none();
    const size_t rows = found.missed.size() + robot.tendons.size();
    const Shape shape{rows, rows};
    return nb::make_tuple(solution, vector_of(found.missed.data(), found.missed.size()), array_of(std::move(found.matrix), shape));
}

/// Per tube: outer neighbours (records,), forces and moments (records, 3); s (records,).
nb::dict contact_arrays(const std::vector<tactr::ContactRecord>& records, size_t tubes) {
    std::vector<double> s, outer, force, moment;
    for (const auto& record : records) s.push_back(record.s);
    for (size_t i = 0; i < tubes; ++i)
        for (const auto& record : records) {
            outer.push_back(record.outer[i]);
            force.insert(force.end(), record.on[i].force, record.on[i].force + 3);
            moment.insert(moment.end(), record.on[i].moment, record.on[i].moment + 3);
        }
    const Shape line{records.size()}, plane{tubes, records.size()}, cube{tubes, records.size(), 3};
    nb::dict out;
    out["s"] = array_of(std::move(s), line);
    out["outer"] = array_of(std::move(outer), plane);
    out["force"] = array_of(std::move(force), cube);
    out["moment"] = array_of(std::move(moment), cube);
    return out;
}

nb::dict contacts(const PreparedRobot& robot, const tactr::Solution& solution, const Vector& stations) {
    const std::vector<double> s(stations.data(), stations.data() + stations.shape(0));
    if (!std::is_sorted(s.begin(), s.end())) throw std::invalid_argument("stations must ascend");
    tactr::Contacts found;
    if (!tactr::contacts(robot.view(), solution, s, found)) throw std::runtime_error("the solution has no contact forces");
    nb::dict out;
    out["along"] = contact_arrays(found.along, robot.tubes.size());
    out["points"] = contact_arrays(found.points, robot.tubes.size());
    return out;
}

nb::dict energetics(const PreparedRobot& robot, const tactr::Solution& solution) {
    tactr::Energetics found;
    if (!tactr::energetics(robot.view(), solution, found)) throw std::runtime_error("the solution has no energies");
    nb::dict out;
    out["strain_energy"] = vector_of(found.strain_energy.data(), found.strain_energy.size());
    out["load_potential"] = found.load_potential;
    out["torque"] = vector_of(found.torque.data(), found.torque.size());
    out["force"] = vector_of(found.force.data(), found.force.size());
    return out;
}

nb::tuple stability(const PreparedRobot& robot, const tactr::Solution& solution, int samples) {
    tactr::StabilityReport report;
    const tactr::Robot view = robot.view();
    if (!tactr::stability_of(view, solution, samples, report)) throw std::runtime_error("the Jacobi field of the solution was not found");
    const auto array = [](const std::vector<double>& data) { return vector_of(data.data(), data.size()); };
    return nb::make_tuple(report.stable, report.margin, array(report.s), array(report.determinant), array(report.conjugate));
}

/// nodes: a row for each: inner, outer (-1: the guide), s, arm, lever, radius, slide, torque, twist, whether it is at an end.
nb::dict friction_step(const PreparedRobot& robot, const Vector& tension, const Vector& rotation, const Vector& translation,
                       double tolerance, double residual_tolerance, const Table& nodes, const tactr::Solution* guess,
                       const tactr::RubbingModel* model, bool stay) {
    check_columns(nodes, 11, "nodes");
    std::vector<tactr::RubbingNode> list;
    std::vector<char> at_end;
    const auto is_tube = [&](double i) { return i >= 0.0 && i < static_cast<double>(robot.tubes.size()); };
    for (size_t k = 0; k < nodes.shape(0); ++k) {
        const double* row = &nodes(k, 0);
        if (!is_tube(row[0]) || !(row[1] == -1.0 || is_tube(row[1]))) throw std::invalid_argument("node on no tube");
        list.push_back({static_cast<int>(row[0]), static_cast<int>(row[1]), row[2], row[3], row[4], row[5], row[6], row[7], row[8], row[9]});
        at_end.push_back(row[10] != 0.0);
    }
    const tactr::Solution empty = blank(robot, tension, rotation, translation);
    tactr::Settings settings = settings_of(tolerance, residual_tolerance);
    settings.stay = stay;
    auto found = std::make_unique<tactr::FrictionStep>();
    {
        nb::gil_scoped_release release;
        tactr::friction_step(robot, list, at_end, settings, empty, guess, model, *found);
    }
    nb::dict out;
    out["torque"] = vector_of(found->torque.data(), found->torque.size());
    out["twist"] = vector_of(found->twist.data(), found->twist.size());
    out["limit"] = vector_of(found->limit.data(), found->limit.size());
    out["slides"] = vector_of(found->slides.data(), found->slides.size());
    out["heat"] = vector_of(found->heat.data(), found->heat.size());
    const Shape square{list.size(), found->compliance.size() / (list.empty() ? 1 : list.size())};
    if (found->falls > 0) {
        out["compliance"] = array_of(std::move(found->compliance), square);
        const std::vector<double> felt(found->felt.begin(), found->felt.end());
        out["felt"] = vector_of(felt.data(), felt.size());
    }
    out["falls"] = found->falls;
    out["model"] = nb::cast(std::move(found->model));
    out["iterations"] = found->iterations;
    out["missing"] = found->missing;
    out["settled"] = found->settled;
    out["robot"] = nb::cast(std::move(found->robot));
    out["solution"] = nb::cast(std::move(found->solution));
    return out;
}

double free_end_distance(const PreparedRobot& robot, const tactr::Solution& a, const tactr::Solution& b) {
    return tactr::free_end_distance(robot.view(), a, b);
}

}  // namespace

NB_MODULE(_core, m) {
    m.doc() = "tactr's kernel: statics of tendon-actuated concentric tubes, from the free end to the base. SI units.";
    m.attr("MAX_TUBES") = tactr::MAX_TUBES;

    nb::class_<PreparedRobot>(m, "PreparedRobot", "A robot as flat arrays, ready to be solved many times.")
        .def("__init__",
             [](PreparedRobot* self, const Table& tubes, const Table& pieces, const Table& tendons, const Table& routing,
                const Table& profiles, const Table& point_loads, const Table& distributed_loads) {
                 auto robot = std::make_unique<PreparedRobot>();
                 read_tubes(*robot, tubes, pieces);
                 read_routing(*robot, routing);
                 read_tendons(*robot, tendons, profiles);
                 read_loads(*robot, point_loads, distributed_loads);
                 new (self) PreparedRobot(std::move(*robot));
             },
             "tubes"_a, "pieces"_a, "tendons"_a, "routing"_a, "profiles"_a, "point_loads"_a, "distributed_loads"_a);

    nb::class_<tactr::Solution>(m, "Solution", "What a solve found.")
        .def_prop_ro("status", [](const tactr::Solution& s) { return static_cast<int>(s.status); })
        .def_ro("iterations", &tactr::Solution::iterations)
        .def_ro("steps_marched", &tactr::Solution::steps_marched)
        .def_ro("base_residual", &tactr::Solution::base_residual)
        .def_ro("section_residual", &tactr::Solution::section_residual)
        .def_prop_ro("discretisation_error",
                     [](const tactr::Solution& s) { return tactr::larger(s.discretisation_error, s.length_error); })
        .def_ro("least_stretch", &tactr::Solution::least_stretch)
        .def_ro("shortest_tendon", &tactr::Solution::shortest_tendon)
        .def_ro("amplification", &tactr::Solution::amplification)
        .def_ro("base_determinant", &tactr::Solution::base_determinant)
        .def_ro("used_continuation", &tactr::Solution::used_continuation)
        .def_prop_ro("stability", [](const tactr::Solution& s) { return static_cast<int>(s.stability); })
        .def_ro("switched", &tactr::Solution::switched)
        .def_prop_ro("steps", [](const tactr::Solution& s) { return s.mesh.steps; })
        .def_prop_ro("free_end_psi",
                     [](const tactr::Solution& s) { return vector_of(s.free_end.psi, s.rotation.size()); })
        .def_prop_ro("tension", [](const tactr::Solution& s) { return vector_of(s.tension.data(), s.tension.size()); })
        .def_prop_ro("tendon_length",
                     [](const tactr::Solution& s) { return vector_of(s.tendon_length.data(), s.tendon_length.size()); })
        .def_prop_ro("tip_position", [](const tactr::Solution& s) { return vector_of(s.tip_position, 3); })
        .def_prop_ro("tip_quaternion", [](const tactr::Solution& s) { return vector_of(s.tip_quaternion, 4); });

    m.def("solve", &solve, "robot"_a, "tension"_a, "rotation"_a, "translation"_a, "tolerance"_a, "residual_tolerance"_a,
          "guess"_a = nb::none(), "steps"_a = 0, "stay"_a = false, "most_steps"_a = tactr::Settings{}.most_work,
          "patience"_a = tactr::Settings{}.patience,
          "Free-end unknowns, residuals and tip of one robot at one actuation.");
    m.def("branches", &branches, "robot"_a, "tension"_a, "rotation"_a, "translation"_a, "tolerance"_a, "residual_tolerance"_a,
          "samples"_a = 0, "All equilibria found at one actuation, stable ones first, then by energy.");
    m.def("stability", &stability, "robot"_a, "solution"_a, "samples"_a, "stable, margin, s, determinant, conjugate points.");
    m.def("potential_energy", [](const PreparedRobot& robot, const tactr::Solution& s) { return tactr::potential_energy(robot.view(), s); },
          "robot"_a, "solution"_a, "Potential energy, J.");
    m.def("free_end_distance", &free_end_distance, "robot"_a, "a"_a, "b"_a, "Largest turn between two free ends, rad.");
    m.def("sensitivities", &sensitivities, "robot"_a, "solution"_a, "stations"_a, "lengths"_a, "actuators"_a, "probe"_a, "rates"_a,
          "Exact derivatives: rows tip, stations, lengths; columns tensions, rotations, translations, wrench, parameters.");
    m.def("length_jacobian", &length_jacobian, "robot"_a, "solution"_a, "d(tendon lengths)/d(tensions).");
    m.def("joint_march", &joint_march, "robot"_a, "neighbour"_a, "step"_a, "tension"_a, "rotation"_a, "translation"_a, "tolerance"_a,
          "One march from a moved free end: a solution to go on from, missed, d(missed, lengths)/d(free end, tensions); or None.");
    nb::class_<tactr::RubbingModel>(m, "RubbingModel", "An equilibrium with friction between tubes, and how it answers.");
    m.def("friction_step", &friction_step, "robot"_a, "tension"_a, "rotation"_a, "translation"_a, "tolerance"_a,
          "residual_tolerance"_a, "nodes"_a, "guess"_a = nb::none(), "model"_a = nb::none(), "stay"_a = false,
          "One step of friction between tubes: robot with the torques, solution, torque, twist and limit at the nodes. model: of "
          "the guess, which makes it fast.");
    m.def("sample", &sample, "robot"_a, "solution"_a, "stations"_a, "Shape of a converged solution at ascending s.");
    m.def("contacts", &contacts, "robot"_a, "solution"_a, "stations"_a, "What tubes exert on each other: along s, and at points.");
    m.def("energetics", &energetics, "robot"_a, "solution"_a, "Energies, and the torques and forces of the actuators.");
    tactr::bind_friction(m);
    tactr::bind_batch(m);
}
