// Solves the configurations of one chunk in packs: those with the same plan and steps go side by side. Which others are in
// the chunk, and where, makes no difference to any of them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "lane_packer.hpp"
#include "lanes_door.hpp"
#include "solution.hpp"

namespace tactr {

/// What solves a pack, and how many it takes at most. fixed: its rows are always as wide.
struct LanesUnit {
    TactrLanesDoor door;
    int width;
    bool fixed, own_memory;
};

class LaneChunk {
  public:
    explicit LaneChunk(double tolerance, const LanesUnit& unit) : tolerance_(tolerance), unit_(unit) {}

    /// False: it is not for packs.
    bool add(std::size_t item, const RobotTables<double>& robot, const double* tension, const double* rotation, const double* translation,
             double residual_tolerance) {
        if (!seen(robot, translation, residual_tolerance)) {
            robot_ = &robot;
            residual_tolerance_ = residual_tolerance;
            translation_.assign(translation, translation + robot.tubes.size());
            fits_ = packer_.pack(robot, translation, residual_tolerance);
            if (fits_) plan_ = place_of_plan();
        }
        if (!fits_) return false;
        Job job{};
        job.item = item;
        job.plan = plan_;
        job.loaded = packer_.loaded;
        job.row = rows_.size();
        rows_.insert(rows_.end(), packer_.numbers.begin(), packer_.numbers.end());
        packer_.actuate(tension, rotation, rows_.data() + job.row);
        for (int k = 0; k < plans_[plan_].section_count; ++k) job.steps[k] = static_cast<std::int16_t>(plans_[plan_].sections[k].steps);
        job.pending = true;
        jobs_.push_back(job);
        return true;
    }

    /// take(item, solution, sure): for every configuration that was solved; sure: that it is stable.
    template <class F>
    void solve(F&& take) {
        run(LANES_BEGIN);
        for (Job& job : jobs_) job.pending = job.results[LaneResults::ALIVE] == 1.0 && choose_steps(job);
        for (int round = 0; round < MOST_ROUNDS && run(round == 0 ? LANES_FAR : LANES_NEAR); ++round)
            for (Job& job : jobs_)
                if (job.pending) judge(job, take);
    }

  private:
    static constexpr int MOST_ROUNDS = 6;
    // As in newton.hpp; but there, the first march is on the steps that it finds, here on the coarsest.
    static constexpr double MESH_SLACK = 2.0, SINGLE_STEP_SHARE = 0.15, LEAST_STRETCH = 0.2;

    struct Job {
        std::size_t item, row;
        int plan;
        bool loaded, pending;
        std::array<std::int16_t, LANE_SECTIONS> steps;
        std::array<double, LaneResults::ROWS> results;
    };

    const double tolerance_;
    const LanesUnit unit_;
    LanePacker packer_;
    const RobotTables<double>* robot_ = nullptr;
    double residual_tolerance_ = 0.0;
    std::vector<double> translation_;
    bool fits_ = false;
    int plan_ = 0;
    std::vector<LanePlan> plans_;
    std::vector<double> rows_;
    std::vector<Job> jobs_;
    std::vector<double> numbers_, results_;
    std::vector<float> memory_;

    bool seen(const RobotTables<double>& robot, const double* translation, double residual_tolerance) const {
        return robot_ == &robot && residual_tolerance_ == residual_tolerance &&
               std::equal(translation_.begin(), translation_.end(), translation);
    }

    int place_of_plan() {
        for (std::size_t p = 0; p < plans_.size(); ++p)
            if (std::memcmp(&plans_[p], &packer_.plan, sizeof(LanePlan)) == 0) return static_cast<int>(p);
        plans_.push_back(packer_.plan);
        return static_cast<int>(plans_.size()) - 1;
    }

    /// Rows of a pack begin where lines of the cache do.
    template <class A>
    static A* aligned(std::vector<A>& store, std::size_t size) {
        constexpr std::size_t BYTES = 64;
        if (store.size() < size + BYTES / sizeof(A)) store.resize(size + BYTES / sizeof(A));
        const auto at = reinterpret_cast<std::uintptr_t>(store.data());
        return store.data() + ((BYTES - at % BYTES) % BYTES) / sizeof(A);
    }

    /// All that is pending, in packs. False: nothing was.
    bool run(LanePhase phase) {
        std::vector<Job*> order;
        for (Job& job : jobs_)
            if (job.pending) order.push_back(&job);
        std::stable_sort(order.begin(), order.end(), [](const Job* a, const Job* b) {
            if (a->plan != b->plan) return a->plan < b->plan;
            if (a->steps != b->steps) return a->steps < b->steps;
            return a->results[LaneResults::BASE_RESIDUAL] < b->results[LaneResults::BASE_RESIDUAL];
        });
        for (std::size_t first = 0; first < order.size();) {
            std::size_t end = first;
            while (end < order.size() && end < first + unit_.width && order[end]->plan == order[first]->plan && order[end]->steps == order[first]->steps) ++end;
            run_pack(&order[first], static_cast<int>(end - first), phase);
            first = end;
        }
        return !order.empty();
    }

    void run_pack(Job* const* jobs, int count, LanePhase phase) {
        LanePlan& plan = plans_[jobs[0]->plan];
        std::size_t stages = 0;
        for (int k = 0; k < plan.section_count; ++k) {
            plan.sections[k].steps = jobs[0]->steps[k];
            stages += plan.sections[k].even ? 1 : dp8::STAGES * plan.sections[k].steps;
        }
        const std::size_t width = unit_.fixed ? unit_.width : count, memory_rows = stages * LANE_STRAINS * (1 + LANE_UNKNOWNS);
        double* numbers = aligned(numbers_, plan.numbers * width);
        double* results = aligned(results_, LaneResults::ROWS * width);
        float* memory = unit_.own_memory ? nullptr : aligned(memory_, memory_rows * width);
        for (std::size_t l = 0; l < width; ++l) {
            const Job& job = *jobs[std::min<std::size_t>(l, count - 1)];  // short of company, the last one is its own
            for (int n = 0; n < plan.numbers; ++n) numbers[n * width + l] = rows_[job.row + n];
            for (int r = 0; r < LaneResults::ROWS; ++r) results[r * width + l] = job.results[r];
        }
        if (const int error = unit_.door(&plan, phase, count, static_cast<long>(memory_rows), numbers, memory, results))
            throw std::runtime_error("the device failed with error " + std::to_string(error));
        for (int l = 0; l < count; ++l)
            for (int r = 0; r < LaneResults::ROWS; ++r) jobs[l]->results[r] = results[r * width + l];
    }

    double section_error(const Job& job, int k) const { return job.results[LaneResults::SECTION_ERROR + k]; }
    double length_error(const Job& job, int k) const { return job.results[LaneResults::SECTION_LENGTH_ERROR + k]; }

    /// As many as an eighth-order rule needs, from the errors of the coarsest steps. False: too many for a pack.
    bool choose_steps(Job& job) const {
        const LanePlan& plan = plans_[job.plan];
        int total = 0;
        for (int k = 0; k < plan.section_count; ++k) {
            const double excess = larger(section_error(job, k), length_error(job, k)) / (MESH_SLACK * tolerance_);
            if (!std::isfinite(excess)) return false;
            if (excess > 1.0) job.steps[k] = steps_for(job.steps[k], 2.0 * excess, 8.0);
            total += job.steps[k];
        }
        return total <= LANE_STEPS;
    }

    static std::int16_t steps_for(int now, double excess, double most) {
        return static_cast<std::int16_t>(std::max(now + 1, static_cast<int>(std::ceil(smaller(most, std::pow(excess, 0.125)) * now))));
    }

    double largest_error(const Job& job) const {
        double largest = 0.0;
        for (int k = 0; k < plans_[job.plan].section_count; ++k) largest = larger(largest, section_error(job, k));
        return largest;
    }

    bool is_doubtful(const Job& job, int k, double largest) const {
        return job.steps[k] == 1 && section_error(job, k) > (job.loaded ? 0.01 : 0.3) * largest;
    }

    template <class F>
    void judge(Job& job, F&& take) {
        const LanePlan& plan = plans_[job.plan];
        const double* r = job.results.data();
        job.pending = false;
        if (r[LaneResults::ALIVE] != 1.0 || !(r[LaneResults::LEAST_STRETCH] >= LEAST_STRETCH)) return;
        double allowed = tolerance_, largest = largest_error(job);
        for (int k = 0; k < plan.section_count; ++k)
            if (is_doubtful(job, k, largest)) allowed = (job.loaded ? 0.03 : SINGLE_STEP_SHARE) * tolerance_;
        if (r[LaneResults::ERROR] <= allowed && r[LaneResults::LENGTH_ERROR] <= tolerance_) {
            take(job.item, solution_of(job), plan.tubes == 1 || r[LaneResults::FAR_FROM_SNAPPING] == 1.0);
        } else {
            job.pending = refine(job, allowed, largest);
        }
    }

    /// More steps where the error comes from, as for single configurations; not graded.
    bool refine(Job& job, double allowed, double largest) const {
        const LanePlan& plan = plans_[job.plan];
        const double relief = allowed / larger(allowed, SINGLE_STEP_SHARE * tolerance_);
        double longest = 0.0;
        for (int k = 0; k < plan.section_count; ++k) longest = larger(longest, length_error(job, k));
        int total = 0;
        bool finer = false;
        const Job before = job;
        for (int k = 0; k < plan.section_count; ++k) {
            const double tip = largest > 0.0 ? job.results[LaneResults::ERROR] / (0.5 * allowed) * section_error(job, k) / largest : 0.0;
            const double tendon = longest > 0.0 ? job.results[LaneResults::LENGTH_ERROR] / (0.5 * tolerance_) * length_error(job, k) / longest : 0.0;
            const double excess = larger(tip, tendon);
            const bool doubtful = allowed < tolerance_ && is_doubtful(before, k, largest);
            if (!std::isfinite(excess)) return false;
            if (excess > 0.7 || doubtful) {
                job.steps[k] = steps_for(job.steps[k], larger(1.0, excess * relief), 3.0);
                finer = true;
            }
            total += job.steps[k];
        }
        return finer && total <= LANE_STEPS;
    }

    Solution solution_of(const Job& job) const {
        const LanePlan& plan = plans_[job.plan];
        const double *r = job.results.data(), *row = rows_.data() + job.row;
        const int n = plan.tubes - 1;
        Solution solution;
        solution.status = Status::converged;
        solution.iterations = static_cast<int>(r[LaneResults::MARCHES]);
        solution.base_residual = r[LaneResults::BASE_RESIDUAL];
        solution.section_residual = r[LaneResults::SECTION_RESIDUAL];
        solution.discretisation_error = r[LaneResults::ERROR];
        solution.length_error = r[LaneResults::LENGTH_ERROR];
        solution.least_stretch = r[LaneResults::LEAST_STRETCH];
        solution.base_determinant = r[LaneResults::DETERMINANT];
        solution.stability = StabilityFound::stable;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) solution.jacobian[i][j] = r[LaneResults::JACOBIAN + i * n + j];
        for (int i = 0; i < plan.tubes; ++i) solution.free_end.psi[i] = r[LaneResults::PSI + i];
        for (int c = 0; c < 4; ++c) solution.free_end.quaternion[c] = c == 0;
        solution.mesh.steps.assign(job.steps.begin(), job.steps.begin() + plan.section_count);
        solution.mesh.grade.assign(plan.section_count, 1.0);
        solution.mesh.fit();
        solution.tension.assign(row + plan.tension, row + plan.tension + plan.tendons);
        solution.rotation.assign(row + plan.rotation, row + plan.rotation + plan.tubes);
        solution.translation.assign(row + plan.translation, row + plan.translation + plan.tubes);
        solution.tendon_length.assign(r + LaneResults::LENGTH, r + LaneResults::LENGTH + plan.tendons);
        std::copy_n(r + LaneResults::TIP, 3, solution.tip_position);
        std::copy_n(r + LaneResults::QUATERNION, 4, solution.tip_quaternion);
        return solution;
    }
};

}  // namespace tactr
