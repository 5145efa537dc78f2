// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/spm/content_key.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

// One thread at a time, not the haptic one: opening and reading wait for the file.
namespace tactus
{

/// Read-only access to one .spm file. Reads with pread, never mmap: a file that is truncated while
/// it is served gives an error instead of SIGBUS.
///
/// Memory: the header and 18 B a chunk (sizes and hashes); chunks are read on request.
class ModelStore
{
public:
    /// Checks everything except the chunks' content: size, header, root hash, base mesh, index
    /// pages, and that all extents lie within the file. Cost: reads header, base mesh and index.
    /// Refused in one line with the path, like read().
    [[nodiscard]] static Result<ModelStore, Refusal> open(const std::filesystem::path& path);

    ModelStore(ModelStore&& other) noexcept;
    ModelStore& operator=(ModelStore&& other) noexcept;
    ModelStore(const ModelStore&) = delete;
    ModelStore& operator=(const ModelStore&) = delete;
    ~ModelStore();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    /// Header and its bytes belong to the store, and move with it.
    [[nodiscard]] const ModelHeader& header() const noexcept { return header_; }
    [[nodiscard]] std::span<const std::byte> header_bytes() const noexcept { return bytes_; }
    [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }
    [[nodiscard]] std::uint32_t revision() const noexcept { return header_.fields().revision; }

    /// True if the model has this piece.
    [[nodiscard]] bool has(ContentKey key) const noexcept;
    /// Bytes of a piece's coded form. The model must have the key (asserted).
    [[nodiscard]] std::size_t coded_bytes(ContentKey key) const noexcept;

    /// Reads a piece in its coded form into `out` (resized; no allocation once it is large enough)
    /// and verifies its hash. Refuses a key that the model lacks.
    [[nodiscard]] Result<Done, Refusal> read(ContentKey key, std::vector<std::byte>& out) const;

private:
    struct Extent
    {
        std::uint64_t offset{0};
        std::size_t bytes{0};
        ContentHash hash{};
    };

    ModelStore() = default;

    [[nodiscard]] Result<Done, Refusal> open_file(const std::filesystem::path& path);
    [[nodiscard]] Result<Done, Refusal> read_header();
    [[nodiscard]] Result<Done, Refusal> check_base() const;
    [[nodiscard]] Result<Done, Refusal> read_index();
    [[nodiscard]] Result<Done, Refusal> check_chunk_extents(IndexPageId page) const;
    [[nodiscard]] Extent extent_of(ContentKey key) const noexcept;
    [[nodiscard]] Result<Done, Refusal> read_at(std::uint64_t offset, std::span<std::byte> out,
                                                const std::string& what) const;
    [[nodiscard]] Refusal error(const std::string& what) const;

    std::filesystem::path path_;
    int file_{-1};
    std::uint64_t file_bytes_{0};
    std::vector<std::byte> bytes_; ///< Bytes of the header; header_ refers to them.
    ModelHeader header_;
    ContentHash hash_{};
    std::vector<ChunkEntry> chunks_;
};

} // namespace tactus
