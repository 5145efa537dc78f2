// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace tactus::test
{

[[nodiscard]] inline Recording parsed(const std::vector<std::byte>& bytes)
{
    auto recording = Recording::parse(bytes, "rig");
    EXPECT_TRUE(recording) << recording.error().text;
    return std::move(recording).value();
}

/// Expects that a replay of a rig's recording has all its frames, `frames` if given, bit for bit.
inline void expect_same_again(const std::vector<std::byte>& bytes,
                              std::optional<std::uint64_t> frames = {})
{
    const Recording recording = parsed(bytes);
    const auto replayed = replay(recording);
    ASSERT_TRUE(replayed) << replayed.error().text;
    EXPECT_EQ(replayed.value().frames, frames.value_or(recording.frame_count()));
    EXPECT_EQ(recording.frame_count(), replayed.value().frames);
    if (const auto& difference = replayed.value().difference)
    {
        FAIL() << "frame " << difference->frame << ": " << difference->text;
    }
}

} // namespace tactus::test
