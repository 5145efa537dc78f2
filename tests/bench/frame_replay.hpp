// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/work_counters.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"
#include "transport/edit_content.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::bench
{

/// Content of the caches at the start of a frame.
enum class CacheState : std::uint8_t
{
    warm,   ///< Content left by the last frame and its warm-up, as in a loop that runs on its own.
    cold,   ///< Evicted before the frame, and not warmed.
    warmed, ///< Evicted, then warmed, as a loop does in the wait before its deadline.
};

/// An edit of the surface before a frame.
struct TimedEdit
{
    std::size_t frame{0};
    EditContent edit;
};

/// Path of one tool over one model, with the budgets of the frames.
struct FrameRun
{
    const Scene& scene;
    std::vector<Vec3> goals_m;
    std::size_t lead_in{0}; ///< Frames at the start that are not counted.
    test::RigOptions rig;
    Budgets budgets;
    /// Models that share the pools, all of the same scene; rig.objects show them.
    std::uint32_t models{1};
    std::vector<TimedEdit> edits{}; ///< Edits of the first model, by frame.

    [[nodiscard]] std::size_t counted() const { return goals_m.size() - lead_in; }
};

/// Slide over the scene, see slide_motion(). The tool has the radius of the motions; its proxy
/// follows the device at up to 1.5 times the slide's speed, to allow for the swing in depth. The
/// reach R is the tool's radius plus the motion that this permits in a period.
[[nodiscard]] FrameRun make_slide(const Scene& scene, double speed_diag_per_s, std::uint32_t splits,
                                  std::size_t pool_bytes, std::uint32_t frames);

/// Work of the counted frames of one replay.
struct FrameWork
{
    std::uint64_t frames{0};
    WorkCounters counters;
    std::uint64_t coded_bytes{0}; ///< Bytes received over the link.
    std::uint64_t contacts{0};    ///< Frames in contact.
    std::uint64_t uncertified{0}; ///< Frames in contact without an exact answer.
    std::uint64_t edits_refused{0};
    std::uint64_t open{0}; ///< Frames with neither an exact nor a separated answer.
    ModelOutput model;     ///< State after the last frame.

    [[nodiscard]] double per_frame(std::uint64_t count) const
    {
        return static_cast<double>(count) / static_cast<double>(frames);
    }
    [[nodiscard]] std::uint64_t refit_visits() const
    {
        return std::uint64_t{counters.nodes_refitted} + counters.blocks_refitted;
    }
};

/// Repeated runs of the same frames from the start.
class FrameReplay
{
public:
    explicit FrameReplay(const FrameRun& run);

    /// Replays the first `frames` counted frames `passes` times. A failure if a frame's state
    /// differs between replays.
    void run(CacheState caches, std::uint32_t passes, std::size_t frames);
    /// Replays all counted frames with warm caches.
    void run(std::uint32_t passes) { run(CacheState::warm, passes, run_.counted()); }

    /// T_L + T_R + T_B + T_Q of the counted frames, in microseconds.
    [[nodiscard]] const LeastTimes& sum_us(CacheState caches) const
    {
        return sum_us_[index(caches)];
    }
    /// Times of one stage with warm caches.
    [[nodiscard]] const LeastTimes& stage_us(Stage stage) const
    {
        return stage_us_[static_cast<std::size_t>(stage)];
    }
    /// T_R + T_B of all frames divided by their splits; NaN without splits.
    [[nodiscard]] double split_us() const;
    /// Splits of each counted frame.
    [[nodiscard]] const std::vector<double>& splits() const { return splits_; }
    [[nodiscard]] const FrameWork& work() const { return work_; }
    /// Answers of the counted frames in the first replay.
    [[nodiscard]] const std::vector<PairOutput>& answers() const { return answers_; }
    /// Heap calls of the counted frames in the last replay; empty if they are not counted.
    [[nodiscard]] std::optional<std::uint64_t> allocations() const { return allocations_; }
    [[nodiscard]] std::uint64_t hash() const;

private:
    [[nodiscard]] static std::size_t index(CacheState caches)
    {
        return static_cast<std::size_t>(caches);
    }
    void run_once(CacheState caches, std::size_t frames);
    void prepare(test::FrameRig& rig, CacheState caches);
    void count(const FrameOutput& output);

    const FrameRun& run_;
    CacheEvictor evictor_;
    std::array<LeastTimes, 3> sum_us_;
    std::array<LeastTimes, kStages> stage_us_;
    std::vector<std::uint64_t> hashes_; ///< Hash of each frame's state in the first replay.
    std::vector<double> splits_;        ///< Splits of each counted frame in the first replay.
    FrameWork work_;
    std::vector<PairOutput> answers_;
    std::optional<std::uint64_t> allocations_;
};

} // namespace tactus::bench
