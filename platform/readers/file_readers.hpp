// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/file_readers.hpp"

namespace tactus::hrtc
{

/// Readers of the meshes and scenes on hrtc's command line.
[[nodiscard]] FileReaders file_readers();

} // namespace tactus::hrtc
