// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/trial_models.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "tests/shared/worst_shapes.hpp"

#include <cstdio>
#include <cstdlib>

namespace tactus::test
{

std::size_t generated_model_count()
{
    return kSmallModels + worst_model_count();
}

const TestModel& generated_model(std::size_t index)
{
    return index < kSmallModels ? small_model(index) : worst_model(index - kSmallModels);
}

const TestModel* known_model(const KnownMesh& mesh)
{
    const char* folder = std::getenv("TACTUS_MESHES");
    if (folder == nullptr)
    {
        return nullptr;
    }
    const auto read = read_mesh(std::filesystem::path(folder) / mesh.file);
    if (!read)
    {
        std::fprintf(stderr, "%s\n", read.error().text.c_str());
        std::exit(2);
    }
    return &test_model(mesh.name, read.value(), 500);
}

} // namespace tactus::test
