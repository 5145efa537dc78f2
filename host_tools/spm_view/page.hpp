// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>

namespace tactus::view
{

/// A file of host_tools/spm_view/page, compiled into the program.
struct PageFile
{
    const char* url;
    const char* type;
    const char* text;
};

/// All files of the page. Any thread.
[[nodiscard]] std::span<const PageFile> page_files() noexcept;

} // namespace tactus::view
