// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/posix/posix_clock.hpp"

// One thread, the one that sleeps; as PeriodicTimer says.
namespace tactus
{

/// Sleeps by absolute time on CLOCK_MONOTONIC, so neither a late wake-up nor an interrupting signal
/// shifts the grid.
class PosixPeriodicTimer final : public PeriodicTimer
{
private:
    [[nodiscard]] MonotonicTime now() noexcept override;
    void sleep_until(MonotonicTime wake) noexcept override;
    [[nodiscard]] MonotonicTime spin_until(MonotonicTime deadline) noexcept override;

    PosixClock clock_;
};

} // namespace tactus
