// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/detail/polygon_sink.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "transport/base/refusal.hpp"

#include <string>
#include <string_view>
#include <vector>

/// Readers, one for each format. Refusals state the place in the file; read_mesh_file() adds the
/// file's name and checks the properties common to all formats.
namespace tactus::detail
{

[[nodiscard]] Result<MeshFile, Refusal> read_ply(std::string_view bytes);
[[nodiscard]] Result<MeshFile, Refusal> read_obj(std::string_view text);
[[nodiscard]] Result<MeshFile, Refusal> read_stl(std::string_view bytes);
[[nodiscard]] Result<MeshFile, Refusal> read_off(std::string_view text);

/// Adds a note if a text format does not end in a line end: its last number may have lost digits.
void note_missing_line_end(std::string_view text, std::vector<std::string>& notes);

} // namespace tactus::detail
