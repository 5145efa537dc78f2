// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/stability/garbage_trial.hpp"

#include <cstdint>
#include <string>

namespace tactus::test
{

/// Frames of 1 ms: kSampleHold_s; kFadeTime_s with one more on either side; and the recovery of a
/// tool.
inline constexpr std::uint32_t kHeldFrames = 20;
inline constexpr std::uint32_t kGoneFrames = 72;
inline constexpr std::uint32_t kRecoveryFrames = 200;

/// Episodes in which a device sends garbage, for some frames or until all force is gone, each
/// followed by a long sound period in which everything must recover. Begins sound. Checks every
/// tool meanwhile.
class GarbageEpisodes
{
public:
    /// Starts with `figures`, which have the name and must outlive this object.
    GarbageEpisodes(const Garbage& garbage, std::uint64_t seed, TrialFigures& figures)
        : garbage_(garbage), seed_(seed), figures_(figures), random_(Random::seeded(seed))
    {
    }

    /// Sample of the device in the next frame, for a true sample of the hand.
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

    /// Checks that the fault is reported, that the force ends without a sample, and that the tool's
    /// faults end too.
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
    /// True long after an episode, with sound samples.
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
    ToolState good_; ///< Last sound sample.
    std::uint32_t frame_{0};
    std::uint32_t age_{0}; ///< Frames of this episode, or since it.
    std::uint32_t frames_left_{0};
    bool in_episode_{false};
};

} // namespace tactus::test
