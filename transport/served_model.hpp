// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/chunk_link.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

// Any thread; `link` belongs to the transport thread.
namespace tactus
{

/// Data with which a controller starts a model, from a file or a server. `header` has passed
/// ModelHeader::parse; its root hash and the hash of a non-empty `base` are verified.
struct ServedModel
{
    std::string name;
    ContentHash hash{};
    std::vector<std::byte> header;
    std::vector<std::byte> base; ///< Coded base mesh; empty until it is fetched (base_fetch.hpp).
    std::unique_ptr<ChunkLink> link;
    std::uint64_t server_epoch{0}; ///< Epoch of the server that sent the header; 0: from a file.
    std::uint32_t edit_room{0};    ///< Slots for faces that edits add; 0: no edits.
};

/// Verifies the base mesh's hash against the header (SpmRefusal::wrong_checksum), then parses it
/// into `mesh`, whose spans must have the header's counts (PageSlots::take; asserted). On refusal
/// the content of `mesh` is unspecified.
[[nodiscard]] Result<Done, SpmRefusal> load_base_mesh(std::span<const std::byte> bytes,
                                                      const ModelHeader& header,
                                                      const BaseMesh& mesh) noexcept;

/// Parses an untrusted header, then verifies its root hash (SpmRefusal::wrong_checksum). The bytes
/// must outlive the result.
[[nodiscard]] Result<ModelHeader, SpmRefusal>
parse_trusted_header(std::span<const std::byte> bytes) noexcept;

} // namespace tactus
