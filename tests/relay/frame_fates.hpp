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

/// What becomes of one frame.
struct FrameFate
{
    std::size_t copies{0};            ///< That arrive: 0 when it is lost, 2 when it is duplicated.
    std::array<Duration, 2> delays{}; ///< Of each copy.
};

/// Decides what becomes of frame n of one direction: a function of seed, n and condition alone,
/// whatever became of the frames before and whenever they came. So a run with the same frames
/// repeats, and one with a larger loss loses the frames of the smaller one, too.
class FrameFates
{
public:
    explicit FrameFates(std::uint64_t seed) : seed_(seed) {}

    /// Of the next frame. One that must arrive is neither lost nor duplicated, but delayed like the
    /// others.
    [[nodiscard]] FrameFate next(const LinkCondition& condition, bool must_arrive);

private:
    std::uint64_t seed_;
    std::uint64_t frame_{0};
};

} // namespace tactus::relay
