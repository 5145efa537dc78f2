// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/json_at.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::detail
{

/// Of the file, of each buffer, and of all buffers together: as far as a GLB's own counts go.
inline constexpr std::uint64_t kMaxGltfBytes = 0xFFFF'FFFF;

/// A glTF 2.0 file: its JSON and its buffers. Functions throw a SceneFault where it is none.
class GltfFile
{
public:
    /// Reads .gltf and .glb, told apart by their first bytes, and looks at version and extensions;
    /// of the buffers nothing.
    explicit GltfFile(const std::filesystem::path& path);
    ~GltfFile();
    GltfFile(GltfFile&&) noexcept;
    GltfFile& operator=(GltfFile&&) noexcept;

    [[nodiscard]] JsonAt root() const;

    /// Whether the file can't be understood without that extension.
    [[nodiscard]] bool requires_extension(std::string_view name) const;

    /// What of the file as a whole is left out, one line each.
    [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

    /// Whether buffers[index] says where its bytes are.
    [[nodiscard]] bool has_buffer(std::size_t index) const;

    /// The bytes of buffers[index], as many as its byteLength says: from the file's own binary
    /// chunk, a data URI or a file beside it. Read once, at the first call; then kept.
    [[nodiscard]] std::string_view buffer(std::size_t index);

    /// Of all buffers read so far.
    [[nodiscard]] std::uint64_t buffer_bytes() const noexcept { return buffer_bytes_; }

    /// Of a node, mesh or the like, for messages: node 'Arm' (nodes[3]).
    [[nodiscard]] std::string described(const std::string& list, std::size_t index) const;

private:
    void take_chunks(std::string_view bytes);
    void check_asset() const;
    [[nodiscard]] std::string load(const JsonAt& buffer, std::size_t index,
                                   std::uint64_t length) const;
    [[nodiscard]] std::string file_of(const JsonAt& uri) const;

    std::filesystem::path folder_;
    std::unique_ptr<nlohmann::json> json_; ///< At a fixed address: JsonAt points into it.
    std::optional<std::string> binary_;    ///< Of a GLB that has one.
    std::vector<std::string> required_;
    std::vector<std::string> notes_;
    std::vector<std::optional<std::string>> buffers_;
    std::uint64_t buffer_bytes_{0};
};

} // namespace tactus::detail
