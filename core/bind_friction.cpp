// Python's door to friction of tendons.
#include "bind_friction.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bind_arrays.hpp"
#include "friction_step.hpp"
#include "friction_way.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using tactr::array_of, tactr::doubles_of, tactr::Table, tactr::Vector;
using PreparedRobot = tactr::RobotTables<double>;

struct Channels {
    std::vector<tactr::FrictionChannel> list;
};

/// rows: (tendon, tube, end, pieces of friction, contacts or None, cuts), in the order of the tendons.
Channels channels_of(const nb::list& rows) {
    Channels out;
    for (nb::handle item : rows) {
        const nb::tuple row = nb::cast<nb::tuple>(item);
        tactr::FrictionChannel channel{nb::cast<int>(row[0]), nb::cast<int>(row[1]), nb::cast<double>(row[2]),
                                       nb::cast<std::vector<std::pair<double, double>>>(row[3]), !row[4].is_none(), {},
                                       nb::cast<std::vector<double>>(row[5]), {}};
        if (channel.over_disks) channel.contacts = nb::cast<std::vector<double>>(row[4]);
        if (channel.pieces.empty()) throw std::invalid_argument("a channel without friction");
        channel.watched = tactr::watched_places(channel);
        if (!out.list.empty() && channel.tendon <= out.list.back().tendon) throw std::invalid_argument("channels out of order");
        out.list.push_back(std::move(channel));
    }
    return out;
}

/// Of an equilibrium; or a list: None: no tension, or (edges, Chebyshev coefficients) of log tension.
std::vector<std::optional<tactr::Curve>> curves_of(const nb::object& given) {
    if (nb::isinstance<tactr::FrictionSettled>(given)) {
        std::vector<std::optional<tactr::Curve>> out;
        for (const auto& profile : nb::cast<const tactr::FrictionSettled&>(given).profiles)
            out.push_back(profile ? std::optional<tactr::Curve>(profile->log) : std::nullopt);
        return out;
    }
    const nb::list old = nb::cast<nb::list>(given);
    std::vector<std::optional<tactr::Curve>> out(nb::len(old));
    for (size_t c = 0; c < out.size(); ++c) {
        if (old[c].is_none()) continue;
        const nb::tuple pair = nb::cast<nb::tuple>(old[c]);
        const auto coefficients = nb::cast<Table>(pair[1]);
        tactr::Curve curve{doubles_of(nb::cast<Vector>(pair[0])), {}};
        if (coefficients.shape(0) < 1 || curve.edges.size() != coefficients.shape(0) + 1 || coefficients.shape(1) != tactr::CURVE_POINTS)
            throw std::invalid_argument("a profile has the wrong shape");
        curve.coefficients.resize(coefficients.shape(0));
        for (size_t k = 0; k < coefficients.shape(0); ++k)
            std::copy(&coefficients(k, 0), &coefficients(k, 0) + tactr::CURVE_POINTS, curve.coefficients[k].begin());
        out[c] = std::move(curve);
    }
    return out;
}

/// By channel: None, or (edges, coefficients, slides, driven).
nb::list profiles_of(const tactr::FrictionSettled& settled) {
    nb::list out;
    for (const auto& profile : settled.profiles) {
        if (!profile) {
            out.append(nb::none());
            continue;
        }
        std::vector<double> coefficients;
        for (const auto& row : profile->log.coefficients) coefficients.insert(coefficients.end(), row.begin(), row.end());
        const size_t pieces = profile->slides.size();
        nb::list slides, driven;
        for (size_t k = 0; k < pieces; ++k) {
            slides.append(profile->slides[k]);
            driven.append(static_cast<bool>(profile->driven[k]));
        }
        out.append(nb::make_tuple(array_of(std::vector<double>(profile->log.edges), {pieces + 1}),
                                  array_of(std::move(coefficients), {pieces, tactr::CURVE_POINTS}), nb::tuple(slides), nb::tuple(driven)));
    }
    return out;
}

tactr::Solution blank_of(const PreparedRobot& robot, const Vector& tension, const Vector& rotation, const Vector& translation) {
    tactr::Solution blank;
    blank.tension = doubles_of(tension, robot.tendons.size(), "tension");
    blank.rotation = doubles_of(rotation, robot.tubes.size(), "rotation");
    blank.translation = doubles_of(translation, robot.tubes.size(), "translation");
    return blank;
}

std::unique_ptr<tactr::FrictionRounds> rounds_of(const PreparedRobot& plain, const Channels& channels, const nb::object& given,
                                                 std::vector<double> at, const Vector& translation, double precision) {
    auto old = curves_of(given);
    if (old.size() != channels.list.size()) throw std::invalid_argument("one old profile for each channel");
    for (const tactr::FrictionChannel& channel : channels.list)
        if (channel.tendon >= static_cast<int>(plain.tendons.size()) || channel.tube >= static_cast<int>(plain.tubes.size()))
            throw std::invalid_argument("a channel of another robot");
    return std::make_unique<tactr::FrictionRounds>(plain, channels.list, std::move(old), std::move(at),
                                                   doubles_of(translation, plain.tubes.size(), "translation"), precision);
}

void check_places(size_t numbers, const tactr::FrictionSettled& near, const std::vector<const tactr::FrictionSettled*>& past) {
    bool alike = near.at.size() == numbers;
    for (const auto* settled : past) alike = alike && settled->at.size() == numbers;
    if (!alike) throw std::invalid_argument("places of another robot");
}

nb::object run(tactr::FrictionRounds& rounds, const Vector& tension, const Vector& rotation, const Vector& translation,
               double tolerance, double residual_tolerance, const tactr::Solution& guess, bool stay) {
    const tactr::Solution blank = blank_of(rounds.robot, tension, rotation, translation);
    tactr::Settings settings;
    settings.tolerance = tolerance;
    settings.residual_tolerance = residual_tolerance;
    settings.stay = stay;
    auto found = std::make_unique<tactr::FrictionSettled>();
    bool settled = false;
    {
        nb::gil_scoped_release release;
        settled = rounds.run(settings, blank, guess, {}, *found);
    }
    return settled ? nb::cast(std::move(found)) : nb::none();
}

nb::tuple step(const PreparedRobot& plain, const Channels& channels, const nb::object& old, const tactr::FrictionSettled& near,
               const std::vector<const tactr::FrictionSettled*>& past, const std::vector<double>& at, const Vector& tension,
               const Vector& rotation, const Vector& translation, double tolerance, double residual_tolerance,
               std::optional<std::pair<double, double>> limits) {
    check_places(at.size(), near, past);
    const tactr::Solution blank = blank_of(plain, tension, rotation, translation);
    const auto rounds = rounds_of(plain, channels, old, at, translation, residual_tolerance);
    tactr::Settings settings;
    settings.tolerance = tolerance;
    settings.residual_tolerance = residual_tolerance;
    settings.stay = true;
    const tactr::StepLimits most = limits ? tactr::StepLimits{limits->first, limits->second} : tactr::StepLimits{};
    auto found = std::make_unique<tactr::FrictionSettled>();
    tactr::FrictionSpent spent;
    bool taken = false;
    {
        nb::gil_scoped_release release;
        taken = tactr::friction_step(*rounds, channels.list, near, past, settings, blank, limits ? &most : nullptr, *found, spent);
    }
    nb::object settled = taken ? nb::cast(std::move(found)) : nb::none();
    return nb::make_tuple(settled, rounds->history_missed, spent.heat, spent.creep);
}

/// points: all numbers of each. cuts: history missed and turn, the shortest step, how much shorter than may be, stretch.
nb::tuple way(const PreparedRobot& plain, const Channels& channels, const nb::object& old,
              std::vector<std::shared_ptr<const tactr::FrictionSettled>> found, double stride, const Table& points, double tolerance,
              double residual_tolerance, const std::tuple<double, double, double, double, double>& cuts) {
    if (found.empty()) throw std::invalid_argument("a way starts somewhere");
    auto curves = curves_of(old);
    if (curves.size() != channels.list.size()) throw std::invalid_argument("one old profile for each channel");
    for (const auto& settled : found)
        if (settled->at.size() != points.shape(1) || points.shape(1) < plain.tendons.size() + 2 * plain.tubes.size())
            throw std::invalid_argument("places of another robot");
    tactr::Settings settings;
    settings.tolerance = tolerance;
    settings.residual_tolerance = residual_tolerance;
    settings.stay = true;
    const auto [missed, turn, shortest, careful, stretch] = cuts;
    tactr::FrictionWay way(plain, channels.list, settings, {{missed, turn}, shortest, careful, stretch}, std::move(curves), std::move(found), stride);
    std::vector<tactr::WayPoint> reached;
    {
        nb::gil_scoped_release release;
        for (size_t k = 0; k < points.shape(0); ++k) {
            tactr::WayPoint point;
            if (!way.reach({&points(k, 0), &points(k, 0) + points.shape(1)}, point)) break;
            reached.push_back(std::move(point));
        }
    }
    nb::list out;
    for (auto& point : reached) out.append(nb::make_tuple(point.settled, point.steps, point.spent.heat, point.spent.creep, point.seconds));
    return nb::make_tuple(out, way.found, way.stride);
}

}  // namespace

namespace tactr {

void bind_friction(nb::module_& m) {
    nb::class_<Channels>(m, "FrictionChannels", "Where tendons rub.")
        .def("__init__", [](Channels* self, const nb::list& rows) { new (self) Channels(channels_of(rows)); }, "rows"_a);

    nb::class_<FrictionSettled>(m, "FrictionSettled", "One equilibrium with friction of tendons.")
        .def("__init__",
             [](FrictionSettled* self, const PreparedRobot& robot, const Solution& solution, std::vector<double> at) {
                 new (self) FrictionSettled{};
                 self->robot = robot;
                 self->solution = solution;
                 self->at = std::move(at);
             },
             "robot"_a, "solution"_a, "at"_a, "Without tendons that rub.")
        .def_prop_ro("robot", [](FrictionSettled& s) -> PreparedRobot& { return s.robot; }, nb::rv_policy::reference_internal)
        .def_prop_ro("solution", [](FrictionSettled& s) -> Solution& { return s.solution; }, nb::rv_policy::reference_internal)
        .def_prop_ro("profiles", &profiles_of)
        .def_ro("missed", &FrictionSettled::missed)
        .def_ro("rounds", &FrictionSettled::rounds);

    nb::class_<FrictionRounds>(m, "FrictionRounds", "Rounds of profiles, shape and wraps.")
        .def("__init__",
             [](FrictionRounds* self, const PreparedRobot& plain, const Channels& channels, const nb::object& old, std::vector<double> at,
                const Vector& translation, double precision) {
                 new (self) FrictionRounds(*rounds_of(plain, channels, old, std::move(at), translation, precision));
             },
             "plain"_a, "channels"_a, "old"_a, "at"_a, "translation"_a, "precision"_a, nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>())
        .def("start_plain", [](FrictionRounds& r, const Solution& s) { if (!r.start(s)) throw std::runtime_error("the solution cannot be sampled"); },
             "solution"_a)
        .def("start_near", [](FrictionRounds& r, const FrictionSettled& near, const std::vector<const FrictionSettled*>& past) {
                 check_places(r.place().size(), near, past);
                 r.start(near, past);
             }, "near"_a, "past"_a, "Carried on from what was found before near, the latest first.")
        .def("profile", [](FrictionRounds& r, const Vector& tension) {
                 r.profile(doubles_of(tension, r.robot.tendons.size(), "tension"));
                 return r.robot;
             }, "tension"_a, "The robot with profiles at these tensions at the base.")
        .def("measure", &FrictionRounds::measure, "robot"_a, "solution"_a, "Reads the wraps in the round's shape; whether it could.")
        .def("mix", [](FrictionRounds& r, const Vector& tension, const Vector& next) {
                 std::vector<double> mixed = doubles_of(tension);
                 r.mix_pulls(mixed, doubles_of(next, mixed.size(), "next"));
                 const size_t count = mixed.size();
                 return array_of(std::move(mixed), {count});
             }, "tension"_a, "next"_a, "Wraps and tensions to go on with.")
        .def("rates", &FrictionRounds::rates, "still"_a, "channel"_a, "tension"_a, "all"_a)
        .def("slack", [](const FrictionRounds& r, size_t channel) { return !r.profiles.at(channel).has_value(); }, "channel"_a)
        .def("settled", [](FrictionRounds& r, PreparedRobot robot, Solution solution) {
                 auto out = std::make_unique<FrictionSettled>();
                 r.settle(std::move(robot), std::move(solution), *out);
                 return out;
             }, "robot"_a, "solution"_a)
        .def("run", &run, "tension"_a, "rotation"_a, "translation"_a, "tolerance"_a, "residual_tolerance"_a, "guess"_a, "stay"_a,
             "All rounds at given tensions; None: not found.")
        .def_ro("missed", &FrictionRounds::missed)
        .def_ro("rounds", &FrictionRounds::rounds);

    m.def("friction_spent", [](const Channels& channels, const FrictionSettled& before, FrictionSettled& after) {
        std::vector<double> heat, creep;
        friction_heat(channels.list, before, after, heat);
        friction_creep(channels.list, before, after, creep);
        return nb::make_tuple(heat, creep);
    }, "channels"_a, "before"_a, "after"_a, "By channel: heat of a step, J, and creep after it, m.");
    m.def("tendon_friction_step", &step, "plain"_a, "channels"_a, "old"_a, "near"_a, "past"_a, "at"_a, "tension"_a, "rotation"_a,
          "translation"_a, "tolerance"_a, "residual_tolerance"_a, "limits"_a.none(),
          "The next equilibrium, None: not found or beyond limits, of history missed and turn; what was missed; heat of the step, and creep after it.");
    m.def("tendon_friction_way", &way, "plain"_a, "channels"_a, "old"_a, "found"_a, "stride"_a, "points"_a, "tolerance"_a,
          "residual_tolerance"_a, "cuts"_a,
          "Points that were reached: equilibrium, steps, heat and creep, seconds; what was found last, the latest first; stride.");
    m.def("friction_history_missed", [](const Channels& channels, const FrictionSettled& before, const FrictionSettled& after, double enough) {
        return missed_of_history(channels.list, before, after.wraps, after.profiles, after.solution.tension, enough);
    }, "channels"_a, "before"_a, "after"_a, "enough"_a, "What one step misses of log tension that small ones would have seen.");
}

}  // namespace tactr
