#include "tendon_friction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "friction_mixing.hpp"
#include "solve.hpp"

namespace tactr {

namespace {

constexpr int MOST_ROUNDS = 30, MOST_PAIRS = 3;
constexpr int PATIENT = 6;    // rounds; then cusps stay, and what was left once is left for good: else they may come and go without end
constexpr double APART = 1e-3;  // of a tendon: edges nearer to each other are not told apart then
constexpr double NEAR = 100.0;  // of the precision, missed, for cusps to stay
constexpr int RESTLESS = 12;  // rounds; then half of every step is taken: what comes and goes does so by less
constexpr int STRAYED = 15;    // rounds with tensions to be found; then without what earlier rounds taught, with other fronts
constexpr double LOOK_BELOW = 0.2;    // of the limit, missed: from here on it is seen whether a step is too long
constexpr double LITTLE = 10.0;        // of the precision, missed: the free end is where the last march said, but for what it forgives
constexpr double SECTIONS_SHARE = 1e-3, ROUGHEST = 1e-6;  // tolerance of sections: of what was missed, and at most
constexpr double LAST_ROUNDS = 100.0;                    // of the precision, missed: what follows may be the last
constexpr double THIN = 0.1;           // of the precision, by which stuck pieces may be off when they are made one
constexpr double NEGLIGIBLE = 1e-13;  // of a profile: coefficients left away

/// Tension over that at the base, as polynomials.
void add_pieces(const FrictionProfile& profile, double y0, std::vector<TensionPiece>& out) {
    const ChebyshevRules& rules = ChebyshevRules::get();
    const auto& edges = profile.log.edges;
    for (size_t k = 0; k + 1 < edges.size(); ++k) {
        if (profile.log.is_even(static_cast<int>(k))) {
            out.push_back({edges[k], 1, {std::exp(profile.log.coefficients[k][0] - y0)}});
            continue;
        }
        PointValues values = profile.log.on(static_cast<int>(k), points_between(edges[k], edges[k + 1]));
        for (double& x : values) x = std::exp(x - y0);
        PointValues c = ChebyshevRules::times(rules.fit, values);
        double largest = 0.0;
        for (double x : c) largest = larger(largest, std::fabs(x));
        int count = CURVE_POINTS;
        while (count > 1 && !(std::fabs(c[count - 1]) > NEGLIGIBLE * largest)) c[--count] = 0.0;
        c = ChebyshevRules::times(rules.powers, c);
        TensionPiece piece{edges[k], count, {}};
        double scale = 1.0;
        for (int i = 0; i < count; ++i, scale /= edges[k + 1] - edges[k]) piece.c[i] = c[i] * scale;
        out.push_back(piece);
    }
}

/// numbers: at the points between joints.
void add_rises(const std::vector<double>& joints, const double* numbers, Curve& rise) {
    const ChebyshevRules& rules = ChebyshevRules::get();
    Curve correction{joints, {}};
    for (size_t k = 0; k + 1 < joints.size(); ++k, numbers += CURVE_POINTS) {
        PointValues values;
        std::copy(numbers, numbers + CURVE_POINTS, values.begin());
        correction.coefficients.push_back(ChebyshevRules::times(rules.fit, values));
    }
    for (size_t k = 0; k < rise.coefficients.size(); ++k) {
        const int piece = correction.piece(0.5 * (rise.edges[k] + rise.edges[k + 1]));
        const PointValues values = ChebyshevRules::times(rules.fit, correction.on(piece, points_between(rise.edges[k], rise.edges[k + 1])));
        for (int i = 0; i < CURVE_POINTS; ++i) rise.coefficients[k][i] += values[i];
    }
}

}  // namespace

FrictionRounds::FrictionRounds(const RobotTables<double>& plain, const std::vector<FrictionChannel>& channels,
                               std::vector<std::optional<Curve>> old, std::vector<double> at, const std::vector<double>& translation, double precision)
    : robot(plain), profiles(channels.size()), plain_(plain), channels_(channels), old_(std::move(old)), at_(std::move(at)),
      translation_(translation), precision_(precision), left_(channels.size(), 0), last_edges_(channels.size()) {
    const Layout<double> layout = cut_into_sections(plain.view(), translation.data());
    std::vector<double> ends{layout.sections.front().proximal};
    for (const auto& section : layout.sections) ends.push_back(section.distal);
    for (const FrictionChannel& channel : channels) joints_.push_back(channel.joints(ends, translation[channel.tube]));
}

bool FrictionRounds::start(const Solution& solution) {
    return channels_.empty() || read(plain_, solution, wraps_);
}

void FrictionRounds::start(const FrictionSettled& near, const std::vector<const FrictionSettled*>& past) {
    wraps_ = near.wraps;
    first_missed_ = near.first_missed;
    std::vector<double> now;
    numbers_of(wraps_, now);
    for (const RoundsPair& pair : near.pairs)
        if (static_cast<int>(pairs_.size()) < MOST_PAIRS) pairs_.push_back(pair);
    const std::vector<double> share = carrying_on(places_before(near.at, at_, past));
    if (share.size() < 2) return;
    std::vector<double> step(now.size(), 0.0), numbers;
    FreeEnd<double> end{};
    for (size_t k = 0; k < share.size(); ++k) {
        const FrictionSettled& from = k == 0 ? near : *past[k - 1];
        numbers_of(from.wraps, numbers);
        for (size_t i = 0; i < step.size(); ++i) step[i] += share[k] * (numbers[i] - now[i]);
        for (int i = 0; i < MAX_TUBES; ++i) end.psi[i] += share[k] * from.solution.free_end.psi[i];
        for (int c = 0; c < 4; ++c) end.quaternion[c] += share[k] * from.solution.free_end.quaternion[c];
    }
    add(step, wraps_);
    double size = 0.0;
    for (double c : end.quaternion) size += c * c;
    for (double& c : end.quaternion) c /= std::sqrt(size);
    if (std::fabs(std::sqrt(size) - 1.0) < Stride::CLOSE) ahead_ = end;
}

void FrictionRounds::profile(const std::vector<double>& tension) {
    robot.profiles.clear();
    std::vector<Curve> none;
    none.reserve(channels_.size());
    std::vector<std::optional<FrictionWalk>> walks(channels_.size());
    std::vector<double> fronts;  // s, of all channels
    for (size_t c = 0; c < channels_.size(); ++c) {
        const double pull = tension[channels_[c].tendon], base = translation_[channels_[c].tube];
        last_edges_[c] = profiles[c] ? profiles[c]->log.edges : std::vector<double>{};
        profiles[c].reset();
        if (!(pull > 0.0)) continue;
        none.push_back(Curve::constant(NO_TENSION, channels_[c].end));
        walks[c].emplace(old_[c] ? *old_[c] : none.back(), wraps_[c], std::log(pull), precision_, rounds >= PATIENT, left_[c]);
        left_[c] = walks[c]->left;
        for (double front : walks[c]->fronts()) fronts.push_back(base + front);
    }
    std::sort(fronts.begin(), fronts.end());
    for (size_t c = 0; c < channels_.size(); ++c) {
        if (!walks[c]) continue;
        std::vector<double> others = fronts;
        for (double& s : others) s -= translation_[channels_[c].tube];
        profiles[c] = walks[c]->profile(joints_[c], others);
    }
    size_t c = 0;
    for (size_t j = 0; j < robot.tendons.size(); ++j) {
        const Tendon& fixed = plain_.tendons[j];
        robot.tendons[j].profile_begin = static_cast<int>(robot.profiles.size());
        if (c < channels_.size() && channels_[c].tendon == static_cast<int>(j)) {
            if (profiles[c]) add_pieces(*profiles[c], std::log(tension[j]), robot.profiles);
            ++c;
        } else {
            robot.profiles.insert(robot.profiles.end(), plain_.profiles.begin() + fixed.profile_begin,
                                  plain_.profiles.begin() + fixed.profile_end);
        }
        robot.tendons[j].profile_end = static_cast<int>(robot.profiles.size());
    }
}

bool FrictionRounds::measure(const RobotTables<double>& shaped, const Solution& solution) {
    ++rounds;
    missed = 0.0;
    if (channels_.empty()) return true;
    return read(shaped, solution, after_) && compare();
}

bool FrictionRounds::read(const RobotTables<double>& shaped, const Solution& solution, std::vector<Wrap>& wraps) const {
    Solution here = solution;
    const Robot view = shaped.view();
    const Actuation<double> at{here.tension.data(), here.rotation.data(), here.translation.data(), 1.0, 1.0};
    NewtonSolver newton(view, at, Settings{});
    if (!newton.take_over(solution, here)) return false;
    return WrapReader(channels_, joints_, SECTION_TOLERANCE).read(newton, here, wraps);
}

bool FrictionRounds::compare() {
    missed = 0.0;
    numbers_of(wraps_, own_);
    numbers_of(after_, given_);
    size_t n = 0;
    for (size_t c = 0; c < channels_.size(); ++c) {
        const auto& joints = joints_[c];
        const size_t points = channels_[c].over_disks ? 0 : (joints.size() - 1) * CURVE_POINTS;
        double rises = 0.0, jumps = 0.0;
        for (size_t i = 0; i < points; ++i, ++n) rises = larger(rises, std::fabs(given_[n] - own_[n]));
        for (size_t i = 0; i < joints.size(); ++i, ++n) jumps += std::fabs(given_[n] - own_[n]);
        missed = larger(missed, rises + jumps);
    }
    return std::isfinite(missed);
}

void FrictionRounds::mix(std::vector<double>& others, const std::vector<double>& next) {
    std::vector<double> gap = difference(given_, own_), given = given_;
    for (size_t j = 0; j < next.size(); ++j) {
        gap.push_back(next[j] - others[j]);
        given.push_back(next[j]);
    }
    pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), [&](const RoundsPair& pair) { return pair.missed.size() != gap.size(); }),
                 pairs_.end());
    if (!last_missed_.empty()) {
        pairs_.insert(pairs_.begin(), {difference(gap, last_missed_), difference(given, last_given_)});
        if (static_cast<int>(pairs_.size()) > MOST_PAIRS) pairs_.pop_back();
    }
    const bool halved = next.empty() && rounds >= RESTLESS;
    if (halved || (!next.empty() && rounds >= STRAYED)) pairs_.clear();
    const std::vector<double> share = shares(pairs_, gap);
    std::vector<double> correction(given.size(), 0.0);
    if (halved)
        for (size_t i = 0; i < correction.size(); ++i) correction[i] = -0.5 * gap[i];
    for (size_t c = 0; c < pairs_.size(); ++c)
        for (size_t i = 0; i < correction.size(); ++i) correction[i] -= share[c] * pairs_[c].given[i];
    for (size_t c = 0; c < wraps_.size() && rounds >= PATIENT && missed <= NEAR * precision_; ++c) after_[c].cusps = wraps_[c].cusps;
    wraps_ = after_;
    add(correction, wraps_);
    for (size_t j = 0; j < next.size(); ++j) others[j] = next[j] + correction[given_.size() + j];
    last_missed_ = std::move(gap);
    last_given_ = std::move(given);
    if (rounds % PATIENT == 0) cut_alike();
}

/// Profiles of the last two rounds, and the wraps that go with them, are cut at the edges of both from now on: what polynomials
/// cut in other ways make of the same wrap differs, and where edges come and go that never settles.
void FrictionRounds::cut_alike() {
    for (size_t c = 0; c < channels_.size(); ++c) {
        if (channels_[c].over_disks || !profiles[c]) continue;
        std::vector<double>& joints = joints_[c];
        const double apart = APART * channels_[c].end;
        for (const auto* edges : {&last_edges_[c], &profiles[c]->log.edges})
            for (double edge : *edges) {
                const auto beyond = std::upper_bound(joints.begin(), joints.end(), edge);
                if (beyond == joints.begin() || beyond == joints.end()) continue;
                if (edge - *(beyond - 1) > apart && *beyond - edge > apart) joints.insert(beyond, edge);
            }
    }
    last_missed_.clear();
}

void FrictionRounds::mix_pulls(std::vector<double>& tension, const std::vector<double>& next) {
    mix(tension, next);
    for (size_t j = 0; j < next.size(); ++j) tension[j] = next[j] == 0.0 ? 0.0 : larger(tension[j], 0.0);
}

bool FrictionRounds::run(const Settings& settings, const Solution& blank, const Solution& guess, const HistoryLimit& limit,
                         FrictionSettled& out) {
    const std::vector<double>& tension = blank.tension;
    const Actuation<double> actuation{tension.data(), blank.rotation.data(), blank.translation.data(), 1.0, 1.0};
    const double aim = settings.residual_tolerance;
    bool looked = !limit.near;
    std::vector<double> none;
    Solution near = blank;
    const Solution* from = &guess;  // a neighbour; none: the round before
    while (rounds < MOST_ROUNDS) {
        profile(tension);
        const Robot view = robot.view();
        NewtonSolver newton(view, actuation, settings);
        const bool rigid = newton.shooting.unknowns == 0;
        const auto too_long = [&] {  // for all that the wraps may still change
            if (looked || !(missed <= LOOK_BELOW * limit.most)) return false;
            looked = true;
            history_missed = missed_of_history(channels_, *limit.near, after_, profiles, tension, limit.most);
            return history_missed > limit.most + 2.0 * missed;
        };
        const bool seen = !channels_.empty() && glance(newton, from, near);
        if (seen && too_long()) return false;
        if (!seen) {
            Solution found = blank;
            solve(view, actuation, settings, &guess, found);
            if (found.status != Status::converged) return false;
            near = std::move(found);
            step_.assign(newton.shooting.unknowns, 0.0);
            section_tolerance_ = SECTION_TOLERANCE;
            if (!measure(robot, near) || too_long()) return false;
        } else if (rigid && missed <= aim && mesh_error_ <= settings.tolerance) {
            near.discretisation_error = mesh_error_;
            near.length_error = 0.0;
            near.mesh.excess.clear();
        } else if (rigid && missed <= aim) {  // what its steps err is yet to be known
            const auto steps = near.mesh.steps;
            const auto grade = near.mesh.grade;
            if (!newton.polish(near)) return false;
            const bool known = near.mesh.steps == steps && near.mesh.grade == grade;
            if (!known && (!measure(robot, near) || too_long())) return false;
        }
        from = nullptr;
        if (missed <= aim && section_tolerance_ <= SECTION_TOLERANCE && near.discretisation_error <= settings.tolerance && near.base_residual <= settings.residual_tolerance) {
            if (!NewtonSolver::succeed(near)) return false;
            settle(std::move(robot), std::move(near), out);
            return true;
        }
        mix(none, none);
    }
    return false;
}

/// Without unknowns, a neighbour's mesh is all that is asked for.
bool FrictionRounds::lead(NewtonSolver& newton, const Solution& from, const FreeEnd<double>* ahead, Solution& near) {
    if (newton.shooting.unknowns > 0) return newton.lead(from, near, ahead);
    return newton.take_over(from, near) || newton.carry_over(from, near);
}

/// Sections are solved no better than what is missed before asks for; to their tolerance where that is little.
double FrictionRounds::section_tolerance(double still_missed) const {
    if (still_missed < LAST_ROUNDS * precision_) return SECTION_TOLERANCE;
    return std::clamp(SECTIONS_SHARE * still_missed, SECTION_TOLERANCE, ROUGHEST);
}

bool FrictionRounds::glance(NewtonSolver& newton, const Solution* from, Solution& near) {
    const int unknowns = newton.shooting.unknowns;
    section_tolerance_ = section_tolerance(from ? first_missed_ : missed);
    if (from) {
        if (!lead(newton, *from, ahead_ ? &*ahead_ : nullptr, near)) return false;
    } else {
        const FreeEnd<double> before = near.free_end;
        newton.shooting.move(before, step_.data(), 1.0, near.free_end);
        if (near.mesh.steps.size() != newton.layout.sections.size()) {  // a front has come or gone
            const Solution last = near;
            if (!lead(newton, last, &last.free_end, near)) return false;
        } else if (unknowns > 0 && missed > LITTLE * precision_ && !newton.step_by_derivatives(near, section_tolerance_)) {
            return false;
        }
        if (newton.shooting.distance(before, near.free_end) > Stride::CLOSE) return false;
    }
    WrapReader reader(channels_, joints_, section_tolerance_);
    if (!reader.read(newton, near, after_)) return false;
    mesh_error_ = reader.error();
    newton.note_edges(near);
    double step[MAX_UNKNOWNS];
    if (!newton.chord(near, step)) return false;
    step_.assign(step, step + unknowns);
    near.status = Status::converged;
    ++rounds;
    if (!compare()) return false;
    if (from) first_missed_ = missed;
    return true;
}

void FrictionRounds::settle(RobotTables<double>&& shaped, Solution&& solution, FrictionSettled& out) {
    out.robot = std::move(shaped);
    out.solution = std::move(solution);
    out.profiles = std::move(profiles);
    for (auto& profile : out.profiles)
        if (profile) profile = thinned(*profile, THIN * precision_);
    out.wraps = std::move(after_);
    out.missed = missed;
    out.first_missed = first_missed_;
    out.rounds = rounds;
    out.pairs = std::move(pairs_);
    out.at = at_;
}

RobotTables<double> FrictionRounds::rates(const RobotTables<double>& still, size_t channel, double tension, bool all) const {
    RobotTables<double> out = still;
    out.profiles.clear();
    for (size_t j = 0; j < robot.tendons.size(); ++j) {
        const Tendon& tendon = robot.tendons[j];
        out.tendons[j].profile_begin = tendon.profile_begin;
        out.tendons[j].profile_end = tendon.profile_end;
        for (int k = tendon.profile_begin; k < tendon.profile_end; ++k) {
            TensionPiece rate{0.0, robot.profiles[k].count, {}};
            if (channels_[channel].tendon == static_cast<int>(j) && (all || profiles[channel]->driven[k - tendon.profile_begin]))
                for (int i = 0; i < rate.count; ++i) rate.c[i] = robot.profiles[k].c[i] / tension;
            out.profiles.push_back(rate);
        }
    }
    return out;
}

void FrictionRounds::numbers_of(const std::vector<Wrap>& wraps, std::vector<double>& out) const {
    out.clear();
    for (size_t c = 0; c < wraps.size(); ++c) {
        const auto& joints = joints_[c];
        for (size_t k = 0; k + 1 < joints.size() && !channels_[c].over_disks; ++k)
            for (double rise : wraps[c].rise.at(points_between(joints[k], joints[k + 1]))) out.push_back(rise);
        for (double joint : joints) out.push_back(wraps[c].jump_at(joint));
    }
}

void FrictionRounds::add(const std::vector<double>& numbers, std::vector<Wrap>& wraps) const {
    size_t n = 0;
    for (size_t c = 0; c < wraps.size(); ++c) {
        if (!channels_[c].over_disks) add_rises(joints_[c], &numbers[n], wraps[c].rise);
        if (!channels_[c].over_disks) n += (joints_[c].size() - 1) * CURVE_POINTS;
        for (double joint : joints_[c]) {
            const double jump = numbers[n++];
            const auto& edges = wraps[c].rise.edges;
            for (size_t k = 0; k < edges.size() && jump != 0.0; ++k)
                if (std::fabs(edges[k] - joint) <= EDGE_GAP) {
                    wraps[c].jumps[k] = larger(wraps[c].jumps[k] + jump, 0.0);
                    break;
                }
        }
    }
}

}  // namespace tactr
