// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/test_model.hpp"

#include <cstddef>

namespace tactus::test
{

/// The small_model()s and the worst_model()s: all of them generated.
[[nodiscard]] std::size_t generated_model_count();
[[nodiscard]] const TestModel& generated_model(std::size_t index);

/// A mesh that others know, too; it has to be in the folder that TACTUS_MESHES names.
struct KnownMesh
{
    const char* name;
    const char* file;
};

/// The largest, of 269,000 faces, comes last.
inline constexpr KnownMesh kKnownMeshes[] = {{"cow", "cow.obj"},
                                             {"teapot", "teapot.obj"},
                                             {"fandisk", "fandisk.obj"},
                                             {"bunny", "stanford-bunny.obj"},
                                             {"igea", "igea.ply"}};

/// Null without TACTUS_MESHES; a file that isn't there ends the program with a line.
[[nodiscard]] const TestModel* known_model(const KnownMesh& mesh);

} // namespace tactus::test
