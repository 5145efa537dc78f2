// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/random.hpp"

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
/// good times, in which everything must be well again. Good at first.
class GarbageEpisodes
{
public:
    /// Whether the next frame is a good one.
    [[nodiscard]] bool begin_good_frame(Random& random)
    {
        if (frames_left_ == 0)
        {
            in_episode_ = has_begun_ && !in_episode_;
            has_begun_ = true;
            const std::uint32_t episode = random.one_in(2) ? 1 + random.below(5) : kGoneFrames + 20;
            frames_left_ = in_episode_ ? episode : kRecoveryFrames + 50;
            age_ = 0;
        }
        --frames_left_;
        ++age_;
        return !in_episode_;
    }

    [[nodiscard]] bool is_one() const { return in_episode_; }
    /// Frames of this episode, or since it.
    [[nodiscard]] std::uint32_t age() const { return age_; }
    [[nodiscard]] std::string text() const
    {
        return std::to_string(age_) + (in_episode_ ? " into an episode: " : " after an episode: ");
    }

private:
    std::uint32_t age_{0};
    std::uint32_t frames_left_{0};
    bool in_episode_{false};
    bool has_begun_{false};
};

} // namespace tactus::test
