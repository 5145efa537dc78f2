// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/clock.hpp"

// Any thread, as Clock says.
namespace tactus
{

/// CLOCK_MONOTONIC and CLOCK_REALTIME. About 22 ns a call if the kernel maps its clock into the
/// process; otherwise a real system call, 10 to 50 times that.
class PosixClock final : public Clock
{
public:
    [[nodiscard]] MonotonicTime now() const noexcept TACTUS_NONBLOCKING override;
    [[nodiscard]] WallTime wall_now() const noexcept override;
};

} // namespace tactus
