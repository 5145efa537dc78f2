// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/model_store.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace tactus
{

/// A mesh, what it was simplified to, the file written from that, and the file read back; throws in
/// words when that is refused.
struct EncodedModel : test::MadeModel
{
    explicit EncodedModel(test::MadeModel made);

    std::unique_ptr<ModelStore> store;
    std::unique_ptr<DecodedModel> decoded;
};

[[nodiscard]] std::unique_ptr<EncodedModel>
encode_source(std::string name, const TriangleMesh& mesh, std::uint32_t base_faces);

/// The golden model, and shapes through the real simplifier: closed, with a border, with sharp
/// edges. Made once in a process.
[[nodiscard]] const std::vector<std::unique_ptr<EncodedModel>>& sample_models();

/// A mesh of a test that runs once for each: generated, or a well-known one's.
struct SampleMesh
{
    const char* name;
    std::optional<TriangleMesh> (*make)();
    std::uint32_t base_faces;

    /// Null without a mesh.
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
