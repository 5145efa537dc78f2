// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"

namespace tactus::hrtc
{

/// Runs `hrtc deadline-test`: proves that the account of deadlines detects faults on this machine.
/// Then runs the loop alone and beside load, and reports the cause of each miss. argv[0] is the
/// subcommand's name, `form` that of hrtc itself. Returns the exit code: 1 after an overrun or a
/// failed self-check.
int run_deadline_test(int argc, char** argv, CommandForm form);

/// Runs `hrtc doctor [--cpu N] [--domain N] [--json]`; argv[0] is "doctor". Reports properties of
/// this machine that disturb the loop, with their remedies. Returns the exit code: 1 if a finding
/// is critical.
[[nodiscard]] int run_doctor(int argc, char** argv);

} // namespace tactus::hrtc
