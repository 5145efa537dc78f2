// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/json_at.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::detail
{

/// Maximum bytes of the file, of each buffer, and of all buffers together: the range of a GLB's
/// counts.
inline constexpr std::uint64_t kMaxGltfBytes = 0xFFFF'FFFF;

/// A glTF 2.0 file: its JSON and its buffers. Functions throw a SceneFault if it is invalid.
class GltfFile
{
public:
    /// Reads .gltf and .glb, distinguished by their first bytes, and checks version and extensions,
    /// but no buffers.
    explicit GltfFile(const std::filesystem::path& path);
    ~GltfFile();
    GltfFile(GltfFile&&) noexcept;
    GltfFile& operator=(GltfFile&&) noexcept;

    [[nodiscard]] JsonAt root() const;

    /// True if the file requires that extension.
    [[nodiscard]] bool requires_extension(std::string_view name) const;

    /// Notes on content of the whole file that is ignored, one line each.
    [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

    /// True if buffers[index] states where its bytes are.
    [[nodiscard]] bool has_buffer(std::size_t index) const;

    /// Bytes of buffers[index], as many as its byteLength: from the binary chunk of a GLB, a data
    /// URI or another file. Read at the first call, then kept.
    [[nodiscard]] std::string_view buffer(std::size_t index);

    /// Bytes of all buffers read so far.
    [[nodiscard]] std::uint64_t buffer_bytes() const noexcept { return buffer_bytes_; }

    /// Description of a node, mesh or the like, for messages: node 'Arm' (nodes[3]).
    [[nodiscard]] std::string described(const std::string& list, std::size_t index) const;

private:
    void take_chunks(std::string_view bytes);
    void check_asset() const;
    [[nodiscard]] std::string load(const JsonAt& buffer, std::size_t index,
                                   std::uint64_t length) const;
    [[nodiscard]] std::string file_of(const JsonAt& uri) const;

    std::filesystem::path folder_;
    /// JSON at a fixed address, since JsonAt points into it.
    std::unique_ptr<nlohmann::json> json_;
    std::optional<std::string> binary_; ///< Binary chunk of a GLB, if any.
    std::vector<std::string> required_;
    std::vector<std::string> notes_;
    std::vector<std::optional<std::string>> buffers_;
    std::uint64_t buffer_bytes_{0};
};

/// Treatment of an extension of glTF (docs/scene-files.md has the table).
enum class ExtensionUse
{
    none,  ///< Ignored: it changes and moves no surface (materials, lights, sounds, data).
    read,  ///< Read; the mesh that uses the extension is refused if it cannot be read.
    named, ///< Ignored with a note: it adds or moves something, the rest is unaffected.
    vital, ///< Ignored with a note, but a file that requires it is refused.
};

/// A glTF extension, and how much of it is read.
struct KnownExtension
{
    std::string_view name; ///< Name; if it ends in '_', the prefix of several names.
    ExtensionUse use;
    std::string_view left_out; ///< Text about the ignored content; empty if nothing is ignored.
};

/// Extensions of Khronos' list, drafts included, and some more that occur in files. The first entry
/// that matches a name applies.
[[nodiscard]] std::span<const KnownExtension> known_extensions() noexcept;

/// Treatment of an extension; an unknown one is vital.
[[nodiscard]] KnownExtension known_extension(std::string_view name);

/// Names in extensionsRequired; throws unless each is known and not vital.
[[nodiscard]] std::vector<std::string> required_extensions(const JsonAt& root);

/// One line for each extension that the file uses, declared or not, and that has ignored content:
/// its name, that content and its first place.
[[nodiscard]] std::vector<std::string> extension_notes(const JsonAt& root);

} // namespace tactus::detail
