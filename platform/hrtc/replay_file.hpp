// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "transport/log.hpp"

#include <string>
#include <vector>

namespace tactus::hrtc
{

/// hrtc --replay: runs a recording's frames again without device, network or timer and says in one
/// line whether every one agrees: on stdout when all do, else through `log`. `kernels` run the
/// queries, null the best of this processor. Where all agree, `exports` are written: paths that are
/// is_export_name(). Returns the exit code: done, criterion not met when a frame differs, failed
/// when the recording is refused or an export can't be written.
[[nodiscard]] int replay_file(const std::string& path, const Kernels* kernels,
                              const std::vector<std::string>& exports, const Log& log);

} // namespace tactus::hrtc
