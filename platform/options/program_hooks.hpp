// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/run_hooks.hpp"

namespace tactus::hrtc
{

/// Hooks of hrtc: a signal ends a session, and the progress appears on stderr.
[[nodiscard]] RunHooks program_hooks();

} // namespace tactus::hrtc
