// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace tactus
{

/// A mesh of a test that runs once for each: generated, or a well-known one's file.
struct SampleMesh
{
    const char* name;
    const char* file;       ///< In TACTUS_MESHES; null: generated.
    TriangleMesh (*make)(); ///< Null with a file.
    std::uint32_t base_faces;

    /// Null when it is a file and TACTUS_MESHES isn't set.
    [[nodiscard]] std::unique_ptr<EncodedModel> encode() const;
};

inline std::ostream& operator<<(std::ostream& out, const SampleMesh& mesh)
{
    return out << mesh.name;
}

/// Smooth, of genus 1, open, sharp, thin and with needles.
[[nodiscard]] std::vector<SampleMesh> generated_meshes();
/// The well-known ones; the smaller are all but igea, the largest by far.
[[nodiscard]] std::vector<SampleMesh> known_meshes();
[[nodiscard]] std::vector<SampleMesh> smaller_known_meshes();

/// Names the cases of a test over meshes.
[[nodiscard]] inline std::string mesh_name(const testing::TestParamInfo<SampleMesh>& mesh)
{
    return mesh.param.name;
}

} // namespace tactus
