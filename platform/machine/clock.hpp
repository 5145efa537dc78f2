// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/realtime.hpp"

namespace tactus
{

/// A source of time. Any thread; no call blocks or allocates. `rt_core` uses no clock: the
/// controller reads it outside the frame.
class Clock
{
public:
    virtual ~Clock() = default;

    /// Monotonic time; never decreases between two calls on one thread.
    [[nodiscard]] virtual MonotonicTime now() const noexcept TACTUS_NONBLOCKING = 0;
    [[nodiscard]] virtual WallTime wall_now() const noexcept = 0;

protected:
    Clock() = default;
    Clock(const Clock&) = default;
    Clock& operator=(const Clock&) = default;
};

} // namespace tactus
