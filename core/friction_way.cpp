#include "friction_way.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace tactr {

namespace {

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += (b[i] - a[i]) * (b[i] - a[i]);
    return std::sqrt(sum);
}

std::vector<double> towards(const std::vector<double>& a, const std::vector<double>& b, double part) {
    if (part == 1.0) return b;
    std::vector<double> out(a.size());
    for (size_t i = 0; i < a.size(); ++i) out[i] = (1.0 - part) * a[i] + part * b[i];
    return out;
}

/// Tensions, rotations and translations of a place.
Solution blank_at(const RobotTables<double>& robot, const std::vector<double>& at) {
    Solution blank;
    const auto tension = at.begin(), rotation = tension + robot.tendons.size(), translation = rotation + robot.tubes.size();
    blank.tension.assign(tension, rotation);
    blank.rotation.assign(rotation, translation);
    blank.translation.assign(translation, translation + robot.tubes.size());
    return blank;
}

void add(const FrictionSpent& step, FrictionSpent& sum) {
    sum.heat.resize(step.heat.size());
    sum.creep.resize(step.creep.size());
    for (size_t c = 0; c < step.heat.size(); ++c) {
        sum.heat[c] += step.heat[c];
        sum.creep[c] = larger(sum.creep[c], step.creep[c]);
    }
}

}  // namespace

bool FrictionWay::reach(const std::vector<double>& at, WayPoint& out) {
    const auto start = std::chrono::steady_clock::now();
    const Here here{old_, found};
    const std::vector<double> before = found.front()->at;
    const double way = distance(before, at);
    double done = 0.0, length = stride < way ? stride / way : 1.0, missed = 0.0;
    while (done < 1.0) {
        const double parts = std::ceil((1.0 - done) / larger(length, cuts_.shortest) - cuts_.stretch);
        const double to = parts <= 1.0 ? 1.0 : done + (1.0 - done) / parts;
        length = to - done;
        const bool halves = length > (1.0 + 2.0 * cuts_.stretch) * cuts_.shortest;
        FrictionSpent spent;
        if (step(towards(before, at, to), halves, missed, spent)) {
            add(spent, out.spent);
            done = to;
            ++out.steps;
            length *= smaller(4.0, of_step(missed));
        } else if (halves) {
            length *= std::clamp(of_step(missed), 0.1, 0.5);
        } else {
            old_ = here.old;
            found = here.found;
            return false;
        }
    }
    if (way > 0.0) stride = length * way;
    out.settled = found.front();
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return true;
}

bool FrictionWay::step(const std::vector<double>& at, bool halves, double& missed, FrictionSpent& spent) {
    const Solution blank = blank_at(plain_, at);
    FrictionRounds rounds(plain_, channels_, old_, at, blank.translation, settings_.residual_tolerance);
    std::vector<const FrictionSettled*> past;
    for (size_t k = 1; k < found.size(); ++k) past.push_back(found[k].get());
    auto next = std::make_shared<FrictionSettled>();
    const bool taken = friction_step(rounds, channels_, *found.front(), past, settings_, blank, halves ? &cuts_.limits : nullptr, *next, spent);
    missed = rounds.history_missed;
    if (!taken) return false;
    for (size_t c = 0; c < old_.size(); ++c)
        old_[c] = next->profiles[c] ? std::optional<Curve>(next->profiles[c]->log) : std::nullopt;
    found.insert(found.begin(), std::move(next));
    if (found.size() > MOST_FOUND) found.pop_back();
    return true;
}

double FrictionWay::of_step(double missed) const {
    return missed > 0.0 ? cuts_.careful * std::sqrt(cuts_.limits.missed / missed) : std::numeric_limits<double>::infinity();
}

}  // namespace tactr
