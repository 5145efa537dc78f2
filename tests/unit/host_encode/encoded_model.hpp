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

/// Mesh with its simplification, the file written from that, and the file read back; throws the
/// text of a refusal.
struct EncodedModel : test::MadeModel
{
    explicit EncodedModel(test::MadeModel made);

    std::unique_ptr<ModelStore> store;
    std::unique_ptr<DecodedModel> decoded;
};

[[nodiscard]] std::unique_ptr<EncodedModel>
encode_source(std::string name, const TriangleMesh& mesh, std::uint32_t base_faces);

/// Golden model, and shapes through the real simplifier: closed, with a border, with sharp edges.
/// Made once a process.
[[nodiscard]] const std::vector<std::unique_ptr<EncodedModel>>& sample_models();

/// Mesh of a parameterised test: generated or well known.
struct SampleMesh
{
    const char* name;
    std::optional<TriangleMesh> (*make)();
    std::uint32_t base_faces;

    /// Encoded model; null without a mesh.
    [[nodiscard]] std::unique_ptr<EncodedModel> encode() const;
};

inline std::ostream& operator<<(std::ostream& out, const SampleMesh& mesh)
{
    return out << mesh.name;
}

/// Smooth, of genus 1, open, sharp, thin and with needles.
[[nodiscard]] std::vector<SampleMesh> generated_meshes();
/// Well-known meshes; the smaller ones are all except igea, by far the largest.
[[nodiscard]] std::vector<SampleMesh> known_meshes();
[[nodiscard]] std::vector<SampleMesh> smaller_known_meshes();

/// Name of a case in a test over meshes.
[[nodiscard]] inline std::string mesh_name(const testing::TestParamInfo<SampleMesh>& mesh)
{
    return mesh.param.name;
}

} // namespace tactus
