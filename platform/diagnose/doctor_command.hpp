// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus::hrtc
{

/// Runs `hrtc doctor [--cpu N] [--domain N] [--json]`; argv[0] is "doctor". Reports properties of
/// this machine that disturb the loop, with their remedies. Returns the exit code: 1 if a finding
/// is critical.
[[nodiscard]] int run_doctor(int argc, char** argv);

} // namespace tactus::hrtc
