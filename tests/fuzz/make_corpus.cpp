// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// make_corpus FOLDER: rewrites the seeds that contain this build's format: models of one chunk, of
/// two with a border, and without records. The same build writes the same bytes.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/test_model.hpp"

#include <cstdio>
#include <filesystem>

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fputs("usage: make_corpus FOLDER\n", stderr);
        return 3;
    }
    using namespace tactus;
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / "spm_reader";
    std::filesystem::create_directories(folder);
    // There is no extension: files that end in .spm are products and not kept.
    const auto add = [&](const char* name, const TriangleMesh& mesh, std::uint32_t base_faces)
    {
        std::filesystem::copy_file(test::test_model(name, mesh, base_faces).path, folder / name,
                                   std::filesystem::copy_options::overwrite_existing);
    };
    add("one_chunk", make_shape(Shape::sphere, 100).value(), 16);
    add("two_chunks", make_shape(Shape::terrain, 200).value(), 24);
    add("no_records", make_thin_plate(2, 0.01).value(), 500);
    return 0;
}
