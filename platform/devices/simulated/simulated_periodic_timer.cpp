// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/simulated_periodic_timer.hpp"

namespace tactus
{

void SimulatedPeriodicTimer::sleep_until(MonotonicTime wake) noexcept
{
    clock_.advance_to(wake);
    if (script_at_ < script_.size() && script_[script_at_].sleep == sleeps_)
    {
        clock_.advance(script_[script_at_].lateness);
        ++script_at_;
    }
    ++sleeps_;
    meanwhile_();
}

MonotonicTime SimulatedPeriodicTimer::spin_until(MonotonicTime deadline) noexcept
{
    clock_.advance_to(deadline);
    return clock_.now();
}

} // namespace tactus
