// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus::hrtc
{

/// `hrtc doctor [--cpu N] [--domain N] [--json]`, argv[0] being "doctor": says what of this machine
/// is in the loop's way and how to mend it. Returns the exit code: 1 when something critical is
/// missing.
[[nodiscard]] int run_doctor(int argc, char** argv);

} // namespace tactus::hrtc
