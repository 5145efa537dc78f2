// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "transport/log.hpp"

#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Runs hrtc --replay: repeats a recording's frames without device, network or timer. One line
/// tells if all frames agree, on stdout if they do, else through `log`. `kernels`: kernels of the
/// queries; null: the best of this processor. If all frames agree, the files `exports` are written;
/// their names must satisfy is_export_name(). Returns the exit code: done; criterion not met if a
/// frame differs; failed if the recording is refused or an export can't be written.
[[nodiscard]] int replay_file(const std::string& path, const Kernels* kernels,
                              const std::vector<std::string>& exports, const Log& log);

} // namespace tactus::hrtc
