// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/store/model_store.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "transport/base/suggestions.hpp"
#include "transport/content_hash.hpp"
#include "transport/served_model.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tactus
{

namespace
{

std::string name_of(ContentKey key)
{
    switch (key.kind)
    {
    case ContentKind::base:
        return "base mesh";
    case ContentKind::index_page:
        return fmt::format("index page {}", key.number);
    case ContentKind::header:
    case ContentKind::chunk:
        break;
    }
    return fmt::format("chunk {}", key.number);
}

std::uint64_t index_page_offset(const HeaderFields& fields, IndexPageId page) noexcept
{
    return fields.index_offset +
           std::uint64_t{page.value} * coded_index_page_bytes(kChunksPerIndexPage);
}

} // namespace

Result<ModelStore, Refusal> ModelStore::open(const std::filesystem::path& path)
{
    ModelStore store;
    if (auto opened = store.open_file(path); !opened)
    {
        return opened.error();
    }
    if (auto read = store.read_header(); !read)
    {
        return read.error();
    }
    if (auto checked = store.check_base(); !checked)
    {
        return checked.error();
    }
    if (auto read = store.read_index(); !read)
    {
        return read.error();
    }
    return store;
}

ModelStore::ModelStore(ModelStore&& other) noexcept
    : path_(std::move(other.path_))
    , file_(std::exchange(other.file_, -1))
    , file_bytes_(other.file_bytes_)
    , bytes_(std::move(other.bytes_)) // The buffer does not move, so header_ stays valid.
    , header_(other.header_)
    , hash_(other.hash_)
    , chunks_(std::move(other.chunks_))
{
}

ModelStore& ModelStore::operator=(ModelStore&& other) noexcept
{
    std::swap(path_, other.path_);
    std::swap(file_, other.file_);
    std::swap(file_bytes_, other.file_bytes_);
    std::swap(bytes_, other.bytes_);
    std::swap(header_, other.header_);
    std::swap(hash_, other.hash_);
    std::swap(chunks_, other.chunks_);
    return *this;
}

ModelStore::~ModelStore()
{
    if (file_ >= 0)
    {
        ::close(file_);
    }
}

bool ModelStore::has(ContentKey key) const noexcept
{
    switch (key.kind)
    {
    case ContentKind::base:
        return key.number == 0;
    case ContentKind::index_page:
        return key.number < header_.counts().index_pages();
    case ContentKind::chunk:
        return key.number < header_.counts().chunks();
    case ContentKind::header:
        break; // header_bytes() has it.
    }
    return false;
}

std::size_t ModelStore::coded_bytes(ContentKey key) const noexcept
{
    return extent_of(key).bytes;
}

Result<Done, Refusal> ModelStore::read(ContentKey key, std::vector<std::byte>& out) const
{
    if (!has(key))
    {
        return error(name_of(key) + " does not exist in the model");
    }
    const Extent extent = extent_of(key);
    out.resize(extent.bytes);
    if (auto done = read_at(extent.offset, out, name_of(key)); !done)
    {
        return done;
    }
    if (content_hash(out) != extent.hash)
    {
        return error(fmt::format("{} at offset {} is damaged: its hash does not match",
                                 name_of(key), extent.offset));
    }
    return Done{};
}

Result<Done, Refusal> ModelStore::open_file(const std::filesystem::path& path)
{
    path_ = path;
    // Non-blocking, so that a named pipe without a writer is refused and does not block.
    file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat status = {};
    if (file_ < 0 || ::fstat(file_, &status) != 0)
    {
        const int reason = errno;
        return error(fmt::format("cannot be opened: {}{}", std::strerror(reason),
                                 reason == ENOENT ? files_near(path, ".spm") : ""));
    }
    if (!S_ISREG(status.st_mode))
    {
        return error("is not a file but a directory or device");
    }
    file_bytes_ = static_cast<std::uint64_t>(status.st_size);
    if (file_bytes_ == 0)
    {
        return error("is empty");
    }
    return Done{};
}

Result<Done, Refusal> ModelStore::read_header()
{
    std::array<std::byte, sizeof(HeaderFields)> start{};
    const std::size_t available = file_bytes_ < start.size() ? file_bytes_ : start.size();
    if (auto done = read_at(0, std::span(start).first(available), "header"); !done)
    {
        return done;
    }
    // The magic is checked first, so that a short file of another kind is not called a short model.
    if (available < kSpmMagic.size() ||
        std::memcmp(start.data(), kSpmMagic.data(), kSpmMagic.size()) != 0)
    {
        return error("is not an SPM model: it does not begin with the letters TACTSPM");
    }
    const auto fields = ByteReader(start).read<HeaderFields>();
    const bool is_known =
        fields.format_version == kFormatVersion && fields.coder_version == kCoderVersion;
    if (available == start.size() && !is_known)
    {
        return error(fmt::format("has format version {} and coder version {}; this build reads "
                                 "{} and {}",
                                 fields.format_version, fields.coder_version, kFormatVersion,
                                 kCoderVersion));
    }
    if (available < start.size() || fields.header_bytes > file_bytes_)
    {
        return error(
            fmt::format("is cut short: the file ends at byte {}, inside the header", file_bytes_));
    }
    bytes_.resize(fields.header_bytes);
    if (auto done = read_at(0, bytes_, "header"); !done)
    {
        return done;
    }
    const auto header = parse_trusted_header(bytes_);
    if (!header)
    {
        return error(fmt::format("the header (bytes 0 to {}) {}", fields.header_bytes,
                                 refusal_text(header.error())));
    }
    header_ = header.value();
    hash_ = model_hash(bytes_);
    if (fields.file_bytes != file_bytes_)
    {
        return error(
            fmt::format("has {} bytes, but its header states {}: the file is {}", file_bytes_,
                        fields.file_bytes,
                        file_bytes_ < fields.file_bytes ? "cut short" : "followed by other bytes"));
    }
    return Done{};
}

Result<Done, Refusal> ModelStore::check_base() const
{
    const HeaderFields& fields = header_.fields();
    if (fields.base_bytes != coded_base_bytes(fields))
    {
        return error(
            fmt::format("the header states a base mesh of {} bytes, but its counts need {}",
                        fields.base_bytes, coded_base_bytes(fields)));
    }
    std::vector<std::byte> coded;
    if (auto done = read({ContentKind::base, 0}, coded); !done)
    {
        return done;
    }
    std::vector<Vec3f> positions_m(fields.base_vertices);
    std::vector<BaseFace> faces(fields.base_faces);
    std::vector<std::uint32_t> next(fields.base_faces);
    if (auto done = parse_base_mesh(coded, header_, {positions_m, faces, next}); !done)
    {
        return error(fmt::format("the base mesh at offset {} {}", fields.base_offset,
                                 refusal_text(done.error())));
    }
    return Done{};
}

Result<Done, Refusal> ModelStore::read_index()
{
    const ModelCounts counts = header_.counts();
    // Reads page by page, so that a forged header causes no allocation beyond the file's size.
    std::vector<std::byte> coded;
    std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    for (IndexPageId page{0}; page.value < counts.index_pages(); ++page.value)
    {
        if (auto done = read({ContentKind::index_page, page.value}, coded); !done)
        {
            return done;
        }
        IndexPage boxes;
        if (auto done = parse_index_page(coded, counts, page, boxes, entries); !done)
        {
            return error(fmt::format("index page {} at offset {} {}", page.value,
                                     index_page_offset(header_.fields(), page),
                                     refusal_text(done.error())));
        }
        chunks_.insert(chunks_.end(), entries.begin(), entries.begin() + boxes.chunks);
        if (auto done = check_chunk_extents(page); !done)
        {
            return done;
        }
    }
    return Done{};
}

Result<Done, Refusal> ModelStore::check_chunk_extents(IndexPageId page) const
{
    const auto last = static_cast<std::uint32_t>(chunks_.size()) - 1;
    const std::uint64_t start = header_.index_entry(page).chunks_offset;
    const Extent extent = extent_of({ContentKind::chunk, last});
    if (start < bytes_.size() || start > file_bytes_ || extent.offset + extent.bytes > file_bytes_)
    {
        return error(fmt::format(
            "the chunks of index page {} are stated at bytes {} to {}, but the file has {}",
            page.value, start, extent.offset + extent.bytes, file_bytes_));
    }
    return Done{};
}

ModelStore::Extent ModelStore::extent_of(ContentKey key) const noexcept
{
    TACTUS_ASSERT(has(key));
    const HeaderFields& fields = header_.fields();
    const IndexPageId page{key.kind == ContentKind::chunk ? key.number >> kChunksPerIndexPageLog2
                                                          : key.number};
    if (key.kind == ContentKind::base)
    {
        return {fields.base_offset, fields.base_bytes, fields.base_hash};
    }
    const IndexPageEntry entry = header_.index_entry(page);
    if (key.kind == ContentKind::index_page)
    {
        const auto chunks = chunks_in_index_page(header_.counts(), page);
        return {index_page_offset(fields, page), coded_index_page_bytes(chunks), entry.hash};
    }
    TACTUS_ASSERT(key.number < chunks_.size());
    Extent extent{entry.chunks_offset, chunks_[key.number].coded_bytes, chunks_[key.number].hash};
    for (std::uint32_t i = page.value << kChunksPerIndexPageLog2; i < key.number; ++i)
    {
        extent.offset += chunks_[i].coded_bytes;
    }
    return extent;
}

Result<Done, Refusal> ModelStore::read_at(std::uint64_t offset, std::span<std::byte> out,
                                          const std::string& what) const
{
    // `offset` comes from the file and may have any value; pread takes signed offsets.
    constexpr std::uint64_t offset_max = std::numeric_limits<off_t>::max();
    std::size_t done = 0;
    while (done < out.size() && offset <= offset_max - out.size())
    {
        const ssize_t count =
            ::pread(file_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
        if (count < 0 && errno == EINTR)
        {
            continue;
        }
        if (count < 0)
        {
            return error(fmt::format("{} at offset {} cannot be read: {}", what, offset,
                                     std::strerror(errno)));
        }
        if (count == 0)
        {
            break;
        }
        done += static_cast<std::size_t>(count);
    }
    if (done < out.size())
    {
        return error(
            fmt::format("{} at offset {} needs {} bytes, but {} are left: the file was cut short",
                        what, offset, out.size(), done));
    }
    return Done{};
}

Refusal ModelStore::error(const std::string& what) const
{
    return {path_.string() + ": " + what};
}

} // namespace tactus
