// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"

namespace tactus::hrtc
{

/// `hrtc deadline-test`: proves on this machine that the accounting of deadlines sees what it has
/// to see, runs the loop alone and beside load, and tells whose fault each miss was. argv[0] is the
/// subcommand's name, `form` that of hrtc itself. Returns the exit code: 1 after an overrun or a
/// self-check that failed.
int run_deadline_test(int argc, char** argv, CommandForm form);

} // namespace tactus::hrtc
