// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "transport/log.hpp"

#include <string>

namespace tactus::hrtc
{

/// hrtc --replay: runs a recording's frames again without device, network or timer and says in one
/// line whether every one agrees: on stdout when all do, else through `log`. `kernels` run the
/// queries, null the best of this processor. Returns the exit code: done, criterion not met when a
/// frame differs, failed when the file is refused.
[[nodiscard]] int replay_file(const std::string& path, const Kernels* kernels, const Log& log);

} // namespace tactus::hrtc
