// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/seal_model.hpp"

#include "rt_core/base/crc32c.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/content_hash.hpp"

#include <algorithm>
#include <cstring>

namespace tactus::fuzz
{

namespace
{

// Sizes and places of docs/internals/spm-format.md, sections 2 and 5.
constexpr std::uint64_t kFixedBytes = 168;
constexpr std::uint64_t kPageEntryBytes = 48;
constexpr std::uint64_t kFullPageBytes = 1'928;
constexpr std::size_t kChunkEntryBytes = 30;
constexpr std::size_t kSizeInChunkEntry = 12;
constexpr std::size_t kHashInChunkEntry = 14;
constexpr std::size_t kClosingBytes = 36;

using Bytes = std::span<std::byte>;

template <typename T>
T get(Bytes from, std::size_t at)
{
    T value{};
    std::memcpy(&value, from.data() + at, sizeof(T));
    return value;
}

template <typename T>
void put(Bytes to, std::size_t at, const T& value)
{
    std::memcpy(to.data() + at, &value, sizeof(T));
}

/// Part of the file; empty unless entirely inside.
Bytes part(Bytes file, std::uint64_t offset, std::uint64_t bytes)
{
    const bool is_inside = bytes <= file.size() && offset <= file.size() - bytes;
    return is_inside ? file.subspan(offset, bytes) : Bytes{};
}

ContentHash seal_and_hash(Bytes piece)
{
    seal_piece(piece);
    return content_hash(piece);
}

/// Corrects the chunks of one index page, from `chunk` on, then the page; returns the page's hash.
ContentHash seal_index_page(Bytes file, Bytes page, std::uint64_t chunks_offset, ChunkId chunk)
{
    for (std::size_t at = 4; at + kChunkEntryBytes + kChecksumBytes <= page.size();
         at += kChunkEntryBytes, ++chunk.value)
    {
        const auto size = get<std::uint16_t>(page, at + kSizeInChunkEntry);
        const Bytes coded = part(file, chunks_offset, size);
        seal_chunk(coded, chunk);
        put(page, at + kHashInChunkEntry, content_hash(coded));
        chunks_offset += size;
    }
    return seal_and_hash(page);
}

void seal_index(Bytes file, const HeaderFields& fields)
{
    const std::uint64_t chunks = (std::uint64_t{fields.records} + 63) / 64;
    for (std::uint64_t page = 0; page * 64 < chunks; ++page)
    {
        const Bytes entry = part(file, kFixedBytes + page * kPageEntryBytes, kPageEntryBytes);
        const std::uint64_t in_page = std::min<std::uint64_t>(64, chunks - page * 64);
        const Bytes coded = part(file, fields.index_offset + page * kFullPageBytes,
                                 4 + in_page * kChunkEntryBytes + kChecksumBytes);
        if (entry.empty() || coded.empty())
        {
            return;
        }
        auto fixed = get<IndexPageEntry>(entry, 0);
        const ChunkId first{static_cast<std::uint32_t>(page * 64)};
        fixed.hash = seal_index_page(file, coded, fixed.chunks_offset, first);
        put(entry, 0, fixed);
    }
}

} // namespace

void seal_piece(Bytes piece)
{
    if (piece.size() >= kChecksumBytes)
    {
        const std::size_t at = piece.size() - kChecksumBytes;
        put(piece, at, crc32c(piece.first(at)));
    }
}

void seal_chunk(Bytes chunk, ChunkId id)
{
    if (chunk.size() >= kChecksumBytes)
    {
        const std::size_t at = chunk.size() - kChecksumBytes;
        put(chunk, at, chunk_checksum(chunk.first(at), id));
    }
}

void seal_model(Bytes file)
{
    if (file.size() < kFixedBytes)
    {
        return;
    }
    auto fields = get<HeaderFields>(file, 0);
    fields.magic = kSpmMagic;
    fields.format_version = kFormatVersion;
    fields.coder_version = kCoderVersion;
    fields.file_bytes = file.size();
    seal_index(file, fields);
    fields.base_hash = seal_and_hash(part(file, fields.base_offset, fields.base_bytes));
    put(file, 0, fields);
    const Bytes header = part(file, 0, fields.header_bytes);
    if (header.size() >= kFixedBytes + kClosingBytes)
    {
        const std::size_t hashed = header.size() - kClosingBytes;
        put(header, hashed, root_hash(header.first(hashed)));
        seal_piece(header);
    }
}

} // namespace tactus::fuzz
