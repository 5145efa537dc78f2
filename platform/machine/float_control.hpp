// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Sets the calling thread's floating-point control word (MXCSR, FPCR) to the state required for
/// reproducible frames: round to nearest, denormals kept, no traps. Returns false if it was
/// different: a library of the process, for instance one built with fast maths, had changed it, and
/// threads inherit the change. Always true on processors other than x86-64 and aarch64. Neither
/// waits nor allocates.
[[nodiscard]] bool reset_float_control() noexcept;

} // namespace tactus
