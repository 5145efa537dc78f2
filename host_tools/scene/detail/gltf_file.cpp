// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/gltf_file.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/read_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sodium.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <iterator>
#include <system_error>
#include <utility>

namespace tactus::detail
{

namespace
{

constexpr std::string_view kGlbMagic = "glTF";
constexpr std::size_t kGlbHeaderBytes = 12;  ///< Magic, version, total length.
constexpr std::size_t kChunkHeaderBytes = 8; ///< Length and type.
constexpr std::uint32_t kJsonChunk = 0x4E4F'534A;
constexpr std::uint32_t kBinaryChunk = 0x004E'4942;

std::uint32_t u32_at(std::string_view bytes, std::size_t at)
{
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

std::string bytes_of(const std::filesystem::path& path)
{
    auto bytes = read_file(path, kMaxGltfBytes);
    if (!bytes)
    {
        throw SceneFault{bytes.error().text};
    }
    return std::move(bytes).value();
}

/// Data after "base64," of a data URI; throws for another form.
std::string decoded(std::string_view uri, const JsonAt& buffer)
{
    constexpr std::string_view kMark = ";base64,";
    const std::size_t mark = uri.substr(0, 256).find(kMark);
    if (mark == std::string_view::npos)
    {
        buffer.refuse("has a data URI without ';base64,'");
    }
    const std::string_view text = uri.substr(mark + kMark.size());
    std::string bytes(text.size() / 4 * 3 + 3, '\0');
    std::size_t length = 0;
    const char* end = nullptr;
    const int refused =
        sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), text.data(),
                          text.size(), nullptr, &length, &end, sodium_base64_VARIANT_ORIGINAL);
    if (refused != 0 || end != text.data() + text.size())
    {
        buffer.refuse("has a data URI that is not base64");
    }
    bytes.resize(length);
    return bytes;
}

/// Relative file name of a URI: "%20" is a blank. A '%' without two hexadecimal digits after it is
/// kept: some programs write names unescaped.
std::string unescaped(std::string_view uri)
{
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i)
    {
        unsigned code = 0;
        const std::string_view digits = uri.substr(i).substr(1, 2);
        const char* end = digits.data() + digits.size();
        const bool is_code = uri[i] == '%' && digits.size() == 2 &&
                             std::from_chars(digits.data(), end, code, 16).ptr == end && code != 0;
        name += is_code ? static_cast<char>(code) : uri[i];
        i += is_code ? 2 : 0;
    }
    return name;
}

bool is_within_its_folder(const std::filesystem::path& name)
{
    return !name.empty() && name.is_relative() &&
           std::ranges::none_of(name, [](const auto& part) { return part == ".."; });
}

} // namespace

GltfFile::GltfFile(const std::filesystem::path& path) : folder_(path.parent_path())
{
    const std::string bytes = bytes_of(path);
    if (bytes.starts_with(kGlbMagic))
    {
        take_chunks(bytes);
    }
    else
    {
        json_ = std::make_unique<nlohmann::json>(parse_bounded_json(bytes));
    }
    check_asset();
    required_ = required_extensions(root());
    std::ranges::move(extension_notes(root()), std::back_inserter(notes_));
    buffers_.resize(root().size_of("buffers"));
}

GltfFile::~GltfFile() = default;
GltfFile::GltfFile(GltfFile&&) noexcept = default;
GltfFile& GltfFile::operator=(GltfFile&&) noexcept = default;

JsonAt GltfFile::root() const
{
    return {*json_, ""};
}

/// Reads header, JSON, and the binary chunk that most files have; further chunks belong to
/// extensions.
void GltfFile::take_chunks(std::string_view bytes)
{
    if (bytes.size() < kGlbHeaderBytes || u32_at(bytes, 8) > bytes.size() ||
        u32_at(bytes, 8) < kGlbHeaderBytes)
    {
        throw SceneFault{
            fmt::format("is an incomplete GLB: it has {} bytes, its header states {}", bytes.size(),
                        bytes.size() < kGlbHeaderBytes ? kGlbHeaderBytes : u32_at(bytes, 8))};
    }
    if (u32_at(bytes, 4) != 2)
    {
        throw SceneFault{
            fmt::format("is GLB version {}; only version 2 is read", u32_at(bytes, 4))};
    }
    if (const std::size_t tail = bytes.size() - u32_at(bytes, 8); tail > 0)
    {
        notes_.push_back(counted(tail, "byte") + " after the end of the GLB left out");
        bytes.remove_suffix(tail);
    }
    std::size_t at = kGlbHeaderBytes;
    for (std::size_t number = 0; at < bytes.size(); ++number)
    {
        const std::size_t left = bytes.size() - at;
        if (left < kChunkHeaderBytes || u32_at(bytes, at) > left - kChunkHeaderBytes)
        {
            throw SceneFault{
                fmt::format("chunk {} of the GLB, at byte {}, extends beyond its end", number, at)};
        }
        const std::uint32_t type = u32_at(bytes, at + 4);
        const auto chunk = bytes.substr(at + kChunkHeaderBytes, u32_at(bytes, at));
        if (number == 0 && type == kJsonChunk)
        {
            json_ = std::make_unique<nlohmann::json>(parse_bounded_json(chunk));
        }
        if (number == 1 && type == kBinaryChunk)
        {
            binary_ = chunk;
        }
        at += kChunkHeaderBytes + chunk.size();
    }
    if (json_ == nullptr)
    {
        throw SceneFault{"the first chunk of the GLB is not JSON"};
    }
}

void GltfFile::check_asset() const
{
    const JsonAt asset = root().at("asset");
    const JsonAt version = asset.at("version");
    if (!version.text().starts_with("2."))
    {
        version.refuse(fmt::format("is '{}'; only glTF 2 is read", printable(version.text())));
    }
    if (const auto least = asset.find("minVersion"); least && least->text() != "2.0")
    {
        least->refuse(fmt::format("is '{}'; only 2.0 is read", printable(least->text())));
    }
}

bool GltfFile::requires_extension(std::string_view name) const
{
    return std::ranges::find(required_, name) != required_.end();
}

std::string_view GltfFile::buffer(std::size_t index)
{
    std::optional<std::string>& bytes = buffers_.at(index);
    if (!bytes)
    {
        const JsonAt buffer = root().at("buffers").at(index);
        const std::uint64_t length = buffer.at("byteLength").whole(kMaxGltfBytes);
        std::string loaded = load(buffer, index, length);
        if (loaded.size() < length)
        {
            buffer.refuse(fmt::format("has {} bytes; its byteLength is {}", loaded.size(), length));
        }
        if (length > kMaxGltfBytes - buffer_bytes_)
        {
            buffer.refuse(
                fmt::format("exceeds the limit of {} bytes for all buffers", kMaxGltfBytes));
        }
        loaded.resize(length);
        buffer_bytes_ += length;
        bytes = std::move(loaded);
    }
    return *bytes;
}

std::string GltfFile::load(const JsonAt& buffer, std::size_t index, std::uint64_t length) const
{
    const auto uri = buffer.find("uri");
    if (!uri)
    {
        if (index != 0 || !binary_)
        {
            buffer.refuse("has no 'uri', and the file has no binary chunk for it");
        }
        return *binary_;
    }
    if (uri->text().starts_with("data:"))
    {
        return decoded(uri->text(), *uri);
    }
    const std::string name = file_of(*uri);
    auto bytes = read_file(folder_ / name, kMaxGltfBytes);
    if (!bytes)
    {
        uri->refuse(fmt::format("'{}': {}; {} bytes are needed", printable(name),
                                bytes.error().text, length));
    }
    return std::move(bytes).value();
}

/// Relative name of the file that a URI names by the standard. If it does not exist, the URI is
/// read as some programs write it: without escapes, or with backslashes between folders.
std::string GltfFile::file_of(const JsonAt& uri) const
{
    const std::string& text = uri.text();
    std::string slashes = unescaped(text);
    std::ranges::replace(slashes, '\\', '/');
    for (const std::string& name : {unescaped(text), text, slashes})
    {
        if (name.find(':') != std::string::npos || !is_within_its_folder(name))
        {
            uri.refuse(fmt::format("is '{}'; it must name a file in the scene file's folder or "
                                   "below",
                                   printable(name)));
        }
        std::error_code ignored;
        if (std::filesystem::exists(folder_ / name, ignored))
        {
            return name;
        }
    }
    return unescaped(text);
}

bool GltfFile::has_buffer(std::size_t index) const
{
    return root().at("buffers").at(index).find("uri") || (index == 0 && binary_);
}

std::string GltfFile::described(const std::string& list, std::size_t index) const
{
    const JsonAt thing = root().at(list).at(index);
    const std::string name = thing.name();
    const std::string kind = list == "meshes" ? "mesh" : list.substr(0, list.size() - 1);
    return name.empty() ? thing.place()
                        : fmt::format("{} '{}' ({})", kind, printable(name), thing.place());
}

} // namespace tactus::detail
