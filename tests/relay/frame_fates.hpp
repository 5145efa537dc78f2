// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "tests/relay/relay_command.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus::relay
{

struct FrameFate
{
    std::size_t copies{0}; ///< Copies that arrive: 0 if it is lost, 2 if it is duplicated.
    std::array<Duration, 2> delays{};
};

/// Fates of the frames of one direction. That of frame n is a function of seed, n and condition
/// alone, independent of other frames and their times. A run with the same frames thus repeats, and
/// one with a larger loss also loses the frames of the smaller one.
class FrameFates
{
public:
    explicit FrameFates(std::uint64_t seed) : seed_(seed) {}

    /// Fate of the next frame. One that must arrive is neither lost nor duplicated, but delayed.
    [[nodiscard]] FrameFate next(const LinkCondition& condition, bool must_arrive);

private:
    std::uint64_t seed_;
    std::uint64_t frame_{0};
};

} // namespace tactus::relay
