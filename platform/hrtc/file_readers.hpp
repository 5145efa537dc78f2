// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/file_readers.hpp"

namespace tactus::hrtc
{

/// What reads the meshes and scenes that hrtc's command line names.
[[nodiscard]] FileReaders file_readers();

} // namespace tactus::hrtc
