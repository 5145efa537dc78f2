// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/json_at.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::detail
{

/// What becomes of an extension of glTF (docs/scene-files.md has the table).
enum class ExtensionUse
{
    none,  ///< It changes no surface and moves none: materials, lights, sounds, data.
    read,  ///< It is read, or refused at the mesh that can't be read without it.
    named, ///< It adds or moves something that is left out, with a note; the rest stands as it is.
    vital, ///< The same, but a file that requires it is refused.
};

struct KnownExtension
{
    std::string_view name; ///< Where it ends in '_': of all that begin so.
    ExtensionUse use;
    std::string_view left_out; ///< What is not read; empty: nothing.
};

/// Those of Khronos' list, drafts included, and some more that are met in files. The first that
/// fits a name counts.
[[nodiscard]] std::span<const KnownExtension> known_extensions() noexcept;

/// What becomes of an extension; one that is not known is vital.
[[nodiscard]] KnownExtension known_extension(std::string_view name);

/// The names in extensionsRequired, each of which is known and not vital; throws otherwise.
[[nodiscard]] std::vector<std::string> required_extensions(const JsonAt& root);

/// A line for each extension that the file uses, says so or not, and of which something is left
/// out: its name, what is left out and where it stands first.
[[nodiscard]] std::vector<std::string> extension_notes(const JsonAt& root);

} // namespace tactus::detail
