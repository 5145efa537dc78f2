// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/work_counters.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::bench
{

/// What the caches hold when a frame starts.
enum class CacheState : std::uint8_t
{
    warm,      ///< What the last frame and the rehearsal left, as in a loop that runs on its own.
    cold,      ///< Nothing of ours: driven out before the frame, not rehearsed.
    rehearsed, ///< Driven out, then rehearsed, as a loop does in the wait before its deadline.
};

/// One tool's way over one model, and what the frames may do.
struct FrameRun
{
    const Scene& scene;
    std::vector<Vec3> goals_m;
    std::size_t lead_in{0}; ///< Frames at the start that are run and not counted.
    test::RigOptions rig;
    Budgets budgets;
    std::uint32_t models{1}; ///< That share the pools, all the scene's; rig.objects show them.

    [[nodiscard]] std::size_t counted() const { return goals_m.size() - lead_in; }
};

/// A slide over the scene: see slide_motion(). The tool has the motions' radius; its proxy follows
/// the goal at up to 1.5 times the slide's speed, which leaves room for the swing in depth, so the
/// reach R is the tool's radius and what that allows in a period.
[[nodiscard]] FrameRun make_slide(const Scene& scene, double speed_diag_per_s, std::uint32_t splits,
                                  std::size_t pool_bytes, std::uint32_t frames);

/// What frames did, over the counted ones of one replay.
struct FrameWork
{
    std::uint64_t frames{0};
    WorkCounters counters;        ///< Their sum.
    std::uint64_t coded_bytes{0}; ///< That came over the link meanwhile.
    std::uint64_t contacts{0};    ///< Frames in contact.
    std::uint64_t uncertified{0}; ///< Of those, without an exact answer.
    std::uint64_t open{0};        ///< Frames with neither an exact nor a decided answer.
    ModelOutput model;            ///< After the last frame.

    [[nodiscard]] double per_frame(std::uint64_t count) const
    {
        return static_cast<double>(count) / static_cast<double>(frames);
    }
    [[nodiscard]] std::uint64_t refit_visits() const
    {
        return std::uint64_t{counters.nodes_refitted} + counters.blocks_refitted;
    }
};

/// Runs the same frames from the start again and again.
class FrameReplay
{
public:
    explicit FrameReplay(const FrameRun& run);

    /// So many replays of the first counted frames. A failure when a frame's state differs from
    /// that of an earlier replay.
    void run(CacheState caches, std::uint32_t passes, std::size_t frames);
    /// Of all counted frames, the caches warm.
    void run(std::uint32_t passes) { run(CacheState::warm, passes, run_.counted()); }

    /// T_L + T_R + T_B + T_Q, in microseconds, of the counted frames.
    [[nodiscard]] const LeastTimes& sum_us(CacheState caches) const
    {
        return sum_us_[index(caches)];
    }
    /// Warm ones only.
    [[nodiscard]] const LeastTimes& stage_us(Stage stage) const
    {
        return stage_us_[static_cast<std::size_t>(stage)];
    }
    /// T_R + T_B of all frames by all splits of them; NaN when there is none.
    [[nodiscard]] double split_us() const;
    /// Of each counted frame.
    [[nodiscard]] const std::vector<double>& splits() const { return splits_; }
    [[nodiscard]] const FrameWork& work() const { return work_; }
    /// What the counted frames answered, by the first replay.
    [[nodiscard]] const std::vector<PairOutput>& answers() const { return answers_; }
    /// Calls on the heap by the counted frames of the last replay; none where they aren't counted.
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
    std::vector<std::uint64_t> hashes_; ///< Of each frame's state, by the first replay.
    std::vector<double> splits_;        ///< Of each counted frame, likewise.
    FrameWork work_;
    std::vector<PairOutput> answers_;
    std::optional<std::uint64_t> allocations_;
};

} // namespace tactus::bench
