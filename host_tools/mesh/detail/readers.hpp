// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/detail/polygon_sink.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "transport/base/refusal.hpp"

#include <string>
#include <string_view>
#include <vector>

/// One reader per format: bytes in, mesh out. Errors say where in the file; read_mesh_file() puts
/// the file's name in front and checks what is common to all formats.
namespace tactus::detail
{

[[nodiscard]] Result<MeshFile, Refusal> read_ply(std::string_view bytes);
[[nodiscard]] Result<MeshFile, Refusal> read_obj(std::string_view text);
[[nodiscard]] Result<MeshFile, Refusal> read_stl(std::string_view bytes);
[[nodiscard]] Result<MeshFile, Refusal> read_off(std::string_view text);

/// Text formats end in a line end; one that doesn't may have lost digits of its last number.
void note_missing_line_end(std::string_view text, std::vector<std::string>& notes);

} // namespace tactus::detail
