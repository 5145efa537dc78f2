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

// One thread at a time, not the haptic one: open() and read() wait for the file.
namespace tactus
{

/// Read-only access to one .spm file, by pread and not mmap: if the file is truncated meanwhile, a
/// read is refused, without SIGBUS.
///
/// Memory: the header, and 18 bytes for the size and hash of each chunk. Chunks are not kept.
class ModelStore
{
public:
    /// Opens a file and checks all but the content of chunks: size, header, root hash, base mesh,
    /// index pages, and that all pieces lie within the file. Reads header, base mesh and index
    /// pages. A refusal is one line with the path, also in read().
    [[nodiscard]] static Result<ModelStore, Refusal> open(const std::filesystem::path& path);

    ModelStore(ModelStore&& other) noexcept;
    ModelStore& operator=(ModelStore&& other) noexcept;
    ModelStore(const ModelStore&) = delete;
    ModelStore& operator=(const ModelStore&) = delete;
    ~ModelStore();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    /// Header and its bytes live in the store; references stay valid if the store is moved.
    [[nodiscard]] const ModelHeader& header() const noexcept { return header_; }
    [[nodiscard]] std::span<const std::byte> header_bytes() const noexcept { return bytes_; }
    [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }
    [[nodiscard]] std::uint32_t revision() const noexcept { return header_.fields().revision; }

    /// True if the model has this piece.
    [[nodiscard]] bool has(ContentKey key) const noexcept;
    /// Bytes of a piece in coded form. The model must have the piece (asserted).
    [[nodiscard]] std::size_t coded_bytes(ContentKey key) const noexcept;

    /// Reads a piece in coded form into `out` and verifies its hash. `out` is resized; no
    /// allocation once its capacity suffices. Refused for a piece that the model lacks.
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
