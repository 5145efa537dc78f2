// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/run_hooks.hpp"

namespace tactus::hrtc
{

/// The hooks of hrtc: a signal ends a session, and its progress is told on stderr.
[[nodiscard]] RunHooks program_hooks();

} // namespace tactus::hrtc
