// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

// Any thread: values.
namespace tactus
{

/// An indexed triangle mesh as read from a file or made by a generator, in the source's frame. Its
/// lengths are in whatever unit the file has, and in metres where the library made it:
/// prepare_mesh() scales. Faces are counter-clockwise seen from outside where the source has an
/// outside.
struct TriangleMesh
{
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<std::uint32_t, 3>> faces; ///< Places in `positions`, from 0.
};

} // namespace tactus
