// From one robot at one actuation to a plan and a row of numbers for the lock-step solver; or no: it is not for packs.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "bare_section.hpp"
#include "free_end.hpp"
#include "lane_plan.hpp"
#include "robot_tables.hpp"
#include "sections.hpp"

namespace tactr {

class LanePacker {
  public:
    LanePlan plan;
    std::vector<double> numbers;
    bool loaded = false;

    /// False: too many of something, loads in world axes, tension profiles, or tendons that end on another tube than their
    /// host; single configurations have a solver for these. The rotations and tensions are left open: see actuate.
    bool pack(const RobotTables<double>& tables, const double* translation, double residual_tolerance) {
        std::memset(static_cast<void*>(&plan), 0, sizeof plan);
        numbers.clear();
        const Robot robot = tables.view();
        if (robot.tube_count > LANE_TUBES || robot.tendon_count > LANE_TENDONS || !robot.tubes) return false;
        const Layout<double> layout = cut_into_sections(robot, translation);
        const Shooting shooting(robot, layout);
        for (int i = 0; i < robot.tube_count; ++i)
            if (robot.tubes[i].rotation_compliance > 0.0) return false;
        if (shooting.world || layout.sections.size() > LANE_SECTIONS) return false;
        loaded = shooting.loaded;
        plan.tubes = robot.tube_count;
        plan.tendons = robot.tendon_count;
        plan.sums = shooting.sums;
        plan.tip_tube = shooting.tip_tube;
        plan.section_count = static_cast<int>(layout.sections.size());
        place_shared(robot, shooting, translation, residual_tolerance);
        piece_place_.assign(tables.pieces.size(), -1);
        routing_place_.assign(tables.routing.size(), -1);
        for (int k = 0; k < plan.section_count; ++k)
            if (!place_section(robot, layout, k)) return false;
        plan.numbers = static_cast<int>(numbers.size());
        return true;
    }

    void actuate(const double* tension, const double* rotation, double* row) const {
        std::copy_n(rotation, plan.tubes, row + plan.rotation);
        std::copy_n(tension, plan.tendons, row + plan.tension);
    }

  private:
    std::vector<int> piece_place_, routing_place_;

    int append(const double* from, int count) {
        const int place = static_cast<int>(numbers.size());
        numbers.insert(numbers.end(), from, from + count);
        return place;
    }

    void place_shared(const Robot& robot, const Shooting& shooting, const double* translation, double residual_tolerance) {
        const std::vector<double> open(robot.tube_count + robot.tendon_count, 0.0);
        plan.rotation = append(open.data(), robot.tube_count);
        plan.tension = append(open.data(), robot.tendon_count);
        plan.translation = append(translation, robot.tube_count);
        plan.moment_scale = append(&shooting.moment_scale, 1);
        plan.force_scale = append(&shooting.force_scale, 1);
        plan.psi_weight = append(&shooting.error_weight[PSI], 1);
        plan.n3_weight = append(&shooting.error_weight[N3], robot.tube_count);
        plan.m3_weight = append(&shooting.error_weight[M3], robot.tube_count);
        plan.sum_weight = append(&shooting.error_weight[SUM_N], 1);
        append(&shooting.error_weight[SUM_M], 1);
        plan.residual_tolerance = append(&residual_tolerance, 1);
    }

    bool place_section(const Robot& robot, const Layout<double>& layout, int k) {
        constexpr double MOST_WINDING = 4.0;  // rad a step, as for single configurations
        const Section<double>& from = layout.sections[k];
        LaneSection& to = plan.sections[k];
        const double ends[2] = {from.proximal, from.distal};
        to.first = append(ends, 2);
        const double steps = std::ceil(from.winding / MOST_WINDING);
        if (!(steps <= LANE_STEPS)) return false;
        to.steps = std::max(1, static_cast<int>(steps));
        to.guided = from.guided;
        to.even = from.even;
        to.active_count = from.active_count;
        to.hosted_count = from.hosted.end - from.hosted.begin;
        to.bare = to.hosted_count == 0;
        for (int a = 0; a < from.active_count; ++a) {
            to.active[a] = from.active[a];
            to.piece[a] = place_piece(robot.pieces[from.piece[a]], from.piece[a]);
            to.bare = to.bare && bends_alike(robot.pieces[from.piece[a]]);
        }
        if (to.hosted_count > LANE_HOSTED) return false;
        for (int h = 0; h < to.hosted_count; ++h)
            if (!place_hosted(robot, layout, k, layout.hosted[from.hosted.begin + h], to.hosted[h])) return false;
        if (k + 1 < plan.section_count) list_hand_overs(layout, from, layout.sections[k + 1], to);
        return place_loads(robot, layout, from, to);
    }

    LanePiece place_piece(const TubePiece& piece, int index) {
        if (piece_place_[index] < 0) {
            piece_place_[index] = append(&piece.start, 1);
            for (int c = 0; c < piece.count; ++c) append(piece.c[c], QUANTITIES);
        }
        return {piece_place_[index], piece.count, piece.plain};
    }

    bool place_hosted(const Robot& robot, const Layout<double>& layout, int k, const Hosted& hosted, LaneHosted& to) {
        const Tendon& tendon = robot.tendons[hosted.tendon];
        const bool goes_on = k + 1 < plan.section_count && host_of(layout, layout.sections[k + 1], hosted.tendon) >= 0;
        if (hosted.profile >= 0 || (layout.sections[k].active[hosted.slot] != tendon.tube && !goes_on)) return false;
        const RoutingPiece& routing = robot.routing[hosted.routing];
        if (routing_place_[hosted.routing] < 0) {
            routing_place_[hosted.routing] = append(&routing.start, 1);
            append(routing.a, routing.count_a);
            append(routing.b, routing.count_b);
        }
        to = {hosted.tendon, hosted.slot, plan.translation + tendon.tube, routing_place_[hosted.routing], routing.polar,
              routing.count_a, routing.count_b};
        return true;
    }

    static int host_of(const Layout<double>& layout, const Section<double>& section, int tendon) {
        for (int h = section.hosted.begin; h < section.hosted.end; ++h)
            if (layout.hosted[h].tendon == tendon) return section.active[layout.hosted[h].slot];
        return -1;
    }

    static void list_hand_overs(const Layout<double>& layout, const Section<double>& from, const Section<double>& beyond, LaneSection& to) {
        for (int h = beyond.hosted.begin; h < beyond.hosted.end; ++h) {
            const int host = host_of(layout, from, layout.hosted[h].tendon), before = beyond.active[layout.hosted[h].slot];
            if (host >= 0 && host != before) to.handed[to.handed_count++] = {h - beyond.hosted.begin, before, host};
        }
    }

    bool place_loads(const Robot& robot, const Layout<double>& layout, const Section<double>& from, LaneSection& to) {
        to.point_count = from.point_loads.end - from.point_loads.begin;
        to.distributed_count = from.distributed_loads.end - from.distributed_loads.begin;
        if (to.point_count > LANE_LOADS || to.distributed_count > LANE_LOADS) return false;
        for (int p = 0; p < to.point_count; ++p) {
            const SectionLoad& placed = layout.point_loads[from.point_loads.begin + p];
            to.point[p] = {placed.slot, append(robot.point_loads[placed.load].force, 3)};
            append(robot.point_loads[placed.load].moment, 3);
        }
        for (int d = 0; d < to.distributed_count; ++d) {
            const SectionLoad& placed = layout.distributed_loads[from.distributed_loads.begin + d];
            to.distributed[d] = {placed.slot, append(robot.distributed_loads[placed.load].force, 3)};
            append(robot.distributed_loads[placed.load].moment, 3);
        }
        return true;
    }
};

}  // namespace tactr
