// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "transport/store/model_store.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus
{

/// A mesh, what it was simplified to, the file written from that, and the file read back.
struct EncodedModel
{
    std::string name; ///< For failure messages.
    PreparedMesh prepared;
    Simplification simplification;
    test::TemporaryFolder folder;
    HeaderFields fields;
    std::unique_ptr<ModelStore> store;
    std::unique_ptr<DecodedModel> decoded;

    [[nodiscard]] std::filesystem::path path() const { return folder.path() / "model.spm"; }
};

/// Prepares and simplifies a mesh, then the same as encode_mesh().
[[nodiscard]] std::unique_ptr<EncodedModel>
encode_source(std::string name, const TriangleMesh& mesh, std::uint32_t base_faces,
              unsigned position_bits = kMinPositionBits);

/// Writes a model and reads it back; throws in words when any step is refused.
[[nodiscard]] std::unique_ptr<EncodedModel> encode_mesh(std::string name, PreparedMesh prepared,
                                                        Simplification simplification,
                                                        unsigned position_bits);

/// The golden model, and shapes through the real simplifier: closed, with a border, with sharp
/// edges. Made once in a process.
[[nodiscard]] const std::vector<std::unique_ptr<EncodedModel>>& sample_models();

} // namespace tactus
