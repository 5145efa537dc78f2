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
