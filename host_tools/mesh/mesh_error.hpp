// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

namespace tactus
{

/// Why a mesh was refused: one line that names the file or option, what is wrong, where, and what
/// is allowed.
struct MeshError
{
    std::string text;
};

} // namespace tactus
