// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/deadline_account.hpp"
#include "platform/machine/latency_histogram.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/tool_force.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

/// Maxima over the frames of one point.
struct SeriesPoint
{
    float force_n{0.0F}; ///< Largest force on a device.
    float width_m{0.0F}; ///< Widest bounds of a bounded or stale answer; 0 without one.
    float frame_us{0.0F};
    std::array<float, kStages> stage_us{};

    void take(const SeriesPoint& other) noexcept;
    bool operator==(const SeriesPoint&) const noexcept = default;
};

/// Position of a tool in the frame with the most force, among the frames of one point.
struct PathPoint
{
    std::array<float, 3> place_m{}; ///< Position of the proxy, in the world.
    float force_n{0.0F};            ///< Force on the device.

    void take(const PathPoint& other) noexcept { *this = other.force_n > force_n ? other : *this; }
    bool operator==(const PathPoint&) const noexcept = default;
};

/// Series of at most kPoints points over a run of any length. A point merges `stride()` frames by
/// take(). When all points are used, neighbours are merged and the stride doubles. The haptic
/// thread fills the series: no allocation, and at most one merged pair a frame. Other threads read
/// it once the loop has ended.
template <typename Point>
class Series
{
public:
    /// Largest number of points; the two lists take 128 KiB of SeriesPoint.
    static constexpr std::size_t kPoints = 2'048;

    Series() : now_(kPoints), before_(kPoints) {}

    void add(const Point& frame) noexcept;

    /// Frames of each point, a power of two. The last point may have fewer.
    [[nodiscard]] std::uint64_t stride() const noexcept { return stride_; }
    /// Points, oldest first.
    [[nodiscard]] std::vector<Point> points() const;

private:
    [[nodiscard]] Point merged(std::size_t pair) const noexcept;

    std::vector<Point> now_;
    /// Points of half the stride, from before the last doubling.
    std::vector<Point> before_;
    std::size_t unmerged_from_{kPoints}; ///< First pair of `before_` that is not in `now_` yet.
    std::size_t used_{0};                ///< Points of `now_`, including unmerged ones.
    std::uint64_t in_last_{0};           ///< Frames in the last point.
    std::uint64_t stride_{1};
};

using RunSeries = Series<SeriesPoint>;
using ToolPath = Series<PathPoint>;

extern template class Series<SeriesPoint>;
extern template class Series<PathPoint>;

/// Counts of answers, by kind. An object of it counts the frames of a run or those of one pair.
struct AnswerCounts
{
    std::uint64_t exact{0};
    std::uint64_t separated{0};
    std::uint64_t bounded{0};
    std::uint64_t stale{0};
    std::uint64_t within_tolerance{0};
    std::uint64_t longest_inexact_run{0};
    double width_max_m{0.0};     ///< Largest width U - L of a bounded or stale answer.
    double tolerated_max_m{0.0}; ///< Largest tolerated_m of an answer within the tolerance.

    void add(AnswerKind kind, double width_m, double tolerated_m) noexcept;
    [[nodiscard]] std::uint64_t in_all() const noexcept
    {
        return exact + separated + within_tolerance + bounded + stale;
    }

private:
    std::uint64_t inexact_run_{0};
};

/// Forces of one tool over the run. Maxima leave out the fade at the run's end.
struct ForceCounts
{
    double max_n{0.0};
    double max_step_n{0.0}; ///< Largest |F(k) - F(k - 1)|.
    double torque_max_nm{0.0};
    double torque_max_step_nm{0.0}; ///< Largest |T(k) - T(k - 1)|.
    double twist_max_rad{0.0};      ///< Largest angle between device and proxy, in contact.
    double fixture_max_n{0.0};      ///< Largest force of --fixture before it was limited.
    /// Largest force that carried a payload; no other member includes it.
    double load_max_n{0.0};
    /// Largest torque that carried a payload; no other member includes it.
    double load_max_nm{0.0};
    std::uint64_t contact_frames{0};
    std::uint64_t force_frames{0}; ///< Contact frames with a force sent.
    std::uint64_t halted_frames{0};
    std::uint64_t data_limited_frames{0};
    double lag_max_m{0.0}; ///< Largest ToolOutput::lag_m.
    /// Least stiffness to which a contact was reduced for the device; infinite if none was.
    double least_stiffness_n_per_m{kInfinity};
    double observed_energy_max_j{
        0.0}; ///< Largest SpringForce::observed_energy_j, of force or torque.
    std::array<std::uint64_t, kForceActions> conditioned{}; ///< Frames with each ForceAction.

    void add(const ToolOutput& output, const ToolForce& force) noexcept;

private:
    void add_sent(const ToolForce& force, bool in_contact) noexcept;

    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
    bool damped_air_{false}; ///< True if the last frame's force damped motion without contact.
};

/// Minimum, maximum and sum of a frame's work over the run.
struct WorkRange
{
    std::uint32_t min{0};
    std::uint32_t max{0};
    std::uint64_t sum{0};

    void add(std::uint32_t work, bool is_first) noexcept;
};

/// Statistics of a run, for its report. The haptic thread fills them without allocating; other
/// threads read them once the loop has ended.
class RunStatistics
{
public:
    RunStatistics(std::size_t tools, std::size_t objects, std::size_t models, Duration period);

    /// Adds a frame. `forces`: one a tool.
    void add(const FrameOutput& output, std::span<const ToolForce> forces,
             const CycleMeasures& measures) noexcept;

    /// All measured times, by the report's names. Allocates; call once the loop has ended.
    [[nodiscard]] std::vector<std::pair<const char*, LatencyHistogram>> times() const;

    std::uint64_t frames{0};
    std::array<LatencyHistogram, kStages> stages;
    LatencyHistogram frame;
    LatencyHistogram cpu; ///< Processor time of a frame.
    LatencyHistogram wake;
    RunSeries series;
    std::vector<ToolPath> paths; ///< Paths, one a tool.
    DeadlineAccount deadlines;
    AnswerCounts answers; ///< Answers of the frames; a frame counts by its worst pair.
    std::size_t objects;  ///< Capacity for objects: one more than their largest number.
    /// Answers of each pair, at index tool x `objects` + object number. A pair is counted in frames
    /// with its PairOutput.
    std::vector<AnswerCounts> pairs;
    std::vector<ForceCounts> tools;
    std::vector<ModelOutput> models; ///< Models of the last frame; `used_max` covers the run.

    std::uint64_t contact_frames{0}; ///< Frames with at least one tool in contact.
    /// Contact frames in which a tool in contact sent a force above 0.
    std::uint64_t force_frames{0};
    std::uint64_t data_limited_frames{0}; ///< Frames with at least one data-limited tool.
    std::uint64_t splits{0};
    std::uint64_t merges{0};
    std::uint64_t nodes_visited{0};
    std::uint64_t pages_adopted{0};
    std::uint64_t cache_hits{0};
    std::uint64_t cache_misses{0};
    std::uint64_t evictions{0};
    /// Number of skips of each kind, in the order of Skip.
    std::array<std::uint64_t, kSkips> skipped{};
    std::array<std::uint64_t, 32> faults{}; ///< Frames with each FrameFault bit.

    std::uint32_t objects_now{0}; ///< Objects in the last frame.
    std::uint32_t objects_max{0};
    std::uint32_t pairs_awake_max{0};
    /// Frames with a tool that is not proven clear of objects without a pair as far as it requests.
    std::uint64_t capacity_exceeded_frames{0};
    /// Frames with a tool held at an invisible wall: at its proven clearance, or at the box of a
    /// model that is not resident.
    std::uint64_t invisible_wall_frames{0};
    std::uint64_t shed_pairs{0};  ///< Pairs shed (PairOutput::is_shed), summed over the frames.
    std::uint64_t scene_walks{0}; ///< Walks of BroadPhase over all objects.
    /// Changes refused, in the order of ChangeRefusal.
    std::array<std::uint64_t, kChangeRefusals> changes_refused{};

    WorkRange work_allowed;         ///< Range of Budgets::work.
    WorkRange work_done;            ///< Range of WorkBudget::used().
    std::uint64_t work_at_floor{0}; ///< Frames in which even the least work did not fit.

private:
    /// Adds the frame's answers. Returns the width in metres of the widest bounded or stale one.
    double add_answers(const FrameOutput& output) noexcept;
    void add_point(const CycleMeasures& measures, std::span<const ToolForce> forces,
                   double width_m) noexcept;
    void add_work(const FrameOutput& output) noexcept;
    void add_scene(const FrameOutput& output) noexcept;
    void add_work_budget(const WorkCounters& work, const CycleMeasures& measures) noexcept;
    [[nodiscard]] bool is_over_budget(const WorkCounters& work,
                                      const Budgets& limits) const noexcept;
};

} // namespace tactus::hrtc
