// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/handshake_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <utility>
#include <vector>

namespace tactus::dds
{

namespace
{

using std::chrono::seconds;

/// The silences, by their start and length in seconds, of a watch that is stepped once a second
/// from `begin` to `end`.
std::vector<std::pair<int, int>> silences(HandshakeWatch& watch, int begin, int end,
                                          bool is_connected, bool is_discovered)
{
    std::vector<std::pair<int, int>> result;
    for (int second = begin; second < end; ++second)
    {
        const auto now = HandshakeWatch::Clock::time_point(seconds(1'000 + second));
        if (const auto silence = watch.step(now, is_connected, is_discovered))
        {
            result.emplace_back(second, static_cast<int>(silence->count()));
        }
    }
    return result;
}

using Silences = std::vector<std::pair<int, int>>;

TEST(HandshakeWatch, is_silent_after_its_patience_with_growing_pauses)
{
    HandshakeWatch watch;
    EXPECT_EQ(
        silences(watch, 0, 200, false, true),
        (Silences{{5, 3}, {13, 6}, {24, 9}, {38, 12}, {55, 12}, {72, 12}, {104, 12}, {164, 12}}));
}

TEST(HandshakeWatch, has_no_cause_without_a_server_or_with_a_connected_one)
{
    HandshakeWatch watch;
    EXPECT_EQ(silences(watch, 0, 100, false, false), Silences{});
    EXPECT_EQ(silences(watch, 100, 200, true, false), Silences{});
}

TEST(HandshakeWatch, waits_again_after_a_server_was_gone)
{
    HandshakeWatch watch;
    EXPECT_EQ(silences(watch, 0, 5, false, true), Silences{});
    EXPECT_EQ(silences(watch, 5, 6, false, false), Silences{});
    EXPECT_EQ(silences(watch, 6, 12, false, true), (Silences{{11, 3}}));
    // The silence itself ends the discovery; the pauses and lengths continue to grow.
    EXPECT_EQ(silences(watch, 12, 15, false, false), Silences{});
    EXPECT_EQ(silences(watch, 15, 24, false, true), (Silences{{20, 6}}));
}

TEST(HandshakeWatch, forgets_earlier_silences_with_a_connection)
{
    HandshakeWatch watch;
    EXPECT_EQ(silences(watch, 0, 20, false, true), (Silences{{5, 3}, {13, 6}}));
    EXPECT_EQ(silences(watch, 20, 21, true, false), Silences{});
    EXPECT_EQ(silences(watch, 21, 30, false, true), (Silences{{26, 3}}));
}

} // namespace

} // namespace tactus::dds
