// A way with friction of tendons along points of actuation, each reached in as many steps as it takes.
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "friction_step.hpp"

namespace tactr {

/// One point that was reached.
struct WayPoint {
    std::shared_ptr<const FrictionSettled> settled;
    int steps = 0;
    FrictionSpent spent;  // on the way to it
    double seconds = 0.0;
};

class FrictionWay {
  public:
    /// How ways are cut. limits: of a step that is longer than the shortest, a share of the way between two points.
    struct Cuts {
        StepLimits limits;
        double shortest, careful, stretch;
    };

    std::vector<std::shared_ptr<const FrictionSettled>> found;  // the latest first: where it is, and those before that
    double stride;  // how far a step may be expected to get

    /// old: log tension where the way starts.
    FrictionWay(const RobotTables<double>& plain, const std::vector<FrictionChannel>& channels, const Settings& settings,
                const Cuts& cuts, std::vector<std::optional<Curve>> old, std::vector<std::shared_ptr<const FrictionSettled>> found_,
                double stride_)
        : found(std::move(found_)), stride(stride_), plain_(plain), channels_(channels), settings_(settings), cuts_(cuts),
          old_(std::move(old)) {}

    /// at: all numbers of a point, tension and rotation and translation first. False: a step that may be no shorter was not
    /// found; the way is then where it was.
    bool reach(const std::vector<double>& at, WayPoint& out);

  private:
    static constexpr size_t MOST_FOUND = 3;

    const RobotTables<double>& plain_;
    const std::vector<FrictionChannel>& channels_;
    const Settings settings_;
    const Cuts cuts_;
    std::vector<std::optional<Curve>> old_;

    struct Here {  // to come back to
        std::vector<std::optional<Curve>> old;
        std::vector<std::shared_ptr<const FrictionSettled>> found;
    };

    /// One step. missed: of its history.
    bool step(const std::vector<double>& at, bool halves, double& missed, FrictionSpent& spent);

    /// How much longer a step may be than one that missed so much of its history; infinite: not known.
    double of_step(double missed) const;
};

}  // namespace tactr
