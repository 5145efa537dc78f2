// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/frame_fates.hpp"

#include "tests/shared/random.hpp"

namespace tactus::relay
{

namespace
{

/// Random numbers of one frame.
constexpr std::uint64_t kLoss = 0;
constexpr std::uint64_t kDuplicate = 1;
/// Jitter of the first copy; the next number is the second copy's.
constexpr std::uint64_t kJitter = 2;
constexpr std::uint64_t kNumbers = 4;

/// Uniform number in 0 .. 1, without 1: a share of 1 takes every frame and one of 0 none.
double unit(std::uint64_t seed, std::uint64_t index)
{
    return static_cast<double>(test::mixed(seed, index) >> 11U) * 0x1p-53;
}

} // namespace

FrameFate FrameFates::next(const LinkCondition& condition, bool must_arrive)
{
    const std::uint64_t first = kNumbers * frame_++;
    FrameFate fate;
    if (!must_arrive && unit(seed_, first + kLoss) < condition.loss)
    {
        return fate;
    }
    const bool is_twice = !must_arrive && unit(seed_, first + kDuplicate) < condition.duplicates;
    fate.copies = is_twice ? 2 : 1;
    for (std::size_t i = 0; i < fate.copies; ++i)
    {
        const double delay_ms =
            condition.delay_ms + condition.jitter_ms * unit(seed_, first + kJitter + i);
        fate.delays[i] = nanoseconds(static_cast<std::int64_t>(delay_ms * 1e6));
    }
    return fate;
}

} // namespace tactus::relay
