// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/topics.hpp"
#include "transport/part_intake.hpp"
#include "transport/store/model_store.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::dds
{

/// A model and the name by which controllers request it.
struct PublishedModel
{
    std::string name; ///< Valid and unique on this server; not checked.
    ModelStore store;
    /// Slots for faces that edits add, at most kMaxAddedFaces; 0: the model can't be edited.
    std::uint32_t edit_room{0};
};

/// Pieces of a published model, as sent: index pages, chunks, and the parts of header and base
/// mesh. One thread, that of the server; reading waits for the file.
class ModelPieces
{
public:
    /// Reads and keeps the base mesh. Refused if it cannot be read, or if header or base mesh are
    /// larger than kMaxHeaderBytes or kMaxBaseBytes.
    [[nodiscard]] static Result<ModelPieces, Refusal> create(PublishedModel model);

    [[nodiscard]] const PublishedModel& model() const noexcept { return model_; }
    [[nodiscard]] const ModelStore& store() const noexcept { return model_.store; }

    [[nodiscard]] bool has(ContentKey key) const noexcept;
    /// Bytes of a piece, which must exist.
    [[nodiscard]] std::size_t bytes(ContentKey key) const noexcept;
    /// Reads a piece, which must exist, into `out` and verifies its hash. No allocation once `out`
    /// is large enough.
    [[nodiscard]] Result<Done, Refusal> read(ContentKey key, std::vector<std::byte>& out) const;

private:
    explicit ModelPieces(PublishedModel model) : model_(std::move(model)) {}

    /// All bytes of the header or base mesh; empty for other kinds.
    [[nodiscard]] std::span<const std::byte> whole(ContentKind kind) const noexcept;

    PublishedModel model_;
    std::vector<std::byte> base_;
};

} // namespace tactus::dds
