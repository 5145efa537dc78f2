// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Puts the calling thread's floating-point control word (MXCSR, FPCR) into the state that the
/// frame's bits rest on: round to nearest, denormals kept, no traps. Returns false when it was
/// found otherwise: some library of the process, one built with fast maths for instance, had
/// changed it, and threads inherit the change. Always true where the processor is neither x86-64
/// nor aarch64. It neither waits nor allocates.
[[nodiscard]] bool reset_float_control() noexcept;

} // namespace tactus
