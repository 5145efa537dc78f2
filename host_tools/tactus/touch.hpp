// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus::front
{

/// Runs `tactus touch`: builds a mesh's model if needed, shows it in a browser and touches it.
/// `argv[0]` is the command's name. Returns the exit code.
[[nodiscard]] int touch(int argc, char** argv);

} // namespace tactus::front
