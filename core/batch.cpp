#include "batch.hpp"

#include <algorithm>
#include <cmath>

#include "energetics.hpp"
#include "lane_chunk.hpp"
#include "sample.hpp"
#include "sensitivity.hpp"
#include "solve.hpp"
#include "stability_report.hpp"
#include "thread_pool.hpp"

namespace tactr {

namespace {

constexpr std::size_t LEAST_CHUNK = 32, MOST_CHUNK = 512;  // the larger, the more alike are those in a pack
constexpr int STABILITY_SAMPLES = 8;  // per step

/// |u - u*| and |v - v*| of one tube at one station, where they are larger than found before.
void raise_strains(const RobotTables<double>& robot, std::size_t t, double sigma, const StationRecord& at, double* worst) {
    int k = robot.tubes[t].piece_begin;
    while (k + 1 < robot.tubes[t].piece_end && robot.pieces[k + 1].start <= sigma) ++k;
    const TubeState<double> tube = tube_at(robot.pieces[k], sigma, 1.0);
    for (int c = 0; c < 3; ++c) {
        worst[c] = larger(worst[c], std::fabs(at.u[t][c] - tube.ustar[c]));
        worst[3 + c] = larger(worst[3 + c], std::fabs(at.v[t][c] - tube.vstar[c] - (c == 2 ? 1.0 : 0.0)));
    }
}

void largest_strains(const RobotTables<double>& robot, const Solution& solution, const std::vector<double>& stations,
                     const Samples& samples, double* worst) {
    std::fill_n(worst, 6 * robot.tubes.size(), 0.0);
    for (std::size_t k = 0; k < stations.size(); ++k)
        for (std::size_t t = 0; t < robot.tubes.size(); ++t)
            if (samples.stations[k].present[t])
                raise_strains(robot, t, stations[k] - solution.translation[t], samples.stations[k], worst + 6 * t);
}

constexpr int SINGLES = 64, DEVICE_CHUNK = 16384;  // configurations at once

LanesUnit unit_of(const BatchRequest& request) {
    Lanes lanes = request.lanes;
    if (lanes == Lanes::widest) lanes = has_lanes(Lanes::avx2) ? Lanes::avx2 : Lanes::baseline;
#ifdef TACTR_HAS_AVX2
    if (lanes == Lanes::avx2) return {tactr_lanes_avx2, TACTR_LANES_SIDE_BY_SIDE, true, false};
#endif
    if (lanes == Lanes::baseline) return {tactr_lanes_baseline, TACTR_LANES_SIDE_BY_SIDE, true, false};
    if (lanes == Lanes::single) return {tactr_lanes_single, SINGLES, false, false};
    return {lanes == Lanes::device ? request.device : nullptr, DEVICE_CHUNK, false, true};
}

class BatchSolver {
  public:
    BatchSolver(const BatchRequest& request, const BatchResult& result)
        : in_(request), out_(result), tubes_(request.robots.front()->tubes.size()), tendons_(request.robots.front()->tendons.size()) {}

    /// In packs as far as they go; what does not go straight there, one by one.
    void solve(std::size_t begin, std::size_t end) const {
        std::vector<char> open(end - begin);
        for (std::size_t i = begin; i < end; ++i) open[i - begin] = !in_.skip[i];
        const LanesUnit unit = unit_of(in_);
        if (unit.door) {
            LaneChunk chunk(in_.tolerance, unit);
            for (std::size_t i = begin; i < end; ++i)
                if (open[i - begin])
                    chunk.add(i, robot(i), in_.tension + i * tendons_, in_.rotation + i * tubes_, in_.translation + i * tubes_, in_.residual_tolerance[i]);
            chunk.solve([&](std::size_t i, const Solution& solution, bool sure) {
                StabilityReport report;
                if (!sure && !(stability_of(robot(i).view(), solution, 0, report) && report.stable)) return;
                out_.side_by_side[i] = 1;
                write(i, solution);
                open[i - begin] = 0;
            });
        }
        for (std::size_t i = begin; i < end; ++i)
            if (open[i - begin]) solve_item(i);
    }

  private:
    const BatchRequest& in_;
    const BatchResult& out_;
    const std::size_t tubes_, tendons_;

    const RobotTables<double>& robot(std::size_t i) const { return *in_.robots[in_.robots.size() == 1 ? 0 : i]; }

    void solve_item(std::size_t i) const {
        const auto row = [i](const double* table, std::size_t width) {
            return std::vector<double>(table + i * width, table + (i + 1) * width);
        };
        Solution solution;
        solution.tension = row(in_.tension, tendons_);
        solution.rotation = row(in_.rotation, tubes_);
        solution.translation = row(in_.translation, tubes_);
        const Actuation<double> actuation{solution.tension.data(), solution.rotation.data(), solution.translation.data(), 1.0, 1.0};
        Settings settings;
        settings.tolerance = in_.tolerance;
        settings.residual_tolerance = in_.residual_tolerance[i];
        settings.most_work = in_.most_work;
        tactr::solve(robot(i).view(), actuation, settings, nullptr, solution);
        write(i, solution);
    }

    void write(std::size_t i, const Solution& solution) const {
        out_.status[i] = static_cast<std::int8_t>(solution.status);
        out_.shortest_tendon[i] = solution.shortest_tendon;
        out_.discretisation_error[i] = larger(solution.discretisation_error, solution.length_error);
        out_.residual[i] = larger(solution.base_residual, solution.section_residual);
        if (solution.status != Status::converged) return;
        out_.unstable[i] = solution.stability == StabilityFound::unstable;
        std::copy_n(solution.tip_position, 3, out_.tip_position + 3 * i);
        std::copy_n(solution.tip_quaternion, 4, out_.tip_quaternion + 4 * i);
        std::copy_n(solution.tendon_length.data(), tendons_, out_.tendon_length + i * tendons_);
        if (out_.shape || out_.strain) write_samples(i, solution);
        if (out_.jacobian || out_.compliance) write_derivatives(i, solution);
        if (out_.margin) write_stability(i, solution);
        Energetics energetics;
        if (out_.energy && tactr::energetics(robot(i).view(), solution, energetics)) {
            out_.energy[i] = 0.0;
            for (double energy : energetics.strain_energy) out_.energy[i] += energy;
        }
    }

    void write_samples(std::size_t i, const Solution& solution) const {
        const double* first = in_.stations + (in_.own_stations ? i * in_.station_count : 0);
        const std::vector<double> stations(first, first + in_.station_count);
        Samples samples;
        if (!sample(robot(i).view(), solution, stations, samples)) return;
        for (std::size_t k = 0; out_.shape && k < in_.station_count; ++k)
            std::copy_n(samples.stations[k].position, 3, out_.shape + 3 * (i * in_.station_count + k));
        if (out_.strain) largest_strains(robot(i), solution, stations, samples, out_.strain + 6 * tubes_ * i);
    }

    void write_derivatives(std::size_t i, const Solution& solution) const {
        SensitivityRequest request;
        request.actuators = out_.jacobian != nullptr;
        double reach = 0.0;
        for (std::size_t t = 0; t < tubes_; ++t) reach = larger(reach, solution.translation[t] + robot(i).tubes[t].length);
        if (out_.compliance) request.probe = reach;
        Sensitivities found;
        if (!find_sensitivities(robot(i), solution, request, found)) return;
        const std::size_t actuators = request.actuators ? tendons_ + 2 * tubes_ : 0, columns = static_cast<std::size_t>(found.columns);
        for (std::size_t r = 0; r < 6; ++r) {
            const double* line = found.matrix.data() + r * columns;
            if (out_.jacobian) std::copy_n(line, actuators, out_.jacobian + (6 * i + r) * actuators);
            if (out_.compliance) std::copy_n(line + actuators, 6, out_.compliance + (6 * i + r) * 6);
        }
    }

    void write_stability(std::size_t i, const Solution& solution) const {
        StabilityReport report;
        if (!stability_of(robot(i).view(), solution, STABILITY_SAMPLES, report)) return;
        out_.margin[i] = report.margin;
        out_.stable[i] = report.stable;
    }
};

}  // namespace

bool has_lanes(Lanes lanes) {
#ifdef TACTR_HAS_AVX2
    if (lanes == Lanes::avx2) return __builtin_cpu_supports("avx2");
#endif
    return lanes != Lanes::avx2;
}

bool strain_maxima(const RobotTables<double>& robot, const Solution& solution, const std::vector<double>& stations, double* worst) {
    Samples samples;
    if (!sample(robot.view(), solution, stations, samples)) return false;
    largest_strains(robot, solution, stations, samples, worst);
    return true;
}

void solve_batch(const BatchRequest& request, const BatchResult& result, const std::function<bool()>& poll) {
    const BatchSolver solver(request, result);
    const bool device = request.lanes == Lanes::device;
    in_chunks(request.count, device ? DEVICE_CHUNK : LEAST_CHUNK, device ? DEVICE_CHUNK : MOST_CHUNK, request.threads,
              [&](std::size_t begin, std::size_t end) { solver.solve(begin, end); }, poll);
}

}  // namespace tactr
