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

} // namespace tactus::hrtc
