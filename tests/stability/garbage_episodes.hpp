// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/stability/garbage_trial.hpp"

#include <cstdint>
#include <string>

namespace tactus::test
{

/// kSampleHold_s in frames of 1 ms; and kFadeTime_s, and one on either side; and what a tool takes
/// to be well again.
inline constexpr std::uint32_t kHeldFrames = 20;
inline constexpr std::uint32_t kGoneFrames = 72;
inline constexpr std::uint32_t kRecoveryFrames = 200;

/// When a device gives garbage: for some frames, or for so many that all force is gone; then long
/// good times, in which everything must be well again. Good at first. And what must hold of every
/// tool meanwhile.
class GarbageEpisodes
{
public:
    /// `figures` has its name, and must outlive it.
    GarbageEpisodes(const Garbage& garbage, std::uint64_t seed, TrialFigures& figures)
        : garbage_(garbage), seed_(seed), figures_(figures), random_(Random::seeded(seed))
    {
    }

    /// What the device sends in the next frame, where the hand is so.
    [[nodiscard]] ToolState next(ToolState sample)
    {
        ++frame_;
        if (frames_left_ == 0)
        {
            in_episode_ = frame_ > 1 && !in_episode_;
            const std::uint32_t episode =
                random_.one_in(2) ? 1 + random_.below(5) : kGoneFrames + 20;
            frames_left_ = in_episode_ ? episode : kRecoveryFrames + 50;
            age_ = 0;
        }
        --frames_left_;
        ++age_;
        if (in_episode_)
        {
            garbage_.spoil(sample, good_, random_);
            return sample;
        }
        good_ = sample;
        return sample;
    }

    /// The fault is told, without a sample the force ends, and the tool's faults end as well.
    void check(const FrameOutput& output, bool has_force)
    {
        const auto tells = [&](FrameFault fault)
        { return fault == FrameFault::none || has_fault(output.faults, fault); };
        if (in_episode_)
        {
            expect(age_ > 1 || tells(garbage_.fault), "the first frame tells no fault");
            expect(age_ <= kHeldFrames || tells(garbage_.lasting_fault),
                   "no fault is told any more");
            expect(!garbage_.fades || age_ < kGoneFrames || !has_force,
                   "there is force without a sample");
        }
        else if (is_recovered())
        {
            constexpr FrameFault kOfTool =
                FrameFault::tool_invalid | FrameFault::tool_stuck | FrameFault::tool_jumped;
            expect(!has_fault(output.faults, kOfTool), "the tool's faults don't end");
        }
    }
    /// Long after an episode, in good times.
    [[nodiscard]] bool is_recovered() const
    {
        return !in_episode_ && frame_ > kRecoveryFrames && age_ >= kRecoveryFrames;
    }
    [[nodiscard]] bool is_one() const { return in_episode_; }

    void expect(bool holds, const std::string& otherwise)
    {
        if (!holds)
        {
            figures_.flag(figures_.name + ", TACTUS_SEED=" + std::to_string(seed_) + ", frame " +
                          std::to_string(frame_ - 1) + ", " + std::to_string(age_) +
                          (in_episode_ ? " into an episode: " : " after an episode: ") + otherwise);
        }
    }

private:
    const Garbage& garbage_;
    std::uint64_t seed_;
    TrialFigures& figures_;
    Random random_;
    ToolState good_; ///< The last one.
    std::uint32_t frame_{0};
    std::uint32_t age_{0}; ///< Frames of this episode, or since it.
    std::uint32_t frames_left_{0};
    bool in_episode_{false};
};

} // namespace tactus::test
