// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

// Any thread: values.
namespace tactus
{

/// An indexed triangle mesh as read from a file or generated, in the source's frame. Lengths are in
/// the file's unit, or in metres if the library generated it: prepare_mesh() scales. Faces are
/// counter-clockwise seen from outside if the source has an outside.
struct TriangleMesh
{
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<std::uint32_t, 3>> faces; ///< Indices into `positions`.
};

} // namespace tactus
